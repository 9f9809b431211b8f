// What fits of local environment maps must do at horizons, for scenes, and for any number of threads.
#include "tests/inputs/local_maps.h"
#include "tests/inputs/sanitized.h"

#include "compress/local/light.h"
#include "compress/parallel.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cstring>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

TEST(LocalFit, TheSameBytesForAnyNumberOfThreads) {
    const Target target = suns_target(128, 64);
    for (const bool sharing : {true, false}) {
        LocalFileOptions options = of_size(120, 3000);
        options.sharing = sharing;
        std::vector<std::uint8_t> first;
        for (const std::size_t threads : {1u, 2u, 7u}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const auto bytes = local_bytes(target, octahedral_bins(3), options);
            if (first.empty()) first = bytes;
            EXPECT_EQ(bytes, first) << threads;
        }
    }
}

TEST(LocalFit, CompressedFilesSampleTheSame) {
    LocalFileOptions options = of_size(100, 3000);
    const LocalMap plain(suns_target(128, 64), octahedral_bins(4), options);
    options.codec = ACDF_CODEC_ZLIB;
    const LocalMap packed(suns_target(128, 64), octahedral_bins(4), options);
    EXPECT_LT(packed.bytes.size(), plain.bytes.size());
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Normal n = random_direction(random);
        const double u0 = uniform(random), u1 = uniform(random);
        const auto a = plain.view().sample(n.data(), u0, u1), b = packed.view().sample(n.data(), u0, u1);
        ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
}

// One light, alone in the dark: whether it is small enough for a light of its own or not.
struct Lamp {
    std::uint32_t columns, rows, column, row;
};

class OneLamp : public ::testing::TestWithParam<Lamp> {
protected:
    LocalMap map() const {
        const Lamp lamp = GetParam();
        return LocalMap(texel_target(lamp.columns, lamp.rows,
                                     [=](std::uint32_t c, std::uint32_t r) {
                                         return c == lamp.column && r == lamp.row ? 5.0 : 0.0;
                                     }),
                        octahedral_bins(6), of_size(40, 500));
    }
    /// A direction in the lamp's texel, at fractions of it.
    Normal in_lamp(double s, double t) const {
        const Lamp lamp = GetParam();
        Normal d;
        direction_of(kPi - 2.0 * kPi * (lamp.column + s) / lamp.columns, std::cos(kPi * (lamp.row + t) / lamp.rows),
                     d.data());
        return d;
    }
};

TEST_P(OneLamp, IsSeenDownToTheHorizonAndNotFromBelow) {
    const LocalMap lamp = map();
    const auto view = lamp.view();
    std::mt19937_64 random(2);
    const Normal middle = in_lamp(0.5, 0.5);
    const double reach = kPi * std::hypot(0.5 / GetParam().rows, 1.0 / GetParam().columns);
    int nothing = 0;
    for (int i = 0; i < 4000; ++i) {
        const double height =
            i % 2 == 0 ? reach * (2.0 * uniform(random) - 1.0) : std::pow(10.0, -9.0 * uniform(random));
        Normal n = random_direction(random);
        const double down = dot(n.data(), middle.data());
        for (std::size_t k = 0; k < 3; ++k)
            n[k] = static_cast<float>(double{n[k]} - (down - height) * double{middle[k]});
        const Normal d = in_lamp(0.001 + 0.998 * uniform(random), 0.001 + 0.998 * uniform(random));
        const auto s = view.sample(n.data(), uniform(random), uniform(random));
        if (dot(n.data(), d.data()) > 0.0) {
            ASSERT_GT(view.pdf(n.data(), d.data()), 0.0f) << "height " << height;
        }
        if (s.pdf > 0.0f) {
            ASSERT_GT(lamp.radiance(s.direction), 0.0f);
        } else {
            ++nothing;
        }
    }
    EXPECT_LT(nothing, 4000);
}

TEST_P(OneLamp, GivesNextToNothingToNormalsThatLookAway) {
    const LocalMap lamp = map();
    const auto view = lamp.view();
    std::mt19937_64 random(3);
    const Normal middle = in_lamp(0.5, 0.5);
    int away = 0;
    for (int i = 0; i < 3000; ++i) {
        const Normal n = random_direction(random);
        if (dot(n.data(), middle.data()) > -0.5) continue; // farther than the corners of its triangle can see
        ++away;
        // A tile may reach above the horizon though nothing in it shines there.
        EXPECT_LE(view.irradiance(n.data()), 2e-3 * lamp.target.total);
    }
    EXPECT_GT(away, 500);
}

INSTANTIATE_TEST_SUITE_P(All, OneLamp,
                         ::testing::Values(Lamp{64, 32, 37, 9}, Lamp{512, 256, 0, 100}, Lamp{512, 256, 511, 255},
                                           Lamp{400, 200, 123, 0}, Lamp{16, 8, 5, 0}, Lamp{16, 8, 15, 4}),
                         [](const auto& info) {
                             return std::to_string(info.param.columns) + "_" + std::to_string(info.param.column) +
                                    "_" + std::to_string(info.param.row);
                         });

std::vector<SceneNormal> upper_half(int count) {
    std::mt19937_64 random(5);
    std::vector<SceneNormal> scene;
    while (static_cast<int>(scene.size()) < count) {
        const Normal n = random_direction(random);
        if (n[2] > 0.3f) scene.push_back({n, uniform(random) + 0.1});
    }
    return scene;
}

TEST(LocalScene, BinsThatServeNoNormalAreNotStored) {
    const Target target = suns_target(128, 64);
    NormalBins bins = octahedral_bins(6);
    const std::vector<SceneNormal> scene = upper_half(500);
    weigh(bins, scene);
    const LocalMap some(target, bins, of_size(100, 3000)), all(target, octahedral_bins(6), of_size(100, 3000));
    EXPECT_EQ(some.view().data().rows_of_normals->rows, bins.stored());
    EXPECT_LT(some.bytes.size(), all.bytes.size() - 3000);
    for (const SceneNormal& n : scene) EXPECT_TRUE(some.view().stored(n.normal.data()));
    const float down[3] = {0.1f, 0.2f, -1.0f};
    EXPECT_FALSE(some.view().stored(down));
    std::mt19937_64 random(6);
    for (int i = 0; i < 500; ++i) { // there the whole environment serves
        const double u0 = uniform(random), u1 = uniform(random);
        const auto a = some.view().sample(down, u0, u1), b = some.view().environment().sample(u0, u1);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
}

TEST(LocalFit, RefusesWhatIsDark) {
    const Target dark = sphere_target(16, 8, [](double, double) { return 0.0; });
    EXPECT_THROW(LocalHalvingsFitter(dark, octahedral_bins(2), {}), std::invalid_argument);
    EXPECT_THROW(fit_local_separate(dark, octahedral_bins(2), BinTarget::mean, {}), std::invalid_argument);
    NormalBins none = octahedral_bins(2);
    EXPECT_THROW(weigh(none, {{{0.0f, 0.0f, 0.0f}, 1.0}}), std::invalid_argument);
}

/// The mean over ten million samples, spread over a hundred normals.
TEST(LocalFit, TenMillionSamplesAgree) {
    const int normals = 100, samples = repeated(100000);
    LocalFileOptions options = of_size(200, 4000);
    options.cosine_share = 0.1;
    const LocalMap map(suns_target(128, 64), octahedral_bins(6), options);
    const std::vector<Normal> all = hard_normals(map.bins, 7, 60);
    parallel_for(0, normals, [&](int k) {
        const Normal& n = all[all.size() - 1 - std::size_t(k)];
        const auto view = map.view();
        const AcdfLocalPoint at = view.at(n.data());
        std::mt19937_64 random(std::uint64_t(100 + k));
        Sum sum, square;
        for (int i = 0; i < samples; ++i) {
            const double u0 = uniform(random), u1 = uniform(random);
            const acdf::DirectionSample s = view.sample(at, u0, u1);
            const double cosine = dot(n.data(), s.direction) / length(n.data());
            if (!(cosine > 0.0)) continue;
            const double f = static_cast<double>(map.radiance(s.direction)) * cosine / static_cast<double>(s.pdf);
            sum.add(f);
            square.add(f * f);
        }
        const double mean = sum.value() / samples, exact = map.irradiance(n);
        const double variance =
            std::max(square.value() / samples - mean * mean, second_moment(map, n.data()) - exact * exact);
        EXPECT_LE(std::fabs(mean - exact), 4.0 * std::sqrt(variance / samples))
            << n[0] << ' ' << n[1] << ' ' << n[2];
    });
}

} // namespace
