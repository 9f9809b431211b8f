// Lamps whose texels the horizon cuts: files for an MIS partner lose none of them at any normal.
#include "build/accuracy/local.h"
#include "build/own_terms.h"
#include "compress/local/normals.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <acdf/builder.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
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
    for (const AcdfPartnerKind kind : {ACDF_PARTNER_COSINE, ACDF_PARTNER_BRDF})
        for (const AcdfHeuristic heuristic : {ACDF_HEURISTIC_BALANCE, ACDF_HEURISTIC_POWER}) {
            build::Normal at{};
            const double variance = worst(grid, kind, heuristic, 48 << 10, at);
            EXPECT_LT(variance, kMost) << (square ? "octahedral" : "lat-long") << ", " << lamps.front().column
                                       << ", " << lamps.front().row << ", " << kind << ", " << heuristic << ": "
                                       << at[0] << ", " << at[1] << ", " << at[2];
            if (acdf_test::kSanitized) return;
        }
}

TEST(PartnerAtTheHorizon, TexelsAcrossTheEquatorOfTheSquare) {
    expect_lamps_are_sampled({{31, 16}}, true, 32, 32, 1e6);
    if (acdf_test::kSanitized) return;
    expect_lamps_are_sampled({{20, 27}}, true, 32, 32, 1e6);
    expect_lamps_are_sampled({{64, 127}}, true, 128, 128, 1e6);
}

TEST(PartnerAtTheHorizon, TexelsNextToTheEquator) {
    expect_lamps_are_sampled({{20, 15}}, false, 64, 32, 1e6);
    if (acdf_test::kSanitized) return;
    expect_lamps_are_sampled({{20, 16}}, false, 64, 32, 1e6);
    expect_lamps_are_sampled({{80, 64}}, false, 256, 128, 1e6);
    expect_lamps_are_sampled({{7, 8}}, false, 31, 17, 1e6); // across it
}

TEST(PartnerAtTheHorizon, LampsOfWhichABinSeesOne) {
    ACDF_NOT_SANITIZED();
    expect_lamps_are_sampled({{9, 12}, {41, 19}}, false, 64, 32, 1e6);
    expect_lamps_are_sampled({{3, 16}, {25, 4}}, true, 32, 32, 1e6);
}

} // namespace
} // namespace acdf
