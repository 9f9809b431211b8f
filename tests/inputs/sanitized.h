// What sanitizers look for shows in the first of many repetitions: statistics are for the optimised build.
#pragma once

namespace acdf_test {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// So many repetitions, and a twelfth of them under sanitizers.
constexpr int repeated(int times) { return kSanitized ? (times + 11) / 12 : times; }

} // namespace acdf_test
