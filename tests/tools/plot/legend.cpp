// Title and colour bar: where ticks are, and that nothing overlaps.
#include "tools/plot/legend.h"

#include "tools/plot/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace acdf::test {
namespace {

using tools::Box;
using tools::LegendLayout;
using tools::PdfRange;

constexpr PdfRange range{1e-3, 1e2};

struct Drawn {
    LegendLayout layout;
    images::Picture image;

    Drawn(int width, int height, const std::vector<std::string>& title, bool zero, const std::string& font)
        : layout(tools::legend_layout(width, height)) {
        images::Picture picture(width, height); // black
        image = tools::add_legend(picture, {title, range, zero}, font);
    }

    bool blank(int x, int y) const {
        const float* rgb = image.at(x, y);
        return rgb[0] == 1.0f && rgb[1] == 1.0f && rgb[2] == 1.0f;
    }
    bool blank(const Box& box) const {
        for (int y = box.y; y < box.y + box.height; ++y)
            for (int x = box.x; x < box.x + box.width; ++x)
                if (!blank(x, y)) return false;
        return true;
    }
};

TEST(PlotLegend, KeepsThePictureWhole) {
    const Drawn drawn(400, 200, {"sky"}, false, "");
    EXPECT_EQ(drawn.image.width, drawn.layout.width);
    EXPECT_EQ(drawn.image.height, drawn.layout.height);
    const Box& p = drawn.layout.picture;
    EXPECT_EQ(p.width, 400);
    EXPECT_EQ(p.height, 200);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 400; ++x) {
            const float* rgb = drawn.image.at(p.x + x, p.y + y);
            ASSERT_EQ(rgb[0] + rgb[1] + rgb[2], 0.0f);
        }
    EXPECT_TRUE(drawn.blank({p.x + p.width, 0, drawn.layout.bar.x - p.x - p.width, drawn.layout.height}));
}

TEST(PlotLegend, TicksAreAtThePowersOfTenAndNowhereElse) {
    const Drawn drawn(400, 400, {}, false, "");
    const Box& bar = drawn.layout.bar;
    const int end_of_tick = bar.x + bar.width + drawn.layout.tick_length - 1;
    std::vector<int> rows, expected;
    for (int y = 0; y < drawn.layout.height; ++y)
        if (!drawn.blank(end_of_tick, y)) rows.push_back(y);
    for (int decade = 0; decade < 6; ++decade) // five decades evenly over the bar, the largest on top
        expected.push_back(bar.y + static_cast<int>(std::lround(decade / 5.0 * (bar.height - 1))));
    EXPECT_EQ(rows, expected);
}

TEST(PlotLegend, BarShowsTheColourOfEachPdf) {
    const Drawn drawn(400, 400, {}, false, "");
    const Box& bar = drawn.layout.bar;
    for (const double pdf : {1e-3, 1e-2, 0.5, 3.0, 100.0}) {
        const tools::PdfImage pixel{{build::Layout::latlong, 1, 1}, {static_cast<float>(pdf)}};
        const std::vector<float> expected = tools::false_colour(pixel, range).values;
        const float* shown = drawn.image.at(bar.x + bar.width / 2, drawn.layout.row_of(pdf, range));
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 0.02f) << pdf;
    }
}

TEST(PlotLegend, ExplainsZeroOnlyWhereItIsShown) {
    EXPECT_TRUE(Drawn(300, 300, {}, false, "").blank(tools::legend_layout(300, 300).zero));
    const Drawn with(300, 300, {}, true, "");
    const float* rgb = with.image.at(with.layout.zero.x + 2, with.layout.zero.y + 2);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(rgb[c], tools::zero_colour[c]);
}

TEST(PlotLegend, TextLabelsEachDecadeAndStaysInsideItsBox) {
    const std::string font = tools::find_font();
    if (font.empty()) GTEST_SKIP() << "no font is installed";
    const std::string name(300, 'm');
    const Drawn drawn(400, 400, {name, "256 cells"}, true, font);
    const LegendLayout& l = drawn.layout;
    const int labels = l.bar.x + l.bar.width + l.tick_length + 1;
    for (int decade = -3; decade <= 2; ++decade) {
        const int row = l.row_of(std::pow(10.0, decade), range);
        EXPECT_FALSE(drawn.blank({labels, row - l.font_size / 2, l.width - labels, l.font_size})) << decade;
    }
    EXPECT_FALSE(drawn.blank({l.picture.x, 0, l.picture.width, l.picture.y}));
    // A title too long is cut, and ends before the bar's unit.
    EXPECT_TRUE(drawn.blank(
        {l.picture.x + l.picture.width + 1, 0, l.bar.x - l.picture.x - l.picture.width - 1, l.picture.y}));
    EXPECT_TRUE(drawn.blank({l.width - 2, 0, 2, l.height}));
    EXPECT_TRUE(drawn.blank({0, 0, l.width, 2}));
}

TEST(PlotLegend, LabelsKeepClearOfOneAnother) {
    const std::string font = tools::find_font();
    if (font.empty()) GTEST_SKIP() << "no font is installed";
    images::Picture picture(64, 100);
    const LegendLayout l = tools::legend_layout(64, 100);
    const images::Picture image = tools::add_legend(picture, {{}, {1e-20, 1e20}, false}, font);
    int runs = 0, longest = 0, run = 0; // of rows with ink, in the column of labels
    for (int y = l.bar.y - l.font_size / 4; y < l.height; ++y) {
        bool ink = false;
        for (int x = l.bar.x + l.bar.width + l.tick_length + 1; x < l.width; ++x) {
            ink = ink || image.at(x, y)[0] < 0.9f;
        }
        run = ink ? run + 1 : 0;
        runs += run == 1;
        longest = std::max(longest, run);
    }
    EXPECT_GE(runs, 3);
    EXPECT_LE(longest, l.font_size * 3 / 2);
}

TEST(PlotLegend, LongLabelsAreNotCutOff) {
    const std::string font = tools::find_font();
    if (font.empty()) GTEST_SKIP() << "no font is installed";
    for (const int height : {64, 200, 1024})
        for (const tools::PdfRange labelled : {tools::PdfRange{1e-14, 1e-10}, {2e-4, 9e-4}, {2e-14, 9e-14}}) {
            images::Picture picture(64, height);
            const LegendLayout l = tools::legend_layout(64, height);
            const images::Picture image = tools::add_legend(picture, {{}, labelled, false}, font);
            for (int y = 0; y < l.height; ++y)
                for (int x = l.width - 2; x < l.width; ++x)
                    ASSERT_EQ(image.at(x, y)[0], 1.0f) << height << ": " << x << "," << y;
        }
}

TEST(PlotLegend, SurvivesTinyPicturesAndOddNames) {
    const std::string font = tools::find_font();
    for (const int size : {1, 8, 16})
        EXPECT_GT(Drawn(size, size, {"\xC3\xA9\xE2\x82\xAC\n\t", "x"}, true, font).image.height, 8 * 12);
}

} // namespace
} // namespace acdf::test
