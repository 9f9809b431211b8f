// Lights of shading points that densities are told for, of a block of lanes. Those above the horizons of all
// normals of a triangle are one sum (acdf/local_lights.h); the others few lanes have, which are packed behind each
// other. Internal linkage: see local_kernel.h.
#pragma once

#include "waves/local_tile_vectors.h"

#include <cstdint>

namespace {

/// What lanes have of lights: of their points, which leave others out until add_other_lights.
struct LightLanes {
    alignas(64) double normal[3][kRoom], length[kRoom], lights[kRoom], mixture[kRoom], sum[kRoom];
    alignas(64) long long others[kRoom]; // in the lower halves, AcdfFacet::others
    std::uint64_t unlike = 0;            // lanes that have some
};

/* Those of a vector from a lane on. */
template <class P>
ACDF_LANE void keep_lights(const P& p, std::size_t at, LightLanes* l) {
    for (int i = 0; i < 3; ++i) stored(&l->normal[i][at], p.normal[i]);
    stored(&l->length[at], p.length);
    stored(&l->lights[at], p.lights);
    stored(&l->mixture[at], p.mixture);
    stored(&l->sum[at], p.sum);
    stored(&l->others[at], p.others);
    l->unlike |= (std::uint64_t)lanes(has(p.others, 0xFFFFFFFF)) << at;
}

/* Adds others to the sums of the lanes that have some. Calls then(lane, at, mixture, sum) for vectors of these:
 * their numbers, and what they have. */
template <class Then>
ACDF_LANE void add_other_lights(const AcdfLocal& local, LightLanes* l, const Then& then) {
    for (std::uint64_t left = l->unlike; left;) {
        alignas(64) long long lane[ACDF_WIDTH];
        alignas(64) double sum[ACDF_WIDTH];
        std::uint32_t any = 0;
        for (long long& i : lane) { // the first one again where there are no more
            i = left ? __builtin_ctzll(left) : lane[0];
            any |= (std::uint32_t)l->others[i];
            left &= left - 1;
        }
        const Integer at = loaded(lane);
        const auto of = [at](const double* all) { return (Vector)gathered<8>(all, at); };
        Corners corners;
        for (int i = 0; i < 3; ++i) corners.normal[i] = of(l->normal[i]);
        corners.length = of(l->length);
        const Vector others =
            other_lights(local, corners, gathered<8>(l->others, at), any, [](std::uint32_t, const Vector*) {});
        const Vector mixture = of(l->mixture), all = (of(l->lights) + others) + mixture;
        stored(sum, all);
        for (int i = 0; i < ACDF_WIDTH; ++i) l->sum[lane[i]] = sum[i];
        then(lane, at, mixture, all);
    }
}

} // namespace
