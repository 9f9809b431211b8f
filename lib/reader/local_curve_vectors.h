// Curves in tiles: acdf/short_curves.h over vectors, operation by operation. Internal linkage: see local_kernel.h.
#pragma once

#include "local_vectors.h"

#include <acdf/short_curves.h>

#include <algorithm>
#include <cstddef>

namespace {

constexpr std::size_t kBlock = 64, kRoom = kBlock + ACDF_WIDTH; // lanes, and what is written behind them

/// Lanes in curves, and then in cells: random numbers are drawn with, or squares are looked for.
struct Boxes {
    std::size_t count;
    alignas(64) double u[2][kRoom], product[kRoom]; // product: of the curves
    alignas(64) long long square[2][kRoom], low[2][kRoom], high[2][kRoom], curve[kRoom];
    alignas(64) long long number[kRoom]; // of the lane among those that were given
    bool lost[kRoom];                    // left to the single call
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
__attribute__((noinline)) void follow(const std::uint8_t* tree, std::size_t i, Boxes* boxes) {
    AcdfRange range[2];
    double u[2];
    std::uint32_t square[2];
    const auto at = (std::uint32_t)boxes->curve[i];
    for (int axis = 0; axis < 2; ++axis) {
        range[axis] = {(std::uint32_t)boxes->low[axis][i], (std::uint32_t)boxes->high[axis][i], 0.0};
        if (Finds) square[axis] = (std::uint32_t)boxes->square[axis][i];
        else u[axis] = boxes->u[axis][i];
    }
    double& product = boxes->product[i];
    if (Finds) product = acdf_tree_find_on(tree, at, square, range, nullptr, product);
    else product = acdf_tree_sample_on(tree, at, u, range, product);
    for (int axis = 0; axis < 2; ++axis) {
        boxes->low[axis][i] = range[axis].low;
        boxes->high[axis][i] = range[axis].high;
        if (!Finds) boxes->u[axis][i] = u[axis];
    }
    boxes->lost[i] = range[0].tilt != 0.0 || range[1].tilt != 0.0;
}

/// The state of a vector of boxes.
struct Here {
    Vector u[2], product;
    Integer square[2], low[2], high[2], curve, number;
    Vector maximum; // of the cumulative values
    Vector scaled;  // of draws: the number in their steps
};

/* The segment that a number leads to, and the one that holds a square. */
ACDF_LANE Integer drawn_segment(const Curves& c, Here* here) {
    here->scaled = choose(c.axis1, here->u[1], here->u[0]) * here->maximum;
    here->scaled = choose(less(here->scaled, here->maximum), here->scaled, here->maximum * (1.0 - 0x1p-53));
    return segment_of(c, truncated(here->scaled));
}
ACDF_LANE Integer found_segment(const Curves& c, const Here& here) {
    const Integer square = choose(c.axis1, here.square[1], here.square[0]);
    const Integer step = square - choose(c.axis1, here.low[1], here.low[0]);
    const Integer key = choose(has(step, ~0xFFll), Integer{} + 255, step);
    const Integer beyond = shifted_left(~Integer{}, c.inner << 3);
    const Integer segment = 8 - bytes_above(loaded_at(c.positions) | beyond, key);
    return choose(less(converted(segment), converted(c.inner)), segment, c.inner);
}

template <bool Finds>
ACDF_LANE Here loaded(const Boxes& from, std::size_t at) {
    Here here;
    for (int axis = 0; axis < 2; ++axis) {
        if (Finds) here.square[axis] = loaded(&from.square[axis][at]);
        else here.u[axis] = loaded(&from.u[axis][at]);
        here.low[axis] = loaded(&from.low[axis][at]);
        here.high[axis] = loaded(&from.high[axis][at]);
    }
    here.product = loaded(&from.product[at]);
    here.curve = loaded(&from.curve[at]);
    here.number = loaded(&from.number[at]);
    return here;
}
/* Adds the lanes of a mask. */
template <bool Finds>
ACDF_LANE void add(const Here& here, unsigned mask, Boxes* to) {
    const std::size_t at = to->count;
    for (int axis = 0; axis < 2; ++axis) {
        if (Finds) store_packed(&to->square[axis][at], here.square[axis], mask);
        else store_packed(&to->u[axis][at], here.u[axis], mask);
        store_packed(&to->low[axis][at], here.low[axis], mask);
        store_packed(&to->high[axis][at], here.high[axis], mask);
    }
    store_packed(&to->product[at], here.product, mask);
    store_packed(&to->curve[at], here.curve, mask);
    store_packed(&to->number[at], here.number, mask);
    to->count = at + (std::size_t)__builtin_popcount(mask);
}

/* A step of acdf_tree_draw or acdf_tree_locate of a vector: lanes that end are added to `done`, and those that have
 * another curve, too, and their places there to a list. Those that go on are packed, in the order in which they
 * were: what is written where they were read was read before. No branch is one that nobody can guess. */
template <bool Finds>
ACDF_LANE void curve_step(const std::uint8_t* tree, std::uint32_t units, std::size_t at, std::size_t count,
                          Boxes* live, Boxes* done, long long** odd) {
    Curves c;
    Here here = loaded<Finds>(*live, at);
    const Mask given = less(converted(numbers_from(at)), all((double)count));
    const unsigned there = lanes(given);
    here.curve = choose(given, here.curve, Integer{}); /* what is behind the last is none */
    const unsigned served = lanes(curves_at(tree, units, here.curve, &c)) & there, others = served ^ there;
    here.maximum = choose(c.pairs, all(65535.0), all(255.0));
    store_packed(*odd, numbers_from(done->count), (1u << __builtin_popcount(others)) - 1u);
    *odd += __builtin_popcount(others);
    add<Finds>(here, others, done);
    const Integer segment = Finds ? found_segment(c, here) : drawn_segment(c, &here);
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
    const Mask stops = equal(link, Integer{}), on[2] = {without(all_lanes(), c.axis1), c.axis1};
    for (int axis = 0; axis < 2; ++axis) {
        if (!Finds) here.u[axis] = choose(on[axis], (here.scaled - converted(below)) / width, here.u[axis]);
        here.low[axis] = choose(on[axis], from, here.low[axis]);
        here.high[axis] = choose(on[axis], to, here.high[axis]);
    }
    here.product = here.product * (width / here.maximum);
    here.curve = here.curve + link;
    unsigned ends = lanes(stops) & served, on_it_goes = served ^ ends;
    if (Finds) { /* curves below what has no probability: the single call tells */
        const unsigned none = on_it_goes & lanes(equal(above, below));
        for (int i = 0; i < __builtin_popcount(none); ++i) done->lost[done->count + (std::size_t)i] = true;
        add<Finds>(here, none, done);
        on_it_goes ^= none;
    }
    add<Finds>(here, ends, done);
    add<Finds>(here, on_it_goes, live);
}

/* The curves of all boxes. */
template <bool Finds>
ACDF_LANE void follow_all(const std::uint8_t* tree, std::uint32_t units, Boxes* live, Boxes* done) {
    for (bool& lost : done->lost) lost = false;
    if (units < 2 * kCurveUnits) {
        for (std::size_t at = 0; at < live->count; at += ACDF_WIDTH) {
            const std::size_t first = done->count, more = std::min<std::size_t>(live->count - at, ACDF_WIDTH);
            add<Finds>(loaded<Finds>(*live, at), (1u << more) - 1u, done);
            for (std::size_t i = first; i < done->count; ++i) follow<Finds>(tree, i, done);
        }
        return;
    }
    while (live->count > 0) {
        const std::size_t count = live->count;
        long long odd[kRoom], *end = odd;
        live->count = 0;
        for (std::size_t at = 0; at < count; at += ACDF_WIDTH)
            curve_step<Finds>(tree, units, at, count, live, done, &end);
        for (const long long* i = odd; i < end; ++i) follow<Finds>(tree, (std::size_t)*i, done);
    }
}

} // namespace
