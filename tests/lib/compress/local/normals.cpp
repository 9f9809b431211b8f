// Bins that a scene's normals have, and those that its renderer's have, which are rounded.
#include "compress/local/normals.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

namespace {

using acdf::compress::NormalBins;
using Normal = std::array<float, 3>;

constexpr Normal kNormals[] = {{0.0f, 0.0f, 1.0f},  {0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 1.0f},
                               {1.0f, 1.0f, -1.0f}, {0.2f, -0.3f, 0.5f}, {0.3f, 0.1f, 0.9f}};

void expect_served_around(const Normal& normal, NormalBins bins) {
    acdf::compress::weigh(bins, {{normal, 2.0}}, acdf::compress::Rounded::yes);
    EXPECT_NEAR(std::accumulate(bins.weight.begin(), bins.weight.end(), 0.0), 1.0, 1e-5);
    std::mt19937 rng(7);
    std::uniform_real_distribution<float> off(-3e-4f, 3e-4f);
    AcdfNormalBins found;
    for (int k = 0; k < 500; ++k) {
        const float rounded[3] = {normal[0] + off(rng), normal[1] + off(rng), normal[2] + off(rng)};
        ASSERT_TRUE(bins.find(rounded, found));
        for (int i = 0; i < found.count; ++i) ASSERT_GT(bins.weight[found.bin[i]], 0.0) << k;
    }
    double own = 0.0;
    ASSERT_TRUE(bins.find(normal.data(), found));
    for (int i = 0; i < found.count; ++i) own += bins.weight[found.bin[i]];
    EXPECT_NEAR(own, 1.0, 1e-5);
}

TEST(SceneNormals, AreServedAsTheyAreRounded) {
    for (const Normal& normal : kNormals) {
        SCOPED_TRACE(testing::Message() << normal[0] << ' ' << normal[1] << ' ' << normal[2]);
        for (const std::uint32_t subdivisions : {1u, 4u, 7u, 30u})
            expect_served_around(normal, acdf::compress::octahedral_bins(subdivisions));
        expect_served_around(normal, acdf::compress::latlong_bins(12, 6));
    }
}

} // namespace
