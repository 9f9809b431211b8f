/* Words of acdf/shader/dialect.h in C and its kin, in the reader as in what `acdf export` writes. A dialect says
 * besides what whole numbers and tables are called and how functions begin. */
#ifndef ACDF_DIALECT_C_H
#define ACDF_DIALECT_C_H

#include <acdf/shader/dialect_words.h>

#define ACDF_F32 float
#define ACDF_WORD(tables, i) (tables)[i]
#define ACDF_LET(type, name) const type name
#define ACDF_STRUCT_BEGIN(name) typedef struct name {
#define ACDF_STRUCT_END(name)                                                                                      \
    }                                                                                                              \
    name;
#define ACDF_TO_F32(x) ((float)(x))
#define ACDF_MIN(a, b) ((a) < (b) ? (a) : (b))
#define ACDF_MAX(a, b) ((a) > (b) ? (a) : (b))

#endif
