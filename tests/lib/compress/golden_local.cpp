// The frozen local environments of every version: format/make_golden.cpp makes those of the present one.
#include "tests/lib/reader/golden_numbers.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

const std::string kGoldenLocal = ACDF_TEST_DIR "/golden/v1.0/";

class GoldenLocal : public acdf_test::GoldenSamples {};

TEST_P(GoldenLocal, SamplesTheSameSamples) {
    acdf::LoadOptions options; // as SPEC.md says it, to the last bit
    options.tables = false;
    acdf::File walked;
    ASSERT_TRUE(
        acdf::File::open((kGoldenLocal + GetParam() + ".acdf").c_str(), walked, acdf::with_curves(options)).ok());
    for (const acdf_test::GoldenSample& line : lines_) {
        const auto s = walked.local().sample(line.given, line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(s.direction[i], line.direction[i]);
        EXPECT_EQ(s.pdf, line.pdf);
    }
}

TEST_P(GoldenLocal, HasTheSameSamplesByRuntimeTables) { // but for the rounding of floats
    for (const acdf_test::GoldenSample& line : lines_) {
        const auto s = file_.local().sample(line.given, line.u[0], line.u[1]);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.direction[i], line.direction[i], 4e-7);
        EXPECT_EQ(file_.local().pdf(line.given, s.direction), s.pdf);
        EXPECT_NEAR(s.pdf, line.pdf,
                    2e-6 * line.pdf); // of the direction: tilts and the cosine share change along a cell
    }
}

TEST_P(GoldenLocal, HasThatPdfThere) {
    int sampled = 0;
    for (const acdf_test::GoldenSample& line : lines_) {
        EXPECT_EQ(file_.local().pdf(line.given, line.direction), line.pdf);
        sampled += line.pdf > 0.0f;
    }
    EXPECT_GT(sampled, 60);
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenLocal, ::testing::Values("local", "local_grid"),
                         [](const auto& info) { return std::string(info.param); });

TEST(GoldenLocalContents, EachFileHasWhatItIsFor) {
    acdf::File local, grid;
    ASSERT_TRUE(acdf::File::open((kGoldenLocal + "local.acdf").c_str(), local, acdf::with_curves()).ok());
    ASSERT_TRUE(acdf::File::open((kGoldenLocal + "local_grid.acdf").c_str(), grid, acdf::with_curves()).ok());
    EXPECT_EQ(local.local().data().subdivisions, 2u);
    EXPECT_EQ(local.local().data().cosine_share, 0.0);
    EXPECT_EQ(local.bin(7).root, ACDF_NO_ROOT);
    EXPECT_EQ(grid.local().data().columns, 3u);
    EXPECT_EQ(grid.local().data().rows, 2u);
}

// Frame of normals, by hand: theta from +z, the first column of phi begins at -x and turns towards +y.
TEST(GoldenLocalFrame, NormalsFindTheirBins) {
    acdf::File grid;
    ASSERT_TRUE(acdf::File::open((kGoldenLocal + "local_grid.acdf").c_str(), grid, acdf::with_curves()).ok());
    const auto view = grid.local();
    const float left[3] = {-0.5f, 1.0f, 0.1f}, front[3] = {1.0f, 0.0f, 0.1f}, right[3] = {-0.5f, -1.0f, 0.1f};
    EXPECT_DOUBLE_EQ(view.irradiance(left), 3.0 * 0.125);
    EXPECT_DOUBLE_EQ(view.irradiance(front), 3.0 * 0.25);
    EXPECT_FALSE(view.stored(right)); // bin 2
    const float below[3] = {1.0f, 0.0f, -0.1f};
    EXPECT_EQ(view.sample(below, 0.5, 0.5).pdf, 0.0f); // bin 4 is dark
}

} // namespace
