// Lamps whose texels the horizon cuts: files for an MIS partner lose none of them at any normal.
#include "build/accuracy/local.h"
#include "build/own_terms.h"
#include "compress/local/light.h"
#include "compress/local/normals.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <acdf/builder.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace acdf {
namespace {

/// Normals of an octahedron finer than that of the bins: its corners, exactly +z among them, and what rounding
/// makes of them.
std::vector<build::Normal> normals() {
    std::vector<build::Normal> out;
    const compress::NormalBins corners = compress::octahedral_bins(13);
    for (const auto& n : corners.normals)
        for (const float tilt : {0.0f, 1e-6f, 3e-3f})
            out.push_back({static_cast<float>(n[0]) + tilt, static_cast<float>(n[1]) - tilt,
                           static_cast<float>(n[2]) + 0.5f * tilt});
    const std::vector<build::Normal> random = build::random_normals(400);
    out.insert(out.end(), random.begin(), random.end());
    return out;
}

/// The largest relative variance of a pair at any normal.
double worst(const compress::Target& grid, AcdfPartnerKind kind, AcdfHeuristic heuristic, std::uint64_t bytes,
             build::Normal& at) {
    const builder::Target target = builder::target_of(grid, acdf::test::nearest_lookup());
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(bytes);
    options.mis.kind = kind;
    options.mis.heuristic = heuristic;
    builder::Local made;
    const builder::Status status = builder::local(target, options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    File file;
    EXPECT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file).ok());
    const std::vector<build::Normal> all = normals();
    const std::vector<build::NormalAccuracy> measured = build::measure_normals(file, grid, all);
    double out = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(measured[i].support_violations, 0u);
        if (measured[i].relative_variance <= out) continue;
        out = measured[i].relative_variance;
        at = all[i];
    }
    return out;
}

struct Lamp {
    std::uint32_t column, row;
};

/// Sums see a sixty-fourth of a texel. Where that alone is above the horizon, it is as little of a cell.
constexpr double kMost = 150.0;

void expect_lamps_are_sampled(const std::vector<Lamp>& lamps, bool square, std::uint32_t columns,
                              std::uint32_t rows, double brightness) {
    const compress::Target latlong = acdf_test::texel_target(columns, rows, [&](std::uint32_t c, std::uint32_t r) {
        const bool lit =
            std::any_of(lamps.begin(), lamps.end(), [&](const Lamp& l) { return l.column == c && l.row == r; });
        return lit ? brightness : 1e-3;
    });
    const compress::Target grid = square ? acdf_test::octahedral(latlong) : latlong;
    const std::pair<AcdfPartnerKind, AcdfHeuristic> partners[] = {{ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE},
                                                                  {ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER}};
    for (const auto& [kind, heuristic] : partners) {
        build::Normal at{};
        const double variance = worst(grid, kind, heuristic, 48 << 10, at);
        EXPECT_LT(variance, kMost) << (square ? "octahedral" : "lat-long") << ", " << lamps.front().column << ", "
                                   << lamps.front().row << ", " << kind << ", " << heuristic << ": " << at[0]
                                   << ", " << at[1] << ", " << at[2];
        if (acdf_test::kSanitized) return;
    }
}

TEST(PartnerAtTheHorizon, TexelsAcrossTheEquatorOfTheSquare) {
    expect_lamps_are_sampled({{31, 16}}, true, 32, 32, 1e6);
    if (acdf_test::kSanitized) return;
    expect_lamps_are_sampled({{20, 27}}, true, 32, 32, 1e6);
    expect_lamps_are_sampled({{32, 63}}, true, 64, 64, 1e6);
}

TEST(PartnerAtTheHorizon, TexelsNextToTheEquator) {
    expect_lamps_are_sampled({{20, 15}}, false, 64, 32, 1e6);
    if (acdf_test::kSanitized) return;
    expect_lamps_are_sampled({{20, 16}}, false, 64, 32, 1e6);
    expect_lamps_are_sampled({{40, 32}}, false, 128, 64, 1e6);
    expect_lamps_are_sampled({{7, 8}}, false, 31, 17, 1e6); // across it
}

/// Random normals, and as many whose horizon cuts a lit texel or passes just beside it.
std::vector<build::Normal> grazing_normals(const compress::Target& grid, std::uint32_t count) {
    std::vector<build::Normal> out = build::random_normals(count);
    const float brightest = *std::max_element(grid.values.begin(), grid.values.end());
    std::vector<std::size_t> lit;
    for (std::size_t i = 0; i < grid.values.size(); ++i)
        if (grid.values[i] > 1e-4f * brightest) lit.push_back(i);
    std::mt19937_64 random(3);
    const auto u = [&random] { return acdf_test::uniform(random); };
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::size_t texel = lit[static_cast<std::size_t>(u() * double(lit.size()))];
        const compress::Direction to =
            compress::direction_at(grid, double(texel / grid.columns) + u(), double(texel % grid.columns) + u());
        const acdf_test::Normal any = acdf_test::random_direction(random);
        const compress::Direction side{double{any[0]}, double{any[1]}, double{any[2]}};
        const double along = compress::dot(side, to),
                     height = (u() < 0.5 ? -0.3 : 0.3) * std::pow(10.0, -4.0 * u());
        build::Normal normal{};
        for (std::size_t i = 0; i < 3; ++i) normal[i] = static_cast<float>(side[i] + (height - along) * to[i]);
        out.push_back(normal);
    }
    return out;
}

/// Of the weights of the pair with the CDF of all light, which are as large as slivers of texels are small: how
/// many times as much a weight may be. Rows that keep no share of that CDF's samples reach 40, and 1e6 in the dark.
constexpr double kOfCdf = 20.0;

/// Weights of the combination at all normals, between bins too: bounded, or at most kOfCdf of those of the pair
/// with the CDF of all light. Returns the largest there is over what it may be.
double largest_of_allowed(const compress::Target& grid, AcdfPartnerKind kind, AcdfHeuristic heuristic) {
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(48 << 10);
    options.mis.kind = kind;
    options.mis.heuristic = heuristic;
    builder::Local made;
    const builder::Target target = builder::target_of(grid, acdf::test::nearest_lookup());
    EXPECT_TRUE(builder::local(target, options, made).ok());
    File file;
    EXPECT_TRUE(File::from_memory(made.bytes.data(), made.bytes.size(), file).ok());
    double out = 0.0;
    for (const build::NormalAccuracy& at : build::measure_normals(file, grid, grazing_normals(grid, 400))) {
        EXPECT_EQ(at.support_violations, 0u);
        if (at.irradiance > 0.0)
            out = std::max(out, at.max_weight / std::max(kMost, kOfCdf * at.max_weight_full_cdf));
    }
    return out;
}

void expect_bounded_weights(const std::vector<Lamp>& lamps, const std::vector<double>& light, bool square,
                            std::uint32_t columns, std::uint32_t rows, double elsewhere) {
    compress::Target grid = acdf_test::texel_target(columns, rows, [&](std::uint32_t c, std::uint32_t r) {
        for (std::size_t i = 0; i < lamps.size(); ++i)
            if (lamps[i].column == c && lamps[i].row == r) return light[i];
        return elsewhere;
    });
    if (square) grid = acdf_test::octahedral(grid);
    EXPECT_LE(largest_of_allowed(grid, ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE), 1.0) << lamps[0].column;
    EXPECT_LE(largest_of_allowed(grid, ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER), 1.0) << lamps[0].column;
}

/// Bins whose horizon hides the middle of the only lamp have samples for what is above it.
TEST(PartnerAtTheHorizon, WeightsAreBoundedInTheDark) {
    ACDF_NOT_SANITIZED();
    expect_bounded_weights({{20, 15}}, {1e6}, false, 64, 32, 0.0);
    expect_bounded_weights({{31, 16}}, {1e6}, true, 32, 32, 0.0);
}

/// A normal that sees the fainter lamp alone, between bins that see the brighter one.
TEST(PartnerAtTheHorizon, WeightsAreBoundedBesideBrighterLamps) {
    ACDF_NOT_SANITIZED();
    expect_bounded_weights({{9, 12}, {12, 14}}, {1e6, 1e3}, false, 64, 32, 1e-3);
    expect_bounded_weights({{3, 16}, {9, 12}}, {1e6, 1e4}, true, 32, 32, 1e-3);
}

/// All light in the bottom row: half of all normals see next to nothing of it.
TEST(PartnerAtTheHorizon, WeightsAreBoundedWhereARowIsLit) {
    ACDF_NOT_SANITIZED();
    const compress::Target row =
        acdf_test::texel_target(20, 10, [](std::uint32_t, std::uint32_t r) { return r == 9 ? 0.5 : 0.0; });
    EXPECT_LE(largest_of_allowed(row, ACDF_PARTNER_COSINE, ACDF_HEURISTIC_BALANCE), 1.0);
    EXPECT_LE(largest_of_allowed(row, ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER), 1.0);
}

TEST(PartnerAtTheHorizon, LampsOfWhichABinSeesOne) {
    ACDF_NOT_SANITIZED();
    expect_lamps_are_sampled({{9, 12}, {41, 19}}, false, 64, 32, 1e6);
    expect_lamps_are_sampled({{3, 16}, {25, 4}}, true, 32, 32, 1e6);
}

} // namespace
} // namespace acdf
