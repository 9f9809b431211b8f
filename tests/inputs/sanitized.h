// What sanitizers look for shows in the first of many repetitions: statistics are for the optimised build.
#pragma once

#if defined(__GNUC__)
extern "C" __attribute__((weak)) void __asan_init(); // of AddressSanitizer's runtime library
#endif

namespace acdf_test {

/// Whether this program has AddressSanitizer in it. Asked where it runs: tests may be linked as another build
/// compiled them.
#if defined(__GNUC__)
inline const bool kSanitized = __asan_init != nullptr;
#else
inline const bool kSanitized = false;
#endif

/// So many repetitions, and a twelfth of them under sanitizers.
inline int repeated(int times) { return kSanitized ? (times + 11) / 12 : times; }

} // namespace acdf_test

/// Skips the rest of a test under sanitizers: others run the same code, and only numbers differ.
#define ACDF_NOT_SANITIZED()                                                                                       \
    if (acdf_test::kSanitized) GTEST_SKIP() << "the same code as elsewhere: only numbers differ"
