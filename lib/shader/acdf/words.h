// The words of acdf/pieces.h and acdf/shader.h that GLSL and HLSL share.
#ifndef ACDF_WORDS_H
#define ACDF_WORDS_H

#define ACDF_U32 uint
#define ACDF_F32 float
#define ACDF_TABLES uint
#define ACDF_WORD(tables, i) acdf_word(tables, i)

#define ACDF_FN1(result, name, t0, p0) result name(t0 p0)
#define ACDF_FN3(result, name, t0, p0, t1, p1, t2, p2) result name(t0 p0, t1 p1, t2 p2)
#define ACDF_FN4(result, name, t0, p0, t1, p1, t2, p2, t3, p3) result name(t0 p0, t1 p1, t2 p2, t3 p3)
#define ACDF_FN5(result, name, t0, p0, t1, p1, t2, p2, t3, p3, t4, p4)                                             \
    result name(t0 p0, t1 p1, t2 p2, t3 p3, t4 p4)
#define ACDF_LET(type, name) type name
#define ACDF_VAR(type, name) type name
#define ACDF_STRUCT_BEGIN(name) struct name {
#define ACDF_FIELD(type, name) type name;
#define ACDF_STRUCT_END(name)                                                                                      \
    }                                                                                                              \
    ;

#define ACDF_SELECT(condition, yes, no) ((condition) ? (yes) : (no))
#define ACDF_TO_U32(x) uint(x)
#define ACDF_TO_F32(x) float(x)
#define ACDF_ABS(x) abs(x)
#define ACDF_SQRT(x) sqrt(x)
#define ACDF_MIN(a, b) min(a, b)
#define ACDF_RATIO(minor, major) clamp((minor) / (major), -1.0, 1.0) // divisions may round beyond

#endif
