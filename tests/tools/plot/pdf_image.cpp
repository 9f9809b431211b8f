// Pdfs as images: every pixel is the pdf of the direction at its centre.
#include "tools/plot/pdf_image.h"

#include "tests/tools/plot/files.h"

namespace acdf::test {
namespace {

using tools::PdfImage;

class EachFit : public testing::TestWithParam<AcdfFit> {};

TEST_P(EachFit, LatlongPixelsAreTheReadersPdf) {
    const StoredEnvironment stored(dark_noise(), fit_options(GetParam(), 16, 8));
    const PdfImage image =
        tools::pdf_image(tools::plot_map(build::Layout::latlong, 200), tools::pdf_of(stored.view()));
    ASSERT_EQ(image.map.height, 100);
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x) {
            float direction[3];
            latlong_direction(200, 100, x, y, direction);
            const float pdf = stored.view().pdf(direction);
            ASSERT_NEAR(image.at(x, y), pdf, 1e-4f * pdf) << x << "," << y;
        }
}

TEST_P(EachFit, AngularPixelsAreTheReadersPdf) {
    const StoredEnvironment stored(dark_noise(), fit_options(GetParam(), 16, 8));
    const PdfImage image =
        tools::pdf_image(tools::plot_map(build::Layout::angular, 150), tools::pdf_of(stored.view()));
    ASSERT_EQ(image.map.height, 150);
    int outside = 0, differing = 0;
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 150; ++x) {
            float direction[3];
            if (!angular_direction(150, x, y, direction)) {
                ASSERT_EQ(image.at(x, y), tools::shows_nothing);
                ++outside;
                continue;
            }
            const float pdf = stored.view().pdf(direction);
            differing += !(std::abs(image.at(x, y) - pdf) <= 1e-4f * pdf);
        }
    EXPECT_NEAR(outside, 150 * 150 * (1.0 - acdf_test::kPi / 4.0), 150.0);
    // The two formulas round differently: a centre right on a border may fall on either side.
    EXPECT_LE(differing, 4);
}

INSTANTIATE_TEST_SUITE_P(Fits, EachFit,
                         testing::Values(ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF, ACDF_FIT_VARIANCE));

TEST(PlotPdf, OfAProbeIsItsShareAtFullResolution) {
    const compress::Target target = dark_noise();
    const PdfImage image = tools::pdf_image(tools::plot_map(build::Layout::latlong, 64), tools::pdf_of(target));
    double integral = 0.0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto row = static_cast<std::uint32_t>(y), column = static_cast<std::uint32_t>(x);
            const double expected = static_cast<double>(target.row(row)[column]) / compress::integral(target);
            ASSERT_NEAR(image.at(x, y), expected, 1e-6 * expected) << x << "," << y;
            integral +=
                static_cast<double>(image.at(x, y)) * target.row_measure[row] * target.column_measure[column];
        }
    EXPECT_NEAR(integral, 1.0, 1e-5);
}

TEST(PlotPdf, AngularShowsForwardInTheMiddleAndUpAbove) {
    const build::Map map = tools::plot_map(build::Layout::angular, 101);
    float d[3];
    ASSERT_TRUE(tools::pixel_direction(map, 50.5, 50.5, d));
    EXPECT_NEAR(d[0], 1.0f, 1e-6f);
    ASSERT_TRUE(tools::pixel_direction(map, 25.25, 50.5, d)); // halfway to the rim: pi / 2 from the middle
    EXPECT_NEAR(std::abs(d[1]), 1.0f, 1e-6f);
    ASSERT_TRUE(tools::pixel_direction(map, 50.5, 25.25, d));
    EXPECT_NEAR(d[2], 1.0f, 1e-6f);
    EXPECT_FALSE(tools::pixel_direction(map, 1.0, 1.0, d));
}

// An angular probe plotted in its own projection lies where the probe shows it, mirrored or not.
TEST(PlotPdf, OfAnAngularProbeLooksLikeTheProbe) {
    const build::Map map = tools::plot_map(build::Layout::angular, 64);
    const build::Direction lamp{0.3, 0.9, std::sqrt(1.0 - 0.09 - 0.81)};
    const auto pdf = [&](const float d[3]) {
        const double dx = d[0] - lamp.x, dy = d[1] - lamp.y, dz = d[2] - lamp.z;
        return dx * dx + dy * dy + dz * dz < 0.01 ? 1.0f : 0.0f;
    };
    const PdfImage image = tools::pdf_image(map, pdf);
    const build::ImagePoint p = build::to_image(map, lamp);
    EXPECT_EQ(image.at(static_cast<int>(p.u * 64), static_cast<int>(p.v * 64)), 1.0f);
    EXPECT_EQ(image.at(static_cast<int>((1.0 - p.u) * 64), static_cast<int>(p.v * 64)), 0.0f);
}

} // namespace
} // namespace acdf::test
