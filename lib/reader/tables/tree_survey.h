// How many cells and curves a tree has, before tables are made of it.
#pragma once

#include "tables/growable.h"

#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Of the tree of an environment.
class TreeSurvey {
public:
    struct Curve {
        std::uint32_t cells, curves; ///< below it, itself included
    };

    /// Of a tree that takes `tree_units`. The work is linear in them.
    TreeSurvey(const AcdfEnvironment& environment, std::uint32_t tree_units) noexcept;

    /// Whether there are no tilts, curves are not shared so often that walking them all is more work than in
    /// proportion to the tree, and memory did not fail. Else nothing below is known.
    bool done() const noexcept { return done_; }
    /// Twice the units of the tree, and some.
    std::size_t most_steps() const noexcept { return most_steps_; }
    std::uint32_t cells() const noexcept { return curves_[0].cells; }
    /// In the order of the walk of all; the first one is the root.
    const Curve& operator[](std::size_t i) const noexcept { return curves_[i]; }

private:
    bool walk(std::uint32_t at, std::uint32_t& cells) noexcept;

    const std::uint8_t* tree_;
    std::size_t most_steps_, steps_ = 0; ///< segments of curves
    Growable<Curve> curves_;
    bool done_ = false;
};

} // namespace acdf
