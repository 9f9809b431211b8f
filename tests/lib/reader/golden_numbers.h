// The numbers beside golden files: one sample a line, and the fixture of those that are sampled for a direction.
#pragma once

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

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

/// A sample for a normal or a view: `given  u0 u1  direction  pdf` on a line.
struct GoldenSample {
    float given[3];
    double u[2];
    float direction[3], pdf;
};

/// A golden file, named by the parameter, and the 96 samples beside it.
class GoldenSamples : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string path = std::string(ACDF_TEST_DIR "/golden/v1.0/") + GetParam();
        const acdf::Status status = acdf::File::open((path + ".acdf").c_str(), file_, acdf::with_curves());
        ASSERT_TRUE(status.ok()) << status.message;
        for (const std::array<double, 9>& v : golden_numbers<9>(path + ".txt"))
            lines_.push_back({{float(v[0]), float(v[1]), float(v[2])},
                              {v[3], v[4]},
                              {float(v[5]), float(v[6]), float(v[7])},
                              float(v[8])});
        ASSERT_EQ(lines_.size(), 96u);
    }

    acdf::File file_;
    std::vector<GoldenSample> lines_;
};

} // namespace acdf_test
