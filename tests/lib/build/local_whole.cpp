// Points without a normal: environment() of a local file is as accurate, used alone, as an environment file of a
// quarter of its bytes, and covers all light where bins share nothing.
#include "build/accuracy/environment.h"
#include "build/own_terms.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <acdf/builder.h>
#include <acdf/curves/curves.h>
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
        EXPECT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file, acdf::with_curves()).ok());
    }
};

double of_environment(const builder::Target& target, std::uint64_t bytes) {
    builder::EnvironmentOptions options;
    options.goal = builder::Goal::of_budget(bytes);
    builder::Environment made;
    const builder::Status status = builder::environment(target, options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    return made.accuracy.relative_variance;
}

/// `rounding`: of a pdf within tilted cells, relative.
void expect_samples_agree(const EnvironmentView& view, float rounding = 0.0f) {
    std::mt19937_64 random(3);
    for (int i = 0; i < acdf_test::repeated(1000); ++i) {
        const DirectionSample s = view.sample(acdf_test::uniform(random), acdf_test::uniform(random));
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_NEAR(view.pdf(s.direction), s.pdf, rounding * s.pdf);
        double u[2];
        ASSERT_TRUE(view.invert(s.direction, u));
        EXPECT_NEAR(view.sample(u[0], u[1]).pdf, s.pdf, rounding * s.pdf);
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

builder::LocalOptions within(std::uint64_t bytes) {
    builder::LocalOptions out;
    out.goal = builder::Goal::of_budget(bytes);
    return out;
}

TEST(PointsWithoutNormal, OfBudgets) {
    for (const std::uint64_t bytes : {12u << 10, 48u << 10}) {
        if (acdf_test::kSanitized && bytes > 12u << 10) break; // the same code, on more of it
        const std::string what = std::to_string(bytes);
        expect_serves_points(within(bytes), what);
        if (bytes == 48u << 10) expect_serves_points(within(bytes), what + ", square", true);
    }
}

TEST(PointsWithoutNormal, OfSmallScenes) {
    builder::LocalOptions options = within(48 << 10);
    options.normals = {{{0.0f, 0.0f, 1.0f}, 1.0}, {{0.3f, -0.9f, 0.1f}, 0.5}};
    expect_serves_points(options, "scene");
}

TEST(PointsWithoutNormal, OfOtherGoals) {
    ACDF_NOT_SANITIZED();
    builder::LocalOptions options;
    options.goal = builder::Goal::of_cells(3000);
    expect_serves_points(options, "cells");
    options.goal = builder::Goal::of_variance(0.5);
    expect_serves_points(options, "variance");
    options = within(48 << 10);
    options.max_weight = 30.0;
    expect_serves_points(options, "largest weight");
}

// Cells of halvings follow what the partner leaves over: a share of all light stays.
TEST(PointsWithoutNormal, BesideTheCosine) {
    builder::LocalOptions options = within(48 << 10);
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
        builder::LocalOptions options;
        options.sharing = false;
        options.columns = 12;
        options.rows = 6;
        options.fit.fit = fit;
        options.fit.phi_segments = options.fit.theta_segments = 12;
        const MadeLocal made(sky(false), options);
        ASSERT_FALSE(made.local.bytes.empty());
        const build::Accuracy whole = build::measure_whole(made.file, builder::grid_of(sky(false)));
        EXPECT_EQ(whole.support_violations, 0u) << fit;
        EXPECT_LT(whole.relative_variance, fit == ACDF_FIT_UNIFORM ? INFINITY : 1.0) << fit;
        expect_samples_agree(made.file.local().environment(), fit == ACDF_FIT_PDF ? 1e-4f : 0.0f);
        if (acdf_test::kSanitized) break;
    }
}

} // namespace
} // namespace acdf
