// Shading points of LocalWavefront, a lane each: acdf/local_point.h over vectors, operation by operation. Internal
// linkage: see local_kernel.h.
#pragma once

#include "waves/local_vectors.h"

#include <acdf/local.h>

#include <cstring>

namespace {

constexpr int kRows = 3; // of nearly all normals: those on edges of triangles have fewer

/// The corners around normals, with the numbers of their rows: 0 in lanes that are not served, and all else is any
/// number there.
struct Corners {
    Integer served, row[kRows];
    Vector weight[kRows], normal[3], length;
};

/// Of lanes that are not served the rows are some of the table, and all else is any number.
struct Points : Corners {
    Integer codes[kRows]; // addresses of those of the rows
    Vector lights, mixture, sum, light[ACDF_MAX_LIGHTS];
};

/* acdf_local_sum by the normals in the scale of the weights. The horizon cuts few lights: those are weighed again.
 */
ACDF_LANE void weigh_lights(const AcdfLocal& local, Points* out) {
    const AcdfLightPair* pair = acdf_local_lights(local.tables);
    const Vector* const normal = out->normal;
    const Vector length = out->length;
    Vector height[ACDF_MAX_LIGHTS];
    std::uint64_t cut = 0;
    for (std::uint32_t k = 0; k < local.light_count; k += 2, ++pair)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const Vector h = (normal[0] * pair->direction[0][i] + normal[1] * pair->direction[1][i]) +
                             normal[2] * pair->direction[2][i];
            height[k + i] = h;
            out->light[k + i] = pair->share[i] * (0.5 * (h + absolute(h)));
            cut |= (std::uint64_t)(lanes(less(absolute(h), pair->radius[i] * length)) != 0) << (k + i);
        }
    for (; cut; cut &= cut - 1) {
        const std::uint32_t k = (std::uint32_t)__builtin_ctzll(cut), i = k % 2;
        const AcdfLightPair& of = acdf_local_lights(local.tables)[k / 2];
        const Vector radius = of.radius[i] * length, above = height[k] + radius;
        out->light[k] = choose(less(absolute(height[k]), radius), of.share[i] * (above * above / (4.0 * radius)),
                               out->light[k]);
    }
    out->lights = all(0.0);
    for (std::uint32_t k = 0; k < local.light_count; ++k) out->lights += out->light[k];
    out->mixture = (out->weight[0] + out->weight[1]) + out->weight[2];
    out->sum = out->lights + out->mixture;
}

/* The corners that a table has at some numbers: how long they are, their shares and their rows. */
ACDF_LANE void load_corners(const AcdfLocalTables& tables, Integer number, Vector* length, Vector* share,
                            Integer* row) {
    const AcdfCornerRecord* const corners = acdf_local_corners(&tables);
    alignas(64) long long at[ACDF_WIDTH];
    const double* from[ACDF_WIDTH];
    Vector pair[2];
    stored(at, number);
    for (int i = 0; i < ACDF_WIDTH; ++i) from[i] = (const double*)(const void*)(corners + at[i]);
    gather_pairs(from, pair);
    *length = pair[0];
    *share = low_floats((Integer)pair[1]);
    *row = (Integer)((Unsigned)pair[1] >> 32);
}

/* acdf_local_table_corners; what tables do not serve is not served. Small whole numbers are doubles. */
ACDF_LANE void corners_of(const AcdfLocal& local, const float (*normals)[3], Corners* out) {
    const double n = local.subdivisions, side = 2.0 * n + 1.0;
    Vector v[3], a[3], base[3], length, share, sign[3], corner[kRows];
    load_transposed(normals, v);
    const Vector sum = (absolute(v[0]) + absolute(v[1])) + absolute(v[2]);
    Integer served = (sum > 0.0) & (sum < 0x1p1000); // below: finite floats
    Vector over = all(n);
    for (int i = 0; i < 3; ++i) {
        a[i] = absolute(v[i]) / sum * n;
        base[i] = whole_part(a[i]);
        over -= base[i];
        sign[i] = one_if(v[i] < 0.0);
    }
    served &= (over == 1.0) | (over == 2.0);
    const Vector down = over - 1.0, x = 1.0 - 2.0 * sign[0], y = side - 2.0 * side * sign[1];
    corner[2] = (side * side * sign[2] + n * side + n) + (x * (base[0] + down) + y * (base[1] + down));
    corner[0] = corner[2] + x * (1.0 - 2.0 * down);
    corner[1] = corner[2] + y * (1.0 - 2.0 * down);
    for (int i = 0; i < kRows; ++i) {
        load_corners(*local.tables, truncated(select(served, corner[i], all(0.0))), &length, &share, &out->row[i]);
        out->weight[i] = absolute(down - (a[i] - base[i])) * length * share;
    }
    for (int i = 0; i < kRows; ++i) served &= out->weight[i] > 0.0;
    for (int i = 0; i < kRows; ++i) out->row[i] &= served;
    const Vector scale = n / sum, size = root((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
    for (int i = 0; i < 3; ++i) out->normal[i] = scale * v[i];
    out->length = scale * size;
    out->served = served;
}

/* acdf_local_at by tables of corners. */
ACDF_LANE void points_of(const AcdfLocal& local, const float (*normals)[3], Points* out) {
    const AcdfTileTables& tiles = local.tables->tiles;
    const auto rows = (long long)(std::uintptr_t)acdf_tile_row(acdf_local_words(local.tables), &tiles, 0);
    corners_of(local, normals, out);
    for (int i = 0; i < kRows; ++i) out->codes[i] = multiplied(out->row[i], tiles.stride) + rows;
    weigh_lights(local, out);
    out->served &= out->sum > 0.0;
}

/* One point in all lanes, which serves_waves has approved. */
ACDF_LANE void points_of(const AcdfLocal& local, const AcdfLocalPoint& point, Points* out) {
    const AcdfTileTables& tiles = local.tables->tiles;
    const std::uint8_t* const rows = acdf_tile_row(acdf_local_words(local.tables), &tiles, 0);
    for (int i = 0; i < kRows; ++i) {
        out->codes[i] = Integer{} + (long long)(std::uintptr_t)point.codes[i];
        out->row[i] = Integer{} + (long long)((std::size_t)(point.codes[i] - rows) / tiles.stride);
        out->weight[i] = all(point.mix.weight[i]);
        out->normal[i] = all(point.normal[i]);
    }
    out->length = all(point.length);
    weigh_lights(local, out);
    out->served = ~Integer{};
}

/// The points of a vector of normals from a lane on, of which `count` are there; and one point in all lanes.
template <class P>
struct PointsOf {
    const AcdfLocal& local;
    const float (*normals)[3];
    ACDF_LANE_MEMBER const P& operator()(std::size_t lane, std::size_t count, P* room) const {
        float last[ACDF_WIDTH][3] = {};
        if (count < ACDF_WIDTH) std::memcpy(last, normals + lane, count * sizeof *normals);
        points_of(local, count < ACDF_WIDTH ? last : normals + lane, room);
        return *room;
    }
};
template <class P>
struct OnePoint {
    P points;
    OnePoint(const AcdfLocal& local, const AcdfLocalPoint& point) { points_of(local, point, &points); }
    ACDF_LANE_MEMBER const P& operator()(std::size_t, std::size_t, P*) const { return points; }
};

} // namespace
