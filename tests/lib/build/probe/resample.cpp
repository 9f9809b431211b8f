// Resampling to lat-long: the same sky as seen directly, and the same energy.
#include "build/probe/resample.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/build/probe/projection_reference.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>

namespace {

using namespace acdf::build;
using namespace acdf::test;

struct SizedCase {
    const char* name;
    Map map;
    Reference reference;
    double largest_error; // of one texel against the sky: half a source texel times the sky's steepest slope
};

std::vector<SizedCase> sized_cases() {
    return {{"angular", {Layout::angular, 256, 256}, angular_reference, 0.06},
            // Around -x a mirror ball's texels are degrees wide.
            {"mirrorball", {Layout::mirrorball, 160, 160}, mirrorball_reference, 0.35},
            {"vertical cross", {Layout::vertical_cross, 192, 256}, vertical_cross_reference(), 0.06},
            {"horizontal cross", {Layout::horizontal_cross, 256, 192}, horizontal_cross_reference(), 0.06},
            {"octahedral", {Layout::octahedral, 144, 144}, octahedral_reference, 0.08}};
}

std::vector<float> resampled(const Map& map, std::vector<float> rgb, int threads = 0) {
    return resample_to_latlong(map, std::move(rgb), latlong_width(map), threads);
}

void expect_similar(const SizedCase& c, const std::vector<float>& rgb, const Pixels& expected) {
    ASSERT_EQ(rgb.size(), expected.rgb.size()) << c.name;
    double squares = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        const double error = (rgb[i] - expected.rgb[i]) / expected.rgb[i];
        squares += error * error;
        largest = std::max(largest, std::abs(error));
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(rgb.size())), 0.012) << c.name;
    EXPECT_LT(largest, c.largest_error) << c.name;
}

TEST(InputResample, ShowsTheSameSkyWithTheSameEnergy) {
    const Pixels expected = render_sky(latlong_reference, 256, 128), fine = render_sky(latlong_reference, 512, 256);
    for (const SizedCase& c : sized_cases()) {
        ASSERT_EQ(latlong_width(c.map), 256) << c.name;
        const std::vector<float> rgb = resampled(c.map, render_sky(c.reference, c.map.width, c.map.height).rgb);
        expect_similar(c, rgb, expected);
        for (int channel = 0; channel < 3; ++channel) {
            const double energy = latlong_integral(512, 256, fine.rgb, channel);
            EXPECT_NEAR(latlong_integral(256, 128, rgb, channel) / energy, 1.0, 3e-4) << c.name;
        }
    }
}

// The integral of the lat-long image is the sum of L times the texel's solid angle over the source.
TEST(InputResample, KeepsTheEnergyOfNoise) {
    ACDF_NOT_SANITIZED();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-3.0f, 4.0f);
    for (const SizedCase& c : sized_cases()) {
        std::vector<float> rgb(3 * static_cast<std::size_t>(c.map.width * c.map.height));
        for (float& v : rgb) v = std::pow(10.0f, exponent(random));
        double expected = 0.0;
        for (int y = 0; y < c.map.height; ++y)
            for (int x = 0; x < c.map.width; ++x)
                expected += static_cast<double>(rgb[3 * static_cast<std::size_t>(y * c.map.width + x)]) *
                            texel_solid_angle(c.map, x, y);
        const int width = latlong_width(c.map);
        const double energy = latlong_integral(width, width / 2, resampled(c.map, std::move(rgb)), 0);
        EXPECT_NEAR(energy / expected, 1.0, 1e-6) << c.name;
    }
}

// A texel that its layout shows whole, away from rims and face borders.
bool random_texel(const SizedCase& c, std::mt19937& random, int& x, int& y) {
    x = static_cast<int>(random() % static_cast<unsigned>(c.map.width));
    y = static_cast<int>(random() % static_cast<unsigned>(c.map.height));
    Vec d;
    for (const double du : {-0.5, 1.5})
        for (const double dv : {-0.5, 1.5})
            if (!c.reference((x + du) / c.map.width, (y + dv) / c.map.height, d)) return false;
    return true;
}

// Suns of one texel, anywhere, one in each channel. Their solid angle is measured from the reference, not the
// library, and each must stay where it was.
TEST(InputResample, KeepsTheEnergyOfASingleTexel) {
    ACDF_NOT_SANITIZED();
    std::mt19937 random(9);
    for (const SizedCase& c : sized_cases()) {
        const int width = latlong_width(c.map);
        for (int repeat = 0; repeat < 2; ++repeat) {
            std::vector<float> rgb(3 * static_cast<std::size_t>(c.map.width * c.map.height), 0.0f);
            int x[3], y[3];
            for (int channel = 0; channel < 3; ++channel) {
                while (!random_texel(c, random, x[channel], y[channel])) {
                }
                rgb[3 * static_cast<std::size_t>(y[channel] * c.map.width + x[channel]) +
                    static_cast<std::size_t>(channel)] = 1e6f;
            }
            const std::vector<float> sphere = resampled(c.map, std::move(rgb));
            for (int channel = 0; channel < 3; ++channel) {
                const double omega =
                    solid_angle_by_differences(c.reference, c.map.width, c.map.height, x[channel], y[channel], 16);
                EXPECT_NEAR(latlong_integral(width, width / 2, sphere, channel) / (1e6 * omega), 1.0, 1e-3)
                    << c.name << " " << x[channel] << " " << y[channel];
                Vec middle;
                ASSERT_TRUE(
                    c.reference((x[channel] + 0.5) / c.map.width, (y[channel] + 0.5) / c.map.height, middle));
                EXPECT_GT(dot(mean_direction(width, sphere, channel), middle), std::cos(2.0 * pi / width))
                    << c.name << " " << x[channel] << " " << y[channel];
            }
        }
    }
}

TEST(InputResample, ConstantStaysConstant) {
    for (const SizedCase& c : sized_cases()) {
        std::vector<float> rgb(3 * static_cast<std::size_t>(c.map.width * c.map.height), 2.0f);
        double squares = 0.0;
        const std::vector<float> sphere = resampled(c.map, std::move(rgb));
        for (const float v : sphere) {
            ASSERT_NEAR(v, 2.0f, 0.08f) << c.name; // worst around -x, the rim of the discs
            squares += (v - 2.0) * (v - 2.0);
        }
        EXPECT_LT(std::sqrt(squares / static_cast<double>(sphere.size())), 2e-3) << c.name;
    }
}

TEST(InputResample, SameBytesWithAnyNumberOfThreads) {
    ACDF_NOT_SANITIZED();
    for (SizedCase c : sized_cases()) {
        c.map.width /= 2;
        c.map.height /= 2;
        const Pixels sky = render_sky(c.reference, c.map.width, c.map.height);
        const std::vector<float> one = resampled(c.map, sky.rgb, 1), three = resampled(c.map, sky.rgb, 3);
        ASSERT_EQ(one.size(), three.size());
        EXPECT_EQ(std::memcmp(one.data(), three.data(), one.size() * sizeof(float)), 0) << c.name;
    }
}

// The same bytes on every machine: no libm, no contraction. The source is exact too: integers.
TEST(InputResample, SameBytesWithEveryCompiler) {
    const struct {
        Map map;
        std::uint64_t fnv; // FNV-1a of the result
    } known[] = {{{Layout::angular, 45, 45}, 0x26c1b74681364e1eu},
                 {{Layout::mirrorball, 40, 40}, 0x0ab5b0de2d28c03du},
                 {{Layout::vertical_cross, 48, 64}, 0x3a1909b7f302b2f8u},
                 {{Layout::horizontal_cross, 64, 48}, 0xb956dadf22e82d1au},
                 {{Layout::stacked_cube, 15, 90}, 0x8908265f042a68afu},
                 {{Layout::octahedral, 36, 36}, 0xe551b7c65d553d38u}};
    for (const auto& k : known) {
        std::mt19937 random(2);
        std::vector<float> rgb(3 * static_cast<std::size_t>(k.map.width * k.map.height));
        for (float& v : rgb) v = static_cast<float>(random() >> 12);
        std::uint64_t fnv = 0xcbf29ce484222325u;
        for (const float v : resampled(k.map, std::move(rgb))) {
            std::uint32_t bits;
            std::memcpy(&bits, &v, sizeof bits);
            for (int shift = 0; shift < 32; shift += 8) fnv = (fnv ^ ((bits >> shift) & 255u)) * 0x100000001b3u;
        }
        EXPECT_EQ(fnv, k.fnv) << "layout " << static_cast<int>(k.map.layout);
    }
}

TEST(InputResample, SmallestMapsAndExtremeValues) {
    const Map tiny[] = {{Layout::angular, 1, 1},      {Layout::mirrorball, 2, 2},
                        {Layout::octahedral, 1, 1},   {Layout::vertical_cross, 3, 4},
                        {Layout::stacked_cube, 1, 6}, {Layout::horizontal_cross, 4, 3}};
    for (const Map& map : tiny) {
        std::vector<float> rgb(3 * static_cast<std::size_t>(map.width * map.height), 3.0e38f);
        for (const float v : resampled(map, std::move(rgb))) ASSERT_TRUE(std::isfinite(v) && v > 1e38f);
    }
}

} // namespace
