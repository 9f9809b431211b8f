// The words of acdf/shader/dialect.h in HLSL and Slang.
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#include <acdf/words.h>

#define ACDF_BITS(x) asuint(x)
#define ACDF_FLOAT(bits) asfloat(bits)

#endif
