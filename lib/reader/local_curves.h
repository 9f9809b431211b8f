// Curves in tiles: acdf/short_curves.h over vectors, operation by operation. Internal linkage: see local_kernel.h.
#pragma once

#include "local_vectors.h"

#include <acdf/short_curves.h>

#include <cstddef>

namespace {

constexpr std::size_t kBlock = 64, kRoom = kBlock + ACDF_WIDTH; // lanes, and what is written behind them

/// Lanes in tiles, and then in cells: random numbers are drawn with, or squares are looked for.
struct Cells {
    std::size_t count;
    alignas(64) double u[2][kRoom];
    alignas(64) long long square[2][kRoom];
    alignas(64) double probability[kRoom], product[kRoom];             // of the tile, of the curves in it
    alignas(64) long long low[2][kRoom], high[2][kRoom], curve[kRoom]; // curve: below 0 there is none
    long long lane[kRoom], tile[kRoom];
    bool lost[kRoom]; // left to the single call
};

constexpr std::uint32_t kCurveUnits = 20; // up to which a curve that vectors take is read

/// Curves of up to eight segments, with cumulative values of one or two bytes and positions of one.
struct Curves {
    Integer cumulative, positions; // addresses
    Integer links, link_shift, link_mask, inner, code;
    Mask axis1, pairs; // pairs: code is 1
};

/* Returns the lanes that have such a curve; others are given that at the start of the tree. */
ACDF_LANE Mask curves_at(const std::uint8_t* tree, std::uint32_t units, Integer at, Curves* out) {
    const Mask near = less(all(units - double{kCurveUnits}), converted(at));
    const Integer start = choose(near, Integer{}, at) * 2 + (long long)(std::uintptr_t)tree;
    const Integer header = loaded_at(start) & 0xFFFF;
    const Integer segments = header >> ACDF_CURVE_SEGMENTS_SHIFT, links = header >> 7 & 3;
    const Mask many = either(equal(segments, Integer{}), has(segments - 1, -8));
    const Mask odd = either(has(header, 0x0270), equal(links, Integer{} + 3)); /* larger elements, or tilts */
    const Integer wide = links >> 1;
    out->inner = (segments - 1) & 7;
    out->code = header >> 3 & 1;
    out->pairs = has(header, 8);
    out->axis1 = has(header, 1);
    out->cumulative = start + 2;
    out->positions = out->cumulative + shifted_left(out->inner, out->code);
    out->links = (out->positions + out->inner + wide) & ~wide;
    out->link_shift = wide;
    out->link_mask = shifted_right(Integer{} + 0xFFFF00FF0000, links << 4) & 0xFFFF;
    return without(without(all_lanes(), near), either(many, odd));
}

/* The segment of a key: how many inner values are not above it. */
ACDF_LANE Integer segment_of(const Curves& c, Integer key) {
    const Integer none = ~Integer{}, first = loaded_at(c.cumulative);
    const Integer byte = 8 - bytes_above(first | shifted_left(none, c.inner << 3), key);
    const Integer last = loaded_at(c.cumulative + 8), bits16 = c.inner << 4;
    const Integer beyond = ACDF_BYTES(subs_epu16((Bytes)bits16, (Bytes)(Integer{} + 64)));
    const Integer pair =
        8 - pairs_above(first | shifted_left(none, bits16), last | shifted_left(none, beyond), key);
    return choose(c.pairs, pair, byte);
}

/* The rest of acdf_tree_draw, or of acdf_tree_locate, from a curve on, of a lane. */
template <bool Finds>
__attribute__((noinline)) void follow(const std::uint8_t* tree, std::size_t i, Cells* cells) {
    AcdfRange range[2];
    double u[2];
    std::uint32_t square[2];
    const auto at = (std::uint32_t)cells->curve[i];
    for (int axis = 0; axis < 2; ++axis) {
        range[axis] = {(std::uint32_t)cells->low[axis][i], (std::uint32_t)cells->high[axis][i], 0.0};
        if (Finds) square[axis] = (std::uint32_t)cells->square[axis][i];
        else u[axis] = cells->u[axis][i];
    }
    double& product = cells->product[i];
    if (Finds) product = acdf_tree_find_on(tree, at, square, range, nullptr, product);
    else product = acdf_tree_sample_on(tree, at, u, range, product);
    for (int axis = 0; axis < 2; ++axis) {
        cells->low[axis][i] = range[axis].low;
        cells->high[axis][i] = range[axis].high;
        if (!Finds) cells->u[axis][i] = u[axis];
    }
    cells->lost[i] = range[0].tilt != 0.0 || range[1].tilt != 0.0;
    cells->curve[i] = -1;
}

/// The state of a vector of cells.
struct Here {
    Vector u[2];
    Integer low[2], high[2], curve;
    Vector maximum; // of the cumulative values
    Vector scaled;  // of draws: the number in their steps
};

/* The segment that a number leads to, and the one that holds a square. */
ACDF_LANE Integer drawn_segment(const Curves& c, Here* here) {
    here->scaled = choose(c.axis1, here->u[1], here->u[0]) * here->maximum;
    here->scaled = choose(less(here->scaled, here->maximum), here->scaled, here->maximum * (1.0 - 0x1p-53));
    return segment_of(c, truncated(here->scaled));
}
ACDF_LANE Integer found_segment(const Curves& c, const Cells& cells, const Here& here, std::size_t at) {
    const Integer square = choose(c.axis1, loaded(&cells.square[1][at]), loaded(&cells.square[0][at]));
    const Integer step = square - choose(c.axis1, here.low[1], here.low[0]);
    const Integer key = choose(has(step, ~0xFFll), Integer{} + 255, step);
    const Integer beyond = shifted_left(~Integer{}, c.inner << 3);
    const Integer segment = 8 - bytes_above(loaded_at(c.positions) | beyond, key);
    return choose(less(converted(segment), converted(c.inner)), segment, c.inner);
}

/* A step of acdf_tree_draw or acdf_tree_locate of a vector. Returns whether any lane goes on. Lanes that have
 * another curve are added to a list, without a branch that nobody can guess. */
template <bool Finds>
ACDF_LANE bool curve_step(const std::uint8_t* tree, std::uint32_t units, Cells* cells, std::size_t at,
                          long long** odd) {
    Curves c;
    Here here;
    for (int axis = 0; axis < 2; ++axis) {
        if (!Finds) here.u[axis] = loaded(&cells->u[axis][at]);
        here.low[axis] = loaded(&cells->low[axis][at]);
        here.high[axis] = loaded(&cells->high[axis][at]);
    }
    here.curve = loaded(&cells->curve[at]);
    const Mask ended = has(here.curve, -0x7FFFFFFFFFFFFFFF - 1);
    const Mask served = curves_at(tree, units, choose(ended, Integer{}, here.curve), &c);
    const Mask taken = without(served, ended);
    here.maximum = choose(c.pairs, all(65535.0), all(255.0));
    const Integer segment = Finds ? found_segment(c, *cells, here, at) : drawn_segment(c, &here);
    const Mask first = equal(segment, Integer{}), last = equal(segment, c.inner);
    const Integer values = loaded_at(c.cumulative + shifted_left(segment - 1, c.code));
    const Integer value_mask = choose(c.pairs, Integer{} + 0xFFFF, Integer{} + 0xFF);
    const Integer below = choose(first, Integer{}, values & value_mask);
    const Integer above = choose(last, value_mask, shifted_right(values, (c.code + 1) << 3) & value_mask);
    const Vector width = converted(above - below);
    const Integer knots = loaded_at(c.positions + segment - 1);
    const Integer origin = choose(c.axis1, here.low[1], here.low[0]);
    const Integer end = choose(c.axis1, here.high[1], here.high[0]);
    const Integer from = origin + choose(first, Integer{}, knots & 0xFF);
    const Integer to = choose(last, end, origin + (knots >> 8 & 0xFF));
    const Integer link = loaded_at(c.links + shifted_left(segment, c.link_shift)) & c.link_mask;
    const Mask stops = equal(link, Integer{}), on[2] = {without(taken, c.axis1), both(taken, c.axis1)};
    for (int axis = 0; axis < 2; ++axis) {
        if (!Finds)
            stored(&cells->u[axis][at], choose(on[axis], (here.scaled - converted(below)) / width, here.u[axis]));
        stored(&cells->low[axis][at], choose(on[axis], from, here.low[axis]));
        stored(&cells->high[axis][at], choose(on[axis], to, here.high[axis]));
    }
    const Vector product = loaded(&cells->product[at]);
    stored(&cells->product[at], choose(taken, product * (width / here.maximum), product));
    stored(&cells->curve[at], choose(taken, choose(stops, ~Integer{}, here.curve + link), here.curve));
    const unsigned others = lanes(without(without(all_lanes(), served), ended));
    store_packed(*odd, numbers_from(at), others);
    *odd += __builtin_popcount(others);
    if (Finds) /* curves below what has no probability: the single call tells */
        for (unsigned none = lanes(both(without(taken, stops), equal(above, below))); none; none &= none - 1)
            cells->lost[at + acdf_lowest_bit(none)] = true;
    return lanes(without(taken, stops)) != 0;
}

/* The curves of all cells, of which those up to the end of a vector are set; `product` becomes what they give. */
template <bool Finds>
ACDF_LANE void follow_all(const std::uint8_t* tree, std::uint32_t units, Cells* cells) {
    std::size_t live[kRoom / ACDF_WIDTH], count = 0;
    for (std::size_t at = 0; at < cells->count; at += ACDF_WIDTH) {
        stored(&cells->product[at], all(1.0));
        live[count++] = at;
    }
    if (units < 2 * kCurveUnits) {
        for (std::size_t i = 0; i < cells->count; ++i)
            if (cells->curve[i] >= 0) follow<Finds>(tree, i, cells);
        count = 0;
    }
    while (count > 0) {
        std::size_t left = 0;
        long long odd[kRoom], *end = odd;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = live[k];
            live[left] = at;
            left += curve_step<Finds>(tree, units, cells, at, &end);
        }
        for (const long long* i = odd; i < end; ++i) follow<Finds>(tree, (std::size_t)*i, cells);
        count = left;
    }
}

} // namespace
