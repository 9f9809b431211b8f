// Curves in tiles: acdf/short_curves.h over vectors, operation by operation. Internal linkage: see local_kernel.h.
#pragma once

#include "local_vectors.h"

#include <acdf/short_curves.h>

#include <cstddef>

namespace {

constexpr std::size_t kBlock = 64, kRoom = kBlock + ACDF_WIDTH; // lanes, and what is written behind them

/// Lanes in tiles, and then in cells.
struct Cells {
    std::size_t count;
    alignas(64) double u[2][kRoom], probability[kRoom], product[kRoom]; // of the tile, of the curves in it
    alignas(64) long long low[2][kRoom], high[2][kRoom], curve[kRoom];  // below 0: there is none
    long long lane[kRoom], tile[kRoom];
    bool tilted[kRoom];
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

/* The rest of acdf_tree_draw from a curve on, of a lane. */
__attribute__((noinline)) void draw_on(const std::uint8_t* tree, std::size_t i, Cells* cells) {
    AcdfRange range[2];
    double u[2];
    for (int axis = 0; axis < 2; ++axis) {
        range[axis] = {(std::uint32_t)cells->low[axis][i], (std::uint32_t)cells->high[axis][i], 0.0};
        u[axis] = cells->u[axis][i];
    }
    cells->product[i] = acdf_tree_sample_on(tree, (std::uint32_t)cells->curve[i], u, range, cells->product[i]);
    for (int axis = 0; axis < 2; ++axis) {
        cells->low[axis][i] = range[axis].low;
        cells->high[axis][i] = range[axis].high;
        cells->u[axis][i] = u[axis];
    }
    cells->tilted[i] = range[0].tilt != 0.0 || range[1].tilt != 0.0;
    cells->curve[i] = -1;
}

/* A step of acdf_tree_draw of a vector. Returns whether any lane goes on. Lanes that have another curve are added
 * to a list, without a branch that nobody can guess. */
ACDF_LANE bool draw_step(const std::uint8_t* tree, std::uint32_t units, Cells* cells, std::size_t at,
                         long long** odd) {
    Curves c;
    const Integer curve = loaded(&cells->curve[at]);
    const Mask ended = has(curve, -0x7FFFFFFFFFFFFFFF - 1);
    const Mask served = curves_at(tree, units, choose(ended, Integer{}, curve), &c), taken = without(served, ended);
    const Vector u[2] = {loaded(&cells->u[0][at]), loaded(&cells->u[1][at])};
    const Integer low[2] = {loaded(&cells->low[0][at]), loaded(&cells->low[1][at])};
    const Integer high[2] = {loaded(&cells->high[0][at]), loaded(&cells->high[1][at])};
    const Vector maximum = choose(c.pairs, all(65535.0), all(255.0));
    Vector scaled = choose(c.axis1, u[1], u[0]) * maximum;
    scaled = choose(less(scaled, maximum), scaled, maximum * (1.0 - 0x1p-53));
    const Integer segment = segment_of(c, truncated(scaled));
    const Mask first = equal(segment, Integer{}), last = equal(segment, c.inner);
    const Integer values = loaded_at(c.cumulative + shifted_left(segment - 1, c.code));
    const Integer value_mask = choose(c.pairs, Integer{} + 0xFFFF, Integer{} + 0xFF);
    const Integer below = choose(first, Integer{}, values & value_mask);
    const Integer above = choose(last, value_mask, shifted_right(values, (c.code + 1) << 3) & value_mask);
    const Vector width = converted(above - below), left = (scaled - converted(below)) / width;
    const Integer knots = loaded_at(c.positions + segment - 1);
    const Integer origin = choose(c.axis1, low[1], low[0]), end = choose(c.axis1, high[1], high[0]);
    const Integer from = origin + choose(first, Integer{}, knots & 0xFF);
    const Integer to = choose(last, end, origin + (knots >> 8 & 0xFF));
    const Integer link = loaded_at(c.links + shifted_left(segment, c.link_shift)) & c.link_mask;
    const Mask here[2] = {without(taken, c.axis1), both(taken, c.axis1)};
    for (int axis = 0; axis < 2; ++axis) {
        stored(&cells->u[axis][at], choose(here[axis], left, u[axis]));
        stored(&cells->low[axis][at], choose(here[axis], from, low[axis]));
        stored(&cells->high[axis][at], choose(here[axis], to, high[axis]));
    }
    const Vector product = loaded(&cells->product[at]);
    stored(&cells->product[at], choose(taken, product * (width / maximum), product));
    const Integer next = choose(equal(link, Integer{}), ~Integer{}, curve + link);
    stored(&cells->curve[at], choose(taken, next, curve));
    const unsigned others = lanes(without(without(all_lanes(), served), ended));
    store_packed(*odd, numbers_from(at), others);
    *odd += __builtin_popcount(others);
    return lanes(without(taken, equal(link, Integer{}))) != 0;
}

/* acdf_local_draw_inside of all cells, of which those up to the end of a vector are set. */
ACDF_LANE void draw_inside(const std::uint8_t* tree, std::uint32_t units, Cells* cells) {
    std::size_t live[kRoom / ACDF_WIDTH], count = 0;
    for (std::size_t at = 0; at < cells->count; at += ACDF_WIDTH) {
        stored(&cells->product[at], all(1.0));
        live[count++] = at;
    }
    if (units < 2 * kCurveUnits) {
        for (std::size_t i = 0; i < cells->count; ++i)
            if (cells->curve[i] >= 0) draw_on(tree, i, cells);
        count = 0;
    }
    while (count > 0) {
        std::size_t left = 0;
        long long odd[kRoom], *end = odd;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = live[k];
            live[left] = at;
            left += draw_step(tree, units, cells, at, &end);
        }
        for (const long long* i = odd; i < end; ++i) draw_on(tree, (std::size_t)*i, cells);
        count = left;
    }
    for (std::size_t at = 0; at < cells->count; at += ACDF_WIDTH)
        stored(&cells->probability[at],
               positive(loaded(&cells->probability[at]) * positive(loaded(&cells->product[at]))));
}

} // namespace
