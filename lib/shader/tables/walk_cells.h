// Cells as leaves of acdf/shader/tree.h: on the sphere, on the octahedral square and of half-vectors.
#pragma once

#include "shader/tables/sides.h"

#include <acdf/reader.h>
#include <acdf/shader/brdf.h>
#include <acdf/views.h>

namespace acdf {

struct WalkNode {
    std::uint32_t key, lower, upper, chance;
};
struct WalkLeaf {
    std::uint32_t flags;
    float density, axes[2][4];
};
static_assert(sizeof(WalkNode) == 16 && sizeof(WalkLeaf) == 4 * ACDF_LEAF_WORDS);

inline std::uint32_t float_bits(double x) { return acdf_float_bits(static_cast<float>(x)); }

/// The chance of a node whose parts share lower + upper.
std::uint32_t chance_of(double lower, double upper) noexcept;

/// What traversals pass, and where they end.
class WalkParts {
public:
    std::uint32_t add(const WalkNode& node) noexcept;
    /// Returns a link.
    std::uint32_t add(const WalkLeaf& leaf) noexcept;
    bool failed() const noexcept { return nodes.failed() || leaves.failed(); }

    Growable<WalkNode> nodes;
    Growable<WalkLeaf> leaves;
};

/// How a file's grid shows directions.
class WalkCells {
public:
    WalkCells(std::uint32_t parameterization, std::uint32_t columns, std::uint32_t rows) noexcept;

    /// Trigonometry once, where there are not more than `most` columns or rows. False where memory fails.
    bool remember(std::size_t most) noexcept;
    Cell whole() const noexcept;
    /// What keys of directions are at or above from a position on.
    std::uint32_t key(std::uint32_t axis, std::uint32_t position) const noexcept;
    /// Adds a cell, which is not dark; returns its link. Nodes are added where the cell lies in several pieces of
    /// the sphere.
    std::uint32_t add(const Cell& cell, WalkParts& out) const noexcept;
    bool octahedral() const noexcept { return grid_.parameterization == ACDF_PARAM_OCTAHEDRAL; }

private:
    std::uint32_t square(const Cell& cell, WalkParts& out) const noexcept;
    std::uint32_t half_vectors(const Cell& cell, WalkParts& out) const noexcept;
    std::uint32_t pieces(const Cell& cell, WalkParts& out) const noexcept;
    std::uint32_t steps(std::uint32_t axis) const noexcept { return axis == 0 ? grid_.columns : grid_.rows; }

    AcdfEnvironment grid_ = {};
    Sides sides_;
};

} // namespace acdf
