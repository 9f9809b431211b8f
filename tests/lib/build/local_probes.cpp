// Local environment maps of real probes, at the sizes that users ask for, beside everything that a renderer could
// use instead. All by exact summation, over random normals that are no bin's own.
#include "tests/inputs/paths.h"

#include "build/accuracy/local.h"
#include "build/local.h"
#include "input/probe/probe.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/tiling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

namespace acdf {
namespace {

struct Probe {
    const char* file;
    input::Projection projection;
};
constexpr Probe kProbes[] = {
    {"city.exr", input::Projection::latlong},
    {"sunset.exr", input::Projection::latlong},
    {"studio.exr", input::Projection::latlong},
    {"courtyard.exr", input::Projection::latlong},
    {"noon_grass_1k.hdr", input::Projection::latlong},
    {"grace_probe.hdr", input::Projection::angular},
    {"stpeters_cross.hdr", input::Projection::cube_cross},
    {"beach_probe.hdr", input::Projection::angular},
};

const compress::Target& target_of(const Probe& probe) {
    static std::map<std::string, compress::Target> targets;
    const auto [found, missing] = targets.try_emplace(probe.file);
    if (missing) {
        const std::string path = std::string(acdf_test::kTestData) + "/probes/" + probe.file;
        const input::Probe read = input::read_probe(path, {probe.projection});
        found->second = compress::environment_target(read.rgb.data(), static_cast<std::uint32_t>(read.width),
                                                     static_cast<std::uint32_t>(read.height), {});
    }
    return found->second;
}

build::Local built(const Probe& probe, std::uint64_t budget) {
    build::LocalOptions options;
    options.goal.budget = budget;
    build::Local local = build::build_local(target_of(probe), {}, options);
    EXPECT_EQ(local.normals, 256u);
    return local;
}

/// Gain over the full-resolution CDF; fails where the file is not what any file of a budget must be.
double gain(const Probe& probe, std::uint64_t budget, const build::Local& local) {
    const build::LocalAccuracy& a = local.accuracy;
    const std::size_t bytes = local.bytes.size();
    const double gain = a.relative_variance_full_cdf / a.relative_variance;
    std::printf("%-20s %8llu bytes, relative variance %.4g, gain %.4g, above the horizon %.4g, least %.4g\n",
                probe.file, static_cast<unsigned long long>(bytes), a.relative_variance, gain,
                a.share_above_horizon, a.least_share_above_horizon);
    EXPECT_LE(bytes, budget) << probe.file;
    EXPECT_GE(double(bytes), 0.97 * double(budget)) << probe.file;
    EXPECT_EQ(a.support_violations, 0u) << probe.file;
    return gain;
}

/// Over one of 32 normals: baselines are summed over all texels for each.
void expect_less_noise_than_baselines(const Probe& probe, const build::Local& local) {
    std::vector<build::Normal> normals;
    const std::vector<build::Normal> all = build::random_normals(256);
    for (std::size_t i = 0; i < all.size(); i += 32) normals.push_back(all[i]);
    const compress::Target& target = target_of(probe);
    File file;
    ASSERT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file).ok());
    const double ours = build::summary(build::measure_normals(file, target, normals)).relative_variance;
    const measure::Resampling resampling(target, 32);
    const measure::TilingOnTheFly tiling(target, 32, 16);
    double resampled = 0.0, tiled = 0.0;
    for (const build::Normal& n : normals) {
        resampled += resampling.relative_variance(n.data()) / double(normals.size());
        tiled += tiling.relative_variance(n.data()) / double(normals.size());
    }
    EXPECT_LT(ours, resampled) << probe.file;
    EXPECT_LT(ours, tiled) << probe.file;
    EXPECT_LT(local.bytes.size(), tiling.bytes()) << probe.file;
    EXPECT_LT(local.bytes.size(), resampling.bytes()) << probe.file;
}

class LocalProbes : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(std::string(acdf_test::kTestData) + "/probes"))
            GTEST_SKIP() << acdf_test::kTestData << "/probes is absent; set ACDF_TEST_DATA";
    }
};

TEST_F(LocalProbes, OneMegabyte) {
    double sum = 0.0;
    for (const Probe& probe : kProbes) {
        const build::Local local = built(probe, 1000000);
        const build::LocalAccuracy& a = local.accuracy;
        const double g = gain(probe, 1000000, local);
        EXPECT_GE(g, 50.0) << probe.file; // this, and 100 in the mean, was hoped for from two megabytes
        EXPECT_GE(a.least_share_above_horizon, 0.9) << probe.file;
        EXPECT_LE(a.least_share_above_horizon_full_cdf, 0.35) << probe.file;
        EXPECT_LE(a.max_weight, 200.0) << probe.file;
        expect_less_noise_than_baselines(probe, local);
        sum += std::log(g);
    }
    EXPECT_GE(std::exp(sum / std::size(kProbes)), 100.0);
}

// Large soft boxes, and normals that get an 80th of the brightest one's light: most of
// theirs is at the horizon.
TEST_F(LocalProbes, SoftBoxesAtTheHorizon) {
    const Probe probe = {"studio_small_05_1k.hdr", input::Projection::latlong};
    const build::Local local = built(probe, 1000000);
    EXPECT_GE(gain(probe, 1000000, local), 50.0);
    EXPECT_GE(local.accuracy.least_share_above_horizon, 0.9);
    EXPECT_LE(local.accuracy.max_weight, 200.0);
}

TEST_F(LocalProbes, AQuarterOfThat) {
    double sum = 0.0;
    for (const Probe& probe : kProbes) sum += std::log(gain(probe, 256 * 1024, built(probe, 256 * 1024)));
    EXPECT_GE(std::exp(sum / std::size(kProbes)), 40.0);
}

} // namespace
} // namespace acdf
