// Targets for channels and filters: against brute force, and what a mismatch with the renderer's lookup costs.
#include "tests/inputs/directions.h"

#include "build/accuracy/environment.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using namespace acdf;
using acdf_test::kPi;

constexpr std::uint32_t kColumns = 12, kRows = 7;

std::vector<float> noisy_map() {
    std::mt19937 random(3);
    std::vector<float> rgb(kColumns * kRows * 3);
    for (float& value : rgb) value = random() % 3 == 0 ? 0.0f : static_cast<float>(random() % 1000) / 100.0f;
    return rgb;
}

/// A bilinear lookup, written as renderers do: centres at half texels, wrap at the seam, clamp at the poles.
double bilinear(const std::vector<float>& rgb, std::size_t channel, double x, double y) {
    const double cx = x - 0.5, cy = y - 0.5;
    const int c0 = static_cast<int>(std::floor(cx)), r0 = static_cast<int>(std::floor(cy));
    const double s = cx - c0, t = cy - r0;
    const auto texel = [&](int c, int r) {
        const auto column = static_cast<std::size_t>((c + int(kColumns)) % int(kColumns));
        const auto row = static_cast<std::size_t>(std::clamp(r, 0, int(kRows) - 1));
        return double{rgb[3 * (row * kColumns + column) + channel]};
    };
    return (1 - t) * ((1 - s) * texel(c0, r0) + s * texel(c0 + 1, r0)) +
           t * ((1 - s) * texel(c0, r0 + 1) + s * texel(c0 + 1, r0 + 1));
}

compress::TargetOptions options(AcdfChannels channels, AcdfFilter filter) {
    return {{1.0, 0.0, 0.0}, channels, filter};
}

TEST(Target, BilinearIsTheRootMeanSquareOverTheTexel) {
    const std::vector<float> rgb = noisy_map();
    const compress::Target target = compress::environment_target(
        rgb.data(), kColumns, kRows, options(ACDF_CHANNELS_WEIGHTED, ACDF_FILTER_BILINEAR));
    constexpr int n = 64;
    double total = 0.0;
    for (std::uint32_t r = 0; r < kRows; ++r)
        for (std::uint32_t c = 0; c < kColumns; ++c) {
            double square = 0.0, weight = 0.0, peak = 0.0, mean = 0.0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const double y = r + (j + 0.5) / n, f = bilinear(rgb, 0, c + (i + 0.5) / n, y);
                    const double w = std::sin(kPi * y / kRows);
                    square += w * f * f;
                    mean += w * f;
                    weight += w;
                    peak = std::max(peak, f);
                    total += f * w * (2.0 * kPi / kColumns / n) * (kPi / kRows / n);
                }
            const std::size_t at = std::size_t{r} * kColumns + c;
            EXPECT_NEAR(target.values[at], std::sqrt(square / weight), 2e-3 * std::sqrt(square / weight) + 1e-6);
            EXPECT_NEAR(target.means.at(0)[at], mean / weight, 2e-3 * mean / weight + 1e-6);
            EXPECT_GE(target.peaks[at], peak - 1e-5);
            EXPECT_LE(target.peaks[at], peak + 0.3);
        }
    EXPECT_NEAR(target.total, total, 1e-3 * total);
    EXPECT_NEAR(target.mean_square, total * total, 3e-3 * total * total);
}

TEST(Target, SeparateChannelsAreTheRootOfTheSumOfSquares) {
    const std::vector<float> rgb = noisy_map();
    const compress::Target target = compress::environment_target(
        rgb.data(), kColumns, kRows, options(ACDF_CHANNELS_SEPARATE, ACDF_FILTER_NEAREST));
    double sums[3] = {};
    for (std::size_t i = 0; i < target.values.size(); ++i) {
        const double r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
        EXPECT_FLOAT_EQ(target.values[i], static_cast<float>(std::sqrt(r * r + g * g + b * b)));
        for (std::size_t k = 0; k < 3; ++k) {
            sums[k] += rgb[3 * i + k] * target.row_measure[i / kColumns] * target.column_measure[i % kColumns];
            EXPECT_EQ(target.means.at(k)[i], rgb[3 * i + k]);
        }
    }
    EXPECT_NEAR(target.mean_square, sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2],
                1e-9 * target.mean_square);
}

TEST(Target, ChannelsThatAreMoreThanAFloatTogetherAreRefused) {
    const std::vector<float> rgb(std::size_t{3} * kColumns * kRows, 3e38f);
    const auto made = [&](AcdfChannels channels, AcdfFilter filter) {
        return compress::environment_target(rgb.data(), kColumns, kRows, options(channels, filter));
    };
    EXPECT_THROW(made(ACDF_CHANNELS_SEPARATE, ACDF_FILTER_NEAREST), std::invalid_argument);
    EXPECT_THROW(made(ACDF_CHANNELS_SEPARATE, ACDF_FILTER_BILINEAR), std::invalid_argument);
    EXPECT_EQ(made(ACDF_CHANNELS_LARGEST, ACDF_FILTER_NEAREST).values[0], 3e38f);
}

/// A file that fits `target`, and how it serves `other`.
build::Accuracy measured(const compress::Target& target, const compress::Target& other, std::uint32_t cells) {
    compress::HalvingsOptions fit;
    fit.goal.cells = cells;
    compress::Description description = compress::environment_description(kColumns, kRows);
    description.total = target.total;
    const std::vector<std::uint8_t> bytes = compress::store(compress::fit_halvings(target, fit), description);
    File file;
    const Status status = File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    return build::measure_environment(file, other);
}

TEST(Target, TheSumOfTheChannelsVariancesIsWhatIsMeasured) {
    const std::vector<float> rgb = noisy_map();
    const compress::Target target = compress::environment_target(
        rgb.data(), kColumns, kRows, options(ACDF_CHANNELS_SEPARATE, ACDF_FILTER_NEAREST));
    compress::HalvingsOptions fit;
    fit.goal.cells = 20;
    compress::Description description = compress::environment_description(kColumns, kRows);
    description.total = target.total;
    const std::vector<std::uint8_t> bytes = compress::store(compress::fit_halvings(target, fit), description);
    File file;
    ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
    const EnvironmentView view = file.environment();
    double second = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        double mean = 0.0;
        for (std::size_t i = 0; i < target.values.size(); ++i) {
            const double theta = kPi * (double(i / kColumns) + 0.5) / kRows;
            const double phi = kPi * (1.0 - 2.0 * (double(i % kColumns) + 0.5) / kColumns);
            const float w[3] = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                                static_cast<float>(std::sin(theta) * std::sin(phi)),
                                static_cast<float>(std::cos(theta))};
            const double f = rgb[3 * i + k], measure = target.row_measure[i / kColumns] * target.column_measure[0];
            mean += f * measure;
            if (f > 0.0) second += f * f / view.pdf(w) * measure;
        }
        squares += mean * mean;
    }
    const build::Accuracy accuracy = measured(target, target, 20);
    EXPECT_NEAR(accuracy.relative_variance, (second - squares) / squares, 1e-5 * second / squares);
    EXPECT_GE(accuracy.relative_variance, accuracy.least_variance);
}

TEST(Target, AFitForTheWrongLookupIsBiasedOrNoisier) {
    std::vector<float> rgb(kColumns * kRows * 3, 0.0f);
    for (std::size_t k = 0; k < 3; ++k) rgb[3 * (3 * kColumns + 5) + k] = 1.0f; // one lit texel
    const auto target = [&](AcdfFilter filter) {
        return compress::environment_target(rgb.data(), kColumns, kRows, options(ACDF_CHANNELS_WEIGHTED, filter));
    };
    const compress::Target nearest = target(ACDF_FILTER_NEAREST), interpolated = target(ACDF_FILTER_BILINEAR);
    EXPECT_EQ(measured(nearest, interpolated, 84).support_violations, 8u); // the neighbours
    EXPECT_EQ(measured(interpolated, interpolated, 84).support_violations, 0u);

    for (float& value : rgb) value += 0.01f;
    const compress::Target bright = target(ACDF_FILTER_NEAREST), blurred = target(ACDF_FILTER_BILINEAR);
    const double right = measured(blurred, blurred, 84).relative_variance;
    EXPECT_GT(measured(bright, blurred, 84).relative_variance, 1.5 * right);
    EXPECT_LT(measured(bright, bright, 84).relative_variance, 1e-3);
}

} // namespace
