// What BrdfWavefront keeps beside the file, and the loops over it that are compiled for several processors.
#pragma once

#include <acdf/brdf.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

constexpr int kGuideSteps = 4096; // of the coordinate of views in [0, 1]

/// An AcdfSplit without its position.
struct WavefrontSplit {
    std::uint16_t child[2];
    std::uint32_t axis;
};

/// Steps of a binade of positions; positions lie below 2^28.
constexpr int kStepBits = 4, kPositionBits = 28;
constexpr int kBorderSteps = (kPositionBits + 1) << kStepBits;
constexpr int kBordersAtOnce = 8;

/// Positions at which cells end on an axis. Of two squares between the same neighbours among them, on both axes,
/// each cell has both or none.
struct WavefrontBorders {
    const std::int32_t* position; // increasing, then kBordersAtOnce of the largest number
    const std::uint16_t* guide;   // kBorderSteps: so many lie at or below the first square of this step
};

/// Splits of the first three levels, which vectors of eight keep in a register: numbers 0 to 6.
constexpr std::uint32_t kTopLevels = 3;

/// Tables of an isotropic file whose tiles are cells. T: stored views, N: cells, E: N rounded up to a multiple of
/// 8, B[a]: borders on axis a.
struct WavefrontTable {
    AcdfBrdf brdf;
    double columns, rows;
    bool mirrored;
    long long entries; // E
    long long last;    // the last view that can be the lower one of two

    /// E, those of the first levels first, else in their order: children have higher numbers than their parents.
    /// What is left over, the last one at least, leaves all to its lower part and has the children 0.
    const WavefrontSplit* splits;
    WavefrontSplit top[8]; // the first seven, and the last one
    /// E a pair of neighbouring views, T - 1 of them but at least one: code of the lower view, << 16 of the upper
    /// one.
    const std::uint32_t* codes;
    const std::uint32_t* boxes; // 4 a cell: low and high on axis 0, on axis 1
    WavefrontBorders borders[2];
    long long columns_between;   // B[0] + 1
    const std::uint16_t* cells;  // (B[1] + 1) x (B[0] + 1): the cell between two borders; null: too many
    const double* probabilities; // E a view, T + 1 of them: of a cell in its row; the last view stands twice
    const double* areas;         // one a cell, in grid squares
    const double* nodes;         // 2 (T + 1): coordinate of each view and share of its bin; then infinity and 0
    const std::uint16_t* guide;  // kGuideSteps + 1: views from 1 on that lie in steps before this one
};

#if ACDF_WAVEFRONT_X86
void sample_avx2(const WavefrontTable&, const float (*)[3], const double (*)[2], std::size_t, AcdfDirectionSample*);
void sample_avx512(const WavefrontTable&, const float (*)[3], const double (*)[2], std::size_t,
                   AcdfDirectionSample*);
void pdf_avx2(const WavefrontTable&, const float (*)[3], const float (*)[3], std::size_t, float*);
void pdf_avx512(const WavefrontTable&, const float (*)[3], const float (*)[3], std::size_t, float*);
#endif

} // namespace acdf
