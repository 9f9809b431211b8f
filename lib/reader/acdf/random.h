/* Random numbers as renderers pass them: any float or double. */
#ifndef ACDF_RANDOM_H
#define ACDF_RANDOM_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A random number in [0, 1]; values outside are clamped, what is not finite counts as 0. */
ACDF_FN double acdf_unit_interval(double u) {
    uint64_t bits;
    memcpy(&bits, &u, sizeof bits);
    if (bits <= 0x3FF0000000000000u) return u; /* all there is from 0 to 1 */
    if (!acdf_is_finite(u)) return 0.0;
    return u > 0.0 ? (u < 1.0 ? u : 1.0) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
