/* The corners of the octahedron of normals around a normal, by runtime tables. Part of acdf/local.h. */
#ifndef ACDF_LOCAL_CORNERS_H
#define ACDF_LOCAL_CORNERS_H

#include <acdf/local_parts.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sets the normal in a scale. */
ACDF_INLINE void acdf_local_scaled(const float normal[3], double scale, double length, AcdfLocalPoint* out) {
    out->normal[0] = scale * (double)normal[0];
    out->normal[1] = scale * (double)normal[1];
    out->normal[2] = scale * (double)normal[2];
    out->length = scale * length;
}
ACDF_INLINE double acdf_local_length(const float normal[3]) {
    const double x = normal[0], y = normal[1], z = normal[2];
    return sqrt(x * x + y * y + z * z);
}

/* Sets the normal in the scale of the weights of its bins. */
ACDF_FN void acdf_local_normal(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const double x = normal[0], y = normal[1], z = normal[2], length = acdf_local_length(normal);
    const double scale =
        local->subdivisions > 0 ? (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) : 1.0 / length;
    acdf_local_scaled(normal, scale, length, out);
}

/* The corners of the triangle of the octahedron that holds a normal, by tables, and the weights of their rows:
 * those of acdf_octahedral_bins. *scale becomes that of acdf_local_normal. Returns 0 on the edges of triangles, and
 * where a corner is not stored or has no light. */
ACDF_INLINE int acdf_local_table_corners(const AcdfLocal* local, const float normal[3],
                                         const AcdfCornerRecord* corner[3], double weight[3], double* scale) {
    const double ax = fabs((double)normal[0]), ay = fabs((double)normal[1]), az = fabs((double)normal[2]);
    const double sum = ax + ay + az;
    const int32_t n = (int32_t)local->subdivisions, side = 2 * n + 1;
    double a[3];
    int32_t base[3], over = n, down, x, y, i;
    if (!acdf_is_finite(sum) || !(sum > 0.0)) return 0; /* as all three are finite, or not */
    a[0] = ax / sum * n;
    a[1] = ay / sum * n;
    a[2] = az / sum * n;
    *scale = (double)n / sum;
    for (i = 0; i < 3; ++i) {
        base[i] = (int32_t)a[i];
        over -= base[i];
    }
    if ((uint32_t)(over - 1) > 1) return 0;
    down = over - 1;
    x = 1 - 2 * (int32_t)(normal[0] < 0.0f);
    y = side - 2 * side * (int32_t)(normal[1] < 0.0f);
    corner[2] = acdf_local_corners(local->tables) + (side * side * (int32_t)(normal[2] < 0.0f) + n * side + n) +
                (x * (base[0] + down) + y * (base[1] + down));
    corner[0] = corner[2] + x * (1 - 2 * down);
    corner[1] = corner[2] + y * (1 - 2 * down);
    for (i = 0; i < 3; ++i)
        weight[i] = fabs((double)down - (a[i] - base[i])) * corner[i]->length * (double)corner[i]->share;
    return weight[0] > 0.0 && weight[1] > 0.0 && weight[2] > 0.0;
}

/* Begins a point: nothing serves it. Rows are left open. */
ACDF_INLINE void acdf_local_no_rows(const float normal[3], AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_NOTHING;
    out->root = 0;
    acdf_as_given(normal, out->surface);
    out->normal[0] = out->normal[1] = out->normal[2] = out->length = out->lights = out->sum = 0.0;
    out->mix.count = 0;
}

/* The environment's tree serves a normal: one of its bins is not stored. */
ACDF_INLINE int acdf_local_whole(const AcdfLocal* local, AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_TREE;
    out->root = local->environment.root;
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
