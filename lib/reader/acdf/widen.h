/* Random numbers of 24 bits, made finer. */
#ifndef ACDF_WIDEN_H
#define ACDF_WIDEN_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The 24 lowest bits of k in reverse order. */
ACDF_FN uint32_t acdf_reverse24(uint32_t k) {
    k = (k & 0x55555555u) << 1 | (k >> 1 & 0x55555555u);
    k = (k & 0x33333333u) << 2 | (k >> 2 & 0x33333333u);
    k = (k & 0x0F0F0F0Fu) << 4 | (k >> 4 & 0x0F0F0F0Fu);
    k = (k & 0x00FF00FFu) << 8 | (k >> 8 & 0x00FF00FFu);
    return (k << 16 | k >> 16) >> 8;
}

/* Widens random numbers of 24 bits, which is all that floats in [0, 1) hold. Each u[i] becomes a double in the same
 * step of 2^-24; its lower bits are the other number's in reverse order. All 2^48 pairs then lead to different
 * directions, and a cell that only one step of one axis leads to is met as often as it should be. Within a step
 * nothing else changes: strata and sequences stay what they are. Numbers that are finer than a step keep their own
 * bits. */
ACDF_FN void acdf_widen(float u0, float u1, double u[2]) {
    double x[2];
    uint32_t step[2];
    int i;
    x[0] = u0 > 0.0f ? (u0 < 1.0f ? (double)u0 * 0x1p24 : 0x1p24 - 1.0) : 0.0;
    x[1] = u1 > 0.0f ? (u1 < 1.0f ? (double)u1 * 0x1p24 : 0x1p24 - 1.0) : 0.0;
    for (i = 0; i < 2; ++i) step[i] = (uint32_t)x[i];
    for (i = 0; i < 2; ++i) {
        const double fraction = x[i] - (double)step[i];
        u[i] = ((double)step[i] + (fraction > 0.0 ? fraction : (double)acdf_reverse24(step[1 - i]) * 0x1p-24)) *
               0x1p-24;
    }
}

#ifdef __cplusplus
}
#endif
#endif
