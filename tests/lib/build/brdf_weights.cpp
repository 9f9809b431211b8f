// Weights of samples of BRDF files: bounded without being asked to be, next to free, and by a number where one is
// given; and what more bytes gain.
#include "tests/inputs/sanitized.h"
#include "tests/lib/build/real_brdfs.h"

#include "build/weight_bound.h"

#include <limits>
#include <stdexcept>

using namespace acdf_test;

namespace {

/// Reflects as much at the horizon as measured materials do: rho cos does not fall to 0 there.
class BrightHorizon : public acdf::build::Brdf {
public:
    BrightHorizon() {
        isotropic = mirror = true;
        name = "bright horizon";
    }
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override {
        const bool lit = wo[2] > 0.0 && wi[2] > 0.0;
        rgb[0] = rgb[1] = rgb[2] = lit ? 0.2 + 0.1 / wi[2] : 0.0;
    }
};

constexpr double kNoBound = 1e30;

acdf::build::BrdfFileOptions few_views(double max_weight) {
    acdf::build::BrdfFileOptions options = budget(12 << 10);
    options.fit.theta_views = 6;
    options.max_weight = max_weight;
    return options;
}

/// Over views and half-vectors that neither the fit nor the file's own figures know of.
acdf::build::BrdfAccuracy elsewhere(const MadeBrdf& brdf, std::uint32_t views) {
    const auto measured =
        acdf::build::measure_views(brdf.file, brdf.reflected, acdf::build::random_views(views, true, 0.03, 1.0),
                                   acdf::build::Sides::any, 101, 233);
    return acdf::build::summary(measured);
}

TEST(BrdfWeights, AreBoundedAtNextToNoCost) {
    const auto usual = make_brdf(std::make_unique<BrightHorizon>(), few_views(0.0));
    const auto unbounded = make_brdf(std::make_unique<BrightHorizon>(), few_views(kNoBound));
    EXPECT_LE(elsewhere(*usual, 24).max_weight, 30.0);
    EXPECT_LE(usual->made.accuracy.relative_variance, 1.02 * unbounded->made.accuracy.relative_variance);
    EXPECT_EQ(usual->made.accuracy.support_violations, 0u);
}

TEST(BrdfWeights, StayBelowANumber) {
    ACDF_NOT_SANITIZED();
    acdf::build::BrdfFileOptions options = few_views(5.0);
    const auto brdf = make_brdf(std::make_unique<BrightHorizon>(), options);
    EXPECT_LE(brdf->made.accuracy.max_weight, 5.0);
    EXPECT_LE(elsewhere(*brdf, 24).max_weight, 7.5);
    EXPECT_NE(acdf::build::option_text(options).find("--max-weight 5 "), std::string::npos);
}

TEST(BrdfWeights, TwiceTheBytesMakeLessNoise) {
    ACDF_NOT_SANITIZED();
    double variance = std::numeric_limits<double>::infinity(), worst = variance;
    for (const std::uint64_t kib : {8u, 16u}) { // with more views and more cells
        const auto brdf = make_brdf(std::make_unique<BrightHorizon>(), budget(kib << 10));
        const acdf::build::BrdfAccuracy a = elsewhere(*brdf, 24);
        EXPECT_LT(a.relative_variance, variance) << kib;
        EXPECT_LT(a.worst, worst) << kib;
        variance = a.relative_variance;
        worst = a.worst;
    }
}

struct Weighed {
    struct {
        double max_weight;
    } accuracy;
};

TEST(WithinWeight, TightensAsLongAsItHelps) {
    int builds = 0;
    const auto half_more = [&](double bound) { // the measured weight is half more than the fit finds
        ++builds;
        return Weighed{{1.5 * bound}};
    };
    EXPECT_LE(acdf::build::within_weight(8.0, half_more).accuracy.max_weight, 8.0);
    EXPECT_EQ(builds, 2);
    builds = 0;
    const auto same = [&](double) {
        ++builds;
        return Weighed{{9.0}};
    };
    EXPECT_THROW(acdf::build::within_weight(8.0, same), std::runtime_error);
    EXPECT_EQ(builds, 2);
    EXPECT_EQ(acdf::build::within_weight(0.0, same).accuracy.max_weight, 9.0); // no bound
}

/// A measured BRDF and two sizes of its file.
struct Ladder {
    const char* name;
    std::uint64_t kib[2];
};

class MeasuredWeights : public testing::TestWithParam<Ladder> {};

TEST_P(MeasuredWeights, AreBoundedAndNoiseFallsWithEveryByte) {
    NEEDS(GetParam().name);
    double variance = std::numeric_limits<double>::infinity(), worst = variance;
    for (const std::uint64_t kib : GetParam().kib) {
        const acdf::build::BrdfAccuracy a = elsewhere(real_brdf(GetParam().name, kib), 64);
        EXPECT_LE(a.max_weight, 30.0) << kib;
        EXPECT_LT(a.relative_variance, variance) << kib;
        EXPECT_LT(a.worst, worst) << kib;
        EXPECT_LE(a.worst, 6.0 * a.relative_variance) << kib;
        variance = a.relative_variance;
        worst = a.worst;
    }
}

INSTANTIATE_TEST_SUITE_P(Files, MeasuredWeights, testing::Values(Ladder{"cc_ibiza_sunset_rgb.bsdf", {128, 176}}),
                         [](const auto& info) { return std::string(info.param.name).substr(0, 5); });

} // namespace
