/* The words of acdf/pieces.h and of acdf/shader.h, which are one text for C, C++, CUDA, OpenCL C, GLSL,
 * HLSL and WGSL. Here they are C; lib/shader has the other dialects.
 *
 * ACDF_LET is a constant and ACDF_VAR a variable of a function, ACDF_FN1 to ACDF_FN5 begin functions of so many
 * parameters. ACDF_TABLES is how tables are handed on, ACDF_WORD one of their words. */
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#include <acdf/elementary.h>

#define ACDF_U32 uint32_t
#define ACDF_F32 float
#define ACDF_TABLES const uint32_t*
#define ACDF_WORD(tables, i) (tables)[i]

#define ACDF_FN1(result, name, t0, p0) ACDF_INLINE result name(t0 p0)
#define ACDF_FN3(result, name, t0, p0, t1, p1, t2, p2) ACDF_INLINE result name(t0 p0, t1 p1, t2 p2)
#define ACDF_FN4(result, name, t0, p0, t1, p1, t2, p2, t3, p3) ACDF_INLINE result name(t0 p0, t1 p1, t2 p2, t3 p3)
#define ACDF_FN5(result, name, t0, p0, t1, p1, t2, p2, t3, p3, t4, p4)                                             \
    ACDF_INLINE result name(t0 p0, t1 p1, t2 p2, t3 p3, t4 p4)
#define ACDF_LET(type, name) const type name
#define ACDF_VAR(type, name) type name
#define ACDF_STRUCT_BEGIN(name) typedef struct name {
#define ACDF_FIELD(type, name) type name;
#define ACDF_STRUCT_END(name)                                                                                      \
    }                                                                                                              \
    name;

#define ACDF_SELECT(condition, yes, no) ((condition) ? (yes) : (no))
#define ACDF_TO_U32(x) ((uint32_t)(int32_t)(x)) /* of 0 to 2^31 */
#define ACDF_TO_F32(x) ((float)(x))
#define ACDF_BITS(x) acdf_float_bits(x)
#define ACDF_FLOAT(bits) acdf_bits_float(bits)
#define ACDF_ABS(x) fabsf(x)
#define ACDF_SQRT(x) sqrtf(x)
#define ACDF_MIN(a, b) ((a) < (b) ? (a) : (b))
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
