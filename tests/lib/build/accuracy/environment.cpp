// measure_environment against midpoint quadrature of the reader's own pdf.
#include "tests/lib/build/accuracy/random_cascade.h"

#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace acdf;
using acdf_test::kPi;
using build::Accuracy;
using compress::Target;

constexpr int kSteps = 64; // subsamples of a texel along phi and along z

/// All fields but the cells, slowly: f/p and the rest at 4096 points of every texel.
Accuracy quadrature(const EnvironmentView& view, const Target& target) {
    Accuracy a;
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c)
            a.total += double{target.row(r)[c]} * 2.0 * kPi / target.columns *
                       (std::cos(kPi * r / target.rows) - std::cos(kPi * (r + 1.0) / target.rows));
    double second = 0.0, square = 0.0, violated = 0.0;
    const auto add = [&](double f, double p, double area) {
        const double perfect = f / a.total;
        square += (p - perfect) * (p - perfect) * area;
        if (f > 0.0 && p == 0.0) violated += 1.0 / (kSteps * kSteps);
        if (!(f > 0.0) || p == 0.0) return;
        second += perfect * perfect / p * area;
        a.kl_divergence += perfect * std::log(perfect / p) * area;
        a.max_weight = std::max(a.max_weight, perfect / p);
    };
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const double z0 = std::cos(kPi * r / target.rows), z1 = std::cos(kPi * (r + 1.0) / target.rows);
        for (std::uint32_t c = 0; c < target.columns; ++c)
            for (int j = 0; j < kSteps; ++j)
                for (int i = 0; i < kSteps; ++i) {
                    const double phi = kPi - 2.0 * kPi * (c + (i + 0.5) / kSteps) / target.columns;
                    const double z = z0 + (z1 - z0) * (j + 0.5) / kSteps;
                    float direction[3];
                    acdf_test::direction_of(phi, z, direction);
                    add(double{target.row(r)[c]}, double{view.pdf(direction)},
                        (z0 - z1) * 2.0 * kPi / target.columns / (kSteps * kSteps));
                }
    }
    a.relative_variance = second - 1.0;
    a.rms_pdf_error = std::sqrt(square / (4.0 * kPi));
    a.support_violations = static_cast<std::uint64_t>(std::lround(violated));
    return a;
}

class Stored {
public:
    Stored(const compress::Cascade& cascade, std::uint32_t columns, std::uint32_t rows)
        : bytes_(
              compress::store(compress::encode_tree(cascade), compress::environment_description(columns, rows))) {
        const Status status = File::from_memory(bytes_.data(), bytes_.size(), file_, acdf::with_curves());
        if (!status.ok()) throw std::runtime_error(status.message);
    }
    const File& file() const { return file_; }

private:
    std::vector<std::uint8_t> bytes_;
    File file_;
};

/// `corner`: how far the largest weight may lie above that of the subsamples, which miss the corners.
void expect_agreement(const File& file, const Target& target, double corner) {
    const Accuracy exact = build::measure_environment(file, target);
    const Accuracy slow = quadrature(file.environment(), target);
    EXPECT_NEAR(exact.total / slow.total, 1.0, 1e-11);
    EXPECT_NEAR(exact.relative_variance, slow.relative_variance, 1e-3 * slow.relative_variance + 1e-6);
    EXPECT_NEAR(exact.rms_pdf_error, slow.rms_pdf_error, 1e-3 * slow.rms_pdf_error + 1e-7);
    EXPECT_NEAR(exact.kl_divergence, slow.kl_divergence, 1e-3 * slow.kl_divergence + 1e-6);
    EXPECT_GE(exact.max_weight, slow.max_weight * (1.0 - 1e-6));
    EXPECT_LE(exact.max_weight, slow.max_weight * (1.0 + corner));
    EXPECT_EQ(exact.support_violations, slow.support_violations);
}

TEST(MeasureEnvironment, AgreesWithQuadratureOnRandomCascades) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(seed);
        const Target target = acdf_test::noise_target(7, 5, seed, 0.7, 0.1);
        expect_agreement(Stored(acdf_test::RandomCascade(seed, 0.0, 3).make(7, 5), 7, 5).file(), target, 1e-6);
    }
}

TEST(MeasureEnvironment, AgreesWithQuadratureOnTiltedCascades) {
    for (std::uint64_t seed = 10; seed < 14; ++seed) {
        SCOPED_TRACE(seed);
        const Target target = acdf_test::noise_target(7, 5, seed, 0.7, 0.1);
        expect_agreement(Stored(acdf_test::RandomCascade(seed, 0.8, 3).make(7, 5), 7, 5).file(), target, 0.15);
    }
}

TEST(MeasureEnvironment, AgreesWithQuadratureOnFits) {
    const Target target = acdf_test::sphere_target(9, 6, acdf_test::smooth_sky);
    for (const AcdfFit kind : {ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF}) {
        SCOPED_TRACE(kind);
        compress::FitOptions options;
        options.fit = kind;
        options.column_segments = 4;
        options.row_segments = 3;
        expect_agreement(Stored(compress::fit(target, options).cascade, 9, 6).file(), target, 0.15);
    }
}

/// Half the probability on each half of the sphere, east and west.
const compress::Cascade kHalves{{{0, {2}, {0.25, 0.75}, {}, {}}}, {0}};

TEST(MeasureEnvironment, ByHand) {
    // f = 1 everywhere; p = 0.25 and 0.75 over 2 pi each: the integral of f^2/p over (4 pi)^2 is
    // (1/4)(1/0.25 + 1/0.75) = 4/3.
    const Target target = acdf_test::sphere_target(4, 3, [](double, double) { return 1.0; });
    const Stored stored(kHalves, 4, 3);
    const Accuracy a = build::measure_environment(stored.file(), target);
    EXPECT_NEAR(a.relative_variance, 1.0 / 3.0, 1e-4);
    EXPECT_NEAR(a.max_weight, 2.0, 1e-4);
    EXPECT_NEAR(a.kl_divergence, 0.5 * std::log(2.0) + 0.5 * std::log(2.0 / 3.0), 1e-4);
    EXPECT_NEAR(a.rms_pdf_error, 0.5 / (4.0 * kPi), 1e-5); // |p - p*| is half of p* everywhere
    EXPECT_NEAR(a.total, 4.0 * kPi, 1e-12);
    EXPECT_EQ(a.cells, 2u);
    EXPECT_EQ(a.support_violations, 0u);
}

TEST(MeasureEnvironment, SupportViolationsMakeItInfinite) {
    const Target target = acdf_test::texel_target(
        4, 3, [](std::uint32_t c, std::uint32_t r) { return c == 3 && r == 1 ? 0.0 : 1.0; });
    const compress::Cascade dark_right{{{0, {2}, {1.0, 0.0}, {}, {}}}, {0}};
    const Stored stored(dark_right, 4, 3);
    const Accuracy a = build::measure_environment(stored.file(), target);
    EXPECT_EQ(a.support_violations, 5u); // columns 2 and 3 of three rows, but for the dark texel
    EXPECT_TRUE(std::isinf(a.relative_variance));
    EXPECT_TRUE(std::isinf(a.kl_divergence));
    EXPECT_TRUE(std::isinf(a.max_weight));
    EXPECT_TRUE(std::isfinite(a.rms_pdf_error));
}

TEST(MeasureEnvironment, DarkTexelsWithoutPdfAreNoViolation) {
    const Target target =
        acdf_test::texel_target(4, 3, [](std::uint32_t c, std::uint32_t) { return c < 2 ? 2.0 : 0.0; });
    const compress::Cascade dark_right{{{0, {2}, {1.0, 0.0}, {}, {}}}, {0}};
    const Stored stored(dark_right, 4, 3);
    const Accuracy a = build::measure_environment(stored.file(), target);
    EXPECT_EQ(a.support_violations, 0u);
    EXPECT_NEAR(a.relative_variance, 0.0, 1e-12);
}

TEST(MeasureEnvironment, OneBrightTexelHiddenInACell) {
    // A texel 1e6 times as bright as the other 11 of its cell, all texels of one area but for the rows.
    const Target target = acdf_test::texel_target(
        4, 3, [](std::uint32_t c, std::uint32_t r) { return c == 0 && r == 1 ? 1e6 : 1.0; });
    const Stored stored({{{0, {}, {1.0}, {}, {}}}, {0}}, 4, 3);
    const double share = target.row_measure[1] / 4.0 / 2.0, total = 1e6 * share + (1.0 - share); // over 4 pi
    const Accuracy a = build::measure_environment(stored.file(), target);
    EXPECT_NEAR(a.relative_variance / ((1e12 * share + 1.0 - share) / (total * total) - 1.0), 1.0, 1e-9);
    EXPECT_NEAR(a.max_weight / (1e6 / total), 1.0, 1e-9);
}

TEST(MeasureEnvironment, KeepsTheDigitsOfASmallVariance) {
    // p differs from f/total by one part in a million, half up, half down: the relative variance is 1e-12.
    const Target target = acdf_test::texel_target(
        2, 1, [](std::uint32_t c, std::uint32_t) { return c == 0 ? 1.0 + 0x1p-20 : 1.0 - 0x1p-20; });
    const Stored stored({{{0, {}, {1.0}, {}, {}}}, {0}}, 2, 1);
    EXPECT_NEAR(build::measure_environment(stored.file(), target).relative_variance / 0x1p-40, 1.0, 1e-6);
}

TEST(MeasureEnvironment, RefusesAnotherResolutionAndDarkness) {
    const Stored stored(kHalves, 4, 3);
    const auto one = [](double, double) { return 1.0; };
    EXPECT_THROW(build::measure_environment(stored.file(), acdf_test::sphere_target(5, 3, one)),
                 std::invalid_argument);
    EXPECT_THROW(build::measure_environment(stored.file(), acdf_test::sphere_target(4, 4, one)),
                 std::invalid_argument);
    EXPECT_THROW(build::measure_environment(stored.file(),
                                            acdf_test::sphere_target(4, 3, [](double, double) { return 0.0; })),
                 std::invalid_argument);
}

} // namespace
