// What lookups find: the texel, or what the moments of interpolated maps are of.
#include "tests/inputs/synthetic.h"

#include "compress/target.h"
#include "measure/map_lookup.h"
#include "measure/scenes/scene_points.h"

#include <acdf/octahedral.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace acdf::measure {
namespace {

constexpr std::uint32_t kRows = 6;

std::vector<float> noise(std::uint32_t columns) {
    std::mt19937 random(3);
    std::vector<float> rgb;
    for (std::uint32_t i = 0; i < columns * kRows; ++i)
        rgb.insert(rgb.end(), 3, 1.0f + static_cast<float>(random() % 1000));
    return rgb;
}

compress::Target target(const std::vector<float>& rgb, std::uint32_t columns, AcdfFilter filter,
                        AcdfParameterization parameterization) {
    return compress::environment_target(rgb.data(), columns, kRows,
                                        {{}, ACDF_CHANNELS_WEIGHTED, filter, parameterization});
}

/// The direction at a position in texels, and how much of the sphere lies around it, but for a factor.
double direction_at(double column, double row, std::uint32_t columns, AcdfParameterization grid, float out[3]) {
    double d[3], sine = 1.0;
    if (grid == ACDF_PARAM_OCTAHEDRAL) {
        acdf_octahedral_direction(column / columns, row / kRows, d);
    } else {
        const double phi = ACDF_PI * (1.0 - 2.0 * column / columns), theta = ACDF_PI * row / kRows;
        sine = std::sin(theta);
        d[0] = sine * std::cos(phi), d[1] = sine * std::sin(phi), d[2] = std::cos(theta);
    }
    for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(d[k]);
    return sine;
}

// Seams, poles and the sides of the square among them: lookups find the f whose moments files are fitted to.
TEST(MapLookup, HasTheMomentsThatAreFitted) {
    constexpr int parts = 40;
    for (const AcdfParameterization grid : {ACDF_PARAM_LATLONG, ACDF_PARAM_OCTAHEDRAL}) {
        const std::uint32_t columns = grid == ACDF_PARAM_OCTAHEDRAL ? kRows : 2 * kRows;
        const std::vector<float> rgb = noise(columns);
        const compress::Target texels = target(rgb, columns, ACDF_FILTER_NEAREST, grid),
                               fitted = target(rgb, columns, ACDF_FILTER_BILINEAR, grid);
        const MapLight light(texels, ACDF_FILTER_BILINEAR, false), constant(texels);
        for (std::uint32_t r = 0; r < kRows; ++r)
            for (std::uint32_t c = 0; c < columns; ++c) {
                double mean = 0.0, square = 0.0, all = 0.0;
                float d[3];
                for (int i = 0; i < parts; ++i)
                    for (int k = 0; k < parts; ++k) {
                        const double weight =
                            direction_at(c + (k + 0.5) / parts, r + (i + 0.5) / parts, columns, grid, d);
                        const double f = light.radiance(d);
                        mean += weight * f, square += weight * f * f, all += weight;
                    }
                const std::size_t at = std::size_t{r} * columns + c;
                EXPECT_NEAR(mean / all, fitted.means[0][at], 2e-3 * fitted.means[0][at]) << grid << " " << at;
                EXPECT_NEAR(std::sqrt(square / all), fitted.values[at], 2e-3 * fitted.values[at]) << at;
                direction_at(c + 0.5, r + 0.5, columns, grid, d);
                EXPECT_NEAR(light.radiance(d), texels.values[at], 1e-3 * texels.values[at]) << at;
                EXPECT_EQ(constant.radiance(d), double{texels.values[at]}) << at;
            }
        const float nothing[3] = {NAN, 0.0f, 0.0f}, longer[3] = {0.0f, 2.0f, 0.0f};
        EXPECT_EQ(light.radiance(nothing), 0.0);
        EXPECT_EQ(light.radiance(longer), 0.0);
    }
}

// Beyond the first row of a map whose rows repeat lies the last one.
TEST(MapLookup, RowsMayRepeat) {
    const std::uint32_t columns = 2 * kRows;
    std::vector<float> rgb(3 * columns * kRows, 0.0f);
    for (std::uint32_t i = 0; i < 3 * columns; ++i) rgb[3 * columns * (kRows - 1) + i] = 1.0f;
    const compress::Target texels = target(rgb, columns, ACDF_FILTER_NEAREST, ACDF_PARAM_LATLONG);
    const MapLight stops(texels, ACDF_FILTER_BILINEAR, false), repeats(texels, ACDF_FILTER_BILINEAR, true);
    const float up[3] = {0.0f, 0.0f, 1.0f}, down[3] = {0.0f, 0.0f, -1.0f};
    EXPECT_EQ(stops.radiance(up), 0.0);
    EXPECT_NEAR(stops.radiance(down), 1.0, 1e-6);
    EXPECT_NEAR(repeats.radiance(up), 0.5, 1e-6);
    EXPECT_NEAR(repeats.radiance(down), 0.5, 1e-6);
}

TEST(MapLookup, LightsOfScenesAreLookedUpTheSameWay) {
    const std::uint32_t columns = 2 * kRows;
    const std::vector<float> rgb = noise(columns);
    const compress::Target texels = target(rgb, columns, ACDF_FILTER_NEAREST, ACDF_PARAM_LATLONG);
    for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
        const MapLight light(texels, filter, false);
        const ProbeLight scene{columns, kRows, rgb.data(), filter};
        std::mt19937 random(8);
        for (int i = 0; i < 200; ++i) {
            const double u = static_cast<double>(random()) * 0x1p-32, v = static_cast<double>(random()) * 0x1p-32;
            float d[3];
            direction_at(u * columns, v * kRows, columns, ACDF_PARAM_LATLONG, d);
            EXPECT_NEAR(scene.radiance(d)[1], light.radiance(d), 1e-4 * light.radiance(d));
        }
    }
}

} // namespace
} // namespace acdf::measure
