// What fuzzers check: what does not hold ends the process, and libFuzzer keeps the input.
#pragma once

#include <cstdlib>

namespace acdf_test {

inline void require(bool condition) {
    if (!condition) std::abort();
}

} // namespace acdf_test
