/* Which bins of a local environment map serve a normal (SPEC.md §10.2). */
#ifndef ACDF_NORMALS_H
#define ACDF_NORMALS_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Up to three bins that surround a normal, and weights whose sum with the bins' corners is the normal itself, times
 * a positive number. */
typedef struct AcdfNormalBins {
    uint32_t bin[3];
    double weight[3];
    int count;
} AcdfNormalBins;

/* Number of the corner (x, y, z), |x| + |y| + |z| = n, of an octahedron whose edges are divided by n: levels from
 * z = n down, each once around from +x towards +y. There are 4 n^2 + 2. */
ACDF_FN uint32_t acdf_octahedral_corner(uint32_t n, int32_t x, int32_t y, int32_t z) {
    /* Without branches, since normals come in no order. */
    const uint32_t ax = (uint32_t)(x < 0 ? -x : x), ay = (uint32_t)(y < 0 ? -y : y),
                   az = (uint32_t)(z < 0 ? -z : z);
    const uint32_t west = (uint32_t)x >> 31, back = (uint32_t)y >> 31, south = (uint32_t)z >> 31;
    const uint32_t r = n - az, any = (r + 0x7FFFFFFFu) >> 31; /* 4 r corners on this level, one at a pole */
    const uint32_t upper = any + 2 * r * (r - any), lower = 4 * n * n + 1 - 2 * r * (r + 1);
    const uint32_t first = upper + south * (lower - upper);
    const uint32_t quarter = (3 * back) ^ west; /* from +x towards +y */
    return first + quarter * r + ay + (quarter & 1u) * (ax - ay);
}

/* The corners of the triangle that holds a normal. On the faces |x| + |y| + |z| = 1 the normal is the weighted mean
 * of the corners. Returns 0 for normals that are zero, NaN or infinite. */
ACDF_FN int acdf_octahedral_bins(uint32_t n, const float normal[3], AcdfNormalBins* out) {
    const double ax = fabs((double)normal[0]), ay = fabs((double)normal[1]), az = fabs((double)normal[2]);
    const double sum = ax + ay + az;
    double a[3], f[3];
    int32_t base[3], sign[3], over, down;
    int i, k;
    if (!acdf_are_finite(normal) || !(sum > 0.0)) return 0;
    a[0] = ax / sum * n;
    a[1] = ay / sum * n;
    a[2] = az / sum * n;
    over = (int32_t)n;
    for (i = 0; i < 3; ++i) {
        sign[i] = 1 - 2 * (int32_t)(normal[i] < 0.0f);
        base[i] = (int32_t)a[i];
        f[i] = a[i] - base[i];
        over -= base[i];
    }
    /* The fractions add up to 0, 1 or 2 but for rounding: at a corner, or in a triangle that points up or down. */
    if (over > 2) { /* at a corner too, all three rounded down */
        for (i = 0; i < 3; ++i) ++base[i];
        over = 0;
    }
    down = over >> 1;
    out->count = 0;
    for (i = 0; i < 3; ++i) {
        int32_t c[3];
        double weight = over > 0 ? fabs((double)down - f[i]) : (double)(i == 0);
        for (k = 0; k < 3; ++k) c[k] = base[k] + (over > 0 ? (int32_t)(k == i) ^ down : 0);
        if (!(weight > 0.0)) continue;
        /* The corner lies at |c| / n from the centre: times that, its unit vector is the point on the face. */
        weight *= sqrt((double)(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
        out->bin[out->count] = acdf_octahedral_corner(n, sign[0] * c[0], sign[1] * c[1], sign[2] * c[2]);
        out->weight[out->count++] = weight;
    }
    return out->count > 0;
}

#ifdef __cplusplus
}
#endif
#endif
