// Samplers of a probe's texels: that each samples by the pdf it returns, which is the right one.
#include "tests/lib/measure/samplers/baselines.h"
#include "tests/lib/measure/samplers/light_sampler_checks.h"

#include "measure/samplers/downsampled_cdf.h"
#include "measure/samplers/light_samplers.h"

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

struct NamedSampler {
    std::string name;
    LightSamplerPtr sampler;
    bool has_support = true; ///< everywhere where light is
};

std::vector<NamedSampler> samplers_of(const Target& t) {
    const std::uint32_t columns = std::min(7u, t.columns), rows = std::min(5u, t.rows);
    std::vector<NamedSampler> all;
    all.push_back({"full CDF", full_cdf_sampler(t)});
    all.push_back({"tiling", tiling_sampler(t, columns, rows)});
    all.push_back({"downsampled", downsampled_cdf_sampler(t, columns, rows)});
    all.push_back({"alias, one number", alias_sampler(t, AliasNumbers::one)});
    all.push_back({"alias, two numbers", alias_sampler(t, AliasNumbers::two)});
    all.push_back({"hierarchical", hierarchical_sampler(t)});
    all.push_back({"compensated", compensated_sampler(t), false});
    all.push_back({"half compensated", compensated_sampler(t, 0.5), false});
    return all;
}

class TexelSamplers : public ::testing::TestWithParam<NamedTarget> {
protected:
    const Target& target() const { return GetParam().target; }
};

TEST_P(TexelSamplers, SampleByTheirPdf) {
    const Target& t = target();
    const std::vector<Normal> normals = awkward_normals();
    for (const NamedSampler& each : samplers_of(t))
        for (std::size_t i = 0; i < normals.size(); i += each.name == "tiling" ? 2 : 8) {
            const auto point = each.sampler->point_sampler();
            point->move_to(facing(normals[i]));
            const bool sampled = point->sample(0.5, 0.5).pdf > 0.0f; // else tiles see no light
            expect_samples_as_its_pdf(*each.sampler, facing(normals[i]), {t.columns, t.rows, 1, is_square(t)},
                                      each.name, {}, sampled ? 1.0 : 0.0);
        }
}

TEST_P(TexelSamplers, MeanOfSamplesIsTheSum) {
    const Target& t = target();
    const Normal n = awkward_normals()[1];
    const double flux = acdf::compress::integral(t), expected = irradiance(t, n);
    for (const NamedSampler& each : samplers_of(t)) {
        if (!each.has_support) continue;
        const auto point = each.sampler->point_sampler();
        point->move_to(facing(n));
        std::mt19937_64 random(31);
        const auto sample_of = [&](const auto& f) {
            return monte_carlo(20000, [&] {
                const double u0 = uniform(random), u1 = uniform(random);
                const AcdfDirectionSample s = point->sample(u0, u1);
                return s.pdf > 0.0f ? t.values[texel_of(t, s.direction)] * f(s.direction) / s.pdf : 0.0;
            });
        };
        const MonteCarlo light = sample_of([](const float*) { return 1.0; });
        if (each.name != "tiling") {
            EXPECT_NEAR(light.mean, flux, 5.0 * light.mean_error + 1e-5 * flux) << each.name;
        }
        const MonteCarlo lit = sample_of([&](const float* w) { return std::max(0.0, dot(n.data(), w)); });
        // The sum takes each texel at eight by eight points.
        EXPECT_NEAR(lit.mean, expected, 5.0 * lit.mean_error + 1e-3 * flux) << each.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, TexelSamplers, ::testing::ValuesIn(irradiance_targets()),
                         [](const auto& i) { return i.param.name; });

/// Pdfs at the centres of texels.
std::vector<double> densities(const LightSampler& sampler, const Target& t) {
    const auto point = sampler.point_sampler();
    std::vector<double> out(t.values.size());
    for_each_direction(t, 1, [&](std::size_t i, const double* d, double) {
        const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        out[i] = point->pdf(w);
    });
    return out;
}

TEST(TexelSamplersOf, FullTablesHaveThePdfOfTheLight) {
    for (const NamedTarget& each : irradiance_targets()) {
        const Target& t = each.target;
        const double flux = acdf::compress::integral(t);
        const LightSamplerPtr all[] = {full_cdf_sampler(t), alias_sampler(t), hierarchical_sampler(t)};
        for (const LightSamplerPtr& sampler : all) {
            const std::vector<double> p = densities(*sampler, t);
            for (std::size_t i = 0; i < p.size(); ++i)
                ASSERT_NEAR(p[i], t.values[i] / flux, 1e-6 * p[i]) << each.name;
        }
    }
}

TEST(TexelSamplersOf, CompensationSubtractsTheMean) {
    const Target t = noise_target(32, 16, 8);
    const double mean = acdf::compress::integral(t) / (4.0 * kPi);
    const std::vector<double> p = densities(*compensated_sampler(t), t);
    double sum = 0.0;
    for_each_direction(t, 1, [&](std::size_t i, const double*, double omega) {
        sum += std::max(0.0, t.values[i] - mean) * omega;
    });
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], std::max(0.0, t.values[i] - mean) / sum, 1e-6);
    const Target flat = sphere_target(16, 8, [](double, double) { return 2.0; });
    for (const double uniform_pdf : densities(*compensated_sampler(flat), flat))
        EXPECT_NEAR(uniform_pdf, 1.0 / (4.0 * kPi), 1e-6);
}

TEST(TexelSamplersOf, DownsampledCellsAreMeansOverTheirTexels) {
    const Target t = noise_target(37, 19, 12);
    const double flux = acdf::compress::integral(t);
    const std::vector<double> p = densities(*downsampled_cdf_sampler(t, 37, 19), t); // a cell each texel
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], t.values[i] / flux, 1e-6 * p[i]);

    const std::vector<double> q = densities(*downsampled_cdf_sampler(t, 5, 3), t);
    // Cell (1, 2): columns 7 to 13, rows 12 to 18.
    double sum = 0.0, angle = 0.0;
    for_each_direction(t, 1, [&](std::size_t i, const double*, double omega) {
        const std::size_t c = i % 37, r = i / 37;
        if (c < 7 || c >= 14 || r < 12) return;
        sum += t.values[i] * omega;
        angle += omega;
    });
    for (std::size_t r = 12; r < 19; ++r)
        for (std::size_t c = 7; c < 14; ++c) EXPECT_NEAR(q[r * 37 + c], sum / angle / flux, 1e-6);
    EXPECT_NE(q[12 * 37 + 6], q[12 * 37 + 7]);
    EXPECT_THROW(DownsampledCdf(t, 38, 3), std::invalid_argument);
    EXPECT_THROW(DownsampledCdf(t, 0, 3), std::invalid_argument);
}

TEST(TexelSamplersOf, StrataOfRandomNumbersStayStrataOfDirections) {
    // Of 64 numbers u1, one in each stratum, a quarter falls in the northern half of a constant sky's half.
    const Target t = sphere_target(64, 32, [](double, double) { return 1.0; });
    for (const LightSamplerPtr& sampler : {full_cdf_sampler(t), hierarchical_sampler(t)}) {
        const auto point = sampler->point_sampler();
        std::mt19937_64 random(2);
        for (int i = 0; i < 64; ++i) {
            const double u1 = (i + uniform(random)) / 64.0, u0 = uniform(random);
            EXPECT_NEAR(point->sample(u0, u1).direction[2], 1.0 - 2.0 * u1, 1e-5);
            EXPECT_NEAR(std::atan2(point->sample(u0, u1).direction[1], point->sample(u0, u1).direction[0]),
                        kPi * (1.0 - 2.0 * u0), 1e-4);
        }
    }
}

TEST(TexelSamplersOf, BlackAndFilteredProbesAreRefused) {
    const Target black = sphere_target(8, 4, [](double, double) { return 0.0; });
    EXPECT_THROW(alias_sampler(black), std::invalid_argument);
    EXPECT_THROW(hierarchical_sampler(black), std::invalid_argument);
    EXPECT_THROW(compensated_sampler(black), std::invalid_argument);
    EXPECT_THROW(downsampled_cdf_sampler(black, 2, 2), std::invalid_argument);
    Target filtered = sphere_target(8, 4, smooth_sky);
    filtered.peaks = filtered.values;
    EXPECT_THROW(alias_sampler(filtered), std::invalid_argument);
}

TEST(SurfaceSamplers, SampleByTheirPdf) {
    std::mt19937_64 random(17);
    for (const Normal& n : awkward_normals()) {
        SamplerCheck check;
        check.tolerance = 2e-3; // the hemisphere's border crosses bins
        check.disagreeing = 1e-3;
        expect_samples_as_its_pdf(*cosine_sampler(), facing(n), {24, 12, 16}, "cosine", check);
        Normal wo = random_direction(random);
        const double side = dot(n.data(), wo.data());
        // Where half-vectors are visible but light would come from below nothing is sampled: no integral is known.
        if (side < 0.0)
            for (float& x : wo) x = -x;
        const ShadingPoint at = shading_point(n.data(), wo.data());
        const LightSamplerPtr ggx = ggx_sampler(0.5);
        const auto point = ggx->point_sampler();
        point->move_to(at);
        int sampled = 0;
        for (int i = 0; i < 20000; ++i) {
            const double u0 = uniform(random), u1 = uniform(random);
            sampled += point->sample(u0, u1).pdf > 0.0f;
        }
        check.tolerance = 0.015; // of the share that was counted
        expect_samples_as_its_pdf(*ggx, at, {24, 12, 16}, "ggx", check, sampled / 20000.0);

        const float below[3] = {-wo[0], -wo[1], -wo[2]};
        point->move_to(shading_point(n.data(), below));
        EXPECT_EQ(point->sample(0.3, 0.4).pdf, 0.0f);
        EXPECT_EQ(point->pdf(n.data()), 0.0f);
    }
}

} // namespace
