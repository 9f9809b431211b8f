// The words of acdf/shader/dialect.h in what head.txt makes C, C++, CUDA, HIP and OpenCL C of.
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#include <acdf/shader/dialect_c.h>

#define ACDF_DIALECT_FN ACDF_EXPORT_FN
#define ACDF_U32 acdf_u32
#define ACDF_TABLES acdf_words

#define ACDF_TO_U32(x) ((acdf_u32)(x))
#define ACDF_BITS(x) acdf_export_bits(x)
#define ACDF_FLOAT(bits) acdf_export_float(bits)
#define ACDF_ABS(x) ACDF_EXPORT_ABS(x)
#define ACDF_SQRT(x) ACDF_EXPORT_SQRT(x)
#define ACDF_RATIO(minor, major) acdf_export_ratio(minor, major)

#endif
