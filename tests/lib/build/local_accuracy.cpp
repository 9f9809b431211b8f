// What is measured of local files of several channels, for lookups that vary within texels, and of maps of few
// texels is what samples have.
#include "build/local.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace acdf;
using acdf_test::kPi;
using acdf_test::kSanitized;
using acdf_test::uniform;

const build::Normal kNormal{0.36f, 0.48f, 0.8f};

struct Lookup {
    std::uint32_t columns, rows;
    std::vector<float> rgb;
    AcdfFilter filter;

    double texel(std::size_t channel, double column, double row) const {
        const auto r = static_cast<std::size_t>(std::clamp(row, 0.0, rows - 1.0));
        const auto c = static_cast<std::size_t>(column + columns) % columns;
        return double{rgb[(r * columns + c) * 3 + channel]};
    }
    /// At a position in the map, in texels.
    double operator()(std::size_t channel, double x, double y) const {
        if (filter == ACDF_FILTER_NEAREST) return texel(channel, std::floor(x), std::floor(y));
        const double c = std::floor(x - 0.5), r = std::floor(y - 0.5), s = x - 0.5 - c, t = y - 0.5 - r;
        return (1 - t) * ((1 - s) * texel(channel, c, r) + s * texel(channel, c + 1, r)) +
               t * ((1 - s) * texel(channel, c, r + 1) + s * texel(channel, c + 1, r + 1));
    }
};

/// Of one sample of `channels`, by many.
double sampled_variance(const LocalEnvironmentView& view, const build::Normal& normal, const Lookup& lookup,
                        std::size_t channels, std::mt19937_64& random) {
    const int count = kSanitized ? 20000 : 400000;
    double sum[3] = {}, square = 0.0;
    for (int i = 0; i < count; ++i) {
        const double u0 = uniform(random), u1 = uniform(random);
        const DirectionSample s = view.sample(normal.data(), u0, u1);
        const double x = lookup.columns *
                         (0.5 - std::atan2(double{s.direction[1]}, double{s.direction[0]}) / (2.0 * kPi)),
                     y = lookup.rows * std::acos(double{s.direction[2]}) / kPi;
        const double cosine = std::max(0.0, acdf_test::dot(normal.data(), s.direction));
        for (std::size_t k = 0; k < channels; ++k) {
            const double weight = lookup(k, x, y) * cosine / double{s.pdf};
            sum[k] += weight / count;
            square += weight * weight / count;
        }
    }
    return square / (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) - 1.0;
}

Lookup noise(std::uint32_t columns, std::uint32_t rows, float least, std::mt19937_64& random) {
    Lookup out{columns, rows, std::vector<float>(std::size_t{columns} * rows * 3), ACDF_FILTER_NEAREST};
    for (float& value : out.rgb) value = least + static_cast<float>(uniform(random));
    return out;
}

/// Of one channel the first.
compress::Target target_of(const Lookup& lookup, std::size_t channels) {
    compress::TargetOptions of;
    of.filter = lookup.filter;
    of.channels = channels == 3 ? ACDF_CHANNELS_SEPARATE : ACDF_CHANNELS_WEIGHTED;
    of.weights = channels == 3 ? compress::ChannelWeights{1.0, 1.0, 1.0} : compress::ChannelWeights{1.0, 0.0, 0.0};
    return compress::environment_target(lookup.rgb.data(), lookup.columns, lookup.rows, of);
}

build::Local of_budget(const compress::Target& target, std::uint64_t budget) {
    build::LocalOptions options;
    options.goal.budget = budget;
    return build::build_local(target, {}, options);
}

/// Lives no longer than `local`.
File opened(const build::Local& local) {
    File file;
    EXPECT_TRUE(File::from_memory(local.bytes.data(), local.bytes.size(), file).ok());
    return file;
}

TEST(LocalFiles, ChannelsAndFiltersCountAsInSamples) {
    ACDF_NOT_SANITIZED();
    std::mt19937_64 random(4);
    Lookup lookup = noise(96, 48, 0.0f, random);
    for (const std::size_t channels : {1u, 3u})
        for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
            SCOPED_TRACE(std::to_string(channels) + (filter == ACDF_FILTER_NEAREST ? ", nearest" : ", bilinear"));
            lookup.filter = filter;
            const compress::Target target = target_of(lookup, channels);
            const build::Local local = of_budget(target, 262144);
            const File file = opened(local);
            const double sampled = sampled_variance(file.local(), kNormal, lookup, channels, random);
            const build::NormalAccuracy measured = build::measure_normals(file, target, {kNormal}).front();
            EXPECT_NEAR(measured.relative_variance, sampled, 0.03 * sampled);
            EXPECT_GE(measured.max_weight, 1.0 + measured.relative_variance);
        }
}

// The cosine varies within texels of ten degrees.
TEST(LocalFiles, MapsOfFewTexelsCountAsInSamples) {
    std::mt19937_64 random(6);
    const Lookup lookup = noise(32, 16, 0.1f, random);
    const compress::Target target = target_of(lookup, 1);
    const build::Local local = of_budget(target, 65536);
    const File file = opened(local);
    const double sampled = sampled_variance(file.local(), kNormal, lookup, 1, random);
    EXPECT_NEAR(build::measure_normals(file, target, {kNormal}).front().relative_variance, sampled,
                (kSanitized ? 0.3 : 0.1) * sampled);
}

/// The largest weight that a normal has where each texel gets what is best for its own variance: the root of its
/// measure times the integral of the square of what it shines on the normal. A normal that sees a sliver of a
/// bright texel alone has heavy samples then, as no cell is smaller than a texel.
double largest_weight_of_best(const compress::Target& map, const build::Normal& normal) {
    constexpr std::uint32_t kAcross = 128; // parts of a texel
    double costs = 0.0, irradiance = 0.0, heaviest = 0.0;
    for (std::uint32_t r = 0; r < map.rows; ++r)
        for (std::uint32_t c = 0; c < map.columns; ++c) {
            const double light = double{map.row(r)[c]};
            double measure = 0.0, sum = 0.0, square = 0.0, most = 0.0;
            for (std::uint32_t i = 0; i < kAcross * kAcross; ++i) {
                const double row = r + (i / kAcross + 0.5) / kAcross, column = c + (i % kAcross + 0.5) / kAcross;
                const double theta = kPi * row / map.rows, phi = kPi - 2.0 * kPi * column / map.columns;
                const double area = std::sin(theta) * kPi / map.rows * 2.0 * kPi / map.columns / kAcross / kAcross;
                const double cosine = std::max(
                    0.0, std::sin(theta) * (std::cos(phi) * double{normal[0]} + std::sin(phi) * double{normal[1]}) +
                             std::cos(theta) * double{normal[2]});
                measure += area;
                sum += cosine * area;
                square += cosine * cosine * area;
                most = std::max(most, cosine);
            }
            irradiance += light * sum;
            costs += light * std::sqrt(measure * square);
            if (square > 0.0) heaviest = std::max(heaviest, most * std::sqrt(measure / square));
        }
    return heaviest * costs / irradiance;
}

// A horizon that goes through a texel leaves the light above it.
TEST(LocalFiles, MapsOfFewTexelsHaveLittleNoise) {
    for (const std::uint32_t rows : {2u, 4u, 8u, 16u}) {
        const compress::Target sky = acdf_test::texel_target(2 * rows, rows, [&](std::uint32_t c, std::uint32_t r) {
            return c == rows / 2 && r == rows / 3 ? 500.0 : 1.5 - double(r) / rows;
        });
        const build::Local local = of_budget(sky, 65536);
        EXPECT_LT(local.accuracy.relative_variance, 0.4 * local.accuracy.relative_variance_full_cdf) << rows;
        if (rows > 2) {
            EXPECT_LT(local.accuracy.max_weight, 60.0) << rows;
        }
        const File file = opened(local);
        const std::vector<build::Normal> normals = build::random_normals(local.normals);
        const std::vector<build::NormalAccuracy> each = build::measure_normals(file, sky, normals);
        const auto worst = std::max_element(
            each.begin(), each.end(), [](const auto& a, const auto& b) { return a.max_weight < b.max_weight; });
        EXPECT_LE(worst->max_weight, largest_weight_of_best(sky, normals[std::size_t(worst - each.begin())]))
            << rows;
    }
}

TEST(LocalFiles, NoVarianceIsBelowZero) { // where rounding alone is left
    build::LocalOptions options;
    options.goal.budget = 8192;
    options.cosine_share = 0.99;
    const compress::Target sky = acdf_test::texel_target(1, 1, [](std::uint32_t, std::uint32_t) { return 1.0; });
    const build::Local local = build::build_local(sky, {}, options);
    const File file = opened(local);
    for (const build::NormalAccuracy& a :
         build::measure_normals(file, sky, build::test_normals(options.scene, 64))) {
        EXPECT_GE(a.relative_variance, 0.0);
        EXPECT_LT(a.relative_variance, 0.01);
        EXPECT_NEAR(a.relative_variance_full_cdf, 5.0 / 3.0, 1e-3); // E[cos^2] / E[cos]^2 - 1 over the sphere
    }
}

} // namespace
