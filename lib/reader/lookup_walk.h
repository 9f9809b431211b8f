// Goes through a tree of halvings and the squares of a grid over its axes. Not installed.
#pragma once

#include "sources.h"

#include <acdf/halvings.h>
#include <acdf/layout.h>

namespace acdf {

/// The squares of an axis: `step` lies in square step * scale / 2^shift.
struct Squares {
    u64 scale;
    u32 shift, count;

    u32 of(u32 step) const { return static_cast<u32>(step * scale >> shift); }
};

/// 2^bits of an axis, by random numbers, and by positions, of scale position_scale.
inline Squares squares_of_numbers(u32 bits) { return {1, 31 - bits, 1u << bits}; }
inline Squares squares_of_positions(u64 scale, u32 bits) { return {scale, 32, 1u << bits}; }
inline u64 position_scale(u32 resolution, u32 bits) { return (u64{1} << (32 + bits)) / resolution; }

/// Finds the deepest node that holds each square.
class LookupWalk {
public:
    LookupWalk(const AcdfHalving* nodes, u32 axes) : nodes_(nodes), axes_(axes) {}

    AcdfSpan steps[ACDF_MAX_AXES], box[ACDF_MAX_AXES]; ///< of the node that put() gets
    AcdfSpan squares[ACDF_MAX_AXES];                   ///< whose deepest node it is

    /// Calls put(node) for each node that is the deepest one of a square, or more. `by_position`: squares are those
    /// of grid steps, not of random numbers.
    template <class Put>
    void run(u32 root, const u32* resolution, const Squares* grid, bool by_position, const Put& put) {
        grid_ = grid;
        by_position_ = by_position;
        for (u32 axis = 0; axis < axes_; ++axis) {
            steps[axis] = {{0, ACDF_STEPS}};
            box[axis] = {{0, resolution[axis]}};
            squares[axis] = {{0, grid[axis].count}};
        }
        visit(root, put);
    }

private:
    // At most 31 deep for each axis.
    template <class Put>
    void visit(u32 node, const Put& put) {
        for (u32 axis = 0; axis < axes_; ++axis)
            if (squares[axis].end[0] >= squares[axis].end[1]) return;
        if (node == ACDF_LEAF) return put(node);
        const AcdfHalving halving = nodes_[node];
        const u32 axis = halving.link & 7u, middle = acdf_span_middle(&box[axis]);
        const u32 border = by_position_ ? middle : halving.threshold;
        const AcdfSpan own_steps = steps[axis], own_box = box[axis], all = squares[axis];
        // Squares that end below the border, and those that begin below it: one more, where it lies within one.
        const u32 below = within(all, grid_[axis].of(border));
        const u32 above = border > 0 ? within(all, grid_[axis].of(border - 1) + 1) : below;
        squares[axis] = {{below, above}};
        if (below < above) put(node);
        for (u32 upper = 0; upper < 2; ++upper) {
            steps[axis] = own_steps;
            box[axis] = own_box;
            steps[axis].end[1 - upper] = halving.threshold;
            box[axis].end[1 - upper] = middle;
            squares[axis] = upper ? AcdfSpan{{above, all.end[1]}} : AcdfSpan{{all.end[0], below}};
            visit(halving.link >> (3 + upper) & 1u ? ACDF_LEAF : node + (upper ? halving.link >> 5 : 1), put);
        }
        steps[axis] = own_steps;
        box[axis] = own_box;
        squares[axis] = all;
    }

    static u32 within(const AcdfSpan& span, u32 square) {
        return square < span.end[0] ? span.end[0] : square > span.end[1] ? span.end[1] : square;
    }

    const AcdfHalving* nodes_;
    u32 axes_;
    const Squares* grid_ = nullptr;
    bool by_position_ = false;
};

} // namespace acdf
