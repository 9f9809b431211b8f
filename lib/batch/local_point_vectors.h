// Shading points of LocalBatch, a lane each: acdf/local_point.h over vectors, operation by operation. Internal
// linkage: see local_kernel.h.
#pragma once

#include "batch/local_vectors.h"

#include <acdf/local.h>

#include <cstring>
#include <type_traits>

namespace {

constexpr int kTurns = 4; // vectors of normals that take turns
constexpr int kRows = 3;  // of nearly all normals: those on edges of triangles have fewer

/// The corners around normals, with the numbers of their rows in the lower halves: of lanes that are not served
/// those of any normal, and all else is any number there.
struct Corners {
    Integer served, row[kRows], facet; // facet: in which byte of all it begins
    Vector weight[kRows], normal[3], length;
};

/* Lanes of a vector from one on that are left to single calls, those behind the last one, too. */
ACDF_LANE std::uint64_t not_served(const Corners& p, std::size_t first) {
    return (std::uint64_t)(~bits(p.served) & ((1u << ACDF_WIDTH) - 1u)) << first;
}

/// Of lanes that are not served the rows are some of the table, and all else is any number.
template <bool Draws>
struct Points : Corners {
    static constexpr bool kEach = Draws; // whether they have the weight of each bright tile
    Integer codes[kRows];                // addresses of those of the rows
    Integer others;                      // of pdfs, in the lower halves: AcdfFacet::others, which sums leave out
    Vector bright_tiles, mixture, sum, light[Draws ? ACDF_MAX_BRIGHT_TILES : 1];
};

/* acdf_pair_weight */
ACDF_LANE Vector pair_weight(const Corners& at, const AcdfBrightTilePair& pair, std::uint32_t i, Vector inverse) {
    const Vector height = (at.normal[0] * pair.direction[0][i] + at.normal[1] * pair.direction[1][i]) +
                          at.normal[2] * pair.direction[2][i];
    const Vector radius = pair.radius[i] * at.length, above = height + radius;
    const Vector cut = above * above * (pair.quarter[i] * inverse);
    return choose(less(absolute(height), radius), cut, pair.share[i] * above_zero(height));
}

ACDF_LANE const AcdfFacet& facet_at(const AcdfLocal& local, long long byte) {
    return *(const AcdfFacet*)(const void*)((const char*)(const void*)acdf_local_facets(local.tables) + byte);
}

/// What facets of lanes store of their bright tiles.
struct Facets {
    Vector whole;      // what AcdfFacet::whole gives to the normal
    Integer others;    // in the lower halves, AcdfFacet::others
    std::uint32_t any; // what any lane has of these
};

ACDF_LANE Facets facets_of(const AcdfLocal& local, const Corners& at) {
    alignas(64) long long facet[ACDF_WIDTH];
    const double* from[2][ACDF_WIDTH];
    Vector low[2], high[2];
    Facets out;
    out.any = 0;
    stored(facet, at.facet);
    for (int i = 0; i < ACDF_WIDTH; ++i) {
        const AcdfFacet& of = facet_at(local, facet[i]);
        from[0][i] = of.whole;
        from[1][i] = of.whole + 2;
        out.any |= of.others;
    }
    gather_pairs(from[0], low);
    gather_pairs(from[1], high);
    out.whole = (at.normal[0] * low[0] + at.normal[1] * low[1]) + at.normal[2] * high[0];
    out.others = (Integer)high[1];
    return out;
}

/* What the pairs of `left` give to normals that have them among others. */
ACDF_LANE Vector other_lights(const AcdfLocal& local, const Corners& at, Integer others, std::uint32_t left) {
    const AcdfBrightTilePair* const pair = acdf_local_bright_tiles(local.tables);
    const Vector inverse = 1.0 / at.length;
    Vector sum[2] = {all(0.0), all(0.0)};
    for (; left; left &= left - 1) {
        const std::uint32_t k = acdf_lowest_bit(left);
        const Mask is_other = negative(others << (63 - k));
        for (std::uint32_t i = 0; i < 2; ++i)
            sum[i] += choose(is_other, pair_weight(at, pair[k], i, inverse), all(0.0));
    }
    return sum[0] + sum[1];
}

/* The bright tiles above the horizons of all normals of a triangle, and which others there are. */
template <class P>
ACDF_LANE void leave_others(const AcdfLocal& local, P* out) {
    const Facets of = facets_of(local, *out);
    out->bright_tiles = of.whole;
    out->others = of.others;
}

/* The weight of each bright tile, as in acdf_bright_tile_weight. The horizon cuts few of them: those are weighted
 * again. */
ACDF_LANE void weigh_each(const AcdfLocal& local, Points<true>* out) {
    const AcdfBrightTilePair* pair = acdf_local_bright_tiles(local.tables);
    const Vector* const normal = out->normal;
    const Vector length = out->length;
    Vector height[ACDF_MAX_BRIGHT_TILES];
    std::uint64_t cut = 0;
    for (std::uint32_t k = 0; k < local.bright_tile_count; k += 2, ++pair)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const Vector h = (normal[0] * pair->direction[0][i] + normal[1] * pair->direction[1][i]) +
                             normal[2] * pair->direction[2][i];
            height[k + i] = h;
            out->light[k + i] = pair->share[i] * (0.5 * (h + absolute(h)));
            cut |= (std::uint64_t)(lanes(less(absolute(h), pair->radius[i] * length)) != 0) << (k + i);
        }
    for (; cut; cut &= cut - 1) {
        const std::uint32_t k = (std::uint32_t)__builtin_ctzll(cut), i = k % 2;
        const AcdfBrightTilePair& of = acdf_local_bright_tiles(local.tables)[k / 2];
        const Vector radius = of.radius[i] * length, above = height[k] + radius;
        out->light[k] = choose(less(absolute(height[k]), radius), of.share[i] * (above * above / (4.0 * radius)),
                               out->light[k]);
    }
}

/* All bright tiles, and of pdfs those that all normals of a triangle see. */
ACDF_LANE void weigh_lights(const AcdfLocal& local, Points<true>* out) {
    weigh_each(local, out);
    const Facets of = facets_of(local, *out);
    out->bright_tiles = of.whole + other_lights(local, *out, of.others, of.any); // acdf_facet_bright_tiles
}
ACDF_LANE void weigh_lights(const AcdfLocal& local, Points<false>* out) { leave_others(local, out); }

/* acdf_local_find_facet of kTurns vectors; what tables do not serve is not served. Small whole
 * numbers are doubles. */
template <class At>
ACDF_LANE void corners_of(const AcdfLocal& local, const float (*normals)[3], At* out) {
    const double n = local.subdivisions;
    Vector sum[kTurns], down[kTurns], off[kTurns][3];
    Indices at[kTurns];
    for (int t = 0; t < kTurns; ++t) {
        load_transposed(normals + t * ACDF_WIDTH, out[t].normal);
        const Vector* v = out[t].normal;
        sum[t] = (absolute(v[0]) + absolute(v[1])) + absolute(v[2]);
    }
    for (int t = 0; t < kTurns; ++t) {
        const Vector* v = out[t].normal;
        Vector base[3];
        down[t] = all(n - 1.0);
        for (int i = 0; i < 3; ++i) {
            const Vector a = absolute(v[i]) / sum[t] * n;
            base[i] = whole_part(a);
            down[t] -= base[i];
            off[t][i] = a - base[i];
        }
        const Integer served = (down[t] == 0.0) | (down[t] == 1.0); // not NaN, as of floats that are not finite
        const Vector back = down[t] * (n - 1.0), step = 1.0 - 2.0 * down[t];
        const Vector octant =
            (only(v[0] < 0.0, n * n) + only(v[1] < 0.0, 2.0 * n * n)) + only(v[2] < 0.0, 4.0 * n * n);
        const Vector facet = octant + ((back + base[0] * step) * n + (back + base[1] * step));
        out[t].facet = truncated(select(served, facet * (double)sizeof(AcdfFacet), all(0.0))); // below 2^31
        out[t].served = served;
        stored(&at[t], out[t].facet);
    }
    for (int t = 0; t < kTurns; ++t) {
        const double* from[3][ACDF_WIDTH];
        for (int i = 0; i < ACDF_WIDTH; ++i) {
            const AcdfFacet& of = facet_at(local, at[t].at[i]);
            from[0][i] = of.length;
            from[1][i] = of.length + 2;                              // and shares
            from[2][i] = (const double*)(const void*)(of.share + 2); // and rows
        }
        Vector length[3], share[3], pair[2];
        gather_pairs(from[0], length);
        gather_pairs(from[1], pair);
        length[2] = pair[0];
        share[0] = low_floats((Integer)pair[1]);
        share[1] = low_floats((Integer)((Unsigned)pair[1] >> 32));
        gather_pairs(from[2], pair);
        share[2] = low_floats((Integer)pair[0]);
        out[t].row[0] = (Integer)((Unsigned)pair[0] >> 32);
        out[t].row[1] = (Integer)pair[1];
        out[t].row[2] = (Integer)((Unsigned)pair[1] >> 32);
        Vector* const weight = out[t].weight;
        for (int i = 0; i < kRows; ++i) weight[i] = absolute(down[t] - off[t][i]) * length[i] * share[i];
        out[t].served &= least(least(weight[0], weight[1]), weight[2]) > 0.0;
    }
    for (int t = 0; t < kTurns; ++t) {
        Vector* v = out[t].normal;
        const Vector scale = n / sum[t], size = root((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
        for (int i = 0; i < 3; ++i) v[i] = scale * v[i];
        out[t].length = scale * size;
    }
}

/* acdf_local_at by facets, but for its corners. */
template <bool Draws>
ACDF_LANE void set_points(const AcdfLocal& local, Points<Draws>* out) {
    const AcdfTileTables& tiles = local.tables->tiles;
    const auto rows = (long long)(std::uintptr_t)acdf_tile_row(acdf_local_words(local.tables), &tiles, 0);
    for (int i = 0; i < kRows; ++i) out->codes[i] = multiplied(out->row[i], tiles.stride) + rows;
    weigh_lights(local, out);
    out->mixture = (out->weight[0] + out->weight[1]) + out->weight[2];
    out->sum = out->bright_tiles + out->mixture;
    out->served &= out->sum > 0.0;
}

/* One point in all lanes, which serves_batches has approved. */
template <bool Draws>
ACDF_LANE void points_of(const AcdfLocal& local, const AcdfLocalPoint& point, Points<Draws>* out) {
    const AcdfTileTables& tiles = local.tables->tiles;
    const std::uint8_t* const rows = acdf_tile_row(acdf_local_words(local.tables), &tiles, 0);
    const AcdfScaledNormal normal = acdf_local_scaled_normal(&point);
    for (int i = 0; i < kRows; ++i) {
        out->codes[i] = Integer{} + (long long)(std::uintptr_t)point.by.tabled.codes[i];
        out->row[i] = Integer{} + (long long)((std::size_t)(point.by.tabled.codes[i] - rows) / tiles.stride);
        out->weight[i] = all(point.mix.weight[i]);
        out->normal[i] = all(normal.normal[i]);
    }
    out->length = all(normal.length);
    if constexpr (Draws) weigh_each(local, out);
    out->bright_tiles = all(point.bright_tiles);
    out->others = Integer{};
    out->mixture = (out->weight[0] + out->weight[1]) + out->weight[2];
    out->sum = all(point.sum);
    out->served = ~Integer{};
}

/// Calls then(points, lane) for the points of vectors of `whole` normals, of which `count` are there; and one point
/// in all lanes.
template <class P>
struct PointsOf {
    const AcdfLocal& local;
    const float (*normals)[3];
    template <class Then>
    ACDF_LANE_MEMBER void operator()(std::size_t whole, std::size_t count, const Then& then) const {
        constexpr std::size_t lanes = kTurns * ACDF_WIDTH;
        std::conditional_t<P::kEach, P, Corners> room[kTurns];
        for (std::size_t first = 0; first < whole; first += lanes) {
            float last[lanes][3] = {};
            const bool all = count - first >= lanes;
            if (!all) std::memcpy(last, normals + first, (count - first) * sizeof *normals);
            corners_of(local, all ? normals + first : last, room);
            if constexpr (P::kEach) {
                for (P& points : room) set_points(local, &points);
                for (int t = 0; t < kTurns; ++t) then(room[t], first + (std::size_t)t * ACDF_WIDTH);
            } else {
                for (int t = 0; t < kTurns; ++t) { // which stays in registers
                    P points;
                    (Corners&)points = room[t];
                    set_points(local, &points);
                    then(points, first + (std::size_t)t * ACDF_WIDTH);
                }
            }
        }
    }
};
template <class P>
struct OnePoint {
    const AcdfLocalPoint& point;
    P points;
    OnePoint(const AcdfLocal& local, const AcdfLocalPoint& at) : point(at) { points_of(local, at, &points); }
    template <class Then>
    ACDF_LANE_MEMBER void operator()(std::size_t whole, std::size_t, const Then& then) const {
        for (std::size_t first = 0; first < whole; first += ACDF_WIDTH) then(points, first);
    }
};

} // namespace
