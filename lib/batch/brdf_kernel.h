// The loops of BrdfBatch over vectors of ACDF_WIDTH doubles, by the extensions of GCC and Clang. Included by
// one source a set of instructions, compiled for it; nothing here may be inline with external linkage, lest the
// linker picks code that the processor does not have.
//
// Each function is that of the same name in acdf/brdf.h and acdf/blend.h, a lane an element, operation by
// operation: results agree bit for bit. Lanes that need a branch are left to those functions.
#pragma once

#include "batch/brdf.h"
#include "batch/elementary_vectors.h"

#include <cstring>

namespace {

using acdf::BatchSplit;
using acdf::BatchTable;

constexpr int kGroups = 6; // vectors that take turns: while one waits for its loads the others compute

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

/* acdf_brdf_view of isotropic files. Lanes of no view have the weights 0 and a position inside the tables. */
struct View {
    Directions wo;
    Vector turn[2], weight[2];
    Integer lower; // the lower one of the two stored views
};

/* Vectors of lanes take turns. */
ACDF_LANE void find_views(const BatchTable& t, const float (*wo)[3], View* out) {
    Vector x[kGroups], node[kGroups][4]; // node: coordinate and share of the lower view, and of the upper one
    Integer valid[kGroups], more{};
    for (int g = 0; g < kGroups; ++g) {
        const Directions w = load(&wo[g * kWidth]);
        const Vector sin2 = w.x * w.x + w.y * w.y, length2 = sin2 + w.z * w.z;
        valid[g] = of_unit_length(length2) & (w.z > 0.0);
        const Vector z = select(valid[g], w.z, all(1.0));
        const Vector x2 = select(z < 1.0, 1.0 - z, all(0.0));
        x[g] = root(x2);
        out[g].lower = gathered<2>(t.guide, truncated(x2 * (double)ACDF_VIEW_STEPS)) & 0xFFFF;
        out[g].wo = w;
        out[g].turn[0] = select(sin2 > 0.0, w.x, all(1.0));
        out[g].turn[1] = select(sin2 > 0.0, w.y, all(0.0));
    }
    do {
        more = Integer{};
        for (int g = 0; g < kGroups; ++g) {
            gather_transposed(t.nodes, out[g].lower, node[g]);
            const Integer beyond = (node[g][2] <= x[g]) & (out[g].lower < t.last);
            out[g].lower -= beyond;
            more |= beyond;
        }
    } while (any(more));
    for (int g = 0; g < kGroups; ++g) {
        Vector s = (x[g] - node[g][0]) / (node[g][2] - node[g][0]);
        s = select(s > 0.0, select(s < 1.0, s, all(1.0)), all(0.0));
        out[g].weight[0] = select(valid[g], (1.0 - s) * node[g][1], all(0.0));
        out[g].weight[1] = select(valid[g], s * node[g][3], all(0.0));
    }
}

// ---- traversals
// -----------------------------------------------------------------------------------------------------

struct Walk {
    Vector x[2], weight[2], chosen;
    Integer base, node;
};

/* Goes on from splits whose lower parts rows give so much of theirs. Returns the lanes that go to the upper part.
 */
ACDF_LANE Integer go(Walk* s, const Vector code[2], Integer axis1) {
    const Vector lower0 = s->weight[0] * code[0], lower1 = s->weight[1] * code[1];
    const Vector higher0 = s->weight[0] - lower0, higher1 = s->weight[1] - lower1;
    const Vector low = lower0 + lower1, high = higher0 + higher1;
    const Vector x = select(axis1, s->x[1], s->x[0]);
    const Integer upper = (x >= low) & (high > 0.0);
    const Vector sum = select(upper, high, low), scale = sum / s->chosen, cut = select(upper, x - low, x);
    s->x[0] = select(axis1, s->x[0] * scale, cut);
    s->x[1] = select(axis1, cut, s->x[1] * scale);
    s->chosen = sum;
    s->weight[0] = select(upper, higher0, lower0);
    s->weight[1] = select(upper, higher1, lower1);
    return upper;
}

/* Lanes that are in a cell give all of their weight to the lower part of the entry behind the last split, which
 * changes nothing. All vectors load before the first one computes: what waits for loads leaves schedulers no room
 * for others. */
ACDF_LANE void walk(const BatchTable& t, Walk* walked) {
    const Integer end = Integer{} + (t.entries - 1);
    Walk s[kGroups]; // else compilers store each vector twice
    for (int g = 0; g < kGroups; ++g) s[g] = walked[g];
    for (;;) {
        Integer open{}, split[kGroups];
        for (const Walk& of : s) open |= of.node < (long long)ACDF_TILE_FLAG;
        if (!any(open)) break;
        for (int g = 0; g < kGroups; ++g)
            split[g] = gathered<sizeof(BatchSplit)>(t.splits, s[g].base + least(s[g].node, end));
        for (int g = 0; g < kGroups; ++g) {
            const Vector code[2] = {converted(split[g] & 0xFFFF) * (1.0 / 65535.0),
                                    converted(split[g] & 0xFFFF0000) * (0x1p-16 / 65535.0)};
            const Integer upper = go(&s[g], code, s[g].node > t.last_of_axis0);
            const Unsigned children = (Unsigned)split[g] >> 32;
            const Integer child = select(upper, (Integer)(children >> 16), (Integer)(children & 0xFFFF));
            s[g].node = select(s[g].node > end, s[g].node, child);
        }
    }
    for (int g = 0; g < kGroups; ++g) walked[g] = s[g];
}

// ---- cells -----------------------------------------------------------------------------------------------------

struct Cell {
    Vector low[2], high[2];
};

/* What views give of themselves to a cell to which their rows give those parts. */
ACDF_LANE Vector share_of(const View& view, const Vector part[2]) {
    return (view.weight[0] * part[0] + view.weight[1] * part[1]) / (view.weight[0] + view.weight[1]);
}

ACDF_LANE Vector low_word(Integer pair) { return converted(pair & 0xFFFFFFFF); }
ACDF_LANE Vector high_word(Integer pair) { return converted((Integer)((Unsigned)pair >> 32)); }

ACDF_LANE Cell cell_of(const BatchTable& t, const Walk& s) {
    Vector sides[2];
    gather_pairs<16>(t.boxes, s.node & 0x7FFF, sides);
    const Integer across = (Integer)sides[0], along = (Integer)sides[1];
    return {{low_word(across), low_word(along)}, {high_word(across), high_word(along)}};
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

/* The position of a half-vector. */
ACDF_LANE void place_half(const BatchTable& t, const View& view, const Directions& half, Place* place) {
    const Vector below = 1.0 - 2.0 * one_if(half.z < 0.0);
    const Vector hx = below * (view.turn[0] * half.x + view.turn[1] * half.y);
    const Vector hy = below * (view.turn[0] * half.y - view.turn[1] * half.x);
    const Vector phi = azimuth(absolute(hy), hx);
    const Vector sign = 1.0 - 2.0 * one_if(hy < 0.0);
    place->position[0] = t.columns * (t.mirrored ? phi : 0.5 + 0.5 * sign * phi);
    place->position[1] =
        t.rows * ((half.x * half.x + half.y * half.y) / (place->length * (place->length + absolute(half.z))));
}

ACDF_LANE Vector density(const BatchTable& t, Vector probability, Vector area, const Place& place) {
    const Vector pdf = probability * t.columns * t.rows * place.length / (8.0 * ACDF_PI * place.dot * area);
    const Vector bounded = select(pdf >= 3.402823466e38, all(3.402823466e38f), pdf);
    const Vector positive = select(pdf > 1.17549435e-38, bounded, all(1.17549435e-38f));
    return select(probability > 0.0, rounded_to_float(positive), all(0.0));
}

// ---- samples ---------------------------------------------------------------------------------------------------

ACDF_LANE Vector clamp(Vector x, double low, double high) {
    return select(x < low, all(low), select(x > high, all(high), x));
}

/* All but where it begins. */
ACDF_LANE void begin_walk(const BatchTable& t, const View& view, Vector u0, Vector u1, Walk* s, Vector* sign) {
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

/* A block of lanes whose cells are sampled. */
struct Samples {
    View view[kGroups];
    Walk walked[kGroups];
    Vector sign[kGroups];
    const float (*wo)[3];
    const double (*u)[2];
};

/* What views give to the cells of lanes: numbers in t.parts. */
ACDF_LANE Integer parts_of(const BatchTable& t, const Walk& walked, Integer lower) {
    return multiplied(walked.node & 0x7FFF, t.stride) + lower;
}

/* The boxes of cells, and those. */
ACDF_LANE void ask_for_cells(const BatchTable& t, const Walk& walked, Integer lower) {
    Indices box, part;
    stored(&box, (walked.node & 0x7FFF) * 16);
    stored(&part, parts_of(t, walked, lower) * 8);
    for (int i = 0; i < kWidth; ++i) {
        __builtin_prefetch((const char*)t.boxes + box.at[i]);
        __builtin_prefetch((const char*)t.parts + part.at[i]);
    }
}

ACDF_LANE void begin(const BatchTable& t, const float (*wo)[3], const double (*u)[2], Samples* s) {
    s->wo = wo;
    s->u = u;
    find_views(t, wo, s->view);
    for (int g = 0; g < kGroups; ++g) {
        const int lane = g * kWidth;
        begin_walk(t, s->view[g], every_second(u[lane]), every_second(u[lane] + 1), &s->walked[g], &s->sign[g]);
        s->walked[g].base = s->view[g].lower * t.entries;
        s->walked[g].node = Integer{} + t.root;
    }
    walk(t, s->walked);
    for (int g = 0; g < kGroups; ++g) ask_for_cells(t, s->walked[g], s->view[g].lower);
}

/* Half-vectors in cells. */
struct Aim {
    Vector position[2], x, cap, radius, hx, hy, hz;
};

ACDF_LANE void draw_half(const BatchTable& t, const Walk& s, const Cell& cell, Aim* a) {
    for (int axis = 0; axis < 2; ++axis) {
        const Vector u = select(s.x[axis] < s.chosen, s.x[axis] / s.chosen, all(1.0));
        a->position[axis] = cell.low[axis] + clamp(u, 0x1p-30, 1.0 - 0x1p-30) * (cell.high[axis] - cell.low[axis]);
    }
    if (t.exact_inverse) {
        a->x = a->position[0] * t.inverse[0];
        a->cap = a->position[1] * t.inverse[1];
    } else {
        a->x = a->position[0] / t.columns;
        a->cap = a->position[1] / t.rows;
    }
    a->radius = root(a->cap * (2.0 - a->cap));
    a->hz = 1.0 - a->cap;
}

ACDF_LANE void turn_half(const BatchTable& t, const View& view, Vector sign, Aim* a) {
    const Vector scale = a->radius / root(view.turn[0] * view.turn[0] + view.turn[1] * view.turn[1]);
    Vector sine, cosine;
    sincospi(t.mirrored ? sign * a->x : 2.0 * a->x - 1.0, &sine, &cosine);
    a->hx = scale * (view.turn[0] * cosine - view.turn[1] * sine);
    a->hy = scale * (view.turn[1] * cosine + view.turn[0] * sine);
}

/* Whether positions are farther from the borders of their cells than the reach of acdf_brdf_reflect, both sides
 * times what that divides by. */
ACDF_LANE Integer inside(const BatchTable& t, const Cell& cell, const Aim& a, Vector dot) {
    const Vector reach[2] = {all(0x1p-23 * t.columns), 0x1p-23 * (a.radius * dot + 0x1p-23) * t.rows};
    const Vector scale[2] = {dot * a.radius, dot * dot};
    Integer out = ~Integer{};
    for (int axis = 0; axis < 2; ++axis) {
        const Vector low = a.position[axis] - cell.low[axis], high = cell.high[axis] - a.position[axis];
        out &= select(low < high, low, high) * scale[axis] > reach[axis];
    }
    return out;
}

/* Writes the samples of a vector of lanes in their cells. Returns the lanes that are left to acdf_brdf_sample. */
ACDF_LANE unsigned reflect(const BatchTable& t, const View& view, const Cell& cell, const Aim& a,
                           const Vector part[2], AcdfDirectionSample* out) {
    const Integer valid = view.weight[0] + view.weight[1] > 0.0;
    const Vector dot = 2.0 * (view.wo.x * a.hx + view.wo.y * a.hy + view.wo.z * a.hz);
    const Directions wi = {rounded_to_float(dot * a.hx - view.wo.x), rounded_to_float(dot * a.hy - view.wo.y),
                           rounded_to_float(dot * a.hz - view.wo.z)};
    Directions half;
    Place place;
    const Integer good = half_of(view, wi, &half, &place) & inside(t, cell, a, absolute(dot));
    const Vector area = (cell.high[0] - cell.low[0]) * (cell.high[1] - cell.low[1]), none = all(0.0);
    store(out, select(valid, wi.x, none), select(valid, wi.y, none), select(valid, wi.z, none),
          select(valid, density(t, positive(share_of(view, part)), area, place), none));
    return bits(valid & ~good);
}

/* Samples of vectors of lanes that have reached those cells; `one`: all of them have the first view. They take
 * turns at each step. Returns the lanes that are left to acdf_brdf_sample. */
template <int Groups>
ACDF_LANE std::uint64_t end_samples(const BatchTable& t, const View* views, bool one, const Walk* walked,
                                    const Cell* cells, const Vector* signs, AcdfDirectionSample* out) {
    Aim aim[Groups];
    Vector part[Groups][2];
    std::uint64_t left = 0;
    for (int g = 0; g < Groups; ++g)
        gather_pairs<8>(t.parts, parts_of(t, walked[g], views[one ? 0 : g].lower), part[g]);
    for (int g = 0; g < Groups; ++g) draw_half(t, walked[g], cells[g], &aim[g]);
    for (int g = 0; g < Groups; ++g) turn_half(t, views[one ? 0 : g], signs[g], &aim[g]);
    for (int g = 0; g < Groups; ++g)
        left |= (std::uint64_t)reflect(t, views[one ? 0 : g], cells[g], aim[g], part[g], &out[g * kWidth])
                << g * kWidth;
    return left;
}

ACDF_LANE void end(const BatchTable& t, const Samples& s, AcdfDirectionSample* out) {
    Cell cells[kGroups];
    for (int g = 0; g < kGroups; ++g) cells[g] = cell_of(t, s.walked[g]);
    std::uint64_t left = end_samples<kGroups>(t, s.view, false, s.walked, cells, s.sign, out);
    for (int lane = 0; left != 0; ++lane, left >>= 1)
        if (left & 1) out[lane] = acdf_brdf_sample(&t.brdf, s.wo[lane], s.u[lane][0], s.u[lane][1]);
}

// ---- all of two arrays -----------------------------------------------------------------------------------------

constexpr std::size_t kBlocksAhead = 4;

/* Past the end of arrays this asks for what is not there, which does nothing. */
template <class T>
ACDF_LANE void prefetch_block(const T* all, std::size_t first) {
    for (std::size_t i = 0; i < sizeof(T) * kBlock; i += 64)
        __builtin_prefetch((const void*)((std::uintptr_t)all + sizeof(T) * first + i));
}

/* Blocks end after the next one began: what they asked for has come then. What does not fill a block is copied to
 * the front of one. */
template <class Block, class A, class B, class Out>
ACDF_LANE void for_blocks(const BatchTable& t, const A* a, const B* b, std::size_t count, Out* out) {
    Block blocks[2];
    const std::size_t whole = count / kBlock, done = whole * kBlock, left = count - done;
    for (std::size_t i = 0; i < whole + 1; ++i) {
        const std::size_t ahead = (i + kBlocksAhead) * kBlock;
        prefetch_block(a, ahead);
        prefetch_block(b, ahead);
        prefetch_block(out, ahead);
        if (i < whole) begin(t, a + i * kBlock, b + i * kBlock, &blocks[i % 2]);
        if (i >= 1) end(t, blocks[(i - 1) % 2], out + (i - 1) * kBlock);
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
