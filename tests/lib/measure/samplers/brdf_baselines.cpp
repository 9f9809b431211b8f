// The samplers that BRDF files are compared with.
#include "input/brdf/models.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/rgl_sampler.h"
#include "tests/inputs/paths.h"
#include "tests/lib/input/brdf/brdf.h"
#include "tests/lib/measure/samplers/brdf_checks.h"

#include <filesystem>

namespace {

using namespace acdf::build;
using namespace acdf::measure;
using acdf::compress::Reflected;
using acdf::compress::View;
using acdf_test::expect_samples_as_its_pdf;
using acdf_test::view_at;

constexpr double cosines[] = {1.0, 0.7, 0.5, 0.1, 1e-3};

std::string at(const char* name, double cosine) {
    return std::string(name) + " at cosine " + std::to_string(cosine);
}

/// The light that a BRDF reflects; the BRDF must live as long.
Reflected light_of(const acdf::input::Brdf& brdf) {
    return [&brdf](const double wo[3], const double wi[3]) {
        double rgb[3];
        brdf.evaluate(wo, wi, rgb);
        return (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) * std::max(0.0, wi[2]);
    };
}

template <class Sampler>
BrdfAccuracy accuracy_of(const Sampler& sampler, const Reflected& light, const std::vector<View>& views,
                         std::uint32_t columns = 200, std::uint32_t rows = 300) {
    return summary(measure_views([&](const double wo[3], const double wi[3]) { return sampler.pdf(wo, wi); }, light,
                                 views, columns, rows));
}

/// Whether reflected light is looked up for one pdf, for several, or once for a search.
TEST(MeasureBrdfBaselines, VariancesAreTheSameHoweverLightIsLookedUp) {
    const auto brdf = acdf::input::model_brdf("ggx:alpha=0.3");
    const Reflected light = light_of(*brdf);
    const std::vector<View> views = random_views(3, true);
    const GgxSampler ggx(0.4);
    const std::vector<ViewPdf> densities = {
        CosineSampler::pdf, [&](const double wo[3], const double wi[3]) { return ggx.pdf(wo, wi); }};
    const std::vector<double> together = relative_variances(densities, light, views, 20, 30);
    ASSERT_EQ(together.size(), 2u);
    for (std::size_t d = 0; d < densities.size(); ++d) {
        const double alone = summary(measure_views(densities[d], light, views, 20, 30)).relative_variance;
        EXPECT_GT(alone, 0.0);
        EXPECT_EQ(together[d], alone);
        for (const std::size_t most_kept : {std::size_t{0}, std::size_t{1200}, std::size_t{1} << 25})
            EXPECT_EQ(ReflectedViews(light, views, 20, 30, most_kept).relative_variance(densities[d]), alone);
    }
}

TEST(MeasureBrdfBaselines, CosineSamplesAsItsPdf) {
    for (const double c : cosines) expect_samples_as_its_pdf(CosineSampler{}, view_at(c), at("cosine", c));
    const double wo[3] = {0.0, 0.0, 1.0}, u[2] = {0.25, 0.36};
    const BrdfSample s = CosineSampler::sample(wo, u);
    EXPECT_NEAR(s.wi[0], 0.0, 1e-15);
    EXPECT_NEAR(s.wi[1], 0.6, 1e-15);
    EXPECT_NEAR(s.pdf, 0.8 / acdf_test::kPi, 1e-15);
}

TEST(MeasureBrdfBaselines, GgxSamplesAsItsPdf) {
    for (const double c : cosines) {
        expect_samples_as_its_pdf(GgxSampler(0.1), view_at(c), at("0.1", c), 48);
        expect_samples_as_its_pdf(GgxSampler(0.8), view_at(c), at("0.8", c));
        expect_samples_as_its_pdf(GgxSampler(0.15, 0.5), view_at(c), at("0.15, 0.5", c), 48);
    }
}

TEST(MeasureBrdfBaselines, VisibleNormalsMakeGgxWeightsOfMasking) {
    // rho cos / pdf = F G2 / G1: at most 1 where F is 1, whatever alpha.
    const auto brdf = acdf::input::model_brdf("ggx:alpha=0.2,0.4");
    const GgxSampler sampler(0.2, 0.4);
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const auto wo = acdf::test::random_direction(random), wi = acdf::test::random_direction(random);
        const auto norm = [](const acdf::test::Direction& w) {
            return std::sqrt(0.04 * w[0] * w[0] + 0.16 * w[1] * w[1] + w[2] * w[2]);
        };
        const double g1 = 2.0 * wo[2] / (wo[2] + norm(wo));
        const double g2 = 2.0 * wo[2] * wi[2] / (wo[2] * norm(wi) + wi[2] * norm(wo));
        EXPECT_NEAR(light_of(*brdf)(wo.data(), wi.data()) / sampler.pdf(wo.data(), wi.data()), g2 / g1, 1e-9);
    }
}

TEST(MeasureBrdfBaselines, TheBestGgxOfAGgxIsNearItself) {
    for (const double alpha : {0.05, 0.3}) {
        const auto brdf = acdf::input::model_brdf("ggx:alpha=" + std::to_string(alpha));
        const std::vector<View> views = random_views(8, true);
        const GgxFit fit = best_ggx(light_of(*brdf), views);
        EXPECT_NEAR(fit.alpha, alpha, 0.1 * alpha);
        // No neighbour is better, on a finer grid too.
        const double here = accuracy_of(GgxSampler(fit.alpha), light_of(*brdf), views).relative_variance;
        const double there = accuracy_of(GgxSampler(fit.alpha), light_of(*brdf), views, 64, 128).relative_variance;
        EXPECT_NEAR(fit.relative_variance, there, 1e-9 * there);
        for (const double other : {0.7 * alpha, 1.4 * alpha})
            EXPECT_LT(here, accuracy_of(GgxSampler(other), light_of(*brdf), views).relative_variance);
    }
}

TEST(MeasureBrdfBaselines, RglSamplesAsItsPdf) {
    for (const bool isotropic : {true, false}) {
        acdf::test::RglParts parts;
        if (!isotropic) parts.phi = {-3.1415927f, -1.0f, 1.5f, 3.1415927f};
        parts.vndf_size = {9, 8};
        parts.fill(3);
        const acdf::test::Bytes file = parts.bytes();
        const auto brdf = acdf::input::parse_rgl("t", file.data(), file.size());
        for (const double c : {1.0, 0.6, 0.1})
            expect_samples_as_its_pdf(RglSampler(*brdf), view_at(c, -1.3), at(isotropic ? "iso" : "aniso", c), 32);
        // Three floats a number of vndf and of luminance, but for the marginals.
        const std::size_t slices = parts.slices();
        EXPECT_EQ(RglSampler(*brdf).bytes(), 4 * slices * (2 * (9 * 8 + 4 * 5) + 9 + 4));
    }
}

TEST(MeasureBrdfBaselines, RglInSinglePrecisionIsRounded) {
    acdf::test::RglParts parts;
    parts.fill(5);
    const acdf::test::Bytes file = parts.bytes();
    const auto brdf = acdf::input::parse_rgl("t", file.data(), file.size());
    const RglSampler precise(*brdf);
    const acdf::measure::RglSamplerOf<float> single(*brdf);
    std::mt19937_64 random(4);
    int other_cells = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto wo = acdf::test::random_direction(random), wi = acdf::test::random_direction(random);
        const double p = precise.pdf(wo.data(), wi.data());
        EXPECT_NEAR(single.pdf(wo.data(), wi.data()), p, 1e-3 * p);
        const double u[2] = {acdf_test::uniform(random), acdf_test::uniform(random)};
        const auto a = precise.sample(wo.data(), u), b = single.sample(wo.data(), u);
        other_cells += !(std::abs(a.pdf - b.pdf) <= 1e-2 * a.pdf) || std::abs(a.wi[0] - b.wi[0]) > 1e-3;
    }
    EXPECT_LE(other_cells, 10);
}

TEST(MeasureBrdfBaselines, RglOfRealMaterials) {
    const std::string folder = std::string(acdf_test::kTestData) + "/brdfs/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real BRDFs: set ACDF_TEST_DATA";
    for (const char* name : {"cc_ibiza_sunset_rgb.bsdf", "paper_white_rgb.bsdf"}) {
        const auto brdf = acdf::input::open_brdf(folder + name);
        const RglSampler sampler(dynamic_cast<const acdf::input::RglBrdf&>(*brdf));
        // The authors' sampler is nearly proportional to their measurement: both sides of the same tables.
        const BrdfAccuracy accuracy = accuracy_of(sampler, light_of(*brdf), random_views(8, true, 0.25, 1.0));
        EXPECT_LT(accuracy.relative_variance, 0.032) << name;
        EXPECT_EQ(accuracy.support_violations, 0u) << name;
        EXPECT_GT(accuracy.share_above_horizon, 0.97) << name;
        expect_samples_as_its_pdf(sampler, view_at(0.6), name, 40, 20000);
    }
}

constexpr BrdfTableSize small = {12, 8, 64, 16};

TEST(MeasureBrdfBaselines, TablesSampleAsTheirPdf) {
    const auto iso = acdf::input::model_brdf("ggx:alpha=0.3"), aniso = acdf::input::model_brdf("ggx:alpha=0.2,0.5");
    for (const BrdfTableKind kind : {BrdfTableKind::centre, BrdfTableKind::mean}) {
        const TabulatedBrdf a(light_of(*iso), true, kind, small), b(light_of(*aniso), false, kind, small);
        BrdfTableSize turned = small;
        turned.phi_o = 1;
        const TabulatedBrdf c(light_of(*iso), true, kind, turned);
        for (const double cosine : {1.0, 0.1}) {
            expect_samples_as_its_pdf(a, view_at(cosine), at("isotropic", cosine), 48);
            expect_samples_as_its_pdf(b, view_at(cosine), at("anisotropic", cosine), 48);
            expect_samples_as_its_pdf(c, view_at(cosine), at("turned", cosine), 48);
        }
    }
}

TEST(MeasureBrdfBaselines, TablesOfIsotropicBrdfsAreTurned) {
    // Made from the bins of one azimuth, or each on its own: the same.
    const auto brdf = acdf::input::model_brdf("ggx:alpha=0.3");
    for (const BrdfTableKind kind : {BrdfTableKind::centre, BrdfTableKind::mean}) {
        const TabulatedBrdf once(light_of(*brdf), true, kind, small), each(light_of(*brdf), false, kind, small);
        std::mt19937_64 random(2);
        for (int i = 0; i < 5000; ++i) {
            const auto wo = acdf::test::random_direction(random), wi = acdf::test::random_direction(random);
            const double p = each.pdf(wo.data(), wi.data());
            EXPECT_NEAR(once.pdf(wo.data(), wi.data()), p, 1e-6 * p);
        }
    }
}

TEST(MeasureBrdfBaselines, RepairedTablesHaveSupportThatCentresLack) {
    const auto brdf = acdf::input::model_brdf("ggx:alpha=0.2");
    const std::vector<View> views = random_views(12, false);
    const auto accuracy = [&](BrdfTableKind kind, BrdfTableSize size) {
        return accuracy_of(TabulatedBrdf(light_of(*brdf), true, kind, size), light_of(*brdf), views);
    };
    EXPECT_GT(accuracy(BrdfTableKind::centre, small).support_violations, 100u);
    const BrdfAccuracy coarse = accuracy(BrdfTableKind::mean, small);
    EXPECT_EQ(coarse.support_violations, 0u);
    BrdfTableSize finer = small;
    finer.theta_o *= 2, finer.phi_o *= 2, finer.theta_h *= 2, finer.phi_h *= 2;
    const BrdfAccuracy fine = accuracy(BrdfTableKind::mean, finer);
    EXPECT_EQ(fine.support_violations, 0u);
    EXPECT_LT(fine.relative_variance, 0.5 * coarse.relative_variance);
}

TEST(MeasureBrdfBaselines, TablesOfThePaperHave65Megabytes) {
    const auto lambert = acdf::input::model_brdf("lambert");
    const TabulatedBrdf table(light_of(*lambert), true, BrdfTableKind::centre);
    EXPECT_EQ(table.bytes(), 8u * (2u * 32 * 16 * 256 * 32 + 32 * 16 * 256));
    EXPECT_THROW(TabulatedBrdf(light_of(*lambert), false, BrdfTableKind::mean, {4, 1, 8, 8}),
                 std::invalid_argument);
    EXPECT_THROW(TabulatedBrdf(light_of(*lambert), true, BrdfTableKind::mean, {4, 1, 0, 8}), std::invalid_argument);
}

TEST(MeasureBrdfBaselines, BlackViewsGiveNoSample) {
    const TabulatedBrdf table([](const double*, const double*) { return 0.0; }, true, BrdfTableKind::centre, small);
    const double wo[3] = {0.0, 0.6, 0.8}, wi[3] = {0.0, 0.0, 1.0}, u[2] = {0.5, 0.5};
    EXPECT_EQ(table.sample(wo, u).pdf, 0.0);
    EXPECT_EQ(table.pdf(wo, wi), 0.0);
}

} // namespace
