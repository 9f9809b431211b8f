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
    out.shape = compress::LocalShape::halvings;
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

TEST(HalvedLocalFiles, AreTheSameOfAnyNumberOfThreads) {
    const Target target = sky(128, 64);
    for (const AcdfPartnerKind kind : {ACDF_PARTNER_NONE, ACDF_PARTNER_COSINE}) {
        build::LocalOptions options = of_budget(24000);
        options.mis.kind = kind;
        std::vector<std::uint8_t> alone, together;
        compress::with_threads(1, [&] { alone = build::build_local(target, {}, options).bytes; });
        compress::with_threads(0, [&] { together = build::build_local(target, {}, options).bytes; });
        EXPECT_EQ(alone, together);
    }
}

TEST(HalvedLocalFiles, ReachTheirGoals) {
    ACDF_NOT_SANITIZED();
    const Target target = sky(128, 64);
    build::LocalOptions options = of_budget(0);
    options.goal = {Goal::Kind::variance, 0, 0, 0.2};
    const build::Local reached = build::build_local(target, {}, options);
    EXPECT_LE(reached.accuracy.relative_variance, 0.2);
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
