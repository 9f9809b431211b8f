// The top of a tree of halvings, where rows have codes of their own, and its lookup grid. Not installed.
#pragma once

#include "check/top.h"
#include "halved_tree.h"

#include <acdf/top_tile.h>

namespace acdf {

/// Goes through the top of a tree. Paths are at most 62 long: each halving halves the steps of an axis.
class TopTree {
public:
    /// `codes`: a bit for each halving, 1 where rows have codes.
    TopTree(const Parts& parts, const u8* codes) : parts_(parts), codes_(codes) {
        for (u32 axis = 0; axis < 2; ++axis) {
            steps[axis] = {{0, ACDF_STEPS}};
            box[axis] = {{0, parts.axes[axis].resolution}};
        }
    }

    AcdfSpan steps[2], box[2]; ///< of the node that is visited

    u32 root() const { return parts_.halving_count ? 0 : ACDF_LEAF; }
    /// Whether a node is a split; else it is a tile.
    bool is_split(u32 node) const { return node != ACDF_LEAF && (codes_[node / 8] >> node % 8 & 1u); }
    u32 axis_of(u32 node) const { return parts_.halvings[node].link & 7u; }
    u32 half_of(u32 node, u32 upper) const {
        const u32 link = parts_.halvings[node].link;
        return link >> (3 + upper) & 1u ? ACDF_LEAF : node + (upper ? link >> 5 : 1);
    }
    /// Calls visit(split, level) for `node` and the splits below it, in preorder; false: not for those below that
    /// one.
    template <class Visit>
    void for_each_split(u32 node, const Visit& visit) const {
        struct {
            u32 node, level;
        } open[most_open_halvings];
        u32 waiting = 0;
        if (is_split(node)) open[waiting++] = {node, 0};
        while (waiting > 0) {
            const auto at = open[--waiting];
            if (!visit(at.node, at.level)) continue;
            for (u32 upper = 2; upper-- > 0;)
                if (const u32 half = half_of(at.node, upper); is_split(half))
                    open[waiting++] = {half, at.level + 1};
        }
    }
    u64 tiles_below(u32 node) const;

    /// Calls visit(half) while `steps` and `box`, those of a split, are narrowed to a half of it.
    template <class Visit>
    void narrowed(u32 node, u32 upper, const Visit& visit) {
        const u32 axis = axis_of(node);
        const AcdfSpan own_steps = steps[axis], own_box = box[axis];
        steps[axis].end[1 - upper] = parts_.halvings[node].threshold;
        box[axis].end[1 - upper] = acdf_span_middle(&own_box);
        visit(half_of(node, upper));
        steps[axis] = own_steps;
        box[axis] = own_box;
    }

    /// The tile that is visited; of half-vectors, whose pdf is not that of a cell, without a scale.
    AcdfTopTile tile(u32 node, const double* heights) const;

private:
    const Parts& parts_;
    const u8* codes_;
};

/// Bits of the grid's axes: a square for a quarter of a tile or more, of a step or more.
u32 top_lookup_bits(const Parts& parts, u32 splits);

/// Fills a grid of `bits`. split(at, axis, middle) sets the axis and middle of a split; child(at, upper) is its
/// half.
template <class Split, class Child>
void fill_top_starts(u32 bits, const u32 scale[2], u32* starts, const Split& split, const Child& child) {
    // The first step of an axis in a square.
    const auto first_step = [scale](u32 axis, u32 square) {
        return static_cast<u32>(((u64{square} << 32) + scale[axis] - 1) / scale[axis]);
    };
    for (u32 y = 0; bits && y < 1u << bits; ++y)
        for (u32 x = 0; x < 1u << bits; ++x) {
            const u32 low[2] = {first_step(0, x), first_step(1, y)};
            const u32 high[2] = {first_step(0, x + 1), first_step(1, y + 1)};
            u32 at = 0;
            while (!(at & ACDF_TOP_TILE)) {
                u32 axis = 0, middle = 0;
                split(at, axis, middle);
                if (low[axis] < middle && high[axis] > middle) break;
                at = child(at, low[axis] >= middle);
            }
            starts[y << bits | x] = at;
        }
}

} // namespace acdf
