// Samplers of irradiance that know either the light or the surface: pdfs, samples, and their exact variance
// against the variance of samples.
#include "tests/lib/measure/samplers/baselines.h"

#include "measure/samplers/local_baselines.h"

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

constexpr int kSamples = 40000;

/// What exact summation says of one sample must be what samples show, but for `centres` in the second moment.
void expect_variance(const MonteCarlo& seen, double irradiance, double relative_variance, double centres) {
    EXPECT_NEAR(seen.mean, irradiance, 4.5 * seen.mean_error + 2e-3 * irradiance);
    const double second = (1.0 + relative_variance) * irradiance * irradiance;
    EXPECT_NEAR(seen.second, second, 4.5 * seen.second_error + centres);
}

class LocalBaseline : public ::testing::TestWithParam<NamedTarget> {
protected:
    const Target& target() const { return GetParam().target; }
};

TEST_P(LocalBaseline, FullCdfPdfIsThatOfItsSamples) {
    const Target& t = target();
    const LocalFullCdf baseline(t);
    double sum = 0.0;
    for_each_direction(t, 1, [&](std::size_t, const double* d, double omega) {
        const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        sum += baseline.pdf(w) * omega;
    });
    EXPECT_NEAR(sum, 1.0, 1e-5);

    std::mt19937_64 random(3);
    std::vector<std::uint32_t> observed(t.values.size(), 0);
    for (int i = 0; i < kSamples; ++i) {
        const AcdfDirectionSample s = baseline.sample(uniform(random), uniform(random));
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_FLOAT_EQ(s.pdf, baseline.pdf(s.direction));
        ++observed[texel_of(t, s.direction)];
    }
    std::vector<double> probability;
    const double total = acdf::compress::integral(t);
    for (std::size_t i = 0; i < t.values.size(); ++i)
        probability.push_back(t.values[i] * t.row_measure[i / t.columns] * t.column_measure[i % t.columns] / total);
    const ChiSquare test = chi_square(observed, probability);
    EXPECT_FALSE(test.impossible);
    EXPECT_GT(test.p_value, sidak(0.01, 10));
}

class LocalBaselineVariance : public LocalBaseline {
protected:
    /// The cosine's variance within one of these coarse texels, times flux squared: what centres miss of
    /// E[(f/p)^2].
    double centres() const {
        return 1e-3 * acdf::compress::integral(target()) * acdf::compress::integral(target());
    }
};

TEST_P(LocalBaselineVariance, FullCdfVarianceIsThatOfItsSamples) {
    const Target& t = target();
    const LocalFullCdf baseline(t);
    std::mt19937_64 random(4);
    for (const Normal& n : awkward_normals()) {
        int above = 0;
        const MonteCarlo seen = monte_carlo(kSamples, [&] {
            const AcdfDirectionSample s = baseline.sample(uniform(random), uniform(random));
            const double cosine = dot(n.data(), s.direction);
            above += cosine > 0.0;
            return cosine > 0.0 ? t.values[texel_of(t, s.direction)] * cosine / s.pdf : 0.0;
        });
        expect_variance(seen, irradiance(t, n), baseline.relative_variance(n.data()), centres());
        EXPECT_NEAR(baseline.share_above_horizon(n.data()), double(above) / kSamples,
                    0.01 + 1.2 / t.rows); // a row on the horizon
    }
}

TEST_P(LocalBaselineVariance, ResamplingHasTheVarianceOfAveragedCandidates) {
    const Target& t = target();
    constexpr std::uint32_t kCandidates = 8;
    const Resampling baseline(t, kCandidates);
    std::mt19937_64 random(5);
    const auto draw = [&] { return uniform(random); };
    for (const Normal& n : awkward_normals()) {
        const MonteCarlo seen = monte_carlo(kSamples / 4, [&] {
            const Resampling::Sample s = baseline.sample(n.data(), draw);
            if (s.weight == 0.0) return 0.0;
            return t.values[texel_of(t, s.direction)] * dot(n.data(), s.direction) * s.weight;
        });
        expect_variance(seen, irradiance(t, n), baseline.relative_variance(n.data()), centres());
        EXPECT_DOUBLE_EQ(baseline.relative_variance(n.data()) * kCandidates,
                         LocalFullCdf(t).relative_variance(n.data()));
    }
}

// Kept samples are spread nearly like f: the more candidates, the more so; the weight alone would not show it.
TEST(LocalBaselines, ResamplingKeepsWhatTheTargetFavours) {
    const Target t = sphere_target(64, 32, smooth_sky);
    const Resampling baseline(t, 64);
    const Normal n{0.6f, 0.0f, 0.8f};
    std::mt19937_64 random(6);
    const auto draw = [&] { return uniform(random); };
    double cosine = 0.0, expected = 0.0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) cosine += dot(n.data(), baseline.sample(n.data(), draw).direction) / kCount;
    for_each_direction(t, 4, [&](std::size_t i, const double* d, double omega) {
        const double c = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        if (c > 0.0) expected += t.values[i] * c * c * omega;
    });
    EXPECT_NEAR(cosine, expected / irradiance(t, n), 0.01);
}

TEST_P(LocalBaselineVariance, CosineVarianceIsThatOfItsSamples) {
    if (GetParam().name == "one_lit_texel" || GetParam().name == "peaky_sun") return; // hit too rarely
    const Target& t = target();
    const CosineHemisphere baseline(t);
    std::mt19937_64 random(7);
    for (const Normal& n : awkward_normals()) {
        const MonteCarlo seen = monte_carlo(kSamples, [&] {
            const AcdfDirectionSample s = CosineHemisphere::sample(n.data(), uniform(random), uniform(random));
            return t.values[texel_of(t, s.direction)] * dot(n.data(), s.direction) / s.pdf;
        });
        const double mean = irradiance(t, n), variance = baseline.relative_variance(n.data());
        expect_variance(seen, mean, variance, 0.01 * (1.0 + variance) * mean * mean);
    }
}

INSTANTIATE_TEST_SUITE_P(Synthetic, LocalBaseline, ::testing::ValuesIn(irradiance_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Synthetic, LocalBaselineVariance, ::testing::ValuesIn(fine_targets()),
                         [](const auto& info) { return info.param.name; });

TEST(LocalBaselines, CosinePdfIsThatOfItsSamples) {
    const Target grid = sphere_target(24, 12, smooth_sky);
    std::mt19937_64 random(9);
    for (const Normal& n : awkward_normals()) {
        std::vector<double> probability(grid.values.size(), 0.0);
        for_each_direction(grid, 32, [&](std::size_t i, const double* d, double omega) {
            const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
            probability[i] += CosineHemisphere::pdf(n.data(), w) * omega;
        });
        double sum = 0.0;
        for (const double p : probability) sum += p;
        EXPECT_NEAR(sum, 1.0, 1e-4);
        std::vector<std::uint32_t> observed(grid.values.size(), 0);
        for (int i = 0; i < kSamples; ++i) {
            const double u0 = uniform(random), u1 = uniform(random); // in this order with every compiler
            const AcdfDirectionSample s = CosineHemisphere::sample(n.data(), u0, u1);
            ASSERT_NEAR(dot(s.direction, s.direction), 1.0, 1e-6);
            ASSERT_NEAR(s.pdf, CosineHemisphere::pdf(n.data(), s.direction), 1e-6);
            ++observed[texel_of(grid, s.direction)];
        }
        EXPECT_GT(chi_square(observed, probability).p_value, sidak(0.01, 9));
    }
}

// Closed forms for a constant sky: E = pi L; the full CDF has 4 pi L * (2 pi / 3) L / (pi L)^2 - 1 = 5/3.
TEST(LocalBaselines, ConstantSky) {
    const Target t = sphere_target(512, 256, [](double, double) { return 0.25; });
    for (const Normal& n : awkward_normals()) {
        EXPECT_NEAR(LocalFullCdf(t).relative_variance(n.data()), 5.0 / 3.0, 1e-4);
        EXPECT_NEAR(Resampling(t, 32).relative_variance(n.data()), 5.0 / 96.0, 1e-5);
        EXPECT_NEAR(CosineHemisphere(t).relative_variance(n.data()), 0.0, 1e-4);
        EXPECT_NEAR(LocalFullCdf(t).share_above_horizon(n.data()), 0.5, 0.01);
    }
}

TEST(LocalBaselines, RefusesWhatCannotBeSampled) {
    EXPECT_THROW(LocalFullCdf(sphere_target(8, 4, [](double, double) { return 0.0; })), std::invalid_argument);
    Target bilinear = sphere_target(8, 4, smooth_sky);
    bilinear.peaks = bilinear.values;
    EXPECT_THROW(LocalFullCdf{bilinear}, std::invalid_argument);
}

TEST(LocalBaselines, NoLightAboveTheHorizon) {
    const Target t = sphere_target(64, 32, [](double, double z) { return z > 0.5 ? 1.0 : 0.0; });
    const float down[3] = {0.0f, 0.0f, -1.0f}, nan[3] = {NAN, 0.0f, 0.0f};
    EXPECT_EQ(LocalFullCdf(t).relative_variance(down), 0.0);
    EXPECT_EQ(LocalFullCdf(t).share_above_horizon(down), 0.0);
    EXPECT_EQ(CosineHemisphere(t).relative_variance(down), 0.0);
    EXPECT_EQ(LocalFullCdf(t).pdf(nan), 0.0f);
    std::mt19937_64 random(9);
    EXPECT_EQ(Resampling(t, 8).sample(down, [&] { return uniform(random); }).weight, 0.0);
}

} // namespace
