// Local environment files on one tree of halvings: small, dark and odd maps, few normals, and any number of
// threads.
#include "build/local.h"
#include "compress/local/halved/fit.h"
#include "compress/threads.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

namespace acdf {
namespace {

using compress::Goal;
using compress::Target;

build::LocalOptions of_budget(std::uint64_t bytes) {
    build::LocalOptions out;
    out.goal.budget = bytes;
    return out;
}

Target map_of(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization,
              const std::function<float(std::size_t)>& light) {
    Target out = compress::empty_target(columns, rows, parameterization);
    out.values.resize(std::size_t{columns} * rows);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = light(i);
    out.total = compress::integral(out);
    return out;
}

/// A sky of noise, and a sun.
Target sky(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization = ACDF_PARAM_LATLONG) {
    std::mt19937 random(4);
    std::lognormal_distribution<float> noise(0.0f, 1.0f);
    return map_of(columns, rows, parameterization, [&](std::size_t i) {
        return noise(random) * (i == std::size_t{columns} * (rows / 3) + columns / 5 ? 1e3f : 1.0f);
    });
}

build::Local expect_made(const Target& target, const build::LocalOptions& options, const char* what) {
    const build::Local made = build::build_local(target, {}, options);
    EXPECT_EQ(made.accuracy.support_violations, 0u) << what;
    EXPECT_LE(made.bytes.size(), options.goal.budget) << what;
    EXPECT_TRUE(std::isfinite(made.accuracy.relative_variance)) << what;
    return made;
}

TEST(HalvedLocalFiles, OfMapsOfAnySize) {
    const std::pair<std::uint32_t, std::uint32_t> sizes[] = {{1, 1},   {2, 1},   {1, 2},   {5, 3},
                                                             {37, 41}, {96, 48}, {1024, 2}};
    for (const auto& [columns, rows] : sizes)
        for (const AcdfParameterization grid : {ACDF_PARAM_LATLONG, ACDF_PARAM_OCTAHEDRAL}) {
            if (grid == ACDF_PARAM_OCTAHEDRAL && columns != rows) continue;
            for (const AcdfPartnerKind kind : {ACDF_PARTNER_NONE, ACDF_PARTNER_COSINE}) {
                build::LocalOptions options = of_budget(20000);
                options.mis.kind = kind;
                const std::string what = std::to_string(columns) + " x " + std::to_string(rows);
                const build::Local made = expect_made(sky(columns, rows, grid), options, what.c_str());
                EXPECT_LE(made.accuracy.relative_variance,
                          columns > 30 ? made.accuracy.relative_variance_full_cdf : INFINITY);
            }
        }
    expect_made(sky(64, 64, ACDF_PARAM_OCTAHEDRAL), of_budget(20000), "square");
}

TEST(HalvedLocalFiles, OfDarkMaps) {
    const std::function<float(std::size_t)> lights[] = {
        [](std::size_t i) { return i == 700 ? 1.0f : 0.0f; },     // one texel
        [](std::size_t i) { return i < 512 ? 1e-30f : 0.0f; },    // above
        [](std::size_t i) { return i % 7 == 0 ? 1e30f : 0.0f; }}; // very bright
    for (const auto& light : lights)
        for (const AcdfPartnerKind kind : {ACDF_PARTNER_NONE, ACDF_PARTNER_COSINE}) {
            build::LocalOptions options = of_budget(20000);
            options.mis.kind = kind;
            expect_made(map_of(64, 32, ACDF_PARAM_LATLONG, light), options, "dark");
            options.scene = {{{0.0f, 0.0f, -1.0f}, 1.0}, {{0.1f, 0.0f, -0.9f}, 0.5}}; // one that sees little
            expect_made(map_of(64, 32, ACDF_PARAM_LATLONG, light), options, "dark, below");
        }
}

TEST(HalvedLocalFiles, OfFewNormals) {
    const Target target = sky(128, 64);
    build::LocalOptions options = of_budget(30000);
    const double all = expect_made(target, options, "all").accuracy.relative_variance;
    options.scene = {{{0.3f, 0.1f, 0.9f}, 1.0}};
    const build::Local one = expect_made(target, options, "one");
    EXPECT_LT(one.accuracy.relative_variance, 0.5 * all);
    File file;
    ASSERT_TRUE(File::from_memory(one.bytes.data(), one.bytes.size(), file).ok());
    const float down[3] = {0.0f, 0.0f, -1.0f};
    EXPECT_FALSE(file.local().stored(down));
}

void expect_same_of_threads(const Target& target, const build::LocalOptions& options) {
    std::vector<std::uint8_t> alone, together;
    compress::with_threads(1, [&] { alone = build::build_local(target, {}, options).bytes; });
    compress::with_threads(0, [&] { together = build::build_local(target, {}, options).bytes; });
    EXPECT_EQ(alone, together);
}

TEST(HalvedLocalFiles, AreTheSameOfAnyNumberOfThreads) {
    const Target target = sky(128, 64);
    build::LocalOptions options = of_budget(24000);
    expect_same_of_threads(target, options);
    options.max_weight = 8.0;
    expect_same_of_threads(target, options);
    options.max_weight = 0.0;
    options.mis.kind = ACDF_PARTNER_COSINE;
    expect_same_of_threads(target, options);
}

/// At other normals than those that were measured when it was built.
double weight_elsewhere(const build::Local& made, const Target& target) {
    std::vector<build::Normal> others;
    for (const build::Normal& n : build::random_normals(300)) others.push_back({n[1], n[2], n[0]});
    File file;
    EXPECT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file).ok());
    return summary(build::measure_normals(file, target, others)).max_weight;
}

build::Local expect_bounded(const Target& target, double max_weight, const char* what) {
    build::LocalOptions options = of_budget(32768);
    const build::Local free = expect_made(target, options, what);
    EXPECT_GT(free.accuracy.max_weight, 1.5 * max_weight) << what; // else the bound would do nothing
    options.max_weight = max_weight;
    const build::Local bounded = expect_made(target, options, what);
    EXPECT_LE(bounded.accuracy.max_weight, max_weight) << what;
    EXPECT_LE(bounded.accuracy.relative_variance, 1.3 * free.accuracy.relative_variance) << what;
    EXPECT_NE(option_text("", options).find("--max-weight"), std::string::npos);
    return bounded;
}

TEST(HalvedLocalFiles, WeightsStayBelowANumber) {
    EXPECT_LE(weight_elsewhere(expect_bounded(sky(128, 64), 5.0, "a sky"), sky(128, 64)), 7.5);
    expect_bounded(sky(96, 96, ACDF_PARAM_OCTAHEDRAL), 5.0, "a square");
    Target target = sky(128, 64); // what a filter makes of texels
    for (const float value : target.values) target.peaks.push_back(1.5f * value);
    expect_bounded(target, 8.0, "peaks");
    expect_bounded(map_of(64, 32, ACDF_PARAM_LATLONG,
                          [](std::size_t i) { return i < 1024 ? 1.0f + static_cast<float>(i % 5) : 0.0f; }),
                   5.0, "nothing below");
}

TEST(HalvedLocalFiles, ABoundThatNoFileKeepsIsRefused) {
    build::LocalOptions options = of_budget(20000);
    options.max_weight = 1.0; // every sample alike: of texels, not of the cosine within them
    try {
        build::build_local(sky(64, 32), {}, options);
        FAIL() << "it is held";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("a largest weight of 1 is out of reach"), std::string::npos);
    }
}

TEST(HalvedLocalFiles, ReachTheirGoals) {
    ACDF_NOT_SANITIZED();
    const Target target = sky(128, 64);
    build::LocalOptions options = of_budget(0);
    options.goal = {Goal::Kind::variance, 0, 0, 0.2};
    const build::Local reached = build::build_local(target, {}, options);
    EXPECT_LE(reached.accuracy.relative_variance, 0.2);
    options.max_weight = 10.0;
    const build::Local bounded = build::build_local(target, {}, options);
    EXPECT_LE(bounded.accuracy.relative_variance, 0.2);
    EXPECT_LE(bounded.accuracy.max_weight, 10.0);
    options.max_weight = 0.0;
    options.goal = {Goal::Kind::cells, 3000, 0, 0.0};
    const build::Local made = build::build_local(target, {}, options);
    File file;
    ASSERT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file).ok());
    EXPECT_EQ(file.environment().data().halved->count, 2999u);
    options = of_budget(24000);
    options.codec = ACDF_CODEC_ZLIB;
    expect_made(target, options, "compressed");
    options = of_budget(300);
    EXPECT_THROW(build::build_local(target, {}, options), std::runtime_error);
}

} // namespace
} // namespace acdf
