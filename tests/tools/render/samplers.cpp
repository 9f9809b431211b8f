// Every sampler on a small scene with shadows and two materials: none may be biased.
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/tools/render/scenes.h"

#include "tools/render/report.h"
#include "tools/render/sampler_build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

struct SmallScene {
    test::SceneFolder folder;
    std::unique_ptr<LoadedScene> loaded;
    compress::Target target;
    std::unique_ptr<SamplerBuilder> builder;

    SmallScene() {
        loaded = load_scene(parse_scene(test::small_scene("\"full-cdf\"")), folder.data());
        target = compress::environment_target(loaded->probe.rgb.data(), 32, 16, compress::TargetOptions());
        std::vector<const input::Brdf*> brdfs;
        for (const auto& brdf : loaded->brdfs) brdfs.push_back(brdf.get());
        builder = std::make_unique<SamplerBuilder>(acdf::builder::target_of(target, acdf::test::nearest_lookup()),
                                                   brdfs, folder.data());
    }
    Comparison compare(const std::vector<std::string>& samplers, std::uint32_t seeds, bool timing = false,
                       measure::Numbers numbers = measure::Numbers::independent) {
        ComparisonOptions options;
        options.render.numbers = numbers;
        for (const std::string& text : samplers) options.samplers.push_back(parse_sampler(text));
        options.samples = 8;
        options.render.seeds = seeds;
        options.timing = timing;
        options.time.rounds = 3;
        options.time.seconds_a_round = 1e-4;
        return tools::compare(loaded->scene, loaded->points.points, *builder, options);
    }
};

const std::uint32_t kSeeds = acdf_test::kSanitized ? 60 : 400; // sanitizers are for code, not for statistics

void expect_unbiased(const Comparison& comparison) {
    for (const Compared& one : comparison.samplers) {
        EXPECT_LT(std::abs(one.bias_standard_errors), 4.0) << one.spec.text << " by " << one.bias;
        EXPECT_GT(one.relative_variance.value, 0.0) << one.spec.text;
        EXPECT_GT(one.share_above, 0.0) << one.spec.text;
    }
}

TEST(RenderSamplers, OfLightAreUnbiased) {
    SmallScene scene;
    expect_unbiased(scene.compare({"full-cdf", "cosine", "tiles:8x4", "alias", "hierarchical", "downsampled:8x4",
                                   "strata", "strata:radiance", "ris:4", "env:4KiB"},
                                  kSeeds));
}

TEST(RenderSamplers, OfPartnersAreUnbiased) {
    SmallScene scene;
    expect_unbiased(scene.compare({"mis(env:4KiB --mis cosine,cosine)", "mis(auto:env:4KiB --mis cosine,cosine)",
                                   "mis-power(local:48KiB --mis cosine --heuristic power,cosine)",
                                   "mis(auto:local:48KiB --mis cosine --shares 3:1, cosine, full-cdf)",
                                   "mis(env:4KiB --mis brdf,cosine)", "ideal", "mis(ideal --mis cosine,cosine)"},
                                  kSeeds));
}

TEST(RenderSamplers, CombinedAreUnbiased) {
    SmallScene scene;
    expect_unbiased(scene.compare(
        {"mis(full-cdf,cosine)", "mis-power(3*full-cdf,cosine)", "mis-compensated", "mis(env:4KiB,ggx:0.4,cosine)"},
        kSeeds));
}

TEST(RenderSamplers, OfTheSurfaceAreUnbiased) {
    ACDF_NOT_SANITIZED();
    SmallScene scene;
    expect_unbiased(scene.compare({"ggx:0.4", "brdf:16KiB", "mis(env:4KiB,brdf:16KiB)"}, kSeeds));
}

TEST(RenderSamplers, OfLocalEnvironmentsAreUnbiased) {
    SmallScene scene;
    expect_unbiased(scene.compare({"local:32KiB", "mis(4*local:32KiB,cosine)"}, kSeeds));
}

TEST(RenderSamplers, ScrambledSequencesAreUnbiasedAndLessNoisy) {
    SmallScene scene;
    const std::vector<std::string> samplers{"full-cdf", "cosine", "ris:4", "mis(env:4KiB,cosine)"};
    const Comparison sobol = scene.compare(samplers, 200, false, measure::Numbers::sobol);
    expect_unbiased(sobol);
    const Comparison independent = scene.compare(samplers, 100);
    for (const std::size_t i : {0u, 3u}) {
        EXPECT_LT(sobol.samplers[i].relative_variance.high, independent.samplers[i].relative_variance.low) << i;
        EXPECT_TRUE(independent.samplers[i].scales);
        EXPECT_FALSE(sobol.samplers[i].scales);
    }
}

// The same check must see what is wrong: light that is lost.
TEST(RenderSamplers, BiasIsSeen) {
    SmallScene scene;
    Comparison honest = scene.compare({"cosine"}, 400);
    std::vector<measure::ScenePoint> open;
    for (const measure::ScenePoint& point : scene.loaded->points.points) open.push_back(point.in_the_open());
    ComparisonOptions options;
    options.samplers = {parse_sampler("cosine")};
    options.samples = 8;
    options.render.seeds = 400;
    options.timing = false;
    const Comparison other = compare(scene.loaded->scene, open, *scene.builder, options);
    EXPECT_GT(honest.sky_hidden, 0.05);
    EXPECT_EQ(other.sky_hidden, 0.0);
    double with = 0.0, without = 0.0, square_error = 0.0;
    for (std::size_t i = 0; i < open.size(); ++i) {
        with += measure::luminance(honest.reference[i]);
        without += measure::luminance(other.samplers[0].rendering.mean[i]);
        square_error += other.samplers[0].rendering.variance[i] / 400.0;
    }
    EXPECT_GT(without - with, 20.0 * std::sqrt(square_error)); // shadows matter in this scene
}

TEST(RenderSamplers, GainsAreOfTheBaselineAndReciprocal) {
    SmallScene scene;
    const Comparison c = scene.compare({"full-cdf", "cosine", "ris:16"}, 200, true);
    EXPECT_EQ(c.samplers[0].equal_samples.value, 1.0);
    EXPECT_EQ(c.samplers[0].equal_time.value, 1.0);
    const Compared &a = c.samplers[1], &b = c.samplers[2];
    EXPECT_NEAR(a.equal_samples.value * a.relative_variance.value, c.samplers[0].relative_variance.value, 1e-12);
    EXPECT_NEAR(gain_at_equal_samples(a, b).value * gain_at_equal_samples(b, a).value, 1.0, 1e-12);
    EXPECT_NEAR(gain_at_equal_time(a, b).value * gain_at_equal_time(b, a).value, 1.0, 1e-12);
    EXPECT_GT(gain_at_equal_samples(b, c.samplers[0]).low, 1.0); // sixteen candidates are better than one
    EXPECT_LE(b.shadow_rays, 8.0);
}

/// A comparison of which only variances and times matter.
Compared made(const char* text, bool ours, double noise, double time) {
    Compared out;
    out.spec.text = text;
    out.ours = ours;
    out.noise = {noise, noise * 1.01, noise * 0.99};
    out.nanoseconds = {time, time * 1.01, time * 0.99};
    return out;
}

TEST(RenderSamplers, VerdictSaysWhereABaselineWins) {
    Comparison comparison;
    comparison.samplers = {made("full-cdf", false, 1.0, 100.0), made("ris:32", false, 0.05, 4000.0),
                           made("local:1MB", true, 0.1, 150.0)};
    std::vector<std::string> says = verdict(comparison, true);
    ASSERT_EQ(says.size(), 2u);
    EXPECT_NE(says[0].find("a baseline wins: 'ris:32', 2 ("), std::string::npos) << says[0];
    EXPECT_NE(says[1].find("ours, 'local:1MB', wins"), std::string::npos) << says[1];
    EXPECT_NE(says[1].find("'full-cdf'"), std::string::npos) << says[1];
    EXPECT_EQ(says[0].find("within the noise"), std::string::npos);
    comparison.samplers[1].noise = {0.05, 0.2, 0.01};
    EXPECT_NE(verdict(comparison, false)[0].find("within the noise"), std::string::npos);
}

// Where rare, very bright samples decide an interval reaches below 0: nothing is made of such figures.
TEST(RenderSamplers, WhatIsNotResolvedIsNotJudged) {
    Comparison comparison;
    comparison.samplers = {made("full-cdf", false, 1.0, 100.0), made("cosine", false, 0.05, 100.0),
                           made("local:1MB", true, 0.1, 100.0)};
    for (Compared& one : comparison.samplers) one.relative_variance = measure::mean_interval(one.noise);
    EXPECT_NE(verdict(comparison, false)[0].find("'cosine'"), std::string::npos);
    comparison.samplers[1].noise = {1e-4, 2e-4, 0.15};
    comparison.samplers[1].relative_variance = measure::mean_interval(comparison.samplers[1].noise);
    EXPECT_LT(comparison.samplers[1].relative_variance.low, 0.0);
    EXPECT_FALSE(comparison.samplers[1].resolved());
    EXPECT_EQ(verdict(comparison, false)[0].find("'cosine'"), std::string::npos);
    EXPECT_TRUE(overtakings(comparison, comparison, gain_at_equal_samples).empty());
}

TEST(RenderSamplers, OvertakingsAreThoseBeyondTheNoise) {
    Comparison hidden, open;
    open.samplers = {made("a", false, 1.0, 1.0), made("b", false, 0.1, 1.0), made("c", true, 0.1005, 1.0)};
    hidden.samplers = {made("a", false, 1.0, 1.0), made("b", false, 2.0, 1.0), made("c", true, 0.0995, 1.0)};
    const std::vector<Overtaking> found = overtakings(hidden, open, gain_at_equal_samples);
    ASSERT_EQ(found.size(), 1u); // that of b and c was within the noise in the open
    EXPECT_EQ(found[0].winner->spec.text, "a");
    EXPECT_EQ(found[0].loser->spec.text, "b");
}

} // namespace
} // namespace acdf::tools
