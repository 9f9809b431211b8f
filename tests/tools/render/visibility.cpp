// Files with visibility cells held to sums over all texels, at what a camera sees and anywhere:
// docs/make/visibility.sh does the same with real probes.
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"
#include "tests/tools/render/scenes.h"

#include "measure/scenes/point_sums.h"
#include "measure/scenes/surface_points.h"
#include "tools/render/sampler_build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::tools {
namespace {

constexpr std::uint32_t kSamples = 1024; // so many that rare ones are among them
constexpr std::uint32_t kEstimates = 8;  // at each point: the spread of 32 points alone is known to an eighth

struct Viewed {
    test::SceneFolder folder;
    std::unique_ptr<LoadedScene> loaded;
    compress::Target target;
    std::unique_ptr<SamplerBuilder> builder;

    explicit Viewed(const std::string& scene) {
        test::write_text(folder / "room.obj", test::room());
        loaded = load_scene(parse_scene(scene), folder.data());
        target = compress::environment_target(loaded->probe.rgb.data(), 32, 16, compress::TargetOptions());
        std::vector<const input::Brdf*> brdfs;
        for (const auto& brdf : loaded->brdfs) brdfs.push_back(brdf.get());
        builder = std::make_unique<SamplerBuilder>(acdf::builder::target_of(target, acdf::test::nearest_lookup()),
                                                   brdfs, folder.data(), std::vector<acdf::builder::SceneNormal>{},
                                                   &loaded->scene.geometry, &loaded->points.points);
    }
    /// The same number of samples of each.
    measure::SamplerParts parts(const std::vector<std::string>& samplers) {
        measure::SamplerParts out;
        for (const std::string& text : samplers) {
            measure::SamplerParts::Part part{{}, kSamples / static_cast<std::uint32_t>(samplers.size())};
            for (std::size_t m = 0; m < loaded->brdfs.size(); ++m)
                part.of_material.push_back(&builder->single(parse_sampler(text), m, kSamples));
            out.parts.push_back(part);
        }
        return out;
    }
};

/// How far estimates at all points are off, in standard errors by the sums.
struct Deviations {
    double sum = 0.0, variance = 0.0, square = 0.0;
    std::uint32_t estimates = 0, far = 0, lost = 0;

    void add(double deviation, double own) {
        sum += deviation;
        variance += own;
        if (!(own > 0.0)) return;
        ++estimates;
        square += deviation * deviation / own;
        far += std::fabs(deviation) > 4.0 * std::sqrt(own);
    }
};

void expect_as_summed(Viewed& scene, const std::vector<std::vector<std::string>>& samplers) {
    std::vector<measure::SamplerParts> parts;
    for (const std::vector<std::string>& one : samplers) parts.push_back(scene.parts(one));
    std::vector<Deviations> found(parts.size());
    std::mt19937_64 random(3);
    const measure::ProbeLight& light = scene.loaded->scene.light;
    for (const measure::ScenePoint& point : scene.loaded->points.points) {
        std::vector<measure::PartsAtPoint> at;
        for (const measure::SamplerParts& one : parts) at.emplace_back(one, point);
        const measure::PointSums exact = measure::sums_at(point, light, at);
        for (std::size_t k = 0; k < at.size(); ++k) {
            for (std::uint32_t i = 0; i < kEstimates; ++i)
                found[k].add(at[k].estimate(point, light, random) - exact.mean, exact.variance[k] / kSamples);
            found[k].lost += exact.lost[k];
        }
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Deviations& d = found[k];
        const std::string& name = samplers[k].front();
        ASSERT_GT(d.estimates, 30 * kEstimates) << name;
        EXPECT_EQ(d.lost, 0u) << name;
        EXPECT_LT(std::fabs(d.sum), 4.0 * std::sqrt(d.variance)) << name;
        EXPECT_NEAR(std::sqrt(d.square / d.estimates), 1.0, 0.2) << name;
        EXPECT_LE(d.far, d.estimates / 50) << name; // estimates of few samples have no normal distribution
    }
}

TEST(RenderVisibility, AreAsSummedBehindAWall) {
    ACDF_NOT_SANITIZED();
    Viewed scene(test::small_scene("\"full-cdf\""));
    expect_as_summed(scene, {{"local:24KiB"},
                             {"visibility:24KiB"},
                             {"visibility-cache:8x4"},
                             {"visibility:24KiB", "cosine"},
                             {"visibility:24KiB --mis cosine", "cosine"},
                             {"learned:64KiB"},
                             {"learned:64KiB --mis cosine", "cosine"}});
}

TEST(RenderVisibility, AreAsSummedInARoom) {
    Viewed scene(test::mesh_scene("room.obj"));
    expect_as_summed(scene, {{"local:24KiB"}, {"visibility:24KiB"}, {"tiles:8x4"}, {"visibility-cache:8x4"}});
}

TEST(RenderVisibility, CellsBesideTheCosineHaveLessNoiseWithIt) {
    ACDF_NOT_SANITIZED();
    for (const std::string& text : {test::small_scene("\"full-cdf\""), test::mesh_scene("room.obj")}) {
        Viewed scene(text);
        const measure::SamplerParts plain = scene.parts({"visibility:24KiB", "cosine"}),
                                    beside = scene.parts({"visibility:24KiB --mis cosine", "cosine"});
        double variance[2] = {};
        for (const measure::ScenePoint& point : scene.loaded->points.points) {
            std::vector<measure::PartsAtPoint> at;
            for (const measure::SamplerParts* parts : {&plain, &beside}) at.emplace_back(*parts, point);
            const measure::PointSums exact = measure::sums_at(point, scene.loaded->scene.light, at);
            for (std::size_t k = 0; k < 2 && exact.mean > 0.0; ++k)
                variance[k] += exact.variance[k] / (exact.mean * exact.mean);
        }
        EXPECT_LT(variance[1], 0.98 * variance[0]);
    }
}

/// Wherever light is, from any position and for any normal, it may be sampled.
TEST(RenderVisibility, LoseNoLightAnywhere) {
    ACDF_NOT_SANITIZED();
    for (const std::string& text : {test::small_scene("\"full-cdf\""), test::mesh_scene("room.obj")}) {
        Viewed scene(text);
        const auto point = scene.parts({"visibility:24KiB"}).parts[0].of_material[0]->point_sampler();
        const compress::VisibilityScene visibility = measure::visibility_scene(scene.loaded->scene.geometry);
        std::mt19937_64 random(11);
        const auto any = [&] {
            float w[3];
            acdf_test::direction_of(acdf_test::kPi * (2.0 * acdf_test::uniform(random) - 1.0),
                                    2.0 * acdf_test::uniform(random) - 1.0, w);
            return std::array<float, 3>{w[0], w[1], w[2]};
        };
        const int wanted = 10000;
        int lit = 0, lost = 0;
        for (std::uint64_t i = 0; lit < wanted && i < 200000; ++i) {
            compress::VisibilityPoint place;
            if (!visibility.points(random() >> 40, place)) continue;
            measure::ShadingPoint at;
            const std::array<float, 3> n = i % 2 ? place.normal : any(), w = any();
            std::copy_n(n.begin(), 3, at.n);
            std::copy_n(place.position.begin(), 3, at.position);
            const float cosine = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
            if (!(cosine > 1e-3f && measure::luminance(scene.loaded->scene.light.radiance(w.data())) > 0.0))
                continue;
            ++lit;
            point->move_to(at);
            lost += !(point->pdf(w.data()) > 0.0f);
        }
        EXPECT_EQ(lit, wanted);
        EXPECT_EQ(lost, 0);
    }
}

} // namespace
} // namespace acdf::tools
