// The words of acdf/pieces.h and acdf/shader.h in what head.h makes C, C++, CUDA, HIP and OpenCL C of.
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#define ACDF_U32 acdf_u32
#define ACDF_F32 float
#define ACDF_TABLES acdf_words
#define ACDF_WORD(tables, i) (tables)[i]

#define ACDF_FN1(result, name, t0, p0) ACDF_EXPORT_FN result name(t0 p0)
#define ACDF_FN3(result, name, t0, p0, t1, p1, t2, p2) ACDF_EXPORT_FN result name(t0 p0, t1 p1, t2 p2)
#define ACDF_FN4(result, name, t0, p0, t1, p1, t2, p2, t3, p3)                                                     \
    ACDF_EXPORT_FN result name(t0 p0, t1 p1, t2 p2, t3 p3)
#define ACDF_FN5(result, name, t0, p0, t1, p1, t2, p2, t3, p3, t4, p4)                                             \
    ACDF_EXPORT_FN result name(t0 p0, t1 p1, t2 p2, t3 p3, t4 p4)
#define ACDF_LET(type, name) const type name
#define ACDF_VAR(type, name) type name
#define ACDF_STRUCT_BEGIN(name) typedef struct name {
#define ACDF_FIELD(type, name) type name;
#define ACDF_STRUCT_END(name)                                                                                      \
    }                                                                                                              \
    name;

#define ACDF_SELECT(condition, yes, no) ((condition) ? (yes) : (no))
#define ACDF_TO_U32(x) ((acdf_u32)(x))
#define ACDF_TO_F32(x) ((float)(x))
#define ACDF_BITS(x) acdf_export_bits(x)
#define ACDF_FLOAT(bits) acdf_export_float(bits)
#define ACDF_ABS(x) ACDF_EXPORT_ABS(x)
#define ACDF_SQRT(x) ACDF_EXPORT_SQRT(x)
#define ACDF_MIN(a, b) ((a) < (b) ? (a) : (b))
#define ACDF_RATIO(minor, major) acdf_export_ratio(minor, major)

#endif
