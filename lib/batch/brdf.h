// What BrdfBatch keeps beside the file, and the loops over it that are compiled for several processors.
#pragma once

#include <acdf/batch/batch.h>
#include <acdf/brdf.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A split as two neighbouring views have it: the code of each, and where both go.
struct BatchSplit {
    std::uint16_t code[2], child[2];
};
static_assert(sizeof(BatchSplit) == 8);

/// Positions at which cells end on an axis, of AcdfBrdfTables.
struct BatchBorders {
    const std::int32_t* position;
    const std::uint16_t* guide;
};

/// What the loops need beside and of the runtime tables. T: stored views, N: cells, E: N rounded up to a multiple
/// of 8.
struct BatchTable {
    AcdfBrdf brdf;
    double columns, rows, inverse[2]; // inverse: of them
    bool exact_inverse;
    bool mirrored;
    long long entries; // E

    /// E a pair of neighbouring views, T - 1 of them but at least one: first those of axis 0. What is left over,
    /// the last one at least, leaves all to its lower part.
    const BatchSplit* splits;
    long long root, last_of_axis0; // number of the split, or the cell's with its flag; -1: none
    const std::uint32_t* boxes;    // 4 a cell: low and high on axis 0, on axis 1

    // Of the runtime tables:
    long long last, stride, columns_between;
    BatchBorders borders[2];
    const std::uint16_t *grid, *guide;
    const double *parts, *areas, *nodes;
};

#if ACDF_BATCH_X86
void sample_avx2(const BatchTable&, const float (*)[3], const double (*)[2], std::size_t, AcdfDirectionSample*);
void sample_avx512(const BatchTable&, const float (*)[3], const double (*)[2], std::size_t, AcdfDirectionSample*);
void pdf_avx2(const BatchTable&, const float (*)[3], const float (*)[3], std::size_t, float*);
void pdf_avx512(const BatchTable&, const float (*)[3], const float (*)[3], std::size_t, float*);
// Of one view, by tables that have a grid: of those of the file alone.
void view_pdf_avx2(const BatchTable&, const AcdfBrdfView&, const float (*)[3], std::size_t, float*);
void view_pdf_avx512(const BatchTable&, const AcdfBrdfView&, const float (*)[3], std::size_t, float*);
// By tables that have guesses, too.
void view_sample_avx2(const BatchTable&, const AcdfBrdf&, const AcdfBrdfView&, const double (*)[2], std::size_t,
                      AcdfDirectionSample*);
void view_sample_avx512(const BatchTable&, const AcdfBrdf&, const AcdfBrdfView&, const double (*)[2], std::size_t,
                        AcdfDirectionSample*);
#endif

} // namespace acdf
