#include "tests/lib/compress/checks.h"

#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/environment.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace acdf_test {
namespace {

using acdf::EnvironmentView;
using acdf::build::Cell;
using acdf::compress::Conditional;
using acdf::compress::FitOptions;
using acdf::compress::Order;
using acdf::compress::Target;

const std::uint32_t kSamples = std::uint32_t(repeated(60000));
// Chi-square tests in all: two a fit, 15 fits, 12 synthetic targets on two grids and four probes on two. Together
// they reject a correct program with a chance of 1 % (once and for all, because the seeds are fixed).
constexpr int kChiSquareTests = 2 * 15 * 2 * (12 + 4);
constexpr std::uint32_t kPhiBins = 31,
                        kZBins = 15; // of u and v too; odd, so that no border falls on those of a grid

bool is_octahedral(const Target& target) { return target.parameterization == ACDF_PARAM_OCTAHEDRAL; }

/// The direction at (u, v) of the octahedral square, and back: SPEC.md §6.6.
void square_direction(double u, double v, float d[3]) {
    const double a = std::abs(2.0 * u - 1.0), b = std::abs(2.0 * v - 1.0), e = a + b - 1.0, r = 1.0 - std::abs(e);
    const double phi = r == 0.0 ? 0.0 : kPi / 4.0 * ((b - a) / r + 1.0), sine = r * std::sqrt(2.0 - r * r);
    d[0] = static_cast<float>(sine * std::cos(phi) * (u > 0.5 ? -1.0 : 1.0));
    d[1] = static_cast<float>(sine * std::sin(phi) * (v < 0.5 ? -1.0 : 1.0));
    d[2] = static_cast<float>(-e * (1.0 + r));
}
struct Square {
    double u, v;
};
Square square_of(const float d[3]) {
    const double x = std::abs(double{d[0]}), y = std::abs(double{d[1]}), z = std::abs(double{d[2]});
    const double r = std::sqrt((x * x + y * y) / (1.0 + z));
    double b = 2.0 * r * std::atan2(y, x) / kPi, a = r - b;
    if (d[2] < 0.0f) {
        const double inner = a;
        a = 1.0 - b;
        b = 1.0 - inner;
    }
    return {0.5 * (d[0] > 0.0f ? 1.0 - a : 1.0 + a), 0.5 * (d[1] < 0.0f ? 1.0 - b : 1.0 + b)};
}

/// Cells, and for each texel the cell that covers it.
struct CellMap {
    std::vector<Cell> cells;
    std::vector<std::uint32_t> of_texel;
};

CellMap map_cells(const acdf::File& file, const Target& target) {
    constexpr std::uint32_t kNone = 0xFFFFFFFF;
    CellMap map;
    map.of_texel.assign(target.values.size(), kNone);
    std::size_t overlaps = 0;
    acdf::build::for_each_cell(file.environment(), [&](const Cell& cell) {
        for (std::uint32_t r = cell.range[1].low; r < cell.range[1].high; ++r)
            for (std::uint32_t c = cell.range[0].low; c < cell.range[0].high; ++c) {
                std::uint32_t& owner = map.of_texel[std::size_t{r} * target.columns + c];
                overlaps += owner != kNone;
                owner = static_cast<std::uint32_t>(map.cells.size());
            }
        map.cells.push_back(cell);
    });
    EXPECT_EQ(overlaps, 0u);
    EXPECT_EQ(std::count(map.of_texel.begin(), map.of_texel.end(), kNone), 0);
    return map;
}

void check_cells(const CellMap& map, const Target& target) {
    double sum = 0.0;
    std::vector<double> largest(map.cells.size(), 0.0);
    for (std::size_t i = 0; i < map.of_texel.size(); ++i)
        largest[map.of_texel[i]] = std::max(largest[map.of_texel[i]], double{target.values[i]});
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < map.cells.size(); ++i) {
        sum += map.cells[i].probability;
        wrong += (largest[i] > 0.0) != (map.cells[i].probability > 0.0);
    }
    EXPECT_EQ(wrong, 0u) << "cells with energy and no probability, or the reverse";
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

/// Sums pdf x solid angle over texel centres. Exact for tilted pdfs too: those are linear in phi and in
/// z across a texel, so that the value at the centre is the mean.
void check_integral(const EnvironmentView& view, const Target& target) {
    double sum = 0.0;
    std::uint64_t violations = 0;
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const double z = centre_z(r, target.rows);
        const double height = is_octahedral(target)
                                  ? 2.0 / target.rows
                                  : std::cos(kPi * r / target.rows) - std::cos(kPi * (r + 1.0) / target.rows);
        const double solid_angle = 2.0 * kPi / target.columns * height;
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            float direction[3];
            if (is_octahedral(target))
                square_direction((c + 0.5) / target.columns, (r + 0.5) / target.rows, direction);
            else direction_of(centre_phi(c, target.columns), z, direction);
            const double pdf = view.pdf(direction);
            sum += pdf * solid_angle;
            violations += target.row(r)[c] > 0.0f && !(pdf > 0.0);
        }
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
    EXPECT_EQ(violations, 0u);
}

/// Adds to `bins` the share of a range that falls into each; x0, x1 in [0, 1] where the range lies.
void spread(double x0, double x1, double tilt, std::vector<double>& bins) {
    std::fill(bins.begin(), bins.end(), 0.0);
    const double count = static_cast<double>(bins.size());
    const auto cdf = [&](double x) {
        const double t = std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
        return t * (1.0 - tilt) + tilt * t * t;
    };
    const auto first = static_cast<std::size_t>(x0 * count);
    for (std::size_t i = first; i < bins.size() && double(i) < x1 * count; ++i)
        bins[i] = cdf(double(i + 1) / count) - cdf(double(i) / count);
}

/// Probability of each equal-area bin of the sphere, from the cells.
std::vector<double> bin_probabilities(const CellMap& map, const Target& target) {
    std::vector<double> phi(kPhiBins), z(kZBins), bins(kPhiBins * kZBins, 0.0);
    const auto height = [&](std::uint32_t row) {
        return is_octahedral(target) ? double(row) / target.rows : 0.5 - 0.5 * std::cos(kPi * row / target.rows);
    };
    for (const Cell& cell : map.cells) {
        const acdf::build::Cell& c = cell;
        spread(double(c.range[0].low) / target.columns, double(c.range[0].high) / target.columns, c.range[0].tilt,
               phi);
        spread(height(c.range[1].low), height(c.range[1].high), c.range[1].tilt, z);
        for (std::size_t j = 0; j < kZBins; ++j)
            if (z[j] > 0.0)
                for (std::size_t i = 0; i < kPhiBins; ++i) bins[j * kPhiBins + i] += c.probability * z[j] * phi[i];
    }
    return bins;
}

/// Where a direction lies on the grid, and how far down the sphere's area its row begins: 0 to 1.
struct Where {
    double column, row, z, down;
};

Where where_of(const float d[3], const Target& target) {
    const double x = d[0], y = d[1], z = d[2];
    if (is_octahedral(target)) {
        const Square at = square_of(d);
        return {at.u * target.columns, at.v * target.rows, z, at.v};
    }
    double turn = 0.5 - std::atan2(y, x) / (2.0 * kPi); // 0 at phi = pi, 1 at phi = -pi
    if (turn >= 1.0) turn = 0.0;
    return {turn * target.columns, std::atan2(std::hypot(x, y), z) / kPi * target.rows, z, 0.5 * (1.0 - z)};
}

std::size_t step_of(double position, std::uint32_t count) {
    return std::min<std::size_t>(static_cast<std::size_t>(std::max(position, 0.0)), count - 1);
}

void expect_chi_square(const char* what, const std::vector<std::uint32_t>& observed,
                       const std::vector<double>& probability) {
    const ChiSquare test = chi_square(observed, probability);
    EXPECT_FALSE(test.impossible) << what << ": samples where the density is 0";
    EXPECT_GT(test.p_value, sidak(0.01, kChiSquareTests))
        << what << ": chi-square " << test.statistic << " with " << test.degrees << " degrees of freedom";
}

/// What a direction rounded to float (by less than 2^-22 radians) may change in a cell's tilted pdf.
double rounding_bound(const Cell& cell, const Where& place, const Target& target) {
    if (cell.range[0].tilt == 0.0 && cell.range[1].tilt == 0.0) return 0.0;
    const auto z_of = [&](double row) { return std::cos(kPi * row / target.rows); };
    const auto share = [](const AcdfTiltedRange& range, double t, double error) {
        const double density = std::max(1.0 - std::abs(range.tilt), 1.0 + range.tilt * (2.0 * t - 1.0));
        return 2.0 * std::abs(range.tilt) / density * error;
    };
    const AcdfTiltedRange &columns = cell.range[0], &rows = cell.range[1];
    const double width = columns.high - columns.low, height = z_of(rows.low) - z_of(rows.high);
    if (is_octahedral(target)) { // a sample is moved inside by 2^-23 of the side, and by rounding less than that
        const double tall = rows.high - rows.low;
        return share(columns, (place.column - columns.low) / width, 0x1p-22 * target.columns / width) +
               share(rows, (place.row - rows.low) / tall, 0x1p-22 * target.rows / tall);
    }
    const double sin_theta = std::max(std::sqrt((1.0 - place.z) * (1.0 + place.z)), 0x1p-22);
    return share(columns, (place.column - columns.low) / width,
                 0x1p-22 / sin_theta * target.columns / (2.0 * kPi * width)) +
           share(rows, (z_of(rows.low) - place.z) / height, 0x1p-22 * sin_theta / height);
}

/// How far sample().pdf is from pdf(direction).
struct Agreement {
    double worst = 0.0;    // 0 if bit-exact
    std::uint32_t far = 0; // farther than rounding the direction explains
    std::uint32_t bad = 0; // not unit, not finite or not positive

    void add(const EnvironmentView& view, const acdf::DirectionSample& sample, double bound) {
        const float* d = sample.direction;
        const double length = std::sqrt(double{d[0]} * d[0] + double{d[1]} * d[1] + double{d[2]} * d[2]);
        bad += !(std::abs(length - 1.0) < 1e-6) || !std::isfinite(sample.pdf) || !(sample.pdf > 0.0f);
        const double difference = std::abs(double{view.pdf(d)} / sample.pdf - 1.0);
        far += !(difference <= bound + (bound > 0.0 ? 2e-7 : 0.0)); // 2e-7: pdfs are floats
        worst = std::max(worst, difference);
    }
};

/// The texel that a position lies in.
std::size_t texel_of(const Where& place, const Target& target) {
    return step_of(place.row, target.rows) * target.columns + step_of(place.column, target.columns);
}

void check_samples(const EnvironmentView& view, const CellMap& map, const Target& target, double relative_variance,
                   std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Agreement agreement;
    std::vector<std::uint32_t> in_bins(kPhiBins * kZBins, 0), in_cells(map.cells.size(), 0);
    double estimate = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const auto sample = view.sample(uniform(random), uniform(random));
        const Where place = where_of(sample.direction, target);
        const std::size_t texel = texel_of(place, target);
        agreement.add(view, sample, rounding_bound(map.cells[map.of_texel[texel]], place, target));
        ++in_cells[map.of_texel[texel]];
        ++in_bins[step_of(place.down * kZBins, kZBins) * kPhiBins +
                  step_of(place.column / target.columns * kPhiBins, kPhiBins)];
        estimate += double{target.values[texel]} / sample.pdf / kSamples;
    }
    // How near a tilted cell's darkest edge samples come; `far` says whether rounding explains what is seen there.
    EXPECT_LE(agreement.worst, target.parameterization == ACDF_PARAM_OCTAHEDRAL ? 2e-4 : 1e-4);
    for (const double u0 : {0.0, 0.5, 1.0}) // at a cell's darkest edge rounding shows most
        for (const double u1 : {0.0, 0.5, 1.0}) {
            const auto sample = view.sample(u0, u1);
            const Where place = where_of(sample.direction, target);
            const Cell& cell = map.cells[map.of_texel[texel_of(place, target)]];
            agreement.add(view, sample, rounding_bound(cell, place, target));
        }
    EXPECT_EQ(agreement.bad, 0u);
    EXPECT_EQ(agreement.far, 0u);

    std::vector<double> cell_probability;
    for (const Cell& cell : map.cells) cell_probability.push_back(cell.probability);
    expect_chi_square("bins", in_bins, bin_probabilities(map, target));
    expect_chi_square("cells", in_cells, cell_probability);

    const double total = acdf::compress::integral(target);
    const double standard_error = std::sqrt(relative_variance / kSamples);
    EXPECT_NEAR(estimate / total, 1.0, 5.0 * standard_error + 1e-6); // 1e-6: pdfs are floats
}

} // namespace

std::vector<NamedFit> all_fits(std::uint32_t columns, std::uint32_t rows, std::uint32_t cells) {
    FitOptions base;
    base.column_segments = columns;
    base.row_segments = rows;
    base.goal.cells = cells;
    std::vector<NamedFit> variants;
    const auto add = [&](const char* name, AcdfFit fit, double epsilon, std::uint32_t gradient, Conditional mean) {
        FitOptions options = base;
        options.fit = fit;
        options.epsilon = epsilon;
        options.gradient_knots = gradient;
        options.conditional = mean;
        variants.push_back({name, options});
    };
    add("uniform", ACDF_FIT_UNIFORM, 0.0, 0, Conditional::energy);
    add("cdf", ACDF_FIT_CDF, 0.0, 0, Conditional::energy);
    add("cdf, gradient", ACDF_FIT_CDF, 0.0, rows / 2, Conditional::energy);
    add("cdf, mean", ACDF_FIT_CDF, 0.0, 0, Conditional::mean);
    add("cdf, gradient, mean", ACDF_FIT_CDF, 0.0, rows / 2, Conditional::mean);
    add("cdf, epsilon", ACDF_FIT_CDF, 0.02, 0, Conditional::energy);
    add("pdf", ACDF_FIT_PDF, 0.0, 0, Conditional::energy);

    std::vector<NamedFit> all;
    for (const NamedFit& variant : variants)
        for (const Order order : {Order::phi, Order::z}) {
            all.push_back(variant);
            all.back().name += order == Order::phi ? ", order phi" : ", order z";
            all.back().options.order = order;
        }
    FitOptions variance = base;
    variance.fit = ACDF_FIT_VARIANCE;
    all.push_back({"variance", variance});
    return all;
}

/// Halvings of the variance fit, curves of the others.
static std::vector<std::uint8_t> stored(const Target& target, const FitOptions& options,
                                        const acdf::compress::Description& description) {
    if (options.fit != ACDF_FIT_VARIANCE)
        return acdf::compress::store(acdf::compress::fit(target, options).tree, description);
    acdf::compress::HalvingsOptions halvings;
    halvings.goal = options.goal;
    return acdf::compress::store(acdf::compress::fit_halvings(target, halvings), description);
}

void check_fit(const Target& target, const NamedFit& fit) {
    SCOPED_TRACE(fit.name);
    auto description =
        acdf::compress::environment_description(target.columns, target.rows, target.parameterization);
    description.fit = fit.options.fit;
    description.total = acdf::compress::integral(target);
    const auto bytes = stored(target, fit.options, description);
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    ASSERT_TRUE(status.ok()) << status.message;

    const auto accuracy = acdf::build::measure_environment(file, target);
    ASSERT_TRUE(std::isfinite(accuracy.relative_variance));
    EXPECT_EQ(accuracy.support_violations, 0u);
    EXPECT_NEAR(accuracy.total / file.environment().total(), 1.0, 1e-15);
    const CellMap map = map_cells(file, target);
    EXPECT_EQ(accuracy.cells, map.cells.size());
    check_cells(map, target);
    check_integral(file.environment(), target);
    check_samples(file.environment(), map, target, accuracy.relative_variance, bytes.size());
}

} // namespace acdf_test
