// Lawrence et al. 2005, Fig. 4: two equal area lights at different heights. Along x the regions are AB (dark),
// BC (the first light), CD (the second), DE (dark). The marginal over x is constant over BD, so that its CDF
// needs knots at B and D alone; but the conditional differs between BC and CD, and only the gradient of the
// target (eq. 5) finds C.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/cascade_cells.h"

#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

namespace {

using namespace acdf::compress;

// A square grid, so that the lights can be turned; x is the first axis of the cascade, y the second. The
// borders in y are symmetric about the equator, so that the lights are equal on either axis.
constexpr std::uint32_t kSize = 32;
constexpr std::uint32_t kB = 8, kC = 16, kD = 24;               // x
constexpr std::uint32_t kLow[2] = {6, 12}, kHigh[2] = {20, 26}; // y of the first and of the second light

bool lit(std::uint32_t x, std::uint32_t y) {
    if (x >= kB && x < kC) return y >= kLow[0] && y < kLow[1];
    if (x >= kC && x < kD) return y >= kHigh[0] && y < kHigh[1];
    return false;
}

class TwoLights : public ::testing::TestWithParam<Order> {
protected:
    bool x_is_phi() const { return GetParam() == Order::phi; }

    Target target() const {
        return acdf_test::texel_target(kSize, kSize, [&](std::uint32_t column, std::uint32_t row) {
            return lit(x_is_phi() ? column : row, x_is_phi() ? row : column) ? 4.0 : 0.0;
        });
    }

    FitOptions paper(std::uint32_t x_segments, std::uint32_t gradient_knots) const {
        FitOptions options;
        options.fit = ACDF_FIT_CDF;
        options.order = GetParam();
        options.column_segments = options.row_segments = 5; // enough for two lights on one line
        (x_is_phi() ? options.column_segments : options.row_segments) = x_segments;
        options.gradient_knots = gradient_knots;
        return options;
    }

    void store_fit(const FitOptions& options) {
        Fitted fitted = fit(target(), options);
        cascade_ = std::move(fitted.cascade);
        bytes_ = store(fitted.tree, environment_description(kSize, kSize));
        const acdf::Status status =
            acdf::File::from_memory(bytes_.data(), bytes_.size(), file_, acdf::with_curves());
        ASSERT_TRUE(status.ok()) << status.message;
    }

    double relative_variance() const { return acdf::build::measure_environment(file_, target()).relative_variance; }

    /// The pdf at the middle of grid square (x, y).
    double pdf(std::uint32_t x, std::uint32_t y) const {
        float direction[3];
        acdf_test::direction_of(acdf_test::centre_phi(x_is_phi() ? x : y, kSize),
                                acdf_test::centre_z(x_is_phi() ? y : x, kSize), direction);
        return file_.environment().pdf(direction);
    }

    Cascade cascade_;
    std::vector<std::uint8_t> bytes_;
    acdf::File file_;
};

TEST_P(TwoLights, MarginalAloneNeedsOnlyABDE) {
    store_fit(paper(3, 0));
    EXPECT_EQ(cascade_.curves[0].knots, (std::vector<std::uint32_t>{kB, kD}));
    EXPECT_NEAR(cascade_.curves[0].probability[1], 1.0, 1e-12);
}

TEST_P(TwoLights, WithoutGradientTheConditionalIsWrongOverBD) {
    store_fit(paper(3, 0));
    // Each light's column holds both heights with half the pdf: E[(f/p)^2] = 2.
    EXPECT_NEAR(relative_variance(), 1.0, 1e-4);
    const double light = pdf(kB + 2, kLow[0] + 1), ghost = pdf(kB + 2, kHigh[0] + 1);
    EXPECT_GT(light, 0.0);
    EXPECT_NEAR(ghost / light, 1.0, 1e-4); // as much where there is nothing
    EXPECT_EQ(pdf(kB + 2, 1), 0.0);
    EXPECT_EQ(pdf(kB - 2, kLow[0] + 1), 0.0);
}

TEST_P(TwoLights, WithGradientKnotsItIsRight) {
    store_fit(paper(3, 0));
    const double half = pdf(kB + 2, kLow[0] + 1);
    store_fit(paper(3, 1)); // the steepest region: C
    EXPECT_EQ(cascade_.curves[0].knots, (std::vector<std::uint32_t>{kB, kC, kD}));
    EXPECT_LT(relative_variance(), 1e-6);
    EXPECT_NEAR(pdf(kB + 2, kLow[0] + 1) / half, 2.0, 1e-3);
    EXPECT_NEAR(pdf(kC + 2, kHigh[0] + 1) / half, 2.0, 1e-3);
    EXPECT_EQ(pdf(kB + 2, kHigh[0] + 1), 0.0);
    EXPECT_EQ(pdf(kC + 2, kLow[0] + 1), 0.0);
}

TEST_P(TwoLights, GradientSamplesThatCoincideAddNothing) {
    // g is a at B, 2a at C, a at D: sixteen strata hit nothing but those.
    store_fit(paper(3, 16));
    EXPECT_EQ(cascade_.curves[0].knots, (std::vector<std::uint32_t>{kB, kC, kD}));
    EXPECT_LT(relative_variance(), 1e-6);
}

TEST_P(TwoLights, GradientAloneFindsAllBorders) {
    store_fit(paper(1, 4));
    EXPECT_EQ(cascade_.curves[0].knots, (std::vector<std::uint32_t>{kB, kC, kD}));
}

// The lights begin and end at even rows: halvings find their borders with codes that are exactly 0 and 1.
TEST_P(TwoLights, HalvingsNeedNoHelp) {
    HalvingsOptions options;
    options.goal.cells = 64;
    bytes_ = store(fit_halvings(target(), options), environment_description(kSize, kSize));
    const acdf::Status status = acdf::File::from_memory(bytes_.data(), bytes_.size(), file_, acdf::with_curves());
    ASSERT_TRUE(status.ok()) << status.message;
    EXPECT_LT(relative_variance(), 1e-3); // of codes of ten bits or fewer
    EXPECT_GT(pdf(kB + 2, kLow[0] + 1), 0.0);
    EXPECT_EQ(pdf(kB + 2, kHigh[0] + 1), 0.0);
    EXPECT_EQ(pdf(kC + 2, kLow[0] + 1), 0.0);
}

INSTANTIATE_TEST_SUITE_P(BothOrders, TwoLights, ::testing::Values(Order::phi, Order::z),
                         [](const auto& info) { return info.param == Order::phi ? "phi" : "z"; });

} // namespace
