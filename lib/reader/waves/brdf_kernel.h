// The loops of BrdfWavefront over vectors of ACDF_WIDTH doubles, by the extensions of GCC and Clang. Included by
// one source a set of instructions, compiled for it; nothing here may be inline with external linkage, lest the
// linker picks code that the processor does not have.
//
// Each function is that of the same name in acdf/brdf.h and acdf/blend.h, a lane an element, operation by
// operation: results agree bit for bit. Lanes that need a branch are left to those functions.
#pragma once

#include "waves/brdf.h"
#include "waves/elementary_vectors.h"

#include <cstring>

namespace {

using acdf::WavefrontTable;

constexpr int kGroups = 3; // vectors that take turns: while one waits for its loads the others compute

// ---- views -----------------------------------------------------------------------------------------------------

struct Directions {
    Vector x, y, z;
};

ACDF_LANE Directions load(const float (*v)[3]) {
    Vector axis[3];
    load_transposed(v, axis);
    return {axis[0], axis[1], axis[2]};
}

ACDF_LANE Integer of_unit_length(Vector length2) { return length2 > 0.999 && length2 < 1.001; }

/* acdf_brdf_view of isotropic files. Lanes of no view have the weights 0 and a place inside the tables. */
struct View {
    Directions wo;
    Vector turn[2], weight[2];
    Integer lower; // the lower one of the two stored views
};

ACDF_LANE View view_of(const WavefrontTable& t, const Directions& wo) {
    View out;
    const Vector sin2 = wo.x * wo.x + wo.y * wo.y, length2 = sin2 + wo.z * wo.z;
    const Integer valid = of_unit_length(length2) & (wo.z > 0.0);
    const Vector z = select(valid, wo.z, all(1.0));
    const Vector x2 = select(z < 1.0, 1.0 - z, all(0.0)), x = root(x2);
    Integer low = gathered<2>(t.guide, truncated(x2 * (double)ACDF_VIEW_STEPS)) & 0xFFFF;
    Vector node[4]; // coordinate and share of the lower view, and of the upper one
    gather_transposed(t.nodes, low, node);
    for (;;) {
        const Integer more = (node[2] <= x) & (low < t.last);
        if (!any(more)) break;
        low -= more;
        gather_transposed(t.nodes, low, node);
    }
    Vector s = (x - node[0]) / (node[2] - node[0]);
    s = select(s > 0.0, select(s < 1.0, s, all(1.0)), all(0.0));
    out.wo = wo;
    out.weight[0] = select(valid, (1.0 - s) * node[1], all(0.0));
    out.weight[1] = select(valid, s * node[3], all(0.0));
    out.lower = low;
    out.turn[0] = select(sin2 > 0.0, wo.x, all(1.0));
    out.turn[1] = select(sin2 > 0.0, wo.y, all(0.0));
    return out;
}

// ---- walks -----------------------------------------------------------------------------------------------------

struct Walk {
    Vector x[2], weight[2], chosen;
    Integer base, node;
};

/* The split of a lane, or the entry behind the last one for lanes that are in a tile: all of their weight goes to
 * its lower part, which changes nothing. */
ACDF_LANE Integer split_of(const WavefrontTable& t, const Walk& s) {
    return least(s.node, Integer{} + (t.entries - 1));
}

template <bool Top>
ACDF_LANE Integer split_at(const WavefrontTable& t, Integer number) {
#if ACDF_WIDTH == 8
    if (Top) return (Integer)_mm512_permutexvar_epi64((__m512i)number, _mm512_loadu_si512(t.top));
#endif
    return gathered<8>(t.splits, number);
}

/* Children have higher numbers than their parents, tiles higher ones than splits; that entry's are 0. */
ACDF_LANE void take(Walk* s, Integer upper, Integer split) {
    s->node = most(s->node, select(upper, split >> 16, split) & 0xFFFF);
}

/* Goes on from splits whose lower parts rows give so much of theirs. Returns the lanes that go to the upper part.
 */
ACDF_LANE Integer go(Walk* s, const Vector code[2], Integer axis1) {
    const Vector lower0 = s->weight[0] * code[0], lower1 = s->weight[1] * code[1];
    const Vector higher0 = s->weight[0] - lower0, higher1 = s->weight[1] - lower1;
    const Vector low = lower0 + lower1, high = higher0 + higher1;
    const Integer axis = axis1 != 0;
    const Vector x = select(axis, s->x[1], s->x[0]);
    const Integer upper = (x >= low) & (high > 0.0);
    const Vector sum = select(upper, high, low), scale = sum / s->chosen, cut = select(upper, x - low, x);
    s->x[0] = select(axis, s->x[0] * scale, cut);
    s->x[1] = select(axis, cut, s->x[1] * scale);
    s->chosen = sum;
    s->weight[0] = select(upper, higher0, lower0);
    s->weight[1] = select(upper, higher1, lower1);
    return upper;
}

template <bool Top>
ACDF_LANE void sample_step(const WavefrontTable& t, Walk* s) {
    const Integer at = split_of(t, *s), split = split_at<Top>(t, at), codes = gathered_words(t.codes, s->base + at);
    const Vector code[2] = {converted(codes & 0xFFFF) * (1.0 / 65535.0), converted(codes >> 16) * (1.0 / 65535.0)};
    take(s, go(s, code, split >> 32), split);
}

ACDF_LANE void walk(const WavefrontTable& t, Walk* s) {
    for (std::uint32_t level = 0; level < acdf::kTopLevels; ++level)
        for (int g = 0; g < kGroups; ++g) sample_step<true>(t, &s[g]);
    for (;;) {
        Integer open{};
        for (int g = 0; g < kGroups; ++g) open |= s[g].node < ACDF_TILE_FLAG;
        if (!any(open)) return;
        for (int g = 0; g < kGroups; ++g) sample_step<false>(t, &s[g]);
    }
}

// ---- cells -----------------------------------------------------------------------------------------------------

struct Cell {
    Vector low[2], high[2];
};

/* What views give of themselves to a cell to which their rows give those parts. */
ACDF_LANE Vector share_of(const View& view, const Vector part[2]) {
    return (view.weight[0] * part[0] + view.weight[1] * part[1]) / (view.weight[0] + view.weight[1]);
}

ACDF_LANE Cell cell_of(const WavefrontTable& t, const Walk& s) {
    Cell out;
    for (int axis = 0; axis < 2; ++axis) {
        const Integer box = gathered<8>(t.boxes, 2 * (s.node & 0x7FFF) + axis);
        out.low[axis] = converted(box & 0xFFFFFFFF);
        out.high[axis] = converted(box >> 32 & 0xFFFFFFFF);
    }
    return out;
}

struct Place {
    Vector position[2], dot, length;
};

ACDF_LANE Integer half_of(const View& view, const Directions& wi, Directions* half, Place* place) {
    const Vector length2 = wi.x * wi.x + wi.y * wi.y + wi.z * wi.z;
    half->x = view.wo.x + wi.x;
    half->y = view.wo.y + wi.y;
    half->z = view.wo.z + wi.z;
    place->length = root(half->x * half->x + half->y * half->y + half->z * half->z);
    place->dot = absolute(view.wo.x * half->x + view.wo.y * half->y + view.wo.z * half->z);
    return of_unit_length(length2) & (place->length > 0.0);
}

ACDF_LANE Integer place_of(const WavefrontTable& t, const View& view, const Directions& wi, Place* place) {
    Directions half;
    const Integer valid = half_of(view, wi, &half, place);
    const Vector below = 1.0 - 2.0 * one_if(half.z < 0.0);
    const Vector hx = below * (view.turn[0] * half.x + view.turn[1] * half.y);
    const Vector hy = below * (view.turn[0] * half.y - view.turn[1] * half.x);
    const Vector phi = azimuth(absolute(hy), hx);
    const Vector sign = 1.0 - 2.0 * one_if(hy < 0.0);
    place->position[0] = t.columns * (t.mirrored ? phi : 0.5 + 0.5 * sign * phi);
    place->position[1] =
        t.rows * ((half.x * half.x + half.y * half.y) / (place->length * (place->length + absolute(half.z))));
    return valid;
}

ACDF_LANE Vector density(const WavefrontTable& t, Vector probability, Vector area, const Place& place) {
    const Vector pdf = probability * t.columns * t.rows * place.length / (8.0 * ACDF_PI * place.dot * area);
    const Vector bounded = select(pdf >= 3.402823466e38, all(3.402823466e38f), pdf);
    const Vector positive = select(pdf > 1.17549435e-38, bounded, all(1.17549435e-38f));
    return select(probability > 0.0, rounded_to_float(positive), all(0.0));
}

struct Reflection {
    Directions wi;
    Vector reach[2];
};

ACDF_LANE Reflection reflect(const WavefrontTable& t, const View& view, const Vector position[2], Vector sign) {
    Reflection out;
    const Vector cap = position[1] / t.rows, hz = 1.0 - cap, radius = root(cap * (2.0 - cap));
    const Vector x = position[0] / t.columns;
    const Vector scale = radius / root(view.turn[0] * view.turn[0] + view.turn[1] * view.turn[1]);
    Vector sine, cosine;
    sincospi(t.mirrored ? sign * x : 2.0 * x - 1.0, &sine, &cosine);
    const Vector hx = scale * (view.turn[0] * cosine - view.turn[1] * sine);
    const Vector hy = scale * (view.turn[1] * cosine + view.turn[0] * sine);
    const Vector dot = 2.0 * (view.wo.x * hx + view.wo.y * hy + view.wo.z * hz);
    out.wi.x = rounded_to_float(dot * hx - view.wo.x);
    out.wi.y = rounded_to_float(dot * hy - view.wo.y);
    out.wi.z = rounded_to_float(dot * hz - view.wo.z);
    const Vector turn = 0x1p-23 / (absolute(dot) * radius), angle = turn * radius;
    out.reach[0] = t.columns * turn;
    out.reach[1] = t.rows * (angle * (radius + angle));
    return out;
}

ACDF_LANE Integer inside(const Cell& cell, const Vector position[2], const Vector reach[2]) {
    return (position[0] >= cell.low[0] + reach[0]) & (position[0] < cell.high[0] - reach[0]) &
           (position[1] >= cell.low[1] + reach[1]) & (position[1] < cell.high[1] - reach[1]);
}

// ---- samples ---------------------------------------------------------------------------------------------------

ACDF_LANE Vector clamp(Vector x, double low, double high) {
    return select(x < low, all(low), select(x > high, all(high), x));
}

/* All but where it begins. */
ACDF_LANE void begin_walk(const WavefrontTable& t, const View& view, Vector u0, Vector u1, Walk* s, Vector* sign) {
    Vector u[2] = {unit_interval(u0), unit_interval(u1)};
    *sign = all(1.0);
    if (t.mirrored) {
        const Vector v = 2.0 * u[0] - 1.0;
        *sign = select(v < 0.0, all(-1.0), all(1.0));
        u[0] = absolute(v);
    }
    s->chosen = view.weight[0] + view.weight[1];
    for (int axis = 0; axis < 2; ++axis) s->x[axis] = u[axis] * s->chosen;
    for (int i = 0; i < 2; ++i) s->weight[i] = view.weight[i];
}

constexpr std::size_t kBlock = kGroups * kWidth;

/* A block of lanes whose cells are drawn. */
struct Samples {
    static constexpr bool kWaits = false; // walks wait for memory at every step
    View view[kGroups];
    Walk walked[kGroups];
    Vector sign[kGroups];
    const float (*wo)[3];
    const double (*u)[2];
};

ACDF_LANE void begin(const WavefrontTable& t, const float (*wo)[3], const double (*u)[2], Samples* s) {
    s->wo = wo;
    s->u = u;
    for (int g = 0; g < kGroups; ++g) {
        const int lane = g * kWidth;
        s->view[g] = view_of(t, load(&wo[lane]));
        begin_walk(t, s->view[g], every_second(u[lane]), every_second(u[lane] + 1), &s->walked[g], &s->sign[g]);
        s->walked[g].base = s->view[g].lower * t.entries;
        s->walked[g].node = Integer{} + acdf_blend_root(&t.brdf.blend);
    }
    walk(t, s->walked);
}

/* Writes the samples of a vector of lanes in their cells. Returns the lanes that are left to acdf_brdf_sample. */
ACDF_LANE unsigned end_sample(const WavefrontTable& t, const View& view, const Walk& s, const Cell& cell,
                              Vector sign, AcdfDirectionSample* out) {
    const Integer valid = view.weight[0] + view.weight[1] > 0.0;
    const Integer number = s.node & 0x7FFF, at = multiplied(number, t.stride) + view.lower;
    const Vector area = (Vector)gathered<8>(t.areas, number);
    const Vector part[2] = {(Vector)gathered<8>(t.parts, at), (Vector)gathered<8>(t.parts + 1, at)};
    Vector position[2];
    for (int axis = 0; axis < 2; ++axis) {
        const Vector u = select(s.x[axis] < s.chosen, s.x[axis] / s.chosen, all(1.0));
        position[axis] = cell.low[axis] + clamp(u, 0x1p-30, 1.0 - 0x1p-30) * (cell.high[axis] - cell.low[axis]);
    }
    const Reflection to = reflect(t, view, position, sign);
    Directions half;
    Place place;
    const Integer good = half_of(view, to.wi, &half, &place) & inside(cell, position, to.reach);
    const Vector none = all(0.0);
    store(out, select(valid, to.wi.x, none), select(valid, to.wi.y, none), select(valid, to.wi.z, none),
          select(valid, density(t, positive(share_of(view, part)), area, place), none));
    return bits(valid & ~good);
}

ACDF_LANE void end(const WavefrontTable& t, const Samples& s, AcdfDirectionSample* out) {
    for (int g = 0; g < kGroups; ++g) {
        unsigned left = end_sample(t, s.view[g], s.walked[g], cell_of(t, s.walked[g]), s.sign[g], &out[g * kWidth]);
        for (int lane = g * kWidth; left != 0; ++lane, left >>= 1)
            if (left & 1) out[lane] = acdf_brdf_sample(&t.brdf, s.wo[lane], s.u[lane][0], s.u[lane][1]);
    }
}

// ---- all of two arrays -----------------------------------------------------------------------------------------

constexpr std::size_t kBlocksAhead = 4;

/* Past the end of arrays this asks for what is not there, which does nothing. */
template <class T>
ACDF_LANE void prefetch_block(const T* all, std::size_t first) {
    for (std::size_t i = 0; i < sizeof(T) * kBlock; i += 64)
        __builtin_prefetch((const void*)((std::uintptr_t)all + sizeof(T) * first + i));
}

/* Blocks that wait for memory end after the next one began. What does not fill a block is copied to the front of
 * one. */
template <class Block, class A, class B, class Out>
ACDF_LANE void for_blocks(const WavefrontTable& t, const A* a, const B* b, std::size_t count, Out* out) {
    constexpr std::size_t behind = Block::kWaits ? 1 : 0;
    Block blocks[behind + 1];
    const std::size_t whole = count / kBlock, done = whole * kBlock, left = count - done;
    for (std::size_t i = 0; i < whole + behind; ++i) {
        const std::size_t ahead = (i + kBlocksAhead) * kBlock;
        prefetch_block(a, ahead);
        prefetch_block(b, ahead);
        prefetch_block(out, ahead);
        if (i < whole) begin(t, a + i * kBlock, b + i * kBlock, &blocks[i % (behind + 1)]);
        if (i >= behind) end(t, blocks[(i - behind) % (behind + 1)], out + (i - behind) * kBlock);
    }
    if (left == 0) return;
    A last_a[kBlock] = {};
    B last_b[kBlock] = {};
    Out last_out[kBlock];
    std::memcpy(last_a, a + done, left * sizeof(A));
    std::memcpy(last_b, b + done, left * sizeof(B));
    begin(t, last_a, last_b, &blocks[0]);
    end(t, blocks[0], last_out);
    std::memcpy(out + done, last_out, left * sizeof(Out));
}

} // namespace
