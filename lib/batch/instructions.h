// Which vectors the processor has that runs us.
#pragma once

#include <acdf/batch/batch.h>

#include <algorithm>

namespace acdf {

/// The best of them.
Instructions instructions_of_this_processor() noexcept;

/// The candidate that runs by the best instructions that the processor has, up to `most`.
template <class T>
T best_of(Instructions most, T plain, T avx2, T avx512) noexcept {
    const Instructions best = std::min(most, instructions_of_this_processor());
    return best == Instructions::avx512 ? avx512 : best == Instructions::avx2 ? avx2 : plain;
}

} // namespace acdf

/// The same; where vectors are not compiled, no candidate but the first one is named.
#if ACDF_BATCH_X86
#define ACDF_BEST_OF(most, plain, avx2, avx512) acdf::best_of(most, plain, avx2, avx512)
#else
#define ACDF_BEST_OF(most, plain, avx2, avx512) ((void)(most), (plain))
#endif
