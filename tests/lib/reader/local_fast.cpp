// acdf/local_fast.h against a decoder written from the specification, on files of which no fit would think; with
// runtime tables and without, by products, moved and as C.
#include "tests/inputs/directions.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/local_fast_random.h"
#include "tests/lib/reader/local_loaded.h"
#include "tests/lib/reader/local_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace acdf_test;

extern "C" void acdf_c_local_sample(const AcdfLocal* local, const float normal[3], double u0, double u1,
                                    AcdfDirectionSample* out);

namespace {

using acdf_reference::Local;

const std::uint32_t kFastFiles = acdf_test::kSanitized ? 100 : 160;

Normal normal_of_any_length(std::mt19937_64& rng) {
    if (rng() % 4 == 0) {
        const Normal n = edge_normal(rng);
        return n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f ? Normal{0.0f, 0.0f, 1.0f} : n;
    }
    Normal n = random_direction(rng);
    for (float& x : n) x *= static_cast<float>(std::exp(3.0 * double(rng() % 5) - 6.0));
    return n;
}

struct FastFile {
    Bytes bytes;
    acdf::File file;

    FastFile(LocalSpec spec, bool tables) : bytes(spec.encode()) {
        acdf::LoadOptions options;
        options.tables = tables;
        const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, options);
        EXPECT_TRUE(status.ok()) << status.message;
    }
};

TEST(FastShape, AgreesWithTheSlowDecoder) {
    int sampled = 0, groups = 0;
    for (std::uint32_t seed = 0; seed < kFastFiles; ++seed) {
        const FastFile loaded(random_fast(seed), seed % 3 != 0);
        const Local reference(loaded.bytes);
        const acdf::LocalEnvironmentView view = loaded.file.local();
        ASSERT_NE(view.data().fast.grid, nullptr);
        groups += view.data().blend.tiles->tile_count > 16;
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 200; ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", sample " + std::to_string(i));
            const Normal normal = normal_of_any_length(rng);
            const Local::Vector n = {double{normal[0]}, double{normal[1]}, double{normal[2]}};
            const double u0 = uniform(rng), u1 = uniform(rng), sigma = reference.sigma;
            const Local::Source source = reference.source(n);
            const acdf::DirectionSample s = view.sample(normal.data(), u0, u1);
            ASSERT_EQ(s.pdf > 0.0f, source.what != Local::Source::nothing);
            const double d[3] = {s.direction[0], s.direction[1], s.direction[2]};
            if (s.pdf > 0.0f && u0 >= sigma) {
                const auto expected =
                    reference.sample_light(source, sigma > 0 ? (u0 - sigma) / (1 - sigma) : u0, u1);
                for (int k = 0; k < 3; ++k) ASSERT_NEAR(d[k], expected.direction[k], 4e-7);
                const double cosine = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / std::hypot(n[0], n[1], n[2]);
                const double pdf = (1 - sigma) * expected.pdf + sigma * std::max(0.0, cosine) / pi;
                ASSERT_NEAR(s.pdf / pdf, 1.0, 1e-5);
                ++sampled;
            }
            const Normal any = random_direction(rng);
            float f[3];
            acdf_as_given(any.data(), f);
            const double expected = reference.pdf(n, {double{f[0]}, double{f[1]}, double{f[2]}});
            ASSERT_NEAR(view.pdf(normal.data(), f), expected, 1e-5 * expected);
        }
    }
    EXPECT_GT(sampled, 10000);
    EXPECT_GT(groups, 30);
}

// To the bit, for random numbers of every kind; and nothing with energy is out of reach.
TEST(FastShape, PdfOfASampleIsExact) {
    const double edges[] = {0.0, 1.0, 0.5, 1.0 - 0x1p-24, 1.0 - 0x1p-53, 0x1p-30, 0x1p-1000};
    for (std::uint32_t seed = 0; seed < kFastFiles; ++seed) {
        const FastFile with(random_fast(seed), true), without(random_fast(seed), false);
        const acdf::LocalEnvironmentView view = with.file.local(), plain = without.file.local();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 600; ++i) {
            const Normal n = normal_of_any_length(rng);
            const double u0 = rng() % 8 == 0 ? edges[rng() % 7] : uniform(rng);
            const double u1 = rng() % 8 == 0 ? edges[rng() % 7] : uniform(rng);
            const acdf::DirectionSample s = view.sample(n.data(), u0, u1), t = plain.sample(n.data(), u0, u1);
            ASSERT_TRUE(std::isfinite(s.pdf));
            ASSERT_EQ(s.pdf > 0.0f, t.pdf > 0.0f);
            if (s.pdf == 0.0f) continue;
            ASSERT_EQ(view.pdf(n.data(), s.direction), s.pdf) << "seed " << seed << ", sample " << i;
            ASSERT_EQ(plain.pdf(n.data(), t.direction), t.pdf) << "seed " << seed << ", sample " << i;
            ASSERT_EQ(plain.pdf(n.data(), s.direction), s.pdf) << "seed " << seed << ", sample " << i;
            ASSERT_NEAR(std::hypot(s.direction[0], s.direction[1], s.direction[2]), 1.0, 1e-6);
        }
    }
}

// Of each square of the grid: its pdf and its solid angle.
TEST(FastShape, IntegratesToOne) {
    for (const bool octahedral : {false, true})
        for (std::uint32_t seed = 0; seed < 24; ++seed) {
            RandomOptions options;
            options.columns = octahedral ? 40 : 44;
            options.rows = octahedral ? 40 : 23;
            options.octahedral = octahedral;
            options.long_curves = false;
            LocalSpec spec = RandomFast(seed, options).make();
            spec.cosine_share = 0.0f;
            const FastFile loaded(spec, true);
            const acdf::LocalEnvironmentView view = loaded.file.local();
            const AcdfGrid grid = acdf_environment_grid(&view.data().environment);
            std::mt19937_64 rng(seed);
            for (int i = 0; i < 6; ++i) {
                const Normal normal = normal_of_any_length(rng);
                const AcdfLocalPoint point = view.at(normal.data());
                if (point.what != ACDF_LOCAL_FAST) continue;
                double sum = 0.0;
                for (std::uint32_t row = 0; row < options.rows; ++row)
                    for (std::uint32_t column = 0; column < options.columns; ++column) {
                        AcdfRange range[2] = {{column, column + 1, 0.0}, {row, row + 1, 0.0}};
                        const double middle[2] = {0.5, 0.5};
                        const acdf::DirectionSample s = acdf_grid_position(&grid, range, middle, 1.0);
                        sum += acdf_grid_solid_angle(&grid, range) * double{view.pdf(point, s.direction)};
                    }
                EXPECT_NEAR(sum, 1.0, 1e-6) << seed;
            }
        }
}

// By hand: at +x row 1 alone, 200 of 255 in tile 0; there 110 of 255 in line 2, the second cell of which has 80.
TEST(FastShape, HandMadePdfs) {
    const FastFile loaded(fast_local(), true);
    const acdf::LocalEnvironmentView view = loaded.file.local();
    const float x[3] = {7.0f, 0.0f, 0.0f};
    const auto at = [&](double column, double row) { // positions
        const double phi = pi - 2 * pi * column / 8, theta = pi * row / 8;
        const float d[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                            static_cast<float>(std::sin(theta) * std::sin(phi)),
                            static_cast<float>(std::cos(theta))};
        return static_cast<double>(view.pdf(x, d));
    };
    const double bright = 200.0 / 255.0 * (110.0 / 255.0) * (80.0 / 255.0) /
                          (2 * pi / 8 * (std::cos(4 * pi / 8) - std::cos(6 * pi / 8)));
    EXPECT_NEAR(at(1.5, 5.5) / bright, 1.0, 1e-6);
    EXPECT_EQ(at(1.5, 3.0), 0.0); // line 1
    EXPECT_EQ(at(1.5, 1.0), 0.0); // the second cell of line 0
    EXPECT_EQ(at(5.0, 1.0), 0.0); // tile 1
    const double cut = 55.0 / 255.0 * (60.0 / 255.0) * (165.0 / 255.0) /
                       (2 * pi / 8 * (std::cos(2 * pi / 8) - std::cos(6 * pi / 8)));
    EXPECT_NEAR(at(7.5, 3.0) / cut, 1.0, 1e-6); // the last cell of the line has one column
    EXPECT_NEAR(view.irradiance(x), 3.0 * 0.25, 1e-6);
    EXPECT_TRUE(view.stored(x));
    const float back[3] = {-1, 0, 0}; // is not stored
    EXPECT_FALSE(view.stored(back));
    EXPECT_GT(view.sample(back, 0.3, 0.6).pdf, 0.0f);
}

std::uint32_t walked_from(const AcdfLocal& local, std::uint32_t node, const std::uint32_t* square) {
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = local.blend.splits[node];
        node = split.child[square[split.place & 7u] >= split.place >> 3];
    }
    return node;
}

// Of each square of the grid: tables find the tile, or a split on the way to it, and both happen, by all levels of
// blocks that there can be.
TEST(FastShape, TablesFindTheTilesOfSquares) {
    int at_once = 0, walked = 0, files[ACDF_TILE_BLOCK_LEVELS + 1] = {};
    for (std::uint32_t seed = 0; seed < kFastFiles; ++seed) {
        const FastFile loaded(random_fast(seed), true);
        const AcdfLocal local = loaded.file.local().data();
        ASSERT_NE(local.tables, nullptr);
        ++files[local.tables->blocks.levels];
        for (std::uint32_t row = 0; row < local.environment.rows; row += acdf_test::kSanitized ? 5 : 1)
            for (std::uint32_t column = 0; column < local.environment.columns; ++column) {
                const std::uint32_t square[2] = {column, row};
                const std::uint32_t node =
                    acdf_tile_block_at(acdf_local_words(local.tables), &local.tables->blocks, square);
                ASSERT_EQ(walked_from(local, node, square),
                          walked_from(local, acdf_blend_root(&local.blend), square))
                    << "seed " << seed << ", " << column << ", " << row;
                ++(node & ACDF_TILE_FLAG ? at_once : walked);
            }
    }
    EXPECT_GT(at_once, 1000);
    EXPECT_GT(walked, 100);
    EXPECT_EQ(files[0], 0);
    for (int levels = 1; levels <= ACDF_TILE_BLOCK_LEVELS; ++levels) EXPECT_GT(files[levels], 10) << levels;
}

// The same where all entries of the grid, as many as it can have, are cut: along one axis by cuts that many entries
// share, then along both, where there are more blocks of several levels than numbers.
void find_tiles_where_all_is_cut(std::uint32_t across, std::uint32_t along, std::uint32_t levels) {
    RandomOptions options;
    options.columns = options.rows = 65536;
    options.tilts = options.long_curves = false;
    options.octahedral = true;
    const FastFile loaded(RandomFast(5, options).make_cut_evenly(across, along), true);
    const AcdfLocal local = loaded.file.local().data();
    ASSERT_NE(local.tables, nullptr);
    EXPECT_EQ(local.tables->blocks.levels, levels);
    for (std::uint32_t row = 0; row < 65536; row += acdf_test::kSanitized ? 8191 : 509)
        for (std::uint32_t column = 0; column < 65536; column += 61) {
            const std::uint32_t square[2] = {column, row};
            const std::uint32_t node =
                acdf_tile_block_at(acdf_local_words(local.tables), &local.tables->blocks, square);
            ASSERT_EQ(walked_from(local, node, square), walked_from(local, acdf_blend_root(&local.blend), square))
                << column << ", " << row;
        }
}

TEST(FastShape, TablesFindTheTilesOfSquaresThatAreAllCut) {
    find_tiles_where_all_is_cut(256, 8, ACDF_TILE_BLOCK_LEVELS);
    find_tiles_where_all_is_cut(70, 70, 2);
    find_tiles_where_all_is_cut(127, 101, 1);
}

// A sample for a normal that serves once is that at its point, to the bit: also where bright tiles end.
TEST(FastShape, SamplesOfANormalAreThoseOfItsPoint) {
    int lit = 0;
    for (std::uint32_t seed = 0; seed < kFastFiles; ++seed) {
        const FastFile loaded(random_fast(seed), true);
        const acdf::LocalEnvironmentView view = loaded.file.local();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 60; ++i) {
            const Normal normal = normal_of_any_length(rng);
            const AcdfLocalPoint point = view.at(normal.data());
            const double border = point.sum > 0.0 ? point.bright_tiles / point.sum : 0.5;
            double below = border;
            lit += point.bright_tiles > 0.0;
            for (const double u0 :
                 {0.0, 1.0, border, below = std::nextafter(below, 0.0), below = std::nextafter(below, 0.0),
                                    uniform(rng) * border, uniform(rng)}) {
                const double u1 = uniform(rng);
                const AcdfDirectionSample once = view.sample(normal.data(), u0, u1),
                                          at = view.sample(point, u0, u1);
                ASSERT_EQ(std::memcmp(&once, &at, sizeof at), 0) << "seed " << seed << ", " << i << ", " << u0;
            }
        }
    }
    EXPECT_GT(lit, 1000);
}

TEST(FastShape, StrataStayStrata) {
    const FastFile loaded(random_fast(7), true);
    const acdf::LocalEnvironmentView view = loaded.file.local();
    const float n[3] = {0.3f, -0.5f, 0.8f};
    const AcdfLocalPoint point = view.at(n);
    ASSERT_EQ(point.what, ACDF_LOCAL_FAST);
    double before = -1.0;
    for (int i = 0; i <= 100000; ++i) { // tiles are sampled in their order within a group, groups in theirs
        double u[2] = {0.0, 0.5};
        const double whole = 32767.0 * point.by.fast.mix.whole;
        AcdfFastShare share;
        const std::uint32_t tile = acdf_fast_sample_tile(&view.data().fast, &point.by.fast.mix,
                                                         acdf_fast_scaled(i / 100000.0, whole), u, &share);
        ASSERT_GE(double(tile / ACDF_FAST_GROUP), before);
        ASSERT_GE(u[0], 0.0);
        ASSERT_LE(u[0], 1.0);
        before = tile / ACDF_FAST_GROUP;
    }
}

TEST(FastShape, IsTheSameInC) {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const FastFile loaded(random_fast(seed), true);
        const acdf::LocalEnvironmentView view = loaded.file.local();
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 100; ++i) {
            const Normal normal = normal_of_any_length(rng);
            const double u0 = uniform(rng), u1 = uniform(rng);
            const acdf::DirectionSample one = view.sample(normal.data(), u0, u1);
            AcdfDirectionSample c;
            acdf_c_local_sample(&view.data(), normal.data(), u0, u1, &c);
            EXPECT_EQ(std::memcmp(&one, &c, sizeof c), 0);
        }
    }
}

} // namespace
