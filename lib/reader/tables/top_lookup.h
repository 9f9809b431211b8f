// The lookup grid of the top of a tree of halvings: of each square the deepest split that holds it. Not installed.
#pragma once

#include "check/check.h"
#include "lookup_walk.h"

#include <acdf/top_tile.h>

namespace acdf {

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
