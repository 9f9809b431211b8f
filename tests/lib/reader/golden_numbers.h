// The numbers beside golden files: one sample a line.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace acdf_test {

/// Every line of a file as `Count` numbers.
template <std::size_t Count>
std::vector<std::array<double, Count>> golden_numbers(const std::string& path) {
    std::vector<std::array<double, Count>> lines;
    std::ifstream in(path);
    for (std::string text; std::getline(in, text);) {
        lines.emplace_back();
        const char* at = text.c_str();
        for (double& value : lines.back()) {
            char* end = nullptr;
            value = std::strtod(at, &end);
            EXPECT_NE(end, at) << text;
            at = end;
        }
    }
    return lines;
}

} // namespace acdf_test
