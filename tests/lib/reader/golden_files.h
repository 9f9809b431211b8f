// The frozen files of format 1.0, for tests that compare two ways to read one.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace acdf_test {

/// Calls each(bytes) for every one, until a test fails.
template <class Each>
void each_golden_file(Each&& each) {
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0")) {
        if (entry.path().extension() != ".acdf") continue;
        SCOPED_TRACE(entry.path().filename());
        std::ifstream in(entry.path(), std::ios::binary);
        each(std::vector<std::uint8_t>{std::istreambuf_iterator<char>(in), {}});
        if (testing::Test::HasFatalFailure()) return;
    }
}

} // namespace acdf_test
