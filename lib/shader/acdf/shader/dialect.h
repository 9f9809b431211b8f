/* The words of acdf/angle_float.h and of the headers of shaders, which are one text for C, C++, CUDA, OpenCL
 * C, GLSL, HLSL and WGSL. Here they are C; lib/shader has the other dialects.
 *
 * ACDF_LET is a constant and ACDF_VAR a variable of a function, ACDF_FN1 to ACDF_FN5 begin functions of so many
 * parameters. ACDF_TABLES is how tables are handed on, ACDF_WORD one of their words. */
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#include <acdf/elementary.h>
#include <acdf/shader/dialect_c.h>

#define ACDF_DIALECT_FN ACDF_INLINE
#define ACDF_U32 uint32_t
#define ACDF_TABLES const uint32_t*

#define ACDF_TO_U32(x) ((uint32_t)(int32_t)(x)) /* of 0 to 2^31 */
#define ACDF_BITS(x) acdf_float_bits(x)
#define ACDF_FLOAT(bits) acdf_bits_float(bits)
#define ACDF_ABS(x) fabsf(x)
#define ACDF_SQRT(x) sqrtf(x)
/* minor / major, which is in [-1, 1] where division rounds correctly. */
#define ACDF_RATIO(minor, major) ((minor) / (major))

#ifdef __cplusplus
extern "C" {
#endif

ACDF_INLINE uint32_t acdf_float_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
ACDF_INLINE float acdf_bits_float(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#ifdef __cplusplus
}
#endif
#endif
