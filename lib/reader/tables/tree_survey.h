// How many cells and curves a tree has, before tables are made of it.
#pragma once

#include "tables/growable.h"

#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Of the trees of an environment or a table.
class TreeSurvey {
public:
    /// More cells below a curve than are distinguished.
    static constexpr std::uint32_t kMany = 65535;

    /// Of no tree.
    TreeSurvey() noexcept = default;
    /// Of a tree that takes `tree_units`. The work is linear in them.
    TreeSurvey(const AcdfEnvironment& environment, std::uint32_t tree_units) noexcept;

    /// Whether there are no tilts, curves are not shared so often that visiting them all is more work than in
    /// proportion to the tree, and memory did not fail. Else nothing below is known.
    bool done() const noexcept { return done_; }
    /// Twice the units of the tree, and some.
    std::size_t most_steps() const noexcept { return most_steps_; }
    /// Cells of all trees.
    std::uint32_t cells() const noexcept { return cells_; }
    /// Cells below the curve at `at`, which has that header; at most kMany.
    std::uint32_t cells(std::uint32_t at, std::uint32_t header) const noexcept {
        return ends(header) ? header >> ACDF_CURVE_SEGMENTS_SHIFT : below_[at / 2];
    }

    // Who passes all curves, anyway, makes the survey so: begin(), add() for each that does not end, and end().

    /// Whether a curve has neither children nor tilts, and as few segments as the header holds.
    static bool ends(std::uint32_t header) noexcept {
        return header >> ACDF_CURVE_SEGMENTS_SHIFT != 0 && ACDF_CURVE_LINK_CODE(header) == 0 &&
               !(header & ACDF_CURVE_TILTED);
    }
    /// False where memory fails.
    bool begin(std::uint32_t tree_units) noexcept;
    void add(std::uint32_t at, std::uint32_t cells) noexcept {
        below_[at / 2] = static_cast<std::uint16_t>(cells < kMany ? cells : kMany);
    }
    void end(std::uint32_t cells) noexcept;

private:
    bool walk(std::uint32_t at, std::uint32_t& cells) noexcept;

    const std::uint8_t* tree_ = nullptr;
    std::size_t most_steps_ = 0, steps_ = 0; ///< segments of curves
    std::uint32_t cells_ = 0;
    Growable<std::uint16_t> below_; ///< of each two units: curves that do not end are as long
    bool done_ = false;
};

} // namespace acdf
