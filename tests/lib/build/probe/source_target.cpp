// Files of maps of every layout: their printed accuracy is that of a sum over the map's own texels, with the
// map's own lookup and the reader's pdf, written here once more.
#include "build/probe/source_target.h"
#include "build/accuracy/environment.h"
#include "build/probe/cube.h"
#include "build/probe/source_lookup.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"
#include "compress/threads.h"
#include "tests/inputs/directions.h"
#include "tests/inputs/sanitized.h"

#include <acdf/reader.h>
#include <acdf/views.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace {

using namespace acdf;
using acdf_test::kPi;
using acdf_test::kSanitized;
using build::Direction;
using build::Layout;
using build::Map;

struct Named {
    const char* name;
    Map map;
};

const Named maps[] = {{"latlong", {Layout::latlong, 36, 18}},
                      {"octahedral", {Layout::octahedral, 24, 24}},
                      {"angular", {Layout::angular, 24, 24}},
                      {"mirrorball", {Layout::mirrorball, 24, 24}},
                      {"vertical_cross", {Layout::vertical_cross, 24, 32}},
                      {"horizontal_cross", {Layout::horizontal_cross, 32, 24}},
                      {"stacked_cube", {Layout::stacked_cube, 8, 48}}};
const Named repeated[] = {{"latlong", {Layout::latlong, 36, 18, true}},
                          {"mirrorball", {Layout::mirrorball, 24, 24, true}}};

/// A sky, with a sun of one texel and a part that is dark.
std::vector<float> picture(const Map& map) {
    std::vector<float> rgb(3 * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), 0.0f);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            Direction d;
            if (!build::to_direction(map, (x + 0.5) / map.width, (y + 0.5) / map.height, d)) continue;
            const double sky = d.z < -0.3 ? 0.0 : 1.0 + 0.8 * d.z + 0.3 * d.x * d.y;
            for (std::size_t c = 0; c < 3; ++c)
                rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                         static_cast<std::size_t>(x)) +
                    c] = static_cast<float>(sky);
        }
    const build::ImagePoint sun = build::to_image(map, {0.52, 0.48, 0.7067});
    const auto at = static_cast<std::size_t>(sun.v * map.height) * static_cast<std::size_t>(map.width) +
                    static_cast<std::size_t>(sun.u * map.width);
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * at + c] = 400.0f;
    return rgb;
}

/// Solid angle of a point of a texel, but for a factor.
double weight(const Map& map, double u, double v, const Direction& d) {
    switch (map.layout) {
    case Layout::latlong:
        return std::sin(kPi * v);
    case Layout::angular: {
        const double r = std::hypot(2 * u - 1, 2 * v - 1);
        return r > 0.0 ? std::sin(kPi * r) / r : kPi;
    }
    case Layout::mirrorball:
    case Layout::octahedral:
        return 1.0;
    default:
        return std::pow(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), 3.0);
    }
}

struct Summed {
    double relative_variance = 0.0, max_weight = 0.0, lost = 0.0, total = 0.0;
};

/// With `points` x `points` points a texel: the middles of equal parts, so that borders of cells cut as many on
/// either side.
Summed sum_over(const Map& map, const std::vector<float>& rgb, bool bilinear, const EnvironmentView& view,
                int points) {
    double first = 0.0, second = 0.0, largest = 0.0, lost = 0.0;
    const auto value = [&](int x, int y, int column, int row) {
        const build::TexelPosition at = build::texel_beside(map, x, y, column, row);
        return double{rgb[3 * (static_cast<std::size_t>(at.row) * static_cast<std::size_t>(map.width) +
                               static_cast<std::size_t>(at.column))]};
    };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double omega = build::texel_solid_angle(map, x, y);
            if (!(omega > 0.0)) continue;
            double around[3][3], most = 0.0;
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) {
                    around[j][i] = bilinear || (i == 1 && j == 1) ? value(x, y, x + i - 1, y + j - 1) : 0.0;
                    most = std::max(most, around[j][i]);
                }
            if (!(most > 0.0)) continue;
            double weights = 0.0, sum = 0.0, square = 0.0, dark = 0.0;
            for (int i = 0; i < points * points + 9; ++i) {
                const bool corner = i >= points * points; // or the middle, or that of a side: f is largest at one
                const int k = i - points * points;
                const double s = corner ? 0.5 * (k % 3) : (i % points + 0.5) / points,
                             t = corner ? 0.5 * (k / 3) : (i / points + 0.5) / points;
                Direction d;
                // Inside, as far as the rounding of directions asks.
                const double u = (x + std::clamp(s, 1e-3, 1.0 - 1e-3)) / map.width,
                             v = (y + std::clamp(t, 1e-3, 1.0 - 1e-3)) / map.height;
                if (!build::to_direction(map, u, v, d)) continue;
                double f = around[1][1];
                if (bilinear) {
                    const int i0 = s < 0.5 ? 0 : 1, j0 = t < 0.5 ? 0 : 1;
                    const double a = s + 0.5 - i0, b = t + 0.5 - j0;
                    f = (1 - b) * ((1 - a) * around[j0][i0] + a * around[j0][i0 + 1]) +
                        b * ((1 - a) * around[j0 + 1][i0] + a * around[j0 + 1][i0 + 1]);
                }
                const float direction[3] = {static_cast<float>(d.x), static_cast<float>(d.y),
                                            static_cast<float>(d.z)};
                const double p = view.pdf(direction), w = corner ? 0.0 : weight(map, u, v, d);
                weights += w;
                sum += w * f;
                if (!(f > 0.0)) continue;
                if (p > 0.0) {
                    square += w * f * f / p;
                    largest = std::max(largest, f / p);
                } else {
                    dark += w * f;
                }
            }
            if (!(weights > 0.0)) continue;
            first += omega * sum / weights;
            second += omega * square / weights;
            lost += omega * dark / weights;
        }
    return {second / first / first - 1.0, largest / first, lost / first, first};
}

compress::TargetOptions filtered(AcdfFilter filter) {
    compress::TargetOptions options;
    options.filter = filter;
    return options;
}

/// Found once a process: overlaps of small cells take long, however small the map is.
const build::SourceTarget& target_of(const Map& map, AcdfParameterization grid, AcdfFilter filter) {
    static std::map<std::tuple<Layout, bool, AcdfParameterization, AcdfFilter>, build::SourceTarget> made;
    const auto [at, is_new] = made.try_emplace({map.layout, map.repeats, grid, filter});
    if (is_new)
        at->second = build::source_target(map, picture(map).data(), build::domain_for(map, grid), filtered(filter));
    return at->second;
}

class EveryLayout : public ::testing::TestWithParam<Named> {};

void check(const Map& map, AcdfParameterization grid, AcdfFilter filter) {
    const std::vector<float> rgb = picture(map);
    const build::SourceTarget& made = target_of(map, grid, filter);
    compress::HalvingsOptions fit;
    fit.goal.cells = 500;
    compress::Description description =
        compress::environment_description(made.target.columns, made.target.rows, made.target.parameterization);
    description.total = made.target.total;
    const auto bytes = compress::store(compress::fit_halvings(made.target, fit), description);
    File file;
    const Status status = File::from_memory(bytes.data(), bytes.size(), file);
    ASSERT_TRUE(status.ok()) << status.message;
    const build::Accuracy printed = build::measure_environment(file, made.target);
    const bool bilinear = filter == ACDF_FILTER_BILINEAR;
    const bool own = build::own_domain(map) == build::Domain{grid, made.target.columns, made.target.rows};
    const Summed summed = sum_over(map, rgb, bilinear, file.environment(), own ? 36 : 72);
    EXPECT_EQ(printed.support_violations, 0u);
    EXPECT_EQ(summed.lost, 0.0) << "light without density";
    EXPECT_NEAR(printed.total / summed.total, 1.0, 2e-3);
    // 1e-6: pdfs are floats
    EXPECT_NEAR(printed.relative_variance, summed.relative_variance, 0.01 * summed.relative_variance + 1e-6);
    // The largest weight may lie in a sliver that no point of the sum hits, but not above what is printed.
    EXPECT_LE(summed.max_weight, printed.max_weight * 1.02);
    EXPECT_LT(made.error, 1e-3);
    if (own) {
        EXPECT_NEAR(printed.max_weight / summed.max_weight, 1.0, 0.02);
        EXPECT_EQ(made.error, 0.0);
    }
}

TEST_P(EveryLayout, WhatIsPrintedIsTrue) {
    for (const AcdfParameterization grid : {ACDF_PARAM_LATLONG, ACDF_PARAM_OCTAHEDRAL})
        for (const AcdfFilter filter : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR}) {
            // Each grid with each filter takes long under sanitizers; other tests have the other ones.
            if (kSanitized && (grid == ACDF_PARAM_LATLONG || filter == ACDF_FILTER_NEAREST)) continue;
            SCOPED_TRACE(std::string(grid == ACDF_PARAM_LATLONG ? "lat-long" : "octahedral") +
                         (filter == ACDF_FILTER_NEAREST ? ", nearest" : ", bilinear"));
            check(GetParam().map, grid, filter);
        }
}

INSTANTIATE_TEST_SUITE_P(SourceTarget, EveryLayout, ::testing::ValuesIn(maps),
                         [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(RepeatedSource, EveryLayout, ::testing::ValuesIn(repeated),
                         [](const auto& info) { return std::string(info.param.name); });

// A map of which only the last row is lit, as a texture that repeats shows it: f is 1/2 at the zenith and falls to
// 0 in the middle of the first row; it is 1/2 at the nadir and 1 in the middle of the last row, whence it falls to
// 0 in the middle of the row before. The sums are over z = cos theta, written here once more.
TEST(SourceTarget, RowsThatRepeatMeetAtThePoles) {
    const Map map{Layout::latlong, 20, 10, true};
    std::vector<float> rgb(3 * 20 * 10, 0.0f);
    std::fill_n(rgb.end() - 3 * 20, 3 * 20, 1.0f);
    const auto integral = [](double from, double to, auto&& f) { // over rows
        double sum = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const double v = from + (i + 0.5) / 20000 * (to - from);
            sum += f(v) * std::sin(kPi * v / 10.0) * (to - from) / 20000;
        }
        return sum;
    };
    const auto row_mean = [&](double row, double from, double to, auto&& f) {
        return integral(from, to, f) / integral(row, row + 1.0, [](double) { return 1.0; });
    };
    const auto at_zenith = [](double v) { return 0.5 - v; };
    const auto at_nadir = [](double v) { return 0.5 + (10.0 - v); };
    const auto above = [](double v) { return v - 8.5; };
    const double first = row_mean(0.0, 0.0, 0.5, at_zenith),
                 first_square = row_mean(0.0, 0.0, 0.5, [&](double v) { return at_zenith(v) * at_zenith(v); }),
                 last = row_mean(9.0, 9.0, 9.5, above) + row_mean(9.0, 9.5, 10.0, at_nadir),
                 last_square = row_mean(9.0, 9.0, 9.5, [&](double v) { return above(v) * above(v); }) +
                               row_mean(9.0, 9.5, 10.0, [&](double v) { return at_nadir(v) * at_nadir(v); });
    const compress::Target target =
        build::source_target(map, rgb.data(), {ACDF_PARAM_LATLONG, 20, 10}, filtered(ACDF_FILTER_BILINEAR)).target;
    ASSERT_EQ(target.means.size(), 1u);
    for (std::size_t column = 0; column < 20; ++column) {
        EXPECT_NEAR(target.means[0][column] / first, 1.0, 1e-6);
        EXPECT_NEAR(target.values[column] / std::sqrt(first_square), 1.0, 1e-6);
        EXPECT_FLOAT_EQ(target.peaks[column], 0.5f);
        EXPECT_NEAR(target.means[0][180 + column] / last, 1.0, 1e-6);
        EXPECT_NEAR(target.values[180 + column] / std::sqrt(last_square), 1.0, 1e-6);
        EXPECT_FLOAT_EQ(target.peaks[180 + column], 1.0f);
    }
    const double omega = 2.0 * kPi * (1.0 - std::cos(kPi / 10.0)); // of either row
    const double before = row_mean(8.0, 8.5, 9.0, above),
                 omega_before = 2.0 * kPi * (std::cos(0.8 * kPi) - std::cos(0.9 * kPi));
    EXPECT_NEAR(target.total / (omega * (first + last) + omega_before * before), 1.0, 1e-6);
    EXPECT_DOUBLE_EQ(target.mean_square, target.total * target.total);
}

// Beside a border of the square, of a face and of the seam lies the texel that shows the direction there.
TEST(SourceLookup, NeighboursAcrossBordersAreNeighboursOnTheSphere) {
    for (const Named& named : maps) {
        const Map& map = named.map;
        if (map.layout == Layout::angular || map.layout == Layout::mirrorball) continue; // stop at the image
        if (map.layout == Layout::stacked_cube) continue;                                // stops at the face
        double side = 0.0;
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) side = std::max(side, build::texel_solid_angle(map, x, y));
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) {
                if (!(build::texel_solid_angle(map, x, y) > 0.0)) continue;
                Direction here, there;
                ASSERT_TRUE(build::to_direction(map, (x + 0.5) / map.width, (y + 0.5) / map.height, here));
                const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
                for (const auto& step : steps) {
                    const build::TexelPosition at = build::texel_beside(map, x, y, x + step[0], y + step[1]);
                    ASSERT_TRUE(build::to_direction(map, (at.column + 0.5) / map.width, (at.row + 0.5) / map.height,
                                                    there));
                    const double distance = std::sqrt((here.x - there.x) * (here.x - there.x) +
                                                      (here.y - there.y) * (here.y - there.y) +
                                                      (here.z - there.z) * (here.z - there.z));
                    ASSERT_LT(distance, 2.2 * std::sqrt(side))
                        << named.name << ": " << x << ' ' << y << " to " << at.column << ' ' << at.row;
                }
            }
    }
}

TEST(SourceTarget, IsTheSameForAnyNumberOfThreads) {
    const Map map = maps[2].map;
    const std::vector<float> rgb = picture(map);
    const build::SourceTarget& a = target_of(map, ACDF_PARAM_OCTAHEDRAL, ACDF_FILTER_NEAREST);
    for (const int threads : {1, 7}) {
        build::SourceTarget b;
        compress::with_threads(threads, [&] {
            b = build::source_target(map, rgb.data(), build::domain_for(map, ACDF_PARAM_OCTAHEDRAL),
                                     filtered(ACDF_FILTER_NEAREST));
        });
        EXPECT_EQ(a.target.values, b.target.values);
        EXPECT_EQ(a.target.total, b.target.total);
    }
}

TEST(SourceTarget, TakesTheGridThatLosesLess) {
    for (const Named& named : maps) {
        if (build::own_domain(named.map)) continue;
        if (kSanitized && named.map.layout != Layout::angular) continue;
        if (build::cube_face_size(named.map) > 0 && named.map.layout != Layout::vertical_cross) continue;
        const std::vector<float> rgb = picture(named.map);
        double least = 1e30;
        for (const AcdfParameterization grid : {ACDF_PARAM_LATLONG, ACDF_PARAM_OCTAHEDRAL})
            least = std::min(least,
                             compress::least_second_moment(target_of(named.map, grid, ACDF_FILTER_NEAREST).target));
        const build::SourceTarget chosen =
            build::source_target_losing_least(named.map, rgb.data(), filtered(ACDF_FILTER_NEAREST));
        EXPECT_EQ(compress::least_second_moment(chosen.target), least) << named.name;
    }
}

} // namespace
