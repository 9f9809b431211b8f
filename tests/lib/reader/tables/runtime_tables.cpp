// Runtime tables beside the walk of the tree that they stand for: the same cell for every draw, the same density
// for every direction, on golden files, random trees and every fit.
#include "tests/extremes/targets.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/compress/checks.h"
#include "tests/lib/reader/environment_pair.h"

#include "compress/store/store.h"

#include <acdf/acdf.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>

namespace {

using namespace acdf_test;
using Tables = EnvironmentPair::Tables;

constexpr Tables kBoth[] = {Tables::own, Tables::groups};

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
        const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
        SCOPED_TRACE(entry.path().filename());
        for (const Tables tables : kBoth) {
            const EnvironmentPair pair(bytes, tables);
            if (pair.plain.kind() != ACDF_KIND_ENVIRONMENT) continue;
            ++environments;
            expect_agreement(pair, 1500);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GE(environments, 16);
}

// Shared curves, dark segments, cells of one step, every width of every array.
TEST(RuntimeTables, AgreeOnRandomTrees) {
    int with_tables = 0;
    for (std::uint32_t seed = 0; seed < 150; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = seed % 10 == 0;
        options.octahedral = seed % 7 < 3;
        SCOPED_TRACE(seed);
        const std::vector<std::uint8_t> bytes = RandomTree(seed, options).make().encode();
        for (const Tables tables : kBoth) {
            const EnvironmentPair pair(bytes, tables);
            with_tables += pair.has_tables();
            expect_agreement(pair, 150);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(with_tables, 200);
}

class RuntimeTablesOf : public testing::TestWithParam<NamedTarget> {};

TEST_P(RuntimeTablesOf, EveryFitAgree) {
    for (const NamedFit& fit : all_fits(9, 7, 60)) {
        SCOPED_TRACE(fit.name);
        const std::vector<std::uint8_t> bytes = stored(GetParam().target, fit.options);
        for (const Tables tables : kBoth) {
            expect_agreement(EnvironmentPair(bytes, tables), 600);
            if (HasFatalFailure()) return;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Probes, RuntimeTablesOf, testing::ValuesIn(extreme_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Octahedral, RuntimeTablesOf, testing::ValuesIn(octahedral_extremes()),
                         [](const auto& info) { return info.param.name; });

// As many cells as files in use have: nearly all that is asked is told by the tables, in bounded memory.
TEST(RuntimeTables, ServeNearlyAllOfUsualFiles) {
    ACDF_NOT_SANITIZED();
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
            const EnvironmentPair pair(stored(target, options));
            ASSERT_NE(pair.view().data().cells, nullptr);
            expect_nearly_all(expect_agreement(pair, repeated(20000)));
        }
    }
}

/// Narrow bright lamps in a dark room.
acdf::compress::Target studio(std::uint32_t columns) {
    return texel_target(columns, columns / 2,
                        [columns, random = std::mt19937_64(5)](std::uint32_t c, std::uint32_t r) mutable {
                            const double x = 2.0 * c / columns, y = 2.0 * r / columns, wall = uniform(random);
                            const double across = std::fmod(9.0 * x + 4.0 * y, 1.0);
                            const bool lamp = across < 0.03 && y > 0.2 && y < 0.7;
                            return (lamp ? 100.0 + 900.0 * across : 1e-3 * y) * (0.5 + wall);
                        });
}

/// Cells of one texel, a curve of columns a row.
std::vector<std::uint8_t> all_texels(std::uint32_t columns, std::uint32_t rows, bool octahedral) {
    std::mt19937_64 random(3);
    EnvironmentSpec spec;
    spec.columns = columns;
    spec.rows = rows;
    spec.octahedral = octahedral;
    const auto curve = [&random](std::uint32_t axis, std::uint32_t segments) {
        CurveSpec out;
        out.axis = axis;
        out.cumulative_bytes = out.position_bytes = 2;
        for (std::uint32_t i = 1; i < segments; ++i) {
            out.positions.push_back(i);
            out.cumulative.push_back((i * 65535 + static_cast<std::uint32_t>(random() % 30000)) / segments);
        }
        return out;
    };
    CurveSpec root = curve(1, rows);
    root.link_bytes = 4;
    for (std::uint32_t row = 0; row < rows; ++row) root.children.push_back(static_cast<int>(row + 1));
    spec.tree.curves = {root};
    for (std::uint32_t row = 0; row < rows; ++row) spec.tree.curves.push_back(curve(0, columns));
    return spec.encode();
}

// Files of any size have tables: of cells while they are small, else of groups.
TEST(RuntimeTables, ServeFilesOfAnySize) {
    for (const std::uint32_t cells : {200u, 5000u, 15000u, 40000u})
        for (const bool lamps : {true, false}) {
            acdf::compress::FitOptions options;
            options.goal.cells = cells;
            const auto target = lamps ? studio(512) : octahedral(noise_target(512, 256, 9));
            const EnvironmentPair pair(stored(target, options));
            SCOPED_TRACE(pair.bytes.size());
            ASSERT_GT(pair.fast.table_bytes(), 0u);
            EXPECT_EQ(pair.view().data().groups != nullptr, cells > (lamps ? 10000u : 20000u));
            expect_nearly_all(expect_agreement(pair, 2000));
        }
    for (const std::uint32_t rows : {128u, 496u}) {
        const EnvironmentPair pair(all_texels(2048, rows, rows == 128));
        SCOPED_TRACE(pair.bytes.size());
        ASSERT_NE(pair.view().data().groups, nullptr);
        expect_agreement(pair, 2000);
    }
}

// Words of the tables of an environment that `make` makes, by some instructions: one of acdf::make_cells and
// acdf::make_groups.
template <class Tables, class... Parallel>
std::vector<std::uint32_t> words_by(Tables* (*make)(const AcdfEnvironment&, const acdf::TreeSurvey&, std::size_t,
                                                    const AcdfAllocator&, AcdfBlock&, acdf::Scratch*,
                                                    acdf::Instructions, const Parallel&...) noexcept,
                                    const AcdfEnvironment& environment, acdf::Instructions most,
                                    std::size_t most_bytes, const Parallel&... parallel) {
    const acdf::TreeSurvey survey(environment, environment.tree_units);
    AcdfBlock block = {};
    std::vector<std::uint32_t> words;
    const Tables* const tables = make(environment, survey, most_bytes, {}, block, nullptr, most, parallel...);
    const auto* const first = reinterpret_cast<const std::uint32_t*>(tables);
    if (tables) words.assign(first, first + tables->words);
    acdf::give_block({}, block);
    return words;
}

// Two threads, from the last task to the first. `of`: an int, which counts how often it is asked.
void backwards(void* of, std::size_t count, void (*task)(void* of, std::size_t i), void* of_task) {
    std::atomic<std::size_t> left{count};
    const auto work = [&] {
        for (std::size_t i = left; i > 0;)
            if (left.compare_exchange_weak(i, i - 1)) task(of_task, --i);
    };
    std::thread other(work);
    work();
    other.join();
    ++*static_cast<int*>(of);
}

// Bit for bit, of cells that lie in their lanes and of those that go on in the next block.
TEST(RuntimeTables, AreTheSameByAnyInstructionsAndThreads) {
    int compared = 0, of_cells = 0, asked = 0;
    const auto compare = [&](const std::vector<std::uint8_t>& bytes) {
        const EnvironmentPair pair(bytes, Tables::own);
        const AcdfEnvironment environment = pair.plain.environment().data();
        const std::size_t any = std::size_t{1} << 26;
        const auto cells = words_by(acdf::make_cells, environment, acdf::Instructions::none, any);
        of_cells += !cells.empty();
        for (const auto instructions : {acdf::Instructions::avx2, acdf::Instructions::avx512})
            ASSERT_EQ(cells, words_by(acdf::make_cells, environment, instructions, any));
        for (const std::size_t most : {std::size_t{1} << 14, std::size_t{1} << 16, 40 * bytes.size()}) {
            const AcdfParallel alone = {}, together = {backwards, &asked};
            const auto plain = words_by(acdf::make_groups, environment, acdf::Instructions::none, most, alone);
            for (const auto instructions : {acdf::Instructions::avx2, acdf::Instructions::avx512})
                ASSERT_EQ(plain, words_by(acdf::make_groups, environment, instructions, most, alone));
            ASSERT_EQ(plain, words_by(acdf::make_groups, environment, acdf::Instructions::avx512, most, together));
            compared += !plain.empty();
        }
    };
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = false;
        options.octahedral = seed % 7 < 3;
        SCOPED_TRACE(seed);
        compare(RandomTree(seed, options).make().encode());
    }
    for (const bool square : {false, true}) {
        acdf::compress::FitOptions options;
        options.goal.cells = 9000;
        compare(stored(square ? octahedral(noise_target(512, 256, 9)) : studio(512), options));
    }
    EXPECT_GT(compared, 100);
    EXPECT_EQ(asked, compared);
    EXPECT_EQ(of_cells, 62);
}

// As a file is opened, from C++ and C.
TEST(RuntimeTables, AreMadeByTheCallersThreads) {
    acdf::compress::FitOptions fit;
    fit.goal.cells = 24000;
    const std::vector<std::uint8_t> bytes = stored(studio(512), fit);
    int asked = 0;
    acdf::LoadOptions options;
    options.parallel = {backwards, &asked};
    acdf::File alone, together;
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), alone).ok());
    ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), together, options).ok());
    EXPECT_EQ(asked, 1);
    AcdfMove memory[2][ACDF_MAX_MOVES];
    ASSERT_EQ(alone.memory(memory[0]), 2);
    ASSERT_EQ(together.memory(memory[1]), 2);
    ASSERT_EQ(memory[0][1].bytes, memory[1][1].bytes);
    EXPECT_EQ(std::memcmp(memory[0][1].from, memory[1][1].from, memory[0][1].bytes), 0);
    AcdfLoadOptions of_c = {};
    of_c.parallel = options.parallel;
    AcdfFile* const file = acdf_from_memory_with(bytes.data(), bytes.size(), &of_c, nullptr);
    ASSERT_TRUE(file);
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(acdf_table_bytes(file), alone.table_bytes());
    acdf_close(file);
}

// Two cells, of which one ends just before phi = 3/4 pi, where pieces of the other begin to count azimuths anew.
TEST(RuntimeTables, KnowAQuarterFromTheNext) {
    std::ifstream in(ACDF_TEST_DIR "/fuzz/regressions/fuzz_reader/directions_of_the_next_quarter.acdf",
                     std::ios::binary);
    const EnvironmentPair pair({std::istreambuf_iterator<char>(in), {}}, Tables::own);
    ASSERT_TRUE(pair.has_tables());
    for (int i = 0; i < 1000; ++i)
        for (const double near : {0x1p-24, 0x1p-22, 0x1p-20, 0x1p-12}) {
            const acdf::DirectionSample s = pair.view().sample(1.0 - near, (i + 0.5) / 1000.0);
            ASSERT_EQ(pair.view().pdf(s.direction), s.pdf) << i << " " << near;
        }
}

// The cells of a stratum of numbers are those of the walk, and within a cell directions are in the order of
// numbers.
void expect_monotone(const acdf::compress::Target& target, Tables tables) {
    acdf::compress::FitOptions options;
    options.goal.cells = 300;
    const EnvironmentPair pair(stored(target, options), tables);
    const acdf::EnvironmentView view = pair.view();
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
    for (const Tables tables : kBoth) {
        expect_monotone(noise_target(64, 32, 9), tables);
        expect_monotone(octahedral(noise_target(64, 32, 9)), tables);
    }
}

TEST(RuntimeTables, AreLeftOutWhereAsked) {
    acdf::compress::FitOptions options;
    options.goal.cells = 100;
    const EnvironmentPair pair(stored(noise_target(64, 32, 9), options));
    EXPECT_GT(pair.fast.table_bytes(), 0u);
    EXPECT_EQ(pair.plain.environment().data().cells, nullptr);
    EXPECT_EQ(pair.plain.environment().data().groups, nullptr);
}

} // namespace
