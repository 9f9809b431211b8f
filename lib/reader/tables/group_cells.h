// Writes what draws and densities look up of the cells of groups (acdf/groups.h).
#pragma once

#include "in_parallel.h"
#include "tables/sides.h"

#include <acdf/groups.h>
#include <acdf/sample.h>
#include <acdf/wavefront.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A curve of whose segments groups are made, and the cell that it divides.
struct GroupCurve {
    Cell above;
    std::uint32_t at;
};

/// The segments of a curve that make a group: those that follow each other, up to `last`.
struct GroupRun {
    std::uint32_t curve; ///< which of them
    std::uint32_t first, last;
};

/// What is written, and where to. All but the groups is as long as these tell.
struct GroupCells {
    const AcdfEnvironment& environment;
    const double *heights, *sines; ///< of each border between rows, of the angle to the pole; not on the square
    const GroupCurve* curves;
    const GroupRun* runs; ///< of each group
    const AcdfGroup* groups;
    std::size_t count, cell_count;
    std::uint32_t *boxes, *more;
    AcdfGroupCell* cells;
    float* densities;

    /// Of groups [first, last).
    GroupCells part(std::size_t first, std::size_t last) const noexcept {
        const std::size_t from = groups[first].cells, to = last < count ? groups[last].cells : cell_count;
        return {environment,
                heights,
                sines,
                curves,
                runs + first,
                groups + first,
                last - first,
                to - from,
                boxes + first * ACDF_GROUP_WORDS,
                more + std::size_t{groups[first].more} * ACDF_GROUP_WORDS,
                cells + from,
                densities + from};
    }
};

/// By the best instructions that the processor has, up to `most`: the same bits by any.
void write_group_cells(const GroupCells& cells, Instructions most, const AcdfParallel& parallel) noexcept;
#if ACDF_WAVEFRONT_X86
void write_group_cells_avx2(const GroupCells& cells) noexcept;
void write_group_cells_avx512(const GroupCells& cells) noexcept;
#endif

} // namespace acdf
