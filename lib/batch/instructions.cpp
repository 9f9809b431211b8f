#include "batch/instructions.h"

acdf::Instructions acdf::instructions_of_this_processor() noexcept {
#if ACDF_BATCH_X86
    if (!__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("bmi2")) return Instructions::none;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        return Instructions::avx512;
    if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
    return Instructions::none;
}
