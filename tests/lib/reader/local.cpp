// acdf/local.h against a decoder written from the specification, on files of which no fit would think.
#include "tests/inputs/directions.h"
#include "tests/lib/curves/open.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/local_loaded.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/local_reference.h"
#include "tests/lib/reader/normals_builder.h"

#include <acdf/acdf.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace acdf_test;

extern "C" void acdf_c_local_sample(const AcdfLocal* local, const float normal[3], double u0, double u1,
                                    AcdfDirectionSample* out);

namespace {

using acdf_reference::Local;

// Files of both parameterizations: the first `latlong_count` are lat-long, the others octahedral.
constexpr std::uint32_t latlong_count = 80, file_count = 2 * latlong_count;

LocalSpec random_local(std::uint32_t seed, bool tilts) {
    RandomOptions options;
    options.columns = seed % 3 == 0 ? 1 + seed : seed % 3 == 1 ? 64 : 5000;
    options.rows = seed % 4 == 0 ? 33 : 1 + 7 * seed;
    options.depth = 3 + static_cast<int>(seed % 3);
    options.tilts = tilts;
    options.long_curves = false;
    options.octahedral = seed >= latlong_count;
    LocalSpec spec = RandomLocal(seed, options).make();
    spec.zlib = seed % 5 == 0;
    return spec;
}

struct AnyNormal {
    float n[3];
    Local::Vector exact() const { return {double{n[0]}, double{n[1]}, double{n[2]}}; }
};

// Anywhere, of any length, and where bins meet: on the axes, on edges of the octahedron, in its corners.
AnyNormal any_normal(std::mt19937_64& rng) {
    const auto step = [&] { return static_cast<float>(static_cast<int>(rng() % 7) - 3); };
    switch (rng() % 4) {
    case 0: {
        AnyNormal n{{step(), step(), step()}};
        if (n.n[0] == 0.0f && n.n[1] == 0.0f && n.n[2] == 0.0f) n.n[rng() % 3] = 1.0f;
        return n;
    }
    case 1:
        return {{static_cast<float>(uniform(rng) - 0.5), 0.0f, static_cast<float>(uniform(rng) - 0.5)}};
    default: {
        const double z = 2 * uniform(rng) - 1, phi = 2 * M_PI * uniform(rng),
                     length = std::exp(20 * uniform(rng) - 10);
        const double sine = std::sqrt(1 - z * z);
        return {{static_cast<float>(length * sine * std::cos(phi)),
                 static_cast<float>(length * sine * std::sin(phi)), static_cast<float>(length * z)}};
    }
    }
}

TEST(LocalView, agreesWithTheSlowDecoder) {
    for (std::uint32_t seed = 0; seed < file_count; ++seed) {
        const LoadedLocal loaded(random_local(seed, seed % 2 == 0));
        const Local reference(loaded.bytes);
        const acdf::LocalEnvironmentView view = loaded.view();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 400; ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", sample " + std::to_string(i));
            const AnyNormal normal = any_normal(rng);
            const double u0 = uniform(rng), u1 = uniform(rng), sigma = reference.sigma;
            const Local::Source source = reference.source(normal.exact());
            const acdf::DirectionSample s = view.sample(normal.n, u0, u1);
            const double d[3] = {s.direction[0], s.direction[1], s.direction[2]};
            ASSERT_EQ(s.pdf > 0.0f, source.what != Local::Source::nothing);
            if (s.pdf == 0.0f) continue;
            if (u0 < sigma) {
                ASSERT_NEAR(s.pdf / reference.pdf(normal.exact(), d), 1.0, 1e-5);
                continue;
            }
            const auto expected = reference.sample_light(source, sigma > 0 ? (u0 - sigma) / (1 - sigma) : u0, u1);
            for (int k = 0; k < 3; ++k) ASSERT_NEAR(d[k], expected.direction[k], 3e-7);
            const auto n = normal.exact();
            const double cosine = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / std::hypot(n[0], n[1], n[2]);
            const double pdf = (1 - sigma) * expected.pdf + sigma * std::max(0.0, cosine) / M_PI;
            ASSERT_NEAR(s.pdf / pdf, 1.0, 1e-5);
        }
        for (int i = 0; i < 400; ++i) { // directions anywhere, dark ones too
            const AnyNormal normal = any_normal(rng);
            const double z = 2 * uniform(rng) - 1, phi = 2 * M_PI * uniform(rng), sine = std::sqrt(1 - z * z);
            const float rounded[3] = {static_cast<float>(sine * std::cos(phi)),
                                      static_cast<float>(sine * std::sin(phi)), static_cast<float>(z)};
            float f[3];
            acdf_as_given(rounded, f); // else gcc 12 may use the unrounded value for the reference
            const double expected = reference.pdf(normal.exact(), {double{f[0]}, double{f[1]}, double{f[2]}});
            ASSERT_NEAR(view.pdf(normal.n, f), expected, 1e-5 * expected) << seed << ' ' << i;
        }
    }
}

// To the bit, cosine share or not, for normals and random numbers of every kind.
TEST(LocalView, pdfOfASampleIsExact) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 1.0 - 0x1p-53, 0x1p-30, 0x1p-1000};
    for (std::uint32_t seed = 0; seed < file_count; ++seed) {
        const LoadedLocal loaded(random_local(seed, false));
        const acdf::LocalEnvironmentView view = loaded.view();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 2000; ++i) {
            const AnyNormal n = any_normal(rng);
            const double u0 = rng() % 8 == 0 ? edges[rng() % 7] : uniform(rng);
            const double u1 = rng() % 8 == 0 ? edges[rng() % 7] : uniform(rng);
            const acdf::DirectionSample s = view.sample(n.n, u0, u1);
            ASSERT_TRUE(std::isfinite(s.pdf));
            if (s.pdf == 0.0f) continue;
            ASSERT_EQ(view.pdf(n.n, s.direction), s.pdf) << "seed " << seed << ", sample " << i;
            ASSERT_NEAR(std::hypot(s.direction[0], s.direction[1], s.direction[2]), 1.0, 1e-6);
        }
    }
}

// Of the bins' own weights, the sum that the specification asks for: the corners add up to the normal.
TEST(NormalBins, cornersAddUpToTheNormal) {
    for (std::uint32_t n : {1u, 2u, 3u, 7u, 64u, 1023u, 1024u}) {
        std::vector<std::array<double, 3>> corners(4 * std::size_t{n} * n + 2);
        const int s = static_cast<int>(n);
        std::size_t numbered = 0;
        for (int x = -s; x <= s; ++x)
            for (int y = std::abs(x) - s; y <= s - std::abs(x); ++y)
                for (int sign : {1, -1}) {
                    const int z = sign * (s - std::abs(x) - std::abs(y));
                    if (sign < 0 && z == 0) continue;
                    const std::uint32_t bin = acdf_octahedral_corner(n, x, y, z);
                    ASSERT_LT(bin, corners.size());
                    ASSERT_EQ(bin, Local::corner(n, x, y, z));
                    corners[bin] = {double(x), double(y), double(z)};
                    ++numbered;
                }
        ASSERT_EQ(numbered, corners.size());
        std::mt19937_64 rng(n);
        for (int i = 0; i < 3000; ++i) {
            const AnyNormal normal = any_normal(rng);
            AcdfNormalBins bins;
            ASSERT_TRUE(acdf_octahedral_bins(n, normal.n, &bins));
            ASSERT_GE(bins.count, 1);
            ASSERT_LE(bins.count, 3);
            const auto exact = normal.exact();
            const double norm = std::fabs(exact[0]) + std::fabs(exact[1]) + std::fabs(exact[2]);
            for (std::size_t k = 0; k < 3; ++k) {
                double sum = 0.0;
                for (int b = 0; b < bins.count; ++b) {
                    const auto& c = corners[bins.bin[b]];
                    ASSERT_GT(bins.weight[b], 0.0);
                    sum += bins.weight[b] * c[k] / std::hypot(c[0], c[1], c[2]);
                }
                ASSERT_NEAR(sum, n * exact[k] / norm, 1e-12 * n) << n << ' ' << i;
            }
        }
    }
}

TEST(NormalBins, everyCornerServesItself) {
    constexpr std::uint32_t n = 5;
    std::set<std::uint32_t> seen;
    for (int x = -5; x <= 5; ++x)
        for (int y = -5; y <= 5; ++y)
            for (int z = -5; z <= 5; ++z) {
                if (std::abs(x) + std::abs(y) + std::abs(z) != 5) continue;
                const float normal[3] = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
                AcdfNormalBins bins;
                ASSERT_TRUE(acdf_octahedral_bins(n, normal, &bins));
                EXPECT_EQ(bins.count, 1);
                EXPECT_EQ(bins.bin[0], acdf_octahedral_corner(n, x, y, z));
                EXPECT_DOUBLE_EQ(bins.weight[0], std::sqrt(double(x * x + y * y + z * z)));
                EXPECT_TRUE(seen.insert(bins.bin[0]).second);
            }
    EXPECT_EQ(seen.size(), 102u);
}

TEST(LocalView, invalidNormalsHavePdfZero) {
    const LoadedLocal shared(small_normals().encode()), separate(separate_local());
    const float up[3] = {0.0f, 0.0f, 1.0f}, nan = std::nanf(""), inf = HUGE_VALF;
    const float bad[][3] = {{0, 0, 0},   {-0.0f, 0, 0}, {nan, 0, 1},   {0, nan, 1},
                            {1, 0, nan}, {inf, 0, 1},   {0, -inf, inf}};
    for (const LoadedLocal* loaded : {&shared, &separate})
        for (const auto& normal : bad) {
            const acdf::LocalEnvironmentView view = loaded->view();
            EXPECT_EQ(view.pdf(normal, up), 0.0f);
            EXPECT_EQ(view.sample(normal, 0.5, 0.5).pdf, 0.0f);
            EXPECT_EQ(view.sample(normal, 0.1, 0.5).pdf, 0.0f);
            EXPECT_EQ(view.irradiance(normal), 0.0);
            EXPECT_FALSE(view.stored(normal));
        }
}

TEST(LocalView, invalidDirectionsHavePdfZero) {
    NormalsSpec spec = small_normals();
    for (float cosine : {0.0f, 0.5f}) {
        spec.cosine_share = cosine;
        const LoadedLocal loaded(spec.encode());
        const float up[3] = {0.1f, 0.2f, 1.0f}, nan = std::nanf("");
        const float nans[][3] = {{nan, 0, 0}, {0, 0, nan}, {1, nan, 0}};
        for (const auto& d : nans) EXPECT_EQ(loaded.view().pdf(up, d), 0.0f);
        const float bad[][3] = {{0, 0, 0}, {0, 0, 2}, {0, 0, 0.99f}, {HUGE_VALF, 0, 0}};
        for (const auto& d : bad) EXPECT_EQ(loaded.view().pdf(up, d), 0.0f);
    }
}

TEST(LocalView, storedFiguresAreReturned) {
    const LoadedLocal shared(small_normals().encode()); // corners 0 +z, 1 +x, 2 +y, 3 -x (not stored), 4 -y, 5 -z
    const auto stored = [&](float x, float y, float z) {
        const float n[3] = {x, y, z};
        return shared.view().stored(n);
    };
    EXPECT_TRUE(stored(0, 0, 1));
    EXPECT_TRUE(stored(1, 2, -3));
    EXPECT_TRUE(stored(0, 1, 1)); // -x is not among its corners
    EXPECT_FALSE(stored(-1, 0, 0));
    EXPECT_FALSE(stored(-1e-3f, 1, 1));
    const float back[3] = {-1, 0, 0};
    EXPECT_EQ(shared.view().irradiance(back), shared.file.description().total);
    std::mt19937_64 rng(1);
    for (int i = 0; i < 200; ++i) { // there it is the environment itself
        const double u0 = uniform(rng), u1 = uniform(rng);
        const auto a = shared.view().sample(back, u0, u1), b = shared.view().environment().sample(u0, u1);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
}

TEST(LocalView, compiledAsCIsTheSame) {
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const LoadedLocal loaded(random_local(seed, true));
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 300; ++i) {
            const AnyNormal n = any_normal(rng);
            const double u0 = uniform(rng), u1 = uniform(rng);
            const auto a = loaded.view().sample(n.n, u0, u1);
            AcdfDirectionSample b;
            acdf_c_local_sample(&loaded.view().data(), n.n, u0, u1, &b);
            EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
        }
    }
}

TEST(LocalView, throughTheCInterface) {
    Bytes bytes = small_normals().encode();
    AcdfFile* file = acdf_test::from_memory_in_c(bytes.data(), bytes.size());
    ASSERT_NE(file, nullptr);
    AcdfLocal local;
    AcdfEnvironment environment;
    ASSERT_TRUE(acdf_local(file, &local));
    EXPECT_FALSE(acdf_environment(file, &environment));
    const LoadedLocal same(small_normals().encode());
    const float n[3] = {1.0f, 0.5f, 2.0f};
    const auto a = same.view().sample(n, 0.3, 0.7), b = acdf_local_sample(&local, n, 0.3, 0.7);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    acdf_close(file);
    bytes = complete_environment().encode();
    file = acdf_test::from_memory_in_c(bytes.data(), bytes.size());
    ASSERT_NE(file, nullptr);
    EXPECT_FALSE(acdf_local(file, &local));
    acdf_close(file);
}

} // namespace
