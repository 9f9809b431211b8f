// The words of acdf/shader/dialect.h in WGSL.
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

// What follows is WGSL.
// clang-format off
#define ACDF_U32 u32
#define ACDF_F32 f32
#define ACDF_TABLES u32
#define ACDF_WORD(tables, i) acdf_word(tables, i)

#define ACDF_FN1(result, name, t0, p0) fn name(p0 : t0) -> result
#define ACDF_FN2(result, name, t0, p0, t1, p1) fn name(p0 : t0, p1 : t1) -> result
#define ACDF_FN3(result, name, t0, p0, t1, p1, t2, p2) fn name(p0 : t0, p1 : t1, p2 : t2) -> result
#define ACDF_FN4(result, name, t0, p0, t1, p1, t2, p2, t3, p3)                                                     \
    fn name(p0 : t0, p1 : t1, p2 : t2, p3 : t3) -> result
#define ACDF_FN5(result, name, t0, p0, t1, p1, t2, p2, t3, p3, t4, p4)                                             \
    fn name(p0 : t0, p1 : t1, p2 : t2, p3 : t3, p4 : t4) -> result
#define ACDF_LET(type, name) let name : type
#define ACDF_VAR(type, name) var name : type
#define ACDF_STRUCT_BEGIN(name) struct name {
#define ACDF_FIELD(type, name) name : type,
#define ACDF_STRUCT_END(name) }

#define ACDF_SELECT(condition, yes, no) select(no, yes, condition)
#define ACDF_TO_U32(x) u32(x)
#define ACDF_TO_F32(x) f32(x)
#define ACDF_BITS(x) bitcast<u32>(x)
#define ACDF_FLOAT(bits) bitcast<f32>(bits)
#define ACDF_ABS(x) abs(x)
#define ACDF_SQRT(x) sqrt(x)
#define ACDF_MIN(a, b) min(a, b)
#define ACDF_MAX(a, b) max(a, b)
#define ACDF_RATIO(minor, major) clamp((minor) / (major), -1.0f, 1.0f) // divisions may round beyond

// clang-format on
#endif
