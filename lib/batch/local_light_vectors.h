// Bright tiles of shading points that pdfs are evaluated for, of a block of lanes. Those above the horizons of all
// normals of a triangle are one sum (acdf/bright_tiles.h); the others few lanes have, which are packed behind each
// other. Internal linkage: see local_kernel.h.
#pragma once

#include "batch/local_tile_vectors.h"

#include <cstdint>

namespace {

/// What lanes have of bright tiles: of their points, which leave others out until add_other_lights.
struct LightLanes {
    alignas(64) double normal[3][kRoom], length[kRoom], bright_tiles[kRoom], mixture[kRoom], sum[kRoom];
    alignas(64) long long others[kRoom]; // in the lower halves, AcdfFacet::others
    std::uint64_t unlike = 0;            // lanes that have some
};

/* Keeps the bright tiles of a vector from a lane on. */
template <class P>
ACDF_LANE void keep_lights(const P& p, std::size_t at, LightLanes* l) {
    for (int i = 0; i < 3; ++i) stored(&l->normal[i][at], p.normal[i]);
    stored(&l->length[at], p.length);
    stored(&l->bright_tiles[at], p.bright_tiles);
    stored(&l->mixture[at], p.mixture);
    stored(&l->sum[at], p.sum);
    stored(&l->others[at], p.others);
    l->unlike |= (std::uint64_t)lanes(has(p.others, 0xFFFFFFFF)) << at;
}

/* The numbers of the next lanes of a mask, and of the first one again where there are no more. Returns those that
 * are left. */
ACDF_LANE std::uint64_t next_lanes(std::uint64_t left, long long lane[ACDF_WIDTH]) {
    for (int i = 0; i < ACDF_WIDTH; ++i) {
        lane[i] = left ? __builtin_ctzll(left) : lane[0];
        left &= left - 1;
    }
    return left;
}

ACDF_LANE Vector gathered_doubles(const double* of, Integer at) { return (Vector)gathered<8>(of, at); }

/* What lanes have of their points, but for facets and rows. */
ACDF_LANE Corners corners_at(const LightLanes& l, Integer at) {
    Corners out;
    for (int i = 0; i < 3; ++i) out.normal[i] = gathered_doubles(l.normal[i], at);
    out.length = gathered_doubles(l.length, at);
    return out;
}

/* Adds others to the sums of the lanes that have some. Calls then(lane, at, mixture, sum) for vectors of these:
 * their numbers, and what they have. */
template <class Then>
ACDF_LANE void add_other_lights(const AcdfLocal& local, LightLanes* l, const Then& then) {
    for (std::uint64_t left = l->unlike; left;) {
        alignas(64) long long lane[ACDF_WIDTH];
        alignas(64) double bright_tiles[ACDF_WIDTH], sum[ACDF_WIDTH];
        left = next_lanes(left, lane);
        std::uint32_t any = 0;
        for (const long long i : lane) any |= (std::uint32_t)l->others[i];
        const Integer at = loaded(lane);
        const Corners corners = corners_at(*l, at);
        const Vector others =
            gathered_doubles(l->bright_tiles, at) + other_lights(local, corners, gathered<8>(l->others, at), any);
        const Vector mixture = gathered_doubles(l->mixture, at), all = others + mixture;
        stored(bright_tiles, others);
        stored(sum, all);
        for (int i = 0; i < ACDF_WIDTH; ++i) {
            l->bright_tiles[lane[i]] = bright_tiles[i];
            l->sum[lane[i]] = sum[i];
        }
        then(lane, at, mixture, all);
    }
}

} // namespace
