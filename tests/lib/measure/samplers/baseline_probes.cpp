// The baselines of local environment maps on real probes: their relative variance over random normals, printed as a
// table, and how far taking texels at their centres is from the truth.
#include "tests/inputs/paths.h"
#include "tests/lib/measure/samplers/baselines.h"

#include "compress/parallel.h"
#include "input/probe/probe.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/tiling.h"

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

constexpr int kNormals = 64;

struct Variances {
    double full = 0.0, resampling = 0.0, cosine = 0.0, tiling = 0.0;
};

class BaselinesOn : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string path = std::string(acdf_test::kTestData) + "/probes/" + GetParam();
        if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is absent; set ACDF_TEST_DATA";
        static std::map<std::string, Target> read; // each once a process
        const auto [found, missing] = read.try_emplace(path);
        target_ = &found->second;
        if (!missing) return;
        acdf::input::ProbeOptions options;
        if (path.find("_probe.hdr") != std::string::npos) options.projection = acdf::input::Projection::angular;
        const acdf::input::Probe probe = acdf::input::read_probe(path, options);
        found->second =
            acdf::compress::environment_target(probe.rgb.data(), static_cast<std::uint32_t>(probe.width),
                                               static_cast<std::uint32_t>(probe.height), {});
    }
    const Target& target() const { return *target_; }

private:
    const Target* target_ = nullptr;
};

TEST_P(BaselinesOn, RandomNormals) {
    const LocalFullCdf full(target());
    const CosineHemisphere cosine(target());
    const TilingOnTheFly tiling(target(), 32, 16);
    const std::vector<Normal> normals = random_normals(kNormals, 1);
    std::vector<Variances> each(normals.size());
    std::vector<double> above(normals.size());
    acdf::compress::parallel_for(std::size_t{0}, normals.size(), [&](std::size_t i) {
        const float* n = normals[i].data();
        each[i].full = full.relative_variance(n);
        each[i].cosine = cosine.relative_variance(n);
        each[i].tiling = tiling.relative_variance(n);
        above[i] = full.share_above_horizon(n);
    });
    Variances mean;
    double least_above = 1.0;
    for (std::size_t i = 0; i < each.size(); ++i) {
        mean.full += each[i].full / kNormals;
        mean.resampling += each[i].full / 32.0 / kNormals;
        mean.cosine += each[i].cosine / kNormals;
        mean.tiling += each[i].tiling / kNormals;
        least_above = std::min(least_above, above[i]);
        EXPECT_LT(each[i].tiling, each[i].full);
    }
    std::printf("| %s %ux%u | %.4g | %.3g | %.4g | %.4g | %.4g | %.1f MB |\n", GetParam(), target().columns,
                target().rows, mean.full, least_above, mean.resampling, mean.cosine, mean.tiling,
                static_cast<double>(tiling.bytes()) / 1e6);
    EXPECT_LT(mean.tiling, 0.2);
    EXPECT_GT(mean.full, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Probes, BaselinesOn,
                         ::testing::Values("city.exr", "sunset.exr", "studio.exr", "courtyard.exr",
                                           "noon_grass_1k.hdr", "grace_probe.hdr", "stpeters_cross.hdr",
                                           "beach_probe.hdr"),
                         [](const auto& info) {
                             const std::string name = info.param;
                             return name.substr(0, name.find('.'));
                         });

/// Relative variances of the full CDF, the cosine and the tiling with 8 x 8 cosines a texel.
Variances supersampled(const Target& t, const Normal& n, const TilingOnTheFly& tiling) {
    const TilingOnTheFly::Point point = tiling.at(n.data());
    double flux = 0.0, mean = 0.0, cosine2 = 0.0, radiance2 = 0.0, tiled = 0.0;
    std::vector<double> inverse(t.values.size()); // L/p
    for_each_direction(t, 1, [&](std::size_t i, const double* d, double) {
        const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        const double p = tiling.pdf(point, w);
        inverse[i] = p > 0.0 ? t.values[i] / p : 0.0;
    });
    for_each_direction(t, 8, [&](std::size_t i, const double* d, double omega) {
        const double radiance = t.values[i], cosine = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        flux += radiance * omega;
        if (!(cosine > 0.0)) return;
        mean += radiance * cosine * omega;
        cosine2 += radiance * cosine * cosine * omega;
        radiance2 += radiance * radiance * cosine * omega;
        tiled += radiance * cosine * cosine * inverse[i] * omega;
    });
    const double square = mean * mean;
    return {flux * cosine2 / square - 1.0, 0.0, kPi * radiance2 / square - 1.0, tiled / square - 1.0};
}

/// What texel centres cost, in the relative second moment.
void expect_centres_suffice(const Target& t, int normals, double tolerance) {
    const TilingOnTheFly tiling(t, 32, 16);
    double worst = 0.0;
    for (const Normal& n : random_normals(normals, 2)) {
        const Variances truth = supersampled(t, n, tiling);
        const auto compare = [&](double centre, double exact) {
            worst = std::max(worst, std::abs((1.0 + centre) / (1.0 + exact) - 1.0));
        };
        compare(LocalFullCdf(t).relative_variance(n.data()), truth.full);
        compare(CosineHemisphere(t).relative_variance(n.data()), truth.cosine);
        compare(tiling.relative_variance(n.data()), truth.tiling);
    }
    EXPECT_LT(worst, tolerance);
    std::printf("texel centres: wrong by at most %.2g of the second moment\n", worst);
}

TEST_P(BaselinesOn, TexelCentresSuffice) { expect_centres_suffice(target(), 1, 5e-5); }

// It falls with the square of the resolution.
TEST(TexelCentres, Suffice) {
    expect_centres_suffice(sphere_target(256, 128, smooth_sky), 3, 3e-4);
    expect_centres_suffice(sphere_target(512, 256, smooth_sky), 3, 8e-5);
    expect_centres_suffice(noise_target(256, 128, 4), 3, 3e-4);
    expect_centres_suffice(texel_target(256, 128,
                                        [](std::uint32_t c, std::uint32_t r) {
                                            const double sky = smooth_sky(centre_phi(c, 256), centre_z(r, 128));
                                            return c == 90 && r == 30 ? 1e5 : sky;
                                        }),
                           3, 3e-4);
}

} // namespace
