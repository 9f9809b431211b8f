// The sun of maps: where it is found, and where none is.
#include "tests/lib/build/indexed/skies.h"

#include "build/indexed/sun.h"
#include "build/indexed/texels.h"

#include <cmath>

using namespace acdf_test;

namespace {

/// A sky of radiance 1 above and 0.2 below, and lamps on it.
struct Lamp {
    acdf::build::SunDirection towards;
    double light, radius;
};
SkyMap lamps(int width, const std::vector<Lamp>& all) {
    std::vector<float> rgb;
    for (int row = 0; row < width / 2; ++row)
        for (int column = 0; column < width; ++column) {
            const clear_sky::Vector d = clear_sky::towards(column + 0.5, row + 0.5, width);
            double light = d[2] > 0.0 ? 1.0 : 0.2;
            for (const Lamp& lamp : all)
                if (std::hypot(d[0] - lamp.towards[0], d[1] - lamp.towards[1], d[2] - lamp.towards[2]) <
                    lamp.radius)
                    light += lamp.light;
            rgb.insert(rgb.end(), 3, static_cast<float>(light));
        }
    return sky_map(rgb, width);
}

acdf::build::Suns suns_of(const std::vector<SkyMap>& maps,
                          const std::vector<acdf::build::SunDirection>* given = nullptr) {
    std::vector<acdf::build::SunMap> views;
    for (const SkyMap& map : maps) views.push_back(map.view());
    return acdf::build::find_suns(views, {static_cast<std::uint32_t>(maps.size())}, given);
}

double off(const AcdfMap& map, const acdf::build::SunDirection& sun) {
    return std::hypot(map.sun[0] - sun[0], map.sun[1] - sun[1], map.sun[2] - sun[2]);
}

acdf::build::SunDirection at_height(double degrees) {
    const double angle = degrees * ACDF_PI / 180.0;
    return {std::cos(angle) * 0.6, std::cos(angle) * 0.8, std::sin(angle)};
}

TEST(Suns, areFoundFromTheHorizonToTheZenith) {
    constexpr int width = 256;
    const std::vector<double> heights = {2.0, 10.0, 45.0, 80.0, 90.0};
    std::vector<SkyMap> maps;
    for (const double height : heights) maps.push_back(lamps(width, {{at_height(height), 5e4, 0.02}}));
    const acdf::build::Suns suns = suns_of(maps);
    ASSERT_TRUE(suns.any);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        EXPECT_LT(off(suns.of_maps[i], at_height(heights[i])), ACDF_PI / width)
            << heights[i]; // a quarter of a texel
        const double light = 5e4 * ACDF_PI * 0.02 * 0.02;
        EXPECT_NEAR(suns.of_maps[i].sun_share, light / (light + 2.4 * ACDF_PI), 0.1) << heights[i];
        EXPECT_GT(suns.of_maps[i].radius, 0.02);
        EXPECT_LT(suns.of_maps[i].radius, 0.15);
        // The tree gets the sky alone.
        for (const float value : suns.rest[i]) ASSERT_LE(value, 1.01f);
    }
}

TEST(Suns, belowTheHorizonGoOnWhereTheyWere) {
    constexpr int width = 256;
    std::vector<SkyMap> maps;
    for (const double height : {-10.0, 0.0, 10.0, 20.0, 30.0, 40.0})
        maps.push_back(height > 5.0 ? lamps(width, {{at_height(height), 5e4, 0.03}}) : lamps(width, {}));
    const acdf::build::Suns suns = suns_of(maps);
    ASSERT_TRUE(suns.any);
    EXPECT_EQ(suns.of_maps[1].sun_share, 0.0f);
    EXPECT_LT(off(suns.of_maps[1], at_height(0.0)),
              0.75 * 2.0 * ACDF_PI / width); // of a texel: two suns lead there
    EXPECT_EQ(suns.of_maps[0].sun_share, 0.0f);
}

TEST(Suns, areNoneWhereThereIsNoSmallBrightBody) {
    constexpr int width = 256;
    EXPECT_FALSE(suns_of({lamps(width, {}), lamps(width, {})}).any);
    const Lamp lamp = {at_height(40.0), 5e4, 0.03};
    EXPECT_TRUE(suns_of({lamps(width, {lamp}), lamps(width, {lamp})}).any);
    const Lamp wide = {at_height(40.0), 100.0, 0.3};
    EXPECT_FALSE(suns_of({lamps(width, {wide}), lamps(width, {wide})}).any);
    const Lamp dim = {at_height(40.0), 8.0, 0.03};
    EXPECT_FALSE(suns_of({lamps(width, {dim}), lamps(width, {dim})}).any);
    const std::vector<Lamp> two = {lamp, {{-0.6, -0.8, 0.0}, 5e4, 0.03}};
    EXPECT_FALSE(suns_of({lamps(width, two), lamps(width, two)}).any);
    // In one of three maps.
    EXPECT_FALSE(suns_of({lamps(width, {lamp}), lamps(width, {}), lamps(width, {})}).any);
}

TEST(Suns, areWhereTheyAreGiven) {
    constexpr int width = 256;
    const std::vector<Lamp> two = {{at_height(40.0), 5e4, 0.03}, {{-0.6, -0.8, 0.0}, 6e4, 0.03}};
    const std::vector<acdf::build::SunDirection> given = {at_height(40.5), {0.0, 0.0, 0.0}};
    const acdf::build::Suns suns = suns_of({lamps(width, two), lamps(width, {})}, &given);
    ASSERT_TRUE(suns.any);
    EXPECT_LT(off(suns.of_maps[0], at_height(40.0)), ACDF_PI / width);
    EXPECT_GT(suns.of_maps[0].sun_share, 0.1f);
    EXPECT_EQ(suns.of_maps[1].sun_share, 0.0f);
}

/// What one sees of a map that changes does not flicker, at its frames and `step` between them.
void expect_no_flicker(int frames, double step, const std::function<SkyMap(double frame)>& map) {
    std::vector<SkyMap> maps;
    std::vector<double> times;
    for (int frame = 0; frame < frames; ++frame) {
        maps.push_back(map(frame));
        times.push_back(frame);
    }
    const SkyFile file(maps, along("frame", times));
    double before = 0.0;
    for (double frame = 0.0; frame <= frames - 1; frame += step) {
        const double variance = file.variance(file.stored.at(frame), map(frame));
        if (before > 0.0) {
            EXPECT_NEAR(variance / before, 1.0, 0.15) << frame;
        }
        before = variance;
    }
}

/// By columns.
TEST(Suns, turnedAndRescaledMapDoesNotFlicker) {
    constexpr int width = 256;
    const std::vector<float> rgb = clear_sky::latlong(day_sky(9.0, 3.0), width);
    const auto turned = [&](double frame) {
        std::vector<float> out;
        for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
            const std::size_t from = i / width * width + (i + std::size_t(2.0 * frame)) % width;
            for (std::size_t k = 0; k < 3; ++k) out.push_back(rgb[3 * from + k] * float(1.0 + 0.1 * frame));
        }
        return sky_map(out, width);
    };
    expect_no_flicker(9, 0.5, turned);
}

/// From a clear sky to a hazy one: its sun loses half of its light, and the sky about it gains some.
TEST(Suns, mapWhoseContentChangesDoesNotFlicker) {
    expect_no_flicker(5, 0.25, [](double frame) { return day_map(128, 9.0, 2.0 + frame); });
}

} // namespace
