// Local environments from probe to file: sizes, bins with trees of their own, scenes, and what is measured.
#include "build/local.h"
#include "build/accuracy/cells.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include "compress/local/fit_separate.h"
#include "compress/local/light.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace acdf {
namespace {

using compress::BinTarget;
using compress::Goal;
using compress::NormalBins;
using compress::Target;

const Target& lit_probe() {
    static const Target made = acdf_test::texel_target(128, 64, [](std::uint32_t c, std::uint32_t r) {
        const double phi = acdf_test::centre_phi(c, 128), z = acdf_test::centre_z(r, 64);
        const bool sun = std::hypot(phi - 0.6, z - 0.3) < 0.05, dark = z < -0.8;
        return sun    ? 500.0
               : dark ? 0.0
                      : acdf_test::smooth_sky(phi, z) * (1.0 + 0.5 * ((c * 7 + r * 13) % 11) / 11.0);
    });
    return made;
}

build::Local build(const build::LocalOptions& options) {
    return build::build_local(lit_probe(), {"probe.exr", "", "latlong", ""}, options);
}

File load(const build::Local& local) {
    File file;
    const Status status = File::from_memory(local.bytes.data(), local.bytes.size(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    return file;
}

build::LocalOptions separate(AcdfFit fit) {
    build::LocalOptions options;
    options.sharing = false;
    options.columns = 12;
    options.rows = 6;
    options.fit.fit = fit;
    options.fit.order = compress::Order::z;
    options.fit.column_segments = options.fit.row_segments = 24;
    return options;
}

/// Then no more cells gain anything.
void expect_each_lit_texel_is_a_cell(const build::Local& local) {
    const File file = load(local);
    const auto tiles = static_cast<std::uint32_t>(build::tile_boxes(file).size());
    for (std::uint32_t t = 0; t < tiles; ++t)
        build::for_each_tile_cell(file, t, [](const build::Cell& cell) {
            const AcdfTiltedRange &column = cell.range[0], &row = cell.range[1];
            const std::uint32_t texels = (column.high - column.low) * (row.high - row.low);
            if (texels > 1) {
                EXPECT_EQ(lit_probe().row(row.low)[column.low], 0.0f);
            }
        });
}

TEST(LocalFiles, BudgetsAreFilledAndKept) {
    double before = INFINITY, full_cdf = 0.0;
    for (std::uint64_t budget : {12288u, 32768u, 131072u}) {
        build::LocalOptions options;
        options.goal.budget = budget;
        const build::Local local = build(options);
        EXPECT_LE(local.bytes.size(), budget);
        EXPECT_GE(double(local.bytes.size()), 0.9 * double(budget));
        if (double(local.bytes.size()) < 0.95 * double(budget)) expect_each_lit_texel_is_a_cell(local);
        EXPECT_EQ(local.accuracy.support_violations, 0u);
        EXPECT_LT(local.accuracy.relative_variance, before);
        before = local.accuracy.relative_variance;
        full_cdf = local.accuracy.relative_variance_full_cdf;
    }
    EXPECT_LT(before, full_cdf / 50.0);
}

TEST(LocalFiles, TargetVarianceIsReachedBySmallFilesWhereTheyDo) {
    build::LocalOptions options;
    options.goal = {Goal::Kind::variance, 0, 0, 2.0};
    const build::Local local = build(options);
    EXPECT_LE(local.accuracy.relative_variance, 2.0);
    EXPECT_LT(local.bytes.size(), 12288u);
}

TEST(LocalFiles, CompressedOnesMayBeSmallerThanTheLeastThatIsNot) {
    build::LocalOptions options;
    options.codec = ACDF_CODEC_ZLIB;
    options.goal.budget = 3000;
    EXPECT_LE(build(options).bytes.size(), 3000u);
    options.goal.budget = 1000;
    EXPECT_THROW(build(options), std::runtime_error);
}

TEST(LocalFiles, FitsOfKnotsTakeNoBudget) {
    build::LocalOptions options = separate(ACDF_FIT_CDF);
    options.fit.column_segments = options.fit.row_segments = 3;
    const std::vector<std::uint8_t> made = build(options).bytes;
    options.goal = {Goal::Kind::budget, 0, 64, 0.0};
    EXPECT_EQ(build(options).bytes, made);
}

TEST(LocalFiles, BudgetsTooSmallAreRefused) {
    build::LocalOptions options;
    options.goal.budget = 600;
    EXPECT_THROW(build(options), std::runtime_error);
}

TEST(LocalFiles, BudgetsThatBinsAloneExceedAreRefusedBeforeAnyWork) {
    build::LocalOptions options;
    options.subdivisions = 64;
    options.goal.budget = 32768;
    bool begun = false;
    const build::Progress progress = [&](double, const char*) { begun = true; };
    EXPECT_THROW(build::build_local(lit_probe(), {}, options, progress), std::runtime_error);
    EXPECT_FALSE(begun);
}

TEST(LocalFiles, TargetVarianceIsSearchedForAmongSizesThatBinsLeave) {
    build::LocalOptions options;
    options.subdivisions = 46; // 66 KiB: the search begins below it, and meets it again
    options.scene = {{{0.0f, 0.0f, 1.0f}, 1.0}};
    options.goal = {Goal::Kind::variance, 0, 0, 10.0};
    const Target small = acdf_test::texel_target(
        16, 8, [](std::uint32_t c, std::uint32_t r) { return c == 3 && r == 2 ? 50.0 : 1.0; });
    const build::Local local = build::build_local(small, {}, options);
    EXPECT_LE(local.accuracy.relative_variance, 10.0);
    EXPECT_GT(local.bytes.size(), 65536u);
    EXPECT_LT(local.bytes.size(), 80000u);
}

TEST(LocalFiles, TargetVarianceIsReachedByNoMoreThanItTakes) {
    ACDF_NOT_SANITIZED();
    build::LocalOptions options;
    const double goal = 0.03;
    options.goal = {Goal::Kind::variance, 0, 0, goal};
    const build::Local local = build(options);
    EXPECT_LE(local.accuracy.relative_variance, goal);
    build::LocalOptions smaller;
    smaller.goal.budget = local.bytes.size() * 8 / 10;
    EXPECT_GT(build(smaller).accuracy.relative_variance, goal);
}

TEST(LocalFiles, MeasuresWhatSamplesHave) {
    build::LocalOptions options;
    options.goal.budget = 24576;
    options.cosine_share = 0.25;
    const build::Local local = build(options);
    const File file = load(local);
    const LocalEnvironmentView view = file.local();
    const Target& target = lit_probe();
    const std::vector<build::Normal> normals = build::random_normals(6);
    const std::vector<build::NormalAccuracy> measured = build::measure_normals(file, target, normals);
    for (std::size_t i = 0; i < normals.size(); ++i) { // the slow way, one pdf at a time
        double irradiance = 0.0, second = 0.0, above = 0.0;
        const double n[3] = {normals[i][0], normals[i][1], normals[i][2]};
        const Target parts = compress::empty_target(2 * target.columns, 2 * target.rows, ACDF_PARAM_LATLONG);
        for (std::uint32_t r = 0; r < parts.rows; ++r) // quarters of texels
            for (std::uint32_t c = 0; c < parts.columns; ++c) {
                float direction[3];
                acdf_test::direction_of(acdf_test::centre_phi(c, parts.columns), acdf_test::centre_z(r, parts.rows),
                                        direction);
                const double omega = parts.row_measure[r] * parts.column_measure[c];
                const double cosine = n[0] * direction[0] + n[1] * direction[1] + n[2] * direction[2];
                const double p = view.pdf(normals[i].data(), direction),
                             f = target.row(r / 2)[c / 2] * std::max(0.0, cosine);
                irradiance += f * omega;
                if (cosine > 0.0) above += p * omega;
                if (f > 0.0) second += f * f / p * omega;
            }
        EXPECT_NEAR(measured[i].irradiance, irradiance, 1e-5 * irradiance);
        EXPECT_NEAR(measured[i].relative_variance, second / irradiance / irradiance - 1.0, 1e-4);
        EXPECT_NEAR(measured[i].share_above_horizon, above, 1e-4);
        EXPECT_EQ(measured[i].support_violations, 0u);
    }
}

TEST(LocalFiles, TreesOfTheirOwnCoverAllNormalsOfABin) {
    for (AcdfFit fit : {ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF}) {
        const build::Local local = build(separate(fit));
        EXPECT_EQ(local.accuracy.support_violations, 0u) << fit;
        EXPECT_TRUE(std::isfinite(local.accuracy.relative_variance)) << fit;
        EXPECT_EQ(load(local).description().bin_count, 72u);
        if (fit == ACDF_FIT_UNIFORM) continue; // misses the sun
        EXPECT_LT(local.accuracy.relative_variance, 0.5 * local.accuracy.relative_variance_full_cdf) << fit;
    }
}

// Linear pdfs: measured sums agree with the reader's pdfs at many points of each texel.
TEST(LocalFiles, TiltedCurvesAreMeasured) {
    constexpr std::uint32_t kParts = 2; // of a quarter of a texel
    for (const double share : {0.0, 0.25}) {
        build::LocalOptions options = separate(ACDF_FIT_PDF);
        options.fit.column_segments = options.fit.row_segments = 8;
        options.cosine_share = share;
        const build::Local local = build(options);
        const File file = load(local);
        const LocalEnvironmentView view = file.local();
        const Target& target = lit_probe();
        const Target parts = compress::empty_target(2 * target.columns, 2 * target.rows, ACDF_PARAM_LATLONG);
        const std::vector<build::Normal> normals = build::random_normals(4);
        const std::vector<build::NormalAccuracy> measured = build::measure_normals(file, target, normals);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const double n[3] = {normals[i][0], normals[i][1], normals[i][2]};
            double irradiance = 0.0, second = 0.0, least = INFINITY;
            for (std::uint32_t r = 0; r < parts.rows; ++r)
                for (std::uint32_t c = 0; c < parts.columns; ++c) {
                    float d[3];
                    acdf_test::direction_of(acdf_test::centre_phi(c, parts.columns),
                                            acdf_test::centre_z(r, parts.rows), d);
                    const double f =
                        target.row(r / 2)[c / 2] * std::max(0.0, n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
                    if (!(f > 0.0)) continue;
                    const double part = parts.row_measure[r] * parts.column_measure[c] / (kParts * kParts);
                    const double top = acdf_row_z(r, parts.rows), low = acdf_row_z(r + 1, parts.rows);
                    const auto density = [&](double x, double y) {
                        acdf_test::direction_of(ACDF_PI * (1.0 - 2.0 * (c + x) / parts.columns),
                                                top + (low - top) * y, d);
                        return double{view.pdf(normals[i].data(), d)};
                    };
                    for (std::uint32_t k = 0; k < kParts * kParts; ++k) {
                        const double p = density((k % kParts + 0.5) / kParts, (k / kParts + 0.5) / kParts);
                        irradiance += f * part;
                        second += f * f / p * part;
                    }
                    for (const double x : {0.001, 0.999}) // linear along both axes: least in a corner
                        for (const double y : {0.001, 0.999}) least = std::min(least, density(x, y) / f);
                }
            const double expected = second / irradiance / irradiance;
            EXPECT_NEAR(1.0 + measured[i].relative_variance, expected, 2e-3 * expected) << share;
            if (share > 0.0) continue; // the cosine is the texel's, and vanishes within some
            EXPECT_GE(measured[i].max_weight, 0.99 / least / irradiance) << share;
            EXPECT_LE(measured[i].max_weight, 1.2 / least / irradiance) << share;
        }
    }
}

TEST(LocalFiles, TreesOfTheMiddleNormalAreBiased) {
    build::LocalOptions options = separate(ACDF_FIT_CDF);
    options.bin_target = BinTarget::centre;
    EXPECT_GT(build(options).accuracy.support_violations, 0u);
}

TEST(LocalFiles, OctahedralBinsCanHaveTreesOfTheirOwn) {
    build::LocalOptions options;
    options.sharing = false;
    options.subdivisions = 3;
    options.fit.fit = ACDF_FIT_CDF;
    options.fit.order = compress::Order::z;
    options.fit.column_segments = options.fit.row_segments = 24;
    const build::Local local = build(options);
    EXPECT_EQ(local.accuracy.support_violations, 0u);
    EXPECT_LT(local.accuracy.relative_variance, 0.5 * local.accuracy.relative_variance_full_cdf);
}

/// The mean over the normals of a bin, by many more of them than the fit takes.
double dense_mean(const NormalBins& bins, std::size_t bin, const std::vector<compress::LightPoint>& light,
                  const compress::Direction& omega) {
    constexpr int side = 32;
    double sum = 0.0;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const double theta = acdf_test::kPi * (double(bin / bins.columns) + (i + 0.5) / side) / bins.rows;
            const double phi =
                acdf_test::kPi * (1.0 - 2.0 * (double(bin % bins.columns) + (k + 0.5) / side) / bins.columns);
            const compress::Direction n = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                           std::cos(theta)};
            double irradiance = 0.0;
            for (const compress::LightPoint& p : light)
                irradiance += p.amount * std::max(0.0, compress::dot(p.direction, n));
            const double f = std::max(0.0, compress::dot(omega, n)) / irradiance;
            sum += f * f / (side * side);
        }
    return sum;
}

TEST(LocalFiles, MeanOverABinIsGoodToAFewPerCent) {
    ACDF_NOT_SANITIZED();
    const NormalBins bins = compress::latlong_bins(12, 6);
    const std::vector<compress::LightPoint> light = compress::light_points(lit_probe());
    for (std::size_t bin : {14u, 30u, 66u}) {
        const Target target = compress::bin_target(lit_probe(), bins, bin, BinTarget::mean);
        for (std::uint32_t r = 1; r < 64; r += 9)
            for (std::uint32_t c = 3; c < 128; c += 23) {
                if (lit_probe().row(r)[c] == 0.0f) continue;
                const double phi = acdf_test::centre_phi(c, 128), theta = acdf_test::kPi * (r + 0.5) / 64;
                const compress::Direction omega = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                                   std::cos(theta)};
                const double dense = dense_mean(bins, bin, light, omega);
                const double fitted = std::pow(target.row(r)[c] / double(lit_probe().row(r)[c]), 2.0);
                EXPECT_TRUE(fitted > 0.0 || dense == 0.0);
                if (dense > 0.01) {
                    EXPECT_NEAR(fitted / dense, 1.0, 0.05) << bin << ", " << r << ", " << c;
                }
            }
    }
}

TEST(LocalFiles, OnlyTheBinsOfASceneAreStored) {
    build::LocalOptions options;
    options.goal.budget = 32768;
    options.scene = {{{0.0f, 0.0f, 1.0f}, 1.0}, {{0.1f, 0.0f, 1.0f}, 3.0}};
    const build::Local local = build(options);
    const File file = load(local);
    std::size_t stored = 0;
    for (std::uint32_t b = 0; b < file.description().bin_count; ++b) stored += file.bin(b).root != ACDF_NO_ROOT;
    EXPECT_GE(stored, 1u);
    EXPECT_LE(stored, 12u); // a pole and four around it; a corner and six around it
    const float up[3] = {0.0f, 0.0f, 1.0f}, down[3] = {0.3f, 0.2f, -1.0f};
    EXPECT_TRUE(file.local().stored(up));
    EXPECT_FALSE(file.local().stored(down));
    const std::vector<build::NormalAccuracy> outside =
        build::measure_normals(file, lit_probe(), {{0.3f, 0.2f, -1.0f}});
    EXPECT_EQ(outside[0].support_violations, 0u); // served by the whole environment
    build::LocalOptions all;
    all.goal = options.goal;
    const build::Local whole = build(all);
    const File general = load(whole);
    const std::vector<build::Normal> normals = build::test_normals(options.scene, 256);
    EXPECT_LT(local.accuracy.relative_variance,
              build::summary(build::measure_normals(general, lit_probe(), normals)).relative_variance);
}

TEST(LocalFiles, ManyFilesAreTheSameBytes) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "the tests above make such files, if once";
    for (bool sharing : {true, false}) {
        build::LocalOptions options = separate(ACDF_FIT_CDF);
        if (sharing) options = {};
        if (sharing) options.goal.budget = 32768;
        EXPECT_EQ(build(options).bytes, build(options).bytes);
    }
}

} // namespace
} // namespace acdf
