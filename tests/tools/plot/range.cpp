// The range of pdfs that colours stand for, and its ticks.
#include "tools/plot/range.h"

#include <gtest/gtest.h>

#include <cmath>

namespace acdf::test {
namespace {

using tools::PdfImage;
using tools::PdfRange;

PdfImage latlong_image(int width, float pdf) {
    PdfImage image{tools::plot_map(build::Layout::latlong, width), {}};
    image.pdf.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(width / 2), pdf);
    return image;
}

TEST(PlotRange, ReadsMinimumAndMaximum) {
    const auto range = tools::parse_range("1e-3:250");
    ASSERT_TRUE(range);
    EXPECT_EQ(range->low, 1e-3);
    EXPECT_EQ(range->high, 250.0);
    EXPECT_EQ(tools::to_string(*range), "0.001:250");
}

TEST(PlotRange, RefusesWhatIsNoRange) {
    for (const char* text : {"", ":", "1", "1:", ":1", "1:1", "2:1", "0:1", "-1:1", "nan:1", "1:nan", "1:inf",
                             "1e-60:1", "1:1e60", "1:2:3", "a:b", "1 :2", "1:2 ", "1,5:2"})
        EXPECT_FALSE(tools::parse_range(text)) << text;
}

TEST(PlotRange, PositionIsLogarithmicAndClamped) {
    const PdfRange range{1e-2, 1e2};
    EXPECT_DOUBLE_EQ(range.position(1.0), 0.5);
    EXPECT_DOUBLE_EQ(range.position(10.0), 0.75);
    EXPECT_EQ(range.position(1e-9), 0.0);
    EXPECT_EQ(range.position(1e9), 1.0);
}

TEST(PlotRange, OfAConstantIsADecadeAroundIt) {
    const PdfRange range = tools::automatic_range(latlong_image(64, 0.0796f));
    EXPECT_EQ(range.low, 0.02);
    EXPECT_EQ(range.high, 0.5);
}

TEST(PlotRange, LeavesOutOutliersButNotASun) {
    PdfImage image = latlong_image(256, 0.05f);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) image.pdf[static_cast<std::size_t>(y * 256 + x)] = 0.003f;
    image.pdf[64 * 256 + 10] = 1e-12f; // dark, and tiny
    image.pdf[64 * 256 + 20] = 0.5f;   // brighter than all, but with next to no probability
    PdfRange range = tools::automatic_range(image);
    EXPECT_EQ(range.low, 0.002);
    EXPECT_GE(range.high, 0.05);
    EXPECT_LE(range.high, 0.1);
    image.pdf[64 * 256 + 30] = 1500.0f; // a pixel of 6e-4 sr: most of the probability
    range = tools::automatic_range(image);
    EXPECT_EQ(range.low, 0.002);
    EXPECT_EQ(range.high, 2000.0);
}

TEST(PlotRange, IgnoresZeroAndSpansAtMostEightDecades) {
    PdfImage image = latlong_image(64, 1.0f);
    for (std::size_t i = 0; i < 1024; ++i) image.pdf[i] = i % 2 ? 0.0f : 1e-20f;
    const PdfRange range = tools::automatic_range(image);
    EXPECT_GE(range.high, 1.0);
    EXPECT_GE(range.low, 1e-9);
    EXPECT_LE(range.low, 1e-7);
}

TEST(PlotRange, OfNothingIsStillARange) {
    const PdfRange range = tools::automatic_range(latlong_image(16, 0.0f));
    EXPECT_LT(range.low, range.high);
    EXPECT_GT(range.low, 0.0);
}

std::vector<double> pdfs(const PdfRange& range, bool major) {
    std::vector<double> out;
    for (const tools::Tick& tick : tools::ticks(range))
        if (!major || tools::is_major(tick, range)) out.push_back(tick.pdf());
    return out;
}

TEST(PlotRange, TicksAreTheRoundPdfsInside) {
    EXPECT_EQ(pdfs({0.5, 20.0}, false),
              (std::vector<double>{0.5, 0.6, 0.7, 0.8, 0.9, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 20}));
    EXPECT_EQ(pdfs({2e-7, 4e-7}, false), (std::vector<double>{2e-7, 3e-7, 4e-7}));
}

TEST(PlotRange, MajorTicksAreThePowersOfTen) {
    EXPECT_EQ(pdfs({1e-3, 100.0}, true), (std::vector<double>{1e-3, 1e-2, 1e-1, 1, 10, 100}));
    EXPECT_EQ(pdfs({2e-3, 99.0}, true), (std::vector<double>{1e-2, 1e-1, 1, 10}));
}

TEST(PlotRange, MajorTicksOfAShortRangeAreMore) {
    EXPECT_EQ(pdfs({0.2, 5.0}, true), (std::vector<double>{0.2, 0.5, 1, 2, 5}));
    EXPECT_EQ(pdfs({3e-4, 6e-4}, true), (std::vector<double>{3e-4, 4e-4, 5e-4, 6e-4}));
    EXPECT_EQ(pdfs({0.1, 10.0}, true), (std::vector<double>{0.1, 0.2, 0.5, 1, 2, 5, 10}));
}

} // namespace
} // namespace acdf::test
