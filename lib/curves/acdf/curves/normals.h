/* Bins of a local environment map that are cells of a lat-long grid of normals (SPEC.md §10.2). Valid C99 and
 * C++17. */
#ifndef ACDF_CURVES_NORMALS_H
#define ACDF_CURVES_NORMALS_H

#include <acdf/normals.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The bin of the largest weight. */
ACDF_FN uint32_t acdf_nearest_bin(const AcdfNormalBins* bins) {
    int i, nearest = 0;
    for (i = 1; i < bins->count; ++i)
        if (bins->weight[i] > bins->weight[nearest]) nearest = i;
    return bins->bin[nearest];
}

/* The cell of a lat-long grid of normals: columns in phi, rows in theta, as those of a probe. */
ACDF_FN int acdf_latlong_bins(uint32_t columns, uint32_t rows, const float normal[3], AcdfNormalBins* out) {
    const double x = normal[0], y = normal[1], z = normal[2];
    uint32_t column, row;
    if (!acdf_are_finite(normal) || !(fabs(x) + fabs(y) + fabs(z) > 0.0)) return 0;
    column = (uint32_t)((double)columns * (0.5 - 0.5 * acdf_atan2pi(y, x)));
    row = (uint32_t)((double)rows * acdf_atan2pi(sqrt(x * x + y * y), z));
    if (column >= columns) column = 0;
    if (row >= rows) row = rows - 1;
    out->count = 1;
    out->bin[0] = row * columns + column;
    out->weight[0] = 1.0;
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
