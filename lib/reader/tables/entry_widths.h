// How wide the cells of table files are, which decides how fine the grids over them are (acdf/table_entries.h).
#pragma once

#include "tables/tree_survey.h"

#include <acdf/table.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Of the cells of a bin.
struct EntryWidths {
    /// Sums of the logarithms, to base 2, of their parts of the positions and of the random numbers of each sampled
    /// axis.
    double place[ACDF_MAX_AXES] = {}, number[ACDF_MAX_AXES] = {};
    std::size_t cells = 0;

    /// Turns such a sum over cells into parts as small as logarithms resolve.
    void divide(std::uint32_t axis, double sum) noexcept {
        place[axis] -= sum;
        number[axis] -= sum;
    }
};

/// Finds them. Logarithms are linear between powers of two. How a few cells divide the cells above them is not
/// looked at: each axis as much as the others, but that of a curve without children.
class EntryWidthsFinder {
public:
    /// `survey`: of the tree; where it is not done, all cells are looked at.
    EntryWidthsFinder(const AcdfTable& table, const TreeSurvey& survey) noexcept;

    /// Of the bin whose tree begins there. False where curves have tilts, or are shared so often, by these bins and
    /// those before, that passing all of them is more work than in proportion to the tree.
    bool find(std::uint32_t root, EntryWidths& out) noexcept;

private:
    /// Positions along an axis that a path through the tree has led to, and these logarithms.
    struct Reached {
        std::uint32_t first = 0, last = 1;
        double place = 0.0, number = 0.0;
    };
    bool add(std::uint32_t at, Reached* reached, EntryWidths& out) noexcept;
    bool pass(std::size_t segments) noexcept;
    std::uint32_t cells_below(std::uint32_t at, std::uint32_t header) const noexcept;

    const AcdfTable& table_;
    const TreeSurvey& survey_;
    std::uint32_t first_axis_, axes_; ///< sampled ones
    std::size_t segments_left_;       ///< that may still be passed
};

} // namespace acdf
