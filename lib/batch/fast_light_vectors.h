// Bright tiles that lanes sample in files of the fast shape: acdf_local_fast_bright_tile over vectors of such
// lanes, which are packed behind each other, since few samples fall into bright tiles. Internal linkage: see
// local_kernel.h.
#pragma once

#include "batch/fast_vectors.h"

namespace {

/// Lanes that sample bright tiles by x of the sum of weights: the first bright tile that takes that sum above x,
/// its weight and the sum before it; weight 0 where there is none.
struct LightDraws {
    Vector x, weight = all(0.0), before = all(0.0);
    Integer number = {};
    Mask passed = no_lanes(); // those that have theirs

    ACDF_LANE_MEMBER explicit LightDraws(Vector at) : x(at) {}
    /* The next light: sums never fall. */
    ACDF_LANE_MEMBER void offer(std::uint32_t light, Vector its_weight, Vector begin, Vector end) {
        const Mask above = less(x, end), is = without(above, passed);
        passed = above;
        weight = choose(is, its_weight, weight);
        before = choose(is, begin, before);
        number = choose(is, Integer{} + (long long)light, number);
    }
};

/* What bright tiles of one point weigh, and the sums of that: as many as it may see, by twos. */
struct LightsOfPoint {
    std::uint32_t count = 0, number[ACDF_MAX_BRIGHT_TILES];
    double weight[ACDF_MAX_BRIGHT_TILES], end[ACDF_MAX_BRIGHT_TILES];

    ACDF_LANE_MEMBER LightsOfPoint(const AcdfLocal& local, const AcdfLocalPoint& point) {
        const AcdfBrightTilePair* const pair = acdf_local_bright_tiles(local.tables);
        const AcdfScaledNormal normal = acdf_local_scaled_normal(&point);
        const double inverse = 1.0 / normal.length;
        double before = 0.0;
        for (std::uint32_t seen = acdf_local_seen(&local, point.by.fast.facet); seen;
             seen &= seen - 1, count += 2) {
            const std::uint32_t k = acdf_lowest_bit(seen);
            for (std::uint32_t i = 0; i < 2; ++i) {
                number[count + i] = 2 * k + i;
                weight[count + i] = acdf_pair_weight(&normal, &pair[k], i, inverse);
            }
            end[count] = weight[count] + before;
            before = end[count + 1] = (weight[count + 1] + weight[count]) + before;
        }
    }
};
/* Normals of their own have theirs weighed when they are offered. */
struct LightsOfPoints {};

template <class P>
ACDF_LANE LightsOfPoint lights_of(const AcdfLocal& local, const OnePoint<P>& at) {
    return LightsOfPoint(local, at.point);
}
template <class P>
ACDF_LANE LightsOfPoints lights_of(const AcdfLocal&, const PointsOf<P>&) {
    return {};
}

/* Offers the bright tiles of normals of their own: all that some triangle may see. */
ACDF_LANE void offer_lights(const AcdfLocal& local, const LightsOfPoints&, const FastPointLanes& lanes,
                            const long long lane[ACDF_WIDTH], LightDraws* draws) {
    const AcdfBrightTilePair* const pair = acdf_local_bright_tiles(local.tables);
    const Corners at = corners_at(lanes.bright_tiles, loaded(lane));
    const Vector inverse = 1.0 / at.length;
    std::uint32_t seen = 0;
    for (int i = 0; i < ACDF_WIDTH; ++i) seen |= facet_at(local, lanes.facet[lane[i]]).seen;
    Vector end = all(0.0);
    for (; seen; seen &= seen - 1) {
        const std::uint32_t k = acdf_lowest_bit(seen);
        const Vector first = pair_weight(at, pair[k], 0, inverse), second = pair_weight(at, pair[k], 1, inverse);
        const Vector middle = first + end, last = (second + first) + end;
        draws->offer(2 * k, first, end, middle);
        draws->offer(2 * k + 1, second, middle, last);
        end = last;
    }
}

/* Those of one point. */
ACDF_LANE void offer_lights(const AcdfLocal&, const LightsOfPoint& lights, const FastPointLanes&, const long long*,
                            LightDraws* draws) {
    for (std::uint32_t i = 0; i < lights.count; ++i)
        draws->offer(lights.number[i], all(lights.weight[i]), all(i > 0 ? lights.end[i - 1] : 0.0),
                     all(lights.end[i]));
}

} // namespace
