// Local environments on one tree of halvings: what calls return, against sums worked out here.
#include "tests/lib/compress/chi_square.h"
#include "tests/lib/reader/load.h"
#include "tests/lib/reader/normals_builder.h"

#include <acdf/acdf.h>
#include <acdf/moved.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

using namespace acdf_test;

namespace {

class OpenedNormals : public OpenedFile {
public:
    explicit OpenedNormals(const NormalsSpec& spec, bool tables = true) : OpenedFile(spec.encode(), tables) {}
    acdf::LocalEnvironmentView view() const { return file().local(); }
    AcdfGrid grid() const {
        const AcdfEnvironment whole = view().environment().data();
        return acdf_environment_grid(&whole);
    }
};

using AnyVector = std::array<float, 3>;

AnyVector any_direction(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const double v[3] = {normal(random), normal(random), normal(random)};
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {float(v[0] / length), float(v[1] / length), float(v[2] / length)};
}

/// The mixture of rows that serves a normal.
struct Mixture {
    bool stored = true;
    double sum = 0.0; ///< 0: no light
    std::vector<RowCell> cells;

    Mixture(const NormalsSpec& spec, const AnyVector& normal) {
        AcdfNormalBins bins;
        EXPECT_TRUE(acdf_octahedral_bins(spec.subdivisions, normal.data(), &bins));
        for (int i = 0; i < bins.count; ++i) {
            stored = stored && spec.bins[bins.bin[i]].root != no_root;
            sum += bins.weight[i] * double{spec.bins[bins.bin[i]].share};
        }
        for (int i = 0; i < bins.count && stored && sum > 0.0; ++i) {
            const BinSpec& bin = spec.bins[bins.bin[i]];
            const std::vector<RowCell> row = spec.cells(bin.root);
            if (cells.empty()) cells.resize(row.size());
            for (std::size_t c = 0; c < row.size(); ++c) {
                std::memcpy(cells[c].box, row[c].box, sizeof row[c].box);
                cells[c].probability += bins.weight[i] * double{bin.share} / sum * row[c].probability;
            }
        }
    }

    double pdf(const AcdfGrid& grid, const std::uint32_t square[2]) const {
        for (const RowCell& cell : cells) {
            const auto& box = cell.box;
            if (square[0] < box[0][0] || square[0] >= box[0][1] || square[1] < box[1][0] || square[1] >= box[1][1])
                continue;
            const AcdfRange range[2] = {{box[0][0], box[0][1]}, {box[1][0], box[1][1]}};
            return cell.probability / acdf_grid_solid_angle(&grid, range);
        }
        return 0.0;
    }
};

TEST(NormalRows, pdfIsThatOfTheMixture) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        std::mt19937_64 random(seed);
        const NormalsSpec spec = random_normals(seed);
        const OpenedNormals opened(spec, seed % 2 == 0);
        const acdf::LocalEnvironmentView view = opened.view();
        const AcdfGrid grid = opened.grid();
        for (int n = 0; n < 40; ++n) {
            const AnyVector normal = any_direction(random), direction = any_direction(random);
            const Mixture mixture(spec, normal);
            std::uint32_t square[2];
            double position[2], expected = double{view.environment().pdf(direction.data())};
            ASSERT_TRUE(acdf_grid_square(&grid, direction.data(), square, position));
            EXPECT_EQ(view.stored(normal.data()), mixture.stored && mixture.sum > 0.0);
            if (mixture.stored) expected = mixture.pdf(grid, square);
            if (mixture.sum > 0.0 || !mixture.stored) {
                const double cosine =
                    normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
                const double share = double{spec.cosine_share};
                expected = (1.0 - share) * expected + share * std::max(0.0, cosine) / acdf_test::pi;
            }
            EXPECT_NEAR(view.pdf(normal.data(), direction.data()), expected, 1e-3 * expected) << seed << ' ' << n;
        }
    }
}

TEST(NormalRows, pdfIsThatOfTheSample) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        const OpenedNormals opened(random_normals(seed), seed % 2 == 1);
        const acdf::LocalEnvironmentView view = opened.view();
        for (int n = 0; n < 500; ++n) {
            const AnyVector normal = any_direction(random);
            double u[2] = {unit(random), unit(random)};
            if (n < 9) u[0] = 0.5 * (n % 3), u[1] = 0.5 * (n / 3);
            const acdf::DirectionSample s = view.sample(normal.data(), u[0], u[1]);
            if (s.pdf > 0.0f) {
                ASSERT_EQ(s.pdf, view.pdf(normal.data(), s.direction)) << seed << ' ' << n;
            } else {
                EXPECT_FALSE(view.stored(normal.data()));
            }
        }
    }
}

TEST(NormalRows, lookupsAreDescents) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        const NormalsSpec spec = random_normals(seed);
        const OpenedNormals fast(spec), plain(spec, false);
        for (int n = 0; n < 300; ++n) {
            const AnyVector normal = any_direction(random), direction = any_direction(random);
            const double u0 = unit(random), u1 = unit(random);
            EXPECT_EQ(fast.view().pdf(normal.data(), direction.data()),
                      plain.view().pdf(normal.data(), direction.data()));
            const acdf::DirectionSample a = fast.view().sample(normal.data(), u0, u1),
                                        b = plain.view().sample(normal.data(), u0, u1);
            EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << seed << ' ' << n;
        }
    }
}

/// Over rectangles of grid squares.
TEST(NormalRows, samplesFollowThePdf) {
    const AnyVector normal = {0.4f, -0.6f, 0.7f};
    for (std::uint32_t seed = 1; seed < 9; ++seed) {
        NormalsSpec spec = random_normals(seed);
        spec.cosine_share = 0.0f;
        for (BinSpec& bin : spec.bins) bin.root = bin.root == no_root ? 0 : bin.root, bin.share += 0.1f;
        const OpenedNormals opened(spec);
        const AcdfGrid grid = opened.grid();
        const std::uint32_t step[2] = {1 + grid.columns / 24, 1 + grid.rows / 24};
        const std::uint32_t across = (grid.columns - 1) / step[0] + 1, down = (grid.rows - 1) / step[1] + 1;
        std::vector<double> probability(std::size_t{across} * down, 0.0);
        const Mixture mixture(spec, normal);
        for (std::uint32_t y = 0; y < grid.rows; ++y)
            for (std::uint32_t x = 0; x < grid.columns; ++x) {
                const std::uint32_t square[2] = {x, y};
                const AcdfRange range[2] = {{x, x + 1}, {y, y + 1}};
                probability[y / step[1] * across + x / step[0]] +=
                    mixture.pdf(grid, square) * acdf_grid_solid_angle(&grid, range);
            }
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        std::vector<std::uint32_t> observed(probability.size());
        for (int n = 0; n < 30000; ++n) {
            const acdf::DirectionSample s = opened.view().sample(normal.data(), unit(random), unit(random));
            std::uint32_t square[2];
            double position[2];
            ASSERT_TRUE(acdf_grid_square(&grid, s.direction, square, position));
            ++observed[square[1] / step[1] * across + square[0] / step[0]];
        }
        const ChiSquare test = chi_square(observed, probability);
        EXPECT_GT(test.p_value, sidak(1e-3, 8)) << seed << ", " << test.statistic << " of " << test.degrees;
        EXPECT_FALSE(test.impossible);
    }
}

TEST(NormalRows, irradianceIsTheLightOfTheBins) {
    const NormalsSpec spec = small_normals();
    const OpenedNormals opened(spec);
    const float up[3] = {0.0f, 0.0f, 2.0f}, down[3] = {0.0f, 0.0f, -1.0f};
    EXPECT_NEAR(opened.view().irradiance(up), spec.tree.total * double{spec.bins[0].share}, 1e-12);
    EXPECT_NEAR(opened.view().irradiance(down), spec.tree.total * double{spec.bins[5].share}, 1e-12);
    const float between[3] = {1.0f, 1.0f, 0.0f}; // halfway from +x to +y
    EXPECT_NEAR(opened.view().irradiance(between), spec.tree.total * (0.25 + 0.125) / std::sqrt(2.0), 1e-12);
    const float unstored[3] = {-1.0f, 0.0f, 0.0f}; // bin 3
    EXPECT_FALSE(opened.view().stored(unstored));
    EXPECT_EQ(opened.view().irradiance(unstored), spec.tree.total);
}

TEST(NormalRows, viewsMove) {
    const OpenedNormals opened(random_normals(3));
    AcdfFile* file = acdf_from_memory(opened.bytes().data(), opened.bytes().size(), nullptr);
    ASSERT_NE(file, nullptr);
    AcdfLocal local;
    ASSERT_EQ(acdf_local(file, &local), 1);
    AcdfMove moves[ACDF_MAX_MOVES];
    const int count = acdf_memory(file, moves);
    std::vector<std::vector<std::uint64_t>> copies;
    for (int i = 0; i < count; ++i) {
        copies.emplace_back((moves[i].bytes + 7) / 8 + 8);
        auto at = reinterpret_cast<std::uintptr_t>(copies.back().data());
        auto* to = reinterpret_cast<std::uint8_t*>((at + 63) / 64 * 64);
        std::memcpy(to, moves[i].from, moves[i].bytes);
        moves[i].to = to;
    }
    acdf_move_local(&local, moves, count);
    acdf_close(file);
    std::mt19937_64 random(1);
    for (int n = 0; n < 100; ++n) {
        const AnyVector normal = any_direction(random);
        const AcdfDirectionSample s = acdf_local_sample(&local, normal.data(), 0.01 * n, std::fmod(0.37 * n, 1.0));
        const acdf::DirectionSample t = opened.view().sample(normal.data(), 0.01 * n, std::fmod(0.37 * n, 1.0));
        EXPECT_EQ(std::memcmp(&s.pdf, &t.pdf, sizeof s.pdf), 0);
        if (s.pdf > 0.0f) {
            EXPECT_EQ(std::memcmp(&s, &t, sizeof s), 0);
        }
    }
}

} // namespace
