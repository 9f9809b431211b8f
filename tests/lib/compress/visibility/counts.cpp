// Counts of rays in a grid of fixed size.
#include "compress/visibility/counts.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <vector>

namespace counted_rays {
namespace {

using acdf::compress::VisibilityCount;
using acdf::compress::VisibilityCounts;

constexpr std::array<float, 3> kLow{-1.0f, 0.0f, 2.0f}, kHigh{3.0f, 1.0f, 4.0f};

struct CountedRay {
    float position[3], normal[3];
    std::uint32_t part;
    bool visible;
};

std::vector<CountedRay> random_rays(std::size_t count) {
    std::mt19937 random(3);
    const auto uniform = [&] { return float(random() % 65536) / 65536.0f; };
    std::vector<CountedRay> out;
    for (std::size_t i = 0; i < count; ++i) {
        CountedRay ray{};
        for (std::size_t k = 0; k < 3; ++k) {
            ray.position[k] = kLow[k] + uniform() * (kHigh[k] - kLow[k]);
            ray.normal[k] = k == i % 3 ? uniform() - 0.4999f : 0.0f;
        }
        ray.part = static_cast<std::uint32_t>(random() % 8);
        ray.visible = random() % 3 == 0;
        out.push_back(ray);
    }
    return out;
}

std::vector<VisibilityCount> sorted(VisibilityCounts& of) {
    const VisibilityCounts::Sorted counts = of.sorted();
    std::vector<VisibilityCount> out;
    for (std::size_t i = 0; i < counts.size(); ++i) out.push_back(counts[i]);
    return out;
}

/// Many more keys than slots: cells become wider many times over, and no ray is lost.
TEST(VisibilityCounts, AreTheSameInAnyOrderAndWithinTheirMemory) {
    constexpr std::size_t slots = 1024, count = 40000, threads = 6;
    const std::vector<CountedRay> rays = random_rays(count);
    VisibilityCounts one(kLow, kHigh, slots), many(kLow, kHigh, slots);
    for (const CountedRay& ray : rays) one.add(ray.position, ray.normal, ray.part, ray.visible);
    std::vector<std::thread> adding;
    for (std::size_t t = 0; t < threads; ++t)
        adding.emplace_back([&, t] {
            for (std::size_t i = count; i-- > 0;)
                if (i % threads == t) many.add(rays[i].position, rays[i].normal, rays[i].part, rays[i].visible);
        });
    for (std::thread& thread : adding) thread.join();
    const std::vector<VisibilityCount> a = sorted(one), b = sorted(many);
    EXPECT_LE(a.size(), slots * 3 / 4);
    ASSERT_EQ(a.size(), b.size());
    std::uint64_t all = 0, seen = 0, visible = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].key, b[i].key);
        EXPECT_EQ(a[i].all, b[i].all);
        EXPECT_EQ(a[i].seen, b[i].seen);
        all += a[i].all;
        seen += a[i].seen;
    }
    for (const CountedRay& ray : rays) visible += ray.visible;
    EXPECT_EQ(all, count);
    EXPECT_EQ(seen, visible);
}

TEST(VisibilityCounts, TellPlaceNormalAndPart) {
    VisibilityCounts counts(kLow, kHigh, 1024);
    const float position[3] = {2.5f, 0.25f, 3.0f}, down[3] = {0.01f, -0.01f, -2.0f};
    ASSERT_TRUE(counts.add(position, down, 17, true));
    ASSERT_TRUE(counts.add(position, down, 17, false));
    const VisibilityCounts::Sorted told = counts.sorted();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].all, 2u);
    EXPECT_EQ(told[0].seen, 1u);
    EXPECT_EQ(VisibilityCounts::part_of(told[0].key), 17u);
    const std::array<float, 3> normal = VisibilityCounts::middle_normal(VisibilityCounts::normal_of(told[0].key));
    EXPECT_FLOAT_EQ(normal[0], 0.0f);
    EXPECT_FLOAT_EQ(normal[1], 0.0f);
    EXPECT_FLOAT_EQ(normal[2], -1.0f);
    for (std::size_t k = 0; k < 3; ++k) {
        const float low = told.low(k) + float(VisibilityCounts::cell_of(told[0].key, k)) * told.width();
        EXPECT_GE(position[k], low);
        EXPECT_LE(position[k], low + told.width());
    }
}

TEST(VisibilityCounts, RefuseWhatIsNoPlaceOrNormal) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    VisibilityCounts counts(kLow, kHigh, 1024);
    const float inside[3] = {0.0f, 0.5f, 3.0f}, outside[3] = {0.0f, 1.5f, 3.0f}, strange[3] = {nan, 0.5f, 3.0f},
                up[3] = {0.0f, 0.0f, 1.0f}, none[3] = {}, bad[3] = {1.0f, nan, 0.0f};
    EXPECT_FALSE(counts.add(outside, up, 0, true));
    EXPECT_FALSE(counts.add(strange, up, 0, true));
    EXPECT_FALSE(counts.add(inside, none, 0, true));
    EXPECT_FALSE(counts.add(inside, bad, 0, true));
    EXPECT_EQ(counts.sorted().size(), 0u);
}

} // namespace
} // namespace counted_rays
