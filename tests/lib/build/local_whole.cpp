// Points without a normal: environment() of a local file of any kind is as accurate, used alone, as a tree with
// free borders in a quarter of its bytes.
#include "build/accuracy/environment.h"
#include "build/own_terms.h"
#include "compress/fit/fit.h"
#include "compress/store/store.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <acdf/builder.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace acdf {
namespace {

/// A sky with a sun, on a grass of noise; and the same on the octahedral square.
const builder::Target& sky(bool square) {
    static const auto make = [](bool octahedral) {
        std::mt19937 rng(7);
        std::lognormal_distribution<double> noise(0.0, 1.0);
        const auto light = [&](std::uint32_t c, std::uint32_t r) {
            const double phi = acdf_test::centre_phi(c, 192), z = acdf_test::centre_z(r, 96);
            if (std::hypot(phi - 0.6, z - 0.4) < 0.04) return 3000.0;
            return (z < 0.0 ? 0.3 : acdf_test::smooth_sky(phi, z)) * noise(rng);
        };
        compress::Target grid = acdf_test::texel_target(192, 96, light);
        return builder::target_of(octahedral ? acdf_test::octahedral(grid) : std::move(grid),
                                  acdf::test::nearest_lookup());
    };
    static const builder::Target latlong = make(false), folded = make(true);
    return square ? folded : latlong;
}

struct MadeLocal {
    builder::Local local;
    File file;

    MadeLocal(const builder::Target& target, const builder::LocalOptions& options) {
        const builder::Status status = builder::local(target, options, local);
        EXPECT_TRUE(status.ok()) << status.message;
        if (!status.ok()) return;
        EXPECT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file).ok());
    }
};

/// The relative variance of an environment file of so many bytes whose tree has free borders.
double of_environment(const builder::Target& target, std::uint64_t bytes) {
    const compress::Target& grid = builder::grid_of(target);
    compress::Description description =
        compress::environment_description(grid.columns, grid.rows, grid.parameterization);
    description.metadata = {{"about.as.long.as.usual", std::string(300, ' ')}};
    compress::FitOptions options;
    options.goal = {compress::Goal::Kind::budget, 0, bytes, 0.0};
    options.file_size = [&](const compress::EncodedTree& tree) {
        return std::uint64_t{compress::store(tree, description).size()};
    };
    const std::vector<std::uint8_t> made = compress::store(compress::fit(grid, options).tree, description);
    File file;
    EXPECT_TRUE(File::from_memory(made.data(), made.size(), file).ok());
    return build::measure_environment(file, grid).relative_variance;
}

void expect_samples_agree(const EnvironmentView& view) {
    std::mt19937_64 random(3);
    for (int i = 0; i < acdf_test::repeated(1000); ++i) {
        const DirectionSample s = view.sample(acdf_test::uniform(random), acdf_test::uniform(random));
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_EQ(view.pdf(s.direction), s.pdf);
        double u[2];
        ASSERT_TRUE(view.invert(s.direction, u));
        EXPECT_EQ(view.sample(u[0], u[1]).pdf, s.pdf);
    }
}

void expect_serves_points(const builder::LocalOptions& options, const std::string& what, bool square = false) {
    const builder::Target& target = sky(square);
    const MadeLocal made(target, options);
    if (made.local.bytes.empty()) return;
    const build::Accuracy whole = build::measure_whole(made.file, builder::grid_of(target));
    EXPECT_EQ(whole.support_violations, 0u) << what;
    EXPECT_LE(whole.relative_variance, of_environment(target, made.local.bytes.size() / 4)) << what;
    expect_samples_agree(made.file.local().environment());
}

builder::LocalOptions of_budget(std::uint64_t bytes, builder::LocalShape shape) {
    builder::LocalOptions out;
    out.goal = builder::Goal::of_budget(bytes);
    out.shape = shape;
    return out;
}

constexpr builder::LocalShape kShapes[] = {builder::LocalShape::small, builder::LocalShape::halvings};

TEST(PointsWithoutNormal, OfEveryShape) {
    for (const builder::LocalShape shape : kShapes)
        for (const std::uint64_t bytes : {12u << 10, 48u << 10}) {
            if (acdf_test::kSanitized && bytes > 12u << 10) break; // the same code, on more of it
            const std::string what = std::to_string(int(shape)) + ", " + std::to_string(bytes);
            expect_serves_points(of_budget(bytes, shape), what);
            if (bytes == 48u << 10) expect_serves_points(of_budget(bytes, shape), what + ", square", true);
        }
}

TEST(PointsWithoutNormal, OfSmallScenes) {
    for (const builder::LocalShape shape : kShapes) {
        builder::LocalOptions options = of_budget(48 << 10, shape);
        options.normals = {{{0.0f, 0.0f, 1.0f}, 1.0}, {{0.3f, -0.9f, 0.1f}, 0.5}};
        expect_serves_points(options, "scene " + std::to_string(int(shape)));
    }
}

TEST(PointsWithoutNormal, OfOtherGoals) {
    ACDF_NOT_SANITIZED();
    for (const builder::LocalShape shape : kShapes) {
        builder::LocalOptions options = of_budget(0, shape);
        options.goal = builder::Goal::of_cells(3000);
        expect_serves_points(options, "cells " + std::to_string(int(shape)));
        options.goal = builder::Goal::of_variance(0.5);
        expect_serves_points(options, "variance " + std::to_string(int(shape)));
    }
    builder::LocalOptions options = of_budget(48 << 10, builder::LocalShape::halvings);
    options.max_weight = 30.0;
    expect_serves_points(options, "largest weight");
    options = of_budget(48 << 10, builder::LocalShape::automatic);
    expect_serves_points(options, "as suits options");
}

TEST(PointsWithoutNormal, OfTheSmallShapeBesideTheCosine) {
    builder::LocalOptions options = of_budget(24 << 10, builder::LocalShape::small);
    options.mis.kind = ACDF_PARTNER_COSINE;
    expect_serves_points(options, "beside the cosine");
}

// Cells of halvings follow what the partner leaves over: a share of all light stays.
TEST(PointsWithoutNormal, OfHalvingsBesideTheCosine) {
    builder::LocalOptions options = of_budget(48 << 10, builder::LocalShape::halvings);
    options.mis.kind = ACDF_PARTNER_COSINE;
    for (const bool square : {false, true}) {
        const MadeLocal made(sky(square), options);
        ASSERT_FALSE(made.local.bytes.empty());
        const build::Accuracy whole = build::measure_whole(made.file, builder::grid_of(sky(square)));
        EXPECT_EQ(whole.support_violations, 0u);
        EXPECT_LT(whole.relative_variance, 0.5);
        EXPECT_LT(whole.max_weight, 30.0);
        expect_samples_agree(made.file.local().environment());
    }
}

TEST(PointsWithoutNormal, OfBinsThatShareNothing) {
    for (const AcdfFit fit : {ACDF_FIT_CDF, ACDF_FIT_PDF, ACDF_FIT_UNIFORM}) {
        builder::LocalOptions options = of_budget(100 << 10, builder::LocalShape::automatic);
        options.goal = {};
        options.sharing = false;
        options.columns = 12;
        options.rows = 6;
        options.fit.fit = fit;
        options.fit.phi_segments = options.fit.theta_segments = 12;
        expect_serves_points(options, "fit " + std::to_string(int(fit)));
        if (acdf_test::kSanitized) break;
    }
}

} // namespace
} // namespace acdf
