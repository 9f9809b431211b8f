/* The direction of the middle of a box of grid steps. One freestanding header, valid C99, C++17 and CUDA/HIP/SYCL.
 */
#ifndef ACDF_BOX_MIDDLE_H
#define ACDF_BOX_MIDDLE_H

#include <acdf/angle_float.h>
#include <acdf/local.h>

#ifdef __cplusplus
extern "C" {
#endif

/* sin(pi x) and cos(pi x) for x in [-1, 1], to 1e-6. */
ACDF_FN void acdf_sincospi_float(float x, float* sine, float* cosine) {
    const int quadrant = (int)(2.0f * x + 4.5f) - 4;
    const float y = (x - 0.5f * (float)quadrant) * (float)ACDF_PI;
    const float s = acdf_sine_float(y), c = acdf_cosine_float(y);
    *sine = (quadrant & 1) ? c : s;
    *cosine = (quadrant & 1) ? s : c;
    if (quadrant & 2) *sine = -*sine;
    if ((quadrant + 1) & 2) *cosine = -*cosine;
}

/* The direction (unit to 1e-6) of the middle of a box. Floats do: where a lobe is looked at is free. */
ACDF_FN void acdf_box_middle(const AcdfLocal* local, const uint32_t box[2][2], float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    const float u = (float)((int64_t)box[0][0] + box[0][1]) / (float)grid.columns - 1.0f; /* from -1 to 1 */
    const float v = (float)((int64_t)box[1][0] + box[1][1]) / (float)grid.rows - 1.0f;
    float sine, cosine;
    if (acdf_grid_is_octahedral(&grid)) { /* as acdf_octahedral_direction */
        const float a = fabsf(u), b = fabsf(v), beyond = a + b - 1.0f, r = 1.0f - fabsf(beyond);
        const float radius = r * sqrtf(1.0f - 0.5f * r * r);
        const float turn = r > 0.0f ? (b - a) / r * (float)(0.25 * ACDF_PI) : 0.0f;
        sine = acdf_sine_float(turn);
        cosine = acdf_cosine_float(turn);
        direction[0] = u > 0.0f ? -radius * (cosine - sine) : radius * (cosine - sine);
        direction[1] = v < 0.0f ? -radius * (cosine + sine) : radius * (cosine + sine);
        direction[2] = -beyond * (1.0f + r);
    } else {
        float height, radius;
        acdf_sincospi_float(0.5f * v + 0.5f, &radius, &height);
        acdf_sincospi_float(-u, &sine, &cosine);
        direction[0] = radius * cosine;
        direction[1] = radius * sine;
        direction[2] = height;
    }
}

#ifdef __cplusplus
}
#endif
#endif
