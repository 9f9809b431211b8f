// The top of a tree of halvings, where rows have codes of their own, and its lookup grid. Not installed.
#pragma once

#include "check/top.h"
#include "lookup_walk.h"

#include <acdf/top_tile.h>

namespace acdf {

/// Goes through the top of a tree. Paths are at most 62 long: each halving halves the steps of an axis.
class TopTree {
public:
    /// `codes`: a bit for each halving, 1 where rows have codes.
    TopTree(const Parts& parts, const std::uint8_t* codes) : parts_(parts), codes_(codes) {
        for (std::uint32_t axis = 0; axis < 2; ++axis) {
            steps[axis] = {{0, ACDF_STEPS}};
            box[axis] = {{0, parts.axes[axis].resolution}};
        }
    }

    AcdfSpan steps[2], box[2]; ///< of the node that is visited

    std::uint32_t root() const { return parts_.halving_count ? 0 : ACDF_LEAF; }
    /// Whether a node is a split; else it is a tile.
    bool is_split(std::uint32_t node) const { return node != ACDF_LEAF && (codes_[node / 8] >> node % 8 & 1u); }
    std::uint32_t axis_of(std::uint32_t node) const { return parts_.halvings[node].link & 7u; }
    std::uint32_t half_of(std::uint32_t node, std::uint32_t upper) const {
        const std::uint32_t link = parts_.halvings[node].link;
        return link >> (3 + upper) & 1u ? ACDF_LEAF : node + (upper ? link >> 5 : 1);
    }
    /// Calls visit(split, level) for `node` and the splits below it, in preorder; false: not for those below that
    /// one.
    template <class Visit>
    void for_each_split(std::uint32_t node, const Visit& visit) const {
        struct {
            std::uint32_t node, level;
        } open[most_open_halvings];
        std::uint32_t waiting = 0;
        if (is_split(node)) open[waiting++] = {node, 0};
        while (waiting > 0) {
            const auto at = open[--waiting];
            if (!visit(at.node, at.level)) continue;
            for (std::uint32_t upper = 2; upper-- > 0;)
                if (const std::uint32_t half = half_of(at.node, upper); is_split(half))
                    open[waiting++] = {half, at.level + 1};
        }
    }
    std::uint64_t tiles_below(std::uint32_t node) const {
        std::uint64_t count = 1;
        for_each_split(node, [&](std::uint32_t, std::uint32_t) { return ++count, true; });
        return count;
    }

    /// Calls visit(half) while `steps` and `box`, those of a split, are narrowed to a half of it.
    template <class Visit>
    void narrowed(std::uint32_t node, std::uint32_t upper, const Visit& visit) {
        const std::uint32_t axis = axis_of(node);
        const AcdfSpan own_steps = steps[axis], own_box = box[axis];
        steps[axis].end[1 - upper] = parts_.halvings[node].threshold;
        box[axis].end[1 - upper] = acdf_span_middle(&own_box);
        visit(half_of(node, upper));
        steps[axis] = own_steps;
        box[axis] = own_box;
    }

    /// The tile that is visited; of half-vectors, whose pdf is not that of a cell, without a scale.
    AcdfTopTile tile(std::uint32_t node, const double* heights) const {
        const AcdfGrid grid = {parts_.axes[0].resolution, parts_.axes[1].resolution,
                               parts_.description->parameterization};
        const bool sphere = grid.parameterization != ACDF_PARAM_HALF_ANGLE;
        return {sphere ? acdf_box_scale(heights, &grid, box) : 0.0, node, {steps[0], steps[1]}, {box[0], box[1]}};
    }

private:
    const Parts& parts_;
    const std::uint8_t* codes_;
};

/// Bits of the grid's axes: a square for a quarter of a tile or more, of a step or more.
inline std::uint32_t top_lookup_bits(const Parts& parts, std::uint32_t splits) {
    constexpr std::uint32_t most_bits = 7;
    std::uint32_t bits = 0;
    while (bits < most_bits && splits >> 2 * bits > 0 && 2u << bits < parts.axes[ACDF_AXIS_PHI].resolution &&
           2u << bits < parts.axes[ACDF_AXIS_THETA].resolution)
        ++bits;
    return bits;
}

/// Fills a grid of `bits`. split(at, axis, middle) sets the axis and middle of a split; child(at, upper) is its
/// half.
template <class Split, class Child>
void fill_top_starts(std::uint32_t bits, const std::uint32_t scale[2], std::uint32_t* starts, const Split& split,
                     const Child& child) {
    // The first step of an axis in a square.
    const auto first_step = [scale](std::uint32_t axis, std::uint32_t square) {
        return static_cast<std::uint32_t>(((std::uint64_t{square} << 32) + scale[axis] - 1) / scale[axis]);
    };
    for (std::uint32_t y = 0; bits && y < 1u << bits; ++y)
        for (std::uint32_t x = 0; x < 1u << bits; ++x) {
            const std::uint32_t low[2] = {first_step(0, x), first_step(1, y)};
            const std::uint32_t high[2] = {first_step(0, x + 1), first_step(1, y + 1)};
            std::uint32_t at = 0;
            while (!(at & ACDF_TOP_TILE)) {
                std::uint32_t axis = 0, middle = 0;
                split(at, axis, middle);
                if (low[axis] < middle && high[axis] > middle) break;
                at = child(at, low[axis] >= middle);
            }
            starts[y << bits | x] = at;
        }
}

} // namespace acdf
