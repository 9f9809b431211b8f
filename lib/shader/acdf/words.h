// The words of the reader's acdf/shader/dialect.h that GLSL and HLSL share.
#ifndef ACDF_WORDS_H
#define ACDF_WORDS_H

#include <acdf/shader/dialect_words.h>

#define ACDF_U32 uint
#define ACDF_F32 float
#define ACDF_TABLES uint
#define ACDF_WORD(tables, i) acdf_word(tables, i)

#define ACDF_DIALECT_FN
#define ACDF_LET(type, name) type name
#define ACDF_STRUCT_BEGIN(name) struct name {
#define ACDF_STRUCT_END(name)                                                                                      \
    }                                                                                                              \
    ;

#define ACDF_TO_U32(x) uint(x)
#define ACDF_TO_F32(x) float(x)
#define ACDF_ABS(x) abs(x)
#define ACDF_SQRT(x) sqrt(x)
#define ACDF_MIN(a, b) min(a, b)
#define ACDF_MAX(a, b) max(a, b)
#define ACDF_RATIO(minor, major) clamp((minor) / (major), -1.0, 1.0) // divisions may round beyond

#endif
