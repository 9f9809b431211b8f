// Tables for shaders beside the reader: an answer for every number and direction, the reader's own wherever its
// runtime tables give one, and a density that is always that of the draw.
#include "tests/extremes/targets.h"
#include "tests/lib/compress/checks.h"
#include "tests/lib/reader/random.h"
#include "tests/lib/reader/tables/tables_pair.h"

#include "compress/store/store.h"

#include <acdf/shader_tables.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace {

using namespace acdf_test;

std::uint32_t word_of(float x) { return acdf_float_bits(x); }

/// One file by the reader, with its runtime tables and without, and by the tables for shaders.
struct ShaderFile : TablesPair {
    acdf::ShaderTables tables;
    acdf::Status status;
    explicit ShaderFile(std::vector<std::uint8_t> given) : TablesPair(std::move(given)) {
        status = acdf::ShaderTables::make(plain, tables);
    }
    const AcdfCells& cells() const { return *reinterpret_cast<const AcdfCells*>(tables.words()); }
};

/// All numbers lead somewhere: the areas of pieces fill the square.
void expect_whole_square(const ShaderFile& file) {
    const AcdfCells& cells = file.cells();
    const auto* ends = reinterpret_cast<const AcdfPieceEnds*>(file.tables.words() + cells.ends);
    std::uint64_t area = 0;
    for (std::uint32_t i = 0; i < cells.count; ++i)
        area += std::uint64_t{ends[i].numbers[0][1]} * ends[i].numbers[1][1];
    EXPECT_EQ(area, std::uint64_t{1} << 62);
}

struct Counted {
    int draws = 0, same_draws = 0, other_cells = 0, directions = 0, same_directions = 0;
};

/// How far a draw moves with numbers that are four steps of 2^-31 or 2^-20 of those of its cell off.
double reach(const ShaderFile& file, const double u[2], const acdf::DirectionSample& from) {
    const AcdfEnvironment data = file.plain.environment().data();
    AcdfRange range[2];
    AcdfStratum strata[2] = {{0.0, 1.0}, {0.0, 1.0}};
    double t[2], farthest = 0.0, off[2];
    acdf_environment_find(&data, from.direction, range, t, strata);
    for (int axis = 0; axis < 2; ++axis) off[axis] = std::max(0x1p-29, strata[axis].width * 0x1p-20);
    for (int k = 0; k < 4; ++k) {
        const acdf::DirectionSample near =
            file.plain.environment().sample(u[0] + (k % 2 ? off[0] : -off[0]), u[1] + (k / 2 ? off[1] : -off[1]));
        for (int i = 0; i < 3; ++i)
            farthest = std::max(farthest, std::fabs(double{near.direction[i]} - from.direction[i]));
    }
    return farthest;
}

void compare_draw(const ShaderFile& file, std::uint32_t n0, std::uint32_t n1, Counted& counted) {
    const double u[2] = {n0 * 0x1p-32, n1 * 0x1p-32};
    const AcdfShaderSample s = acdf_shader_sample(file.tables.words(), n0, n1);
    const float direction[3] = {s.x, s.y, s.z};
    ASSERT_EQ(word_of(acdf_shader_pdf(file.tables.words(), s.x, s.y, s.z)), word_of(s.pdf)) << n0 << ' ' << n1;
    ASSERT_EQ(word_of(file.plain.environment().pdf(direction)), word_of(s.pdf)) << n0 << ' ' << n1;
    ++counted.draws;
    AcdfDirectionSample told;
    if (file.fast.environment().data().cells &&
        acdf_cells_sample(file.fast.environment().data().cells, u[0], u[1], &told)) {
        ++counted.same_draws;
        ASSERT_EQ(word_of(told.pdf), word_of(s.pdf)) << n0 << ' ' << n1;
        for (int i = 0; i < 3; ++i) ASSERT_EQ(word_of(told.direction[i]), word_of(direction[i])) << n0 << ' ' << n1;
        return;
    }
    const acdf::DirectionSample walked = file.plain.environment().sample(u[0], u[1]);
    if (word_of(walked.pdf) != word_of(s.pdf)) { // a border between two steps of 2^-31
        ++counted.other_cells;
        return;
    }
    const double near = 3e-6 + reach(file, u, walked);
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(walked.direction[i], direction[i], near) << n0 << ' ' << n1;
}

void compare_density(const ShaderFile& file, const float d[3], Counted& counted) {
    const float pdf = acdf_shader_pdf(file.tables.words(), d[0], d[1], d[2]);
    float told;
    ++counted.directions;
    ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0.0f);
    if (!file.fast.environment().data().cells || !acdf_cells_pdf(file.fast.environment().data().cells, d, &told))
        return;
    ++counted.same_directions;
    ASSERT_EQ(word_of(pdf), word_of(told)) << d[0] << ' ' << d[1] << ' ' << d[2];
}

void towards(double phi, double z, float out[3]) {
    const double sine = std::sqrt((1.0 - z) * (1.0 + z));
    out[0] = static_cast<float>(sine * std::cos(phi));
    out[1] = static_cast<float>(sine * std::sin(phi));
    out[2] = static_cast<float>(z);
}

Counted compare(const ShaderFile& file, int count) {
    Counted counted;
    std::mt19937_64 wide(12);
    auto word = [random = std::mt19937(11)]() mutable { return static_cast<std::uint32_t>(random()); };
    for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
        float direction[3];
        compare_draw(file, word(), word(), counted);
        towards(2.0 * M_PI * uniform(wide), 2.0 * uniform(wide) - 1.0, direction);
        compare_density(file, direction, counted);
    }
    Counted edges; // of numbers, of the pieces of the sphere, about the poles
    const std::uint32_t ends[] = {0u, 1u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu};
    for (const std::uint32_t n0 : ends)
        for (const std::uint32_t n1 : ends) compare_draw(file, n0, n1, edges);
    for (int i = 0; i < count / 4 && !testing::Test::HasFatalFailure(); ++i) {
        float direction[3];
        compare_draw(file, word() << (i % 32), word() << (i / 32 % 32), edges);
        towards(M_PI_4 * (i % 8), 1.0 - std::exp(-40.0 * uniform(wide)), direction);
        compare_density(file, direction, edges);
        direction[2] = -direction[2];
        compare_density(file, direction, edges);
    }
    return counted;
}

std::vector<std::uint8_t> fitted(const acdf::compress::Target& target, const acdf::compress::FitOptions& options) {
    auto description = acdf::compress::environment_description(target.columns, target.rows);
    description.fit = options.fit;
    description.total = acdf::compress::integral(target);
    return acdf::compress::store(acdf::compress::fit(target, options).tree, description);
}

std::vector<std::uint8_t> fitted(const acdf::compress::Target& target, std::uint32_t cells) {
    acdf::compress::FitOptions options;
    options.goal.cells = cells;
    return fitted(target, options);
}

TEST(ShaderTables, AnswerAsTheReaderOnGoldenFiles) {
    int with_tables = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_TEST_DIR "/golden/v1.0")) {
        if (entry.path().extension() != ".acdf") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const ShaderFile file({std::istreambuf_iterator<char>(in), {}});
        SCOPED_TRACE(entry.path().filename());
        EXPECT_EQ(file.status.ok(), file.tables.size() > 0) << file.status.message;
        if (!file.status.ok()) continue;
        ++with_tables;
        expect_whole_square(file);
        compare(file, 3000);
        if (HasFatalFailure()) return;
    }
    EXPECT_GE(with_tables, 6);
}

TEST(ShaderTables, AnswerAsTheReaderOnRandomTrees) {
    int with_tables = 0, others = 0;
    for (std::uint32_t seed = 0; seed < 120; ++seed) {
        RandomOptions options = varied_options(seed);
        options.tilts = false;
        SCOPED_TRACE(seed);
        const ShaderFile file(RandomTree(seed, options).make().encode());
        if (!file.status.ok()) continue;
        ++with_tables;
        expect_whole_square(file);
        others += compare(file, 300).other_cells;
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(with_tables, 100);
    EXPECT_LE(others, 2);
}

TEST(ShaderTables, AnswerAsTheReaderOnUsualFiles) {
    const auto sky =
        texel_target(512, 256, [random = std::mt19937_64(3)](std::uint32_t c, std::uint32_t r) mutable {
            const bool sun = std::hypot(2.0 * (c / 512.0 - 0.6), r / 256.0 - 0.25) < 0.004;
            return sun ? 30000.0 : (r < 128 ? 1.3 : 0.1) * (0.5 + uniform(random));
        });
    const ShaderFile file(fitted(sky, 16000));
    ASSERT_TRUE(file.status.ok()) << file.status.message;
    expect_whole_square(file);
    const Counted counted = compare(file, 200000);
    EXPECT_GT(counted.same_draws, 0.99 * counted.draws);
    EXPECT_GT(counted.same_directions, 0.99 * counted.directions);
    EXPECT_EQ(counted.other_cells, 0);
    EXPECT_LT(4 * file.tables.size(), 2 * file.fast.table_bytes());
}

TEST(ShaderTables, AnswerAsTheReaderOnExtremeProbes) {
    for (const NamedTarget& probe : extreme_targets()) {
        SCOPED_TRACE(probe.name);
        const ShaderFile file(fitted(probe.target, 200));
        ASSERT_TRUE(file.status.ok()) << file.status.message;
        expect_whole_square(file);
        compare(file, 2000);
        if (HasFatalFailure()) return;
    }
}

// Each direction, also on the borders of cells, gets the density of a cell that it touches.
TEST(ShaderTables, BordersHaveTheDensityOfANeighbour) {
    const ShaderFile file(fitted(noise_target(64, 32, 9), 300));
    std::mt19937_64 random(2);
    for (int i = 0; i < 100000; ++i) {
        const double phi = M_PI * (1.0 - static_cast<double>(random() % 65) / 32.0), theta = M_PI * uniform(random);
        float d[3], near[3];
        towards(phi, std::cos(theta), d);
        const float pdf = acdf_shader_pdf(file.tables.words(), d[0], d[1], d[2]);
        bool found = false;
        for (int k = 0; k < 9; ++k) {
            towards(phi + (k % 3 - 1) * 1e-6, std::cos(theta + (k / 3 - 1) * 1e-6), near);
            found = found || word_of(file.plain.environment().pdf(near)) == word_of(pdf);
        }
        ASSERT_TRUE(found) << phi << ' ' << theta;
    }
}

TEST(ShaderTables, WhatIsNoUnitVectorHasNoDensity) {
    const ShaderFile file(fitted(noise_target(64, 32, 9), 300));
    const std::uint32_t* words = file.tables.words();
    const float nan = std::nanf(""), infinite = INFINITY;
    for (const float bad : {0.0f, 2.0f, 0.99f, 1.01f, nan, infinite, -infinite, 1e-30f, 3e38f}) {
        EXPECT_EQ(acdf_shader_pdf(words, bad, 0.0f, 0.0f), 0.0f) << bad;
        EXPECT_EQ(acdf_shader_pdf(words, 0.0f, 0.0f, bad), 0.0f) << bad;
    }
    EXPECT_EQ(acdf_shader_pdf(words, nan, 0.0f, 1.0f), 0.0f);
    for (const float z : {1.0f, -1.0f})
        for (const float tiny : {0.0f, -0.0f, 1e-45f, 1e-30f, 1e-19f, 1e-12f})
            EXPECT_GT(acdf_shader_pdf(words, tiny, tiny, z), 0.0f) << z << ' ' << tiny;
}

TEST(ShaderTables, AreRefusedWithAReason) {
    acdf::compress::FitOptions tilted;
    tilted.fit = ACDF_FIT_PDF;
    tilted.goal.cells = 40;
    const ShaderFile file(fitted(noise_target(64, 32, 9), tilted));
    EXPECT_EQ(file.status.code, acdf::ErrorCode::unsupported);
    EXPECT_NE(std::string(file.status.message).find("--fit pdf"), std::string::npos) << file.status.message;
    EXPECT_EQ(file.tables.size(), 0u);
}

} // namespace
