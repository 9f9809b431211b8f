// Samples of light times cosine times BRDF, of files that were fitted: their pdf, and what they estimate.
#include "tests/inputs/brdf_files.h"
#include "tests/inputs/local_maps.h"
#include "tests/lib/measure/samplers/light_sampler_checks.h"

#include "measure/samplers/product_samplers.h"
#include "measure/samplers/product_warp.h"
#include "measure/surface_frame.h"
#include "tests/inputs/sanitized.h"

namespace {

using namespace acdf::measure;
using namespace acdf_test;

struct Light {
    std::string name;
    std::unique_ptr<LocalMap> map;
};

/// Smooth, noisy, and with small suns; one on the octahedral square; one dark below its horizon.
const std::vector<Light>& lights() {
    static std::vector<Light> out;
    if (!out.empty()) return out;
    const auto add = [&](const std::string& name, const acdf::compress::Target& target, std::uint32_t subdivisions,
                         const LocalFileOptions& options = of_size(60, 1500)) {
        out.push_back(
            {name, std::make_unique<LocalMap>(target, acdf::compress::octahedral_bins(subdivisions), options)});
    };
    add("noise", noise_target(64, 32, 9, 1.0), 4);
    add("suns", suns_target(64, 32), 4);
    add("octahedral", octahedral(noise_target(48, 48, 3, 1.5)), 3);
    add("dark below",
        sphere_target(64, 32, [](double phi, double z) { return z > 0.1 ? 1.5 + std::sin(phi) : 0.0; }), 4);
    return out;
}

/// Where bins of normals meet, and anywhere; views at all angles, one grazing.
std::vector<ShadingPoint> points(int count) {
    std::mt19937_64 random(61);
    std::vector<ShadingPoint> out;
    const Normal seams[] = {{0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, -0.70710678f, 0.70710678f}};
    for (int i = 0; i < count; ++i) {
        const Normal n = i < 3 ? seams[i] : random_direction(random);
        Normal wo = random_direction(random);
        double height = dot(n.data(), wo.data());
        if (height < 0.0)
            for (float& x : wo) x = -x;
        height = std::abs(height);
        if (i % 4 == 1) { // grazing
            for (std::size_t k = 0; k < 3; ++k) wo[k] -= static_cast<float>(height - 0.02) * n[k];
            const auto scale = static_cast<float>(1.0 / length(wo.data()));
            for (float& x : wo) x *= scale;
        }
        out.push_back(shading_point(n.data(), wo.data()));
    }
    return out;
}

struct Surface {
    std::string name;
    std::unique_ptr<acdf::build::Brdf> brdf;
    std::unique_ptr<MadeBrdf> made;
};

const std::vector<Surface>& surfaces() {
    static std::vector<Surface> out;
    if (!out.empty()) return out;
    const auto add = [&](const std::string& name, double a, double b) {
        out.push_back(
            {name, std::make_unique<LobeBrdf>(a, b), make_brdf(std::make_unique<LobeBrdf>(a, b), budget(12000))});
    };
    add("rough", 0.6, 0.6);
    add("narrow", 0.08, 0.08);
    return out;
}

TEST(Product, SamplesByItsPdf) {
    const std::vector<Light>& all_lights = lights();
    const std::vector<Surface>& all_surfaces = surfaces();
    SamplerCheck check;
    // Cells of a BRDF cut across what is summed here; tests/lib/product/product.cpp has the integral to 1e-5.
    check.tolerance = 1e-2;
    check.samples = 4000;
    int i = 0;
    const std::vector<ShadingPoint> at = points(12);
    for (const Light& light : all_lights)
        for (const Surface& surface : all_surfaces) {
            const auto sampler = product_sampler(light.map->file, surface.made->file, i % 2 ? 64 : 24);
            const SphereBins bins{64, 32, surface.name == "narrow" ? 12u : 6u};
            expect_samples_as_its_pdf(*sampler, at[static_cast<std::size_t>(i++)], bins,
                                      light.name + ", " + surface.name, check);
        }
}

TEST(Product, WarpedNumbersSampleByTheirPdf) {
    const std::vector<Light>& all_lights = lights();
    const acdf::File& brdf = surfaces().front().made->file;
    SamplerCheck check;
    check.tolerance = 1e-2;
    check.samples = 4000;
    const std::vector<ShadingPoint> at = points(12);
    for (std::size_t i = 0; i < all_lights.size(); ++i)
        expect_samples_as_its_pdf(*product_warp_sampler(all_lights[i].map->file, brdf), at[2 * i],
                                  SphereBins{64, 32, 12}, all_lights[i].name, check);
}

/// Reflected light of a point, by summation over the grid of the light.
double reflected(const LocalMap& light, const acdf::build::Brdf& brdf, const ShadingPoint& point,
                 const float wi[3]) {
    double n[3] = {point.n[0], point.n[1], point.n[2]}, t[3], b[3], wo[3], w[3], rho[3];
    surface_frame(n, t, b);
    const double* axes[3] = {t, b, n};
    for (int i = 0; i < 3; ++i) {
        wo[i] = w[i] = 0.0;
        for (int k = 0; k < 3; ++k) {
            wo[i] += axes[i][k] * point.wo[k];
            w[i] += axes[i][k] * wi[k];
        }
    }
    if (!(w[2] > 0.0)) return 0.0;
    brdf.evaluate(wo, w, rho);
    return double{light.radiance(wi)} * w[2] * rho[0];
}

struct Estimate {
    double mean = 0.0, squares = 0.0;

    double variance() const { return std::max(0.0, squares - mean * mean); }
};

/// Of so many samples at a point.
Estimate estimate(const acdf::measure::LightSampler& sampler, const LocalMap& light, const acdf::build::Brdf& brdf,
                  const ShadingPoint& point, int samples, std::mt19937_64& random) {
    const auto in_hand = sampler.point_sampler();
    Estimate out;
    in_hand->move_to(point);
    for (int i = 0; i < samples; ++i) {
        const double u0 = uniform(random), u1 = uniform(random);
        const AcdfDirectionSample s = in_hand->sample(u0, u1);
        const double x = s.pdf > 0.0f ? reflected(light, brdf, point, s.direction) / double{s.pdf} : 0.0;
        out.mean += x / samples;
        out.squares += x * x / samples;
    }
    return out;
}

TEST(Product, EstimatesWhatSummationGives) {
    const std::vector<Light>& all_lights = lights();
    const std::vector<Surface>& all_surfaces = surfaces();
    const std::vector<ShadingPoint> at = points(8);
    std::mt19937_64 random(5);
    int beyond = 0, all = 0;
    for (const Light& light : all_lights)
        for (const Surface& surface : all_surfaces) {
            const auto sampler = product_sampler(light.map->file, surface.made->file, 64);
            const SphereBins bins{64, 32, 4};
            for (const ShadingPoint& point : at) {
                double exact = 0.0;
                bins.for_each([&](std::size_t, const float* w, double omega) {
                    exact += omega * reflected(*light.map, *surface.brdf, point, w);
                });
                constexpr int n = 2000;
                const Estimate found = estimate(*sampler, *light.map, *surface.brdf, point, n, random);
                const double error = std::sqrt(found.variance() / n) + 2e-3 * exact;
                beyond += std::abs(found.mean - exact) > 4.0 * error;
                ++all;
                EXPECT_NEAR(found.mean, exact, 6.0 * error) << light.name << ", " << surface.name;
            }
        }
    EXPECT_LE(beyond, 1) << "of " << all;
}

/// Relative variance of a sample at a point, by summation.
double exact_variance(const acdf::measure::LightSampler& sampler, const LocalMap& light,
                      const acdf::build::Brdf& brdf, const ShadingPoint& point) {
    const auto in_hand = sampler.point_sampler();
    double mean = 0.0, squares = 0.0;
    in_hand->move_to(point);
    SphereBins{64, 32, 4}.for_each([&](std::size_t, const float* w, double omega) {
        const double f = reflected(light, brdf, point, w), p = double{in_hand->pdf(w)};
        mean += omega * f;
        if (p > 0.0) squares += omega * f * f / p;
    });
    return mean > 0.0 ? squares / (mean * mean) - 1.0 : 1.0;
}

// A tile with much light that reaches above the horizon where its middle does not: it is sampled nonetheless.
TEST(Product, LightAtTheHorizonIsSampled) {
    const Light& light = lights()[1];
    const Surface& surface = surfaces()[0];
    const ShadingPoint point = points(8)[2]; // a sun is at its horizon
    const acdf::compress::Target suns = suns_target(64, 32);
    int above = 0, below = 0; // texels of it
    for (std::uint32_t r = 0; r < suns.rows; ++r)
        for (std::uint32_t c = 0; c < suns.columns; ++c) {
            float d[3];
            direction_of(centre_phi(c, suns.columns), centre_z(r, suns.rows), d);
            if (suns.row(r)[c] > 1e5f) ++(dot(point.n, d) > 0.0 ? above : below);
        }
    ASSERT_GT(above, 0);
    ASSERT_GT(below, above);
    const auto variance = [&](int parts) {
        const auto sampler = product_sampler(light.map->file, surface.made->file, parts);
        return exact_variance(*sampler, *light.map, *surface.brdf, point);
    };
    const double half_and_half = variance(1);
    EXPECT_LT(variance(8), 0.6 * half_and_half);
    EXPECT_LT(variance(64), 0.4 * half_and_half);
}

} // namespace
