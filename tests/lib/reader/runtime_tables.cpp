// Runtime tables beside the walk of the tree that they stand for: the same cell for every draw, the same density
// for every direction, on golden files, random trees and every fit.
#include "tests/extremes/targets.h"
#include "tests/lib/compress/checks.h"
#include "tests/lib/reader/random.h"

#include "compress/store.h"
#include "tests/lib/reader/tables_pair.h"

#include <acdf/reader.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace {

using namespace acdf_test;

struct Pair : TablesPair {
    using TablesPair::TablesPair;
    const AcdfCells* cells() const { return fast.environment().data().cells; }
};

/// Numbers and directions that were asked, and for how many the tables told the answer.
struct Served {
    std::size_t draws = 0, directions = 0, of_draws = 0, of_directions = 0;
};

std::uint32_t bits_of(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

void expect_same_density(const Pair& pair, const float direction[3], Served& served) {
    const float fast = pair.fast.environment().pdf(direction), plain = pair.plain.environment().pdf(direction);
    ASSERT_EQ(bits_of(fast), bits_of(plain)) << direction[0] << ' ' << direction[1] << ' ' << direction[2];
    float told;
    ++served.directions;
    served.of_directions += pair.cells() && acdf_cells_pdf(pair.cells(), direction, &told);
}

/// A draw, its density, and the densities of directions that rounding could make of it.
void expect_same_draw(const Pair& pair, double u0, double u1, Served& served) {
    const acdf::DirectionSample fast = pair.fast.environment().sample(u0, u1);
    const acdf::DirectionSample plain = pair.plain.environment().sample(u0, u1);
    ASSERT_EQ(bits_of(fast.pdf), bits_of(plain.pdf)) << u0 << ' ' << u1; // of another cell it is another one
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(fast.direction[i], plain.direction[i], 4e-7) << u0 << ' ' << u1;
    ++served.draws;
    if (!pair.cells()) return; // tilts magnify the rounding of directions
    AcdfDirectionSample told;
    served.of_draws += acdf_cells_sample(pair.cells(), u0, u1, &told) != 0;
    ASSERT_EQ(bits_of(pair.fast.environment().pdf(fast.direction)), bits_of(fast.pdf)) << u0 << ' ' << u1;
    ASSERT_EQ(bits_of(pair.plain.environment().pdf(fast.direction)), bits_of(fast.pdf)) << u0 << ' ' << u1;
    const double length =
        std::sqrt(double{fast.direction[0]} * fast.direction[0] + double{fast.direction[1]} * fast.direction[1] +
                  double{fast.direction[2]} * fast.direction[2]);
    float again[3];
    for (int i = 0; i < 3; ++i) again[i] = static_cast<float>(fast.direction[i] / length);
    ASSERT_EQ(bits_of(pair.fast.environment().pdf(again)), bits_of(fast.pdf)) << u0 << ' ' << u1;
}

void direction_of(double phi, double z, float out[3]) {
    const double sine = std::sqrt((1.0 - z) * (1.0 + z));
    out[0] = static_cast<float>(sine * std::cos(phi));
    out[1] = static_cast<float>(sine * std::sin(phi));
    out[2] = static_cast<float>(z);
}

/// A direction on a border between columns or rows, or `off` (radians) beside it; `free` says where along it.
void direction_at_border(const AcdfGrid& grid, int axis, std::uint32_t step, double off, double free,
                         float out[3]) {
    const double part = static_cast<double>(step) / (axis == 0 ? grid.columns : grid.rows);
    if (acdf_grid_is_octahedral(&grid)) {
        const double at = part + off / ACDF_OCTAHEDRAL_LEAST_SPEED;
        double d[3];
        acdf_octahedral_direction(axis == 0 ? at : free, axis == 0 ? free : at, d);
        for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(d[i]);
    } else if (axis == 0) {
        direction_of(M_PI * (1.0 - 2.0 * part) + off, 1.0 - 2.0 * free, out);
    } else {
        direction_of(2.0 * M_PI * free, std::cos(M_PI * part + off), out);
    }
}

Served expect_agreement(const Pair& pair, int count) {
    Served served, edges;
    std::mt19937_64 random(5);
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        const auto step0 = static_cast<float>(random() >> 40) * 0x1p-24f;
        const auto step1 = static_cast<float>(random() >> 40) * 0x1p-24f;
        double wide[2];
        acdf_widen(step0, step1, wide);
        expect_same_draw(pair, uniform(random), uniform(random), served);
        expect_same_draw(pair, double{step0}, double{step1}, served);
        expect_same_draw(pair, wide[0], wide[1], served);
        float direction[3];
        direction_of(2.0 * M_PI * uniform(random), 2.0 * uniform(random) - 1.0, direction);
        expect_same_density(pair, direction, served);
        for (float& d : direction) d *= 1.0003f; // not quite of unit length: it counts all the same
        expect_same_density(pair, direction, edges);
        direction_of(M_PI_4 * static_cast<double>(random() % 8), 1.0 - std::exp(-30.0 * uniform(random)),
                     direction);
        expect_same_density(pair, direction, edges); // at the seams of pieces, close to the poles
    }
    // Exactly on the borders of cells, of the grids, and beside them.
    const AcdfEnvironment data = pair.plain.environment().data();
    const AcdfGrid grid = acdf_environment_grid(&data);
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        float direction[3];
        const auto column = static_cast<std::uint32_t>(random() % data.columns),
                   row = static_cast<std::uint32_t>(random() % data.rows);
        const double off = (uniform(random) - 0.5) * std::exp2(-20.0 - 10.0 * uniform(random));
        direction_at_border(grid, 0, column, off, uniform(random), direction);
        expect_same_density(pair, direction, edges);
        direction_at_border(grid, 1, row, off, uniform(random), direction);
        expect_same_density(pair, direction, edges);
        const double u[2] = {static_cast<double>(random() % 256) / 256.0,
                             static_cast<double>(random() % 65536) / 65535.0};
        expect_same_draw(pair, u[0], u[1], edges);
        expect_same_draw(pair, u[1], uniform(random), edges);
        expect_same_draw(pair, std::nextafter(u[1], 0.0), std::nextafter(u[0], 1.0), edges);
    }
    return served;
}

void expect_nearly_all(const Served& served) {
    EXPECT_GT(double(served.of_draws), 0.99 * double(served.draws));
    EXPECT_GT(double(served.of_directions), 0.99 * double(served.directions));
}

std::vector<std::uint8_t> stored(const acdf::compress::Target& target, const acdf::compress::FitOptions& options) {
    auto description =
        acdf::compress::environment_description(target.columns, target.rows, target.parameterization);
    description.fit = options.fit;
    description.total = acdf::compress::integral(target);
    return acdf::compress::store(acdf::compress::fit(target, options).tree, description);
}

TEST(RuntimeTables, AgreeOnGoldenFiles) {
    int environments = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0")) {
        if (entry.path().extension() != ".acdf") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        Pair pair({std::istreambuf_iterator<char>(in), {}});
        if (pair.plain.kind() != ACDF_KIND_ENVIRONMENT) continue;
        SCOPED_TRACE(entry.path().filename());
        ++environments;
        expect_agreement(pair, 3000);
        if (HasFatalFailure()) return;
    }
    EXPECT_GE(environments, 8);
}

// Shared curves, dark segments, cells of one step, every width of every array.
TEST(RuntimeTables, AgreeOnRandomTrees) {
    int with_tables = 0;
    for (std::uint32_t seed = 0; seed < 150; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = seed % 10 == 0;
        options.octahedral = seed % 7 < 3;
        SCOPED_TRACE(seed);
        Pair pair(RandomTree(seed, options).make().encode());
        with_tables += pair.cells() != nullptr;
        expect_agreement(pair, 200);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(with_tables, 100);
}

class RuntimeTablesOf : public testing::TestWithParam<NamedTarget> {};

TEST_P(RuntimeTablesOf, EveryFitAgree) {
    for (const NamedFit& fit : all_fits(9, 7, 60)) {
        SCOPED_TRACE(fit.name);
        Pair pair(stored(GetParam().target, fit.options));
        expect_agreement(pair, 1000);
        if (HasFatalFailure()) return;
    }
}
INSTANTIATE_TEST_SUITE_P(Probes, RuntimeTablesOf, testing::ValuesIn(extreme_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Octahedral, RuntimeTablesOf, testing::ValuesIn(octahedral_extremes()),
                         [](const auto& info) { return info.param.name; });

// As many cells as files in use have: nearly all that is asked is told by the tables, in bounded memory.
TEST(RuntimeTables, ServeNearlyAllOfUsualFiles) {
    const auto sky =
        texel_target(512, 256, [random = std::mt19937_64(3)](std::uint32_t c, std::uint32_t r) mutable {
            const double x = c / 512.0, y = r / 256.0;
            const double clouds = 1.0 + std::sin(17.0 * x + 3.0 * std::sin(11.0 * y)) * std::sin(23.0 * y);
            const bool sun = std::hypot(2.0 * (x - 0.6), y - 0.25) < 0.004;
            return sun ? 30000.0 : (y < 0.5 ? 0.3 + clouds : 0.1) * (0.8 + 0.4 * uniform(random));
        });
    for (const std::uint32_t cells : {500u, 4000u, 16000u}) {
        acdf::compress::FitOptions options;
        options.goal.cells = cells;
        for (const auto& target : {sky, octahedral(sky)}) {
            Pair pair(stored(target, options));
            ASSERT_NE(pair.cells(), nullptr);
            expect_nearly_all(expect_agreement(pair, 20000));
        }
    }
}

// The cells of a stratum of numbers are those of the walk, and within a cell directions are in the order of
// numbers.
void expect_monotone(const acdf::compress::Target& target) {
    acdf::compress::FitOptions options;
    options.goal.cells = 300;
    Pair pair(stored(target, options));
    const acdf::EnvironmentView view = pair.fast.environment();
    for (int line = 0; line < 40; ++line) {
        const double fixed = (line + 0.5) / 40.0;
        for (int axis = 0; axis < 2; ++axis) {
            AcdfRange before[2] = {};
            double last = 0.0;
            for (int i = 0; i < 4000; ++i) {
                double u[2] = {fixed, fixed};
                u[axis] = (i + 0.5) / 4000.0;
                const auto s = view.sample(u[0], u[1]);
                double place[2] = {-std::atan2(s.direction[1], s.direction[0]), -double{s.direction[2]}};
                if (target.parameterization == ACDF_PARAM_OCTAHEDRAL) {
                    const double d[3] = {s.direction[0], s.direction[1], s.direction[2]};
                    acdf_octahedral_point(d, &place[0], &place[1]);
                }
                AcdfRange range[2];
                acdf_sphere_ranges(64, 32, range);
                acdf_tree_sample(view.data().tree, view.data().root, u, range);
                const bool same = i > 0 && range[0].low == before[0].low && range[1].low == before[1].low;
                if (same) {
                    ASSERT_GE(place[axis], last - 3e-7) << fixed << " " << i;
                }
                std::copy(range, range + 2, before);
                last = place[axis];
            }
        }
    }
}
TEST(RuntimeTables, AreMonotoneWithinACell) {
    expect_monotone(noise_target(64, 32, 9));
    expect_monotone(octahedral(noise_target(64, 32, 9)));
}

TEST(RuntimeTables, AreLeftOutWhereAsked) {
    acdf::compress::FitOptions options;
    options.goal.cells = 100;
    Pair pair(stored(noise_target(64, 32, 9), options));
    EXPECT_GT(pair.fast.table_bytes(), 0u);
    EXPECT_EQ(pair.plain.environment().data().cells, nullptr);
}

} // namespace
