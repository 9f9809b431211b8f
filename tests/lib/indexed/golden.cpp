// The frozen files of several maps of every version (format/make_golden.cpp makes those of the present one).
#include "tests/lib/reader/golden_numbers.h"

#include <acdf/indexed/views.h>
#include <acdf/reader.h>

#include <gtest/gtest.h>

#include <string>

namespace {

class GoldenIndexed : public acdf_test::GoldenSamples {
protected:
    void SetUp() override {
        GoldenSamples::SetUp();
        const acdf::Status status = acdf::IndexedEnvironment::open(file_, maps_);
        ASSERT_TRUE(status.ok()) << status.message;
    }
    acdf::MixedEnvironment at(const acdf_test::GoldenSample& line) const {
        return maps_.at(double{line.given[0]}, double{line.given[1]}, double{line.given[2]});
    }

    acdf::IndexedEnvironment maps_;
};

TEST_P(GoldenIndexed, SamplesTheSameSamples) {
    for (const acdf_test::GoldenSample& line : lines_) {
        const acdf::DirectionSample s = at(line).sample(line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(s.direction[i], line.direction[i]);
        EXPECT_EQ(s.pdf, line.pdf);
    }
}

TEST_P(GoldenIndexed, HasThatPdfThere) {
    for (const acdf_test::GoldenSample& line : lines_) {
        EXPECT_GT(line.pdf, 0.0f);
        EXPECT_EQ(at(line).pdf(line.direction), line.pdf);
    }
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenIndexed, ::testing::Values("indexed", "indexed_octahedral"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
