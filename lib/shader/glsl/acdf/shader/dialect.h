// The words of acdf/shader/dialect.h in GLSL.
#ifndef ACDF_DIALECT_H
#define ACDF_DIALECT_H

#include <acdf/words.h>

#define ACDF_BITS(x) floatBitsToUint(x)
#define ACDF_FLOAT(bits) uintBitsToFloat(bits)

#endif
