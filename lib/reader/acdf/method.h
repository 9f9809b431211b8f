// The qualifier of C++ functions that are called in kernels, for example __host__ __device__.
#pragma once

#ifndef ACDF_METHOD
#define ACDF_METHOD
#endif
