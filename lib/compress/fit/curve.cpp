#include "compress/fit/curve.h"

#include "compress/fit/polyline.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// Positions of the grid borders in the axis's measure: x[0] = 0.
std::vector<double> borders(const Distribution& distribution) {
    std::vector<double> x(distribution.measure.size() + 1, 0.0);
    Sum sum;
    for (std::size_t i = 0; i < distribution.measure.size(); ++i) {
        sum.add(distribution.measure[i]);
        x[i + 1] = sum.value();
    }
    return x;
}

/// The CDF at the grid borders, from 0 to exactly 1.
std::vector<double> cumulative(const Distribution& distribution) {
    std::vector<double> y(distribution.mass.size() + 1, 0.0);
    Sum sum;
    for (std::size_t i = 0; i < distribution.mass.size(); ++i) {
        sum.add(distribution.mass[i]);
        y[i + 1] = sum.value();
    }
    const double total = y.back();
    for (double& value : y) value /= total;
    return y;
}

/// The pdf at the grid borders: the mean of the steps on either side.
std::vector<double> border_pdf(const Distribution& distribution) {
    const std::size_t n = distribution.mass.size();
    std::vector<double> density(n), y(n + 1);
    for (std::size_t i = 0; i < n; ++i) density[i] = distribution.mass[i] / distribution.measure[i];
    y.front() = density.front();
    y.back() = density.back();
    for (std::size_t i = 1; i < n; ++i) y[i] = 0.5 * (density[i - 1] + density[i]);
    const double peak = *std::max_element(density.begin(), density.end());
    for (double& value : y) value /= peak;
    return y;
}

/// The mean of 1 / (1 + s (2t - 1)) over [t0, t1].
double mean_reciprocal(double s, double t0, double t1) {
    const double g0 = 1.0 + s * (2.0 * t0 - 1.0);
    const double x = 2.0 * s * (t1 - t0) / g0;
    return (std::abs(x) < 1e-5 ? 1.0 - x * (0.5 - x / 3.0) : std::log1p(x) / x) / g0;
}

} // namespace

Curve curve_through(const Distribution& distribution, std::vector<std::uint32_t> knots) {
    Curve curve;
    curve.knots = std::move(knots);
    Sum total;
    for (std::size_t s = 0, i = 0; s < curve.segments(); ++s) {
        const std::size_t end = s < curve.knots.size() ? curve.knots[s] : distribution.mass.size();
        Sum sum;
        for (; i < end; ++i) sum.add(distribution.mass[i]);
        curve.probability.push_back(sum.value());
        total.add(sum.value());
    }
    for (double& p : curve.probability) p /= total.value();
    return curve;
}

Curve fit_curve_uniform(const Distribution& distribution, const CurveBudget& budget) {
    const std::uint64_t steps = distribution.mass.size();
    const std::uint64_t segments = std::min<std::uint64_t>(budget.segments, steps);
    std::vector<std::uint32_t> knots;
    for (std::uint64_t k = 1; k < segments; ++k) knots.push_back(static_cast<std::uint32_t>(k * steps / segments));
    return curve_through(distribution, std::move(knots));
}

Curve fit_curve_cdf(const Distribution& distribution, const CurveBudget& budget) {
    return curve_through(distribution, douglas_peucker(borders(distribution), cumulative(distribution),
                                                       budget.segments, budget.epsilon));
}

Curve fit_curve_pdf(const Distribution& distribution, const CurveBudget& budget) {
    Curve curve = curve_through(distribution, douglas_peucker(borders(distribution), border_pdf(distribution),
                                                              budget.segments, budget.epsilon));
    std::uint32_t begin = 0;
    for (std::size_t s = 0; s < curve.segments(); ++s) {
        const std::uint32_t end =
            s < curve.knots.size() ? curve.knots[s] : static_cast<std::uint32_t>(distribution.mass.size());
        curve.tilts.push_back(best_tilt(distribution, begin, end));
        begin = end;
    }
    return curve;
}

double best_tilt(const Distribution& distribution, std::uint32_t begin, std::uint32_t end) {
    double length = 0.0;
    for (std::uint32_t i = begin; i < end; ++i) length += distribution.measure[i];
    const auto cost = [&](double s) {
        double sum = 0.0, t = 0.0;
        for (std::uint32_t i = begin; i < end; ++i) {
            const double next = std::min(1.0, t + distribution.measure[i] / length);
            const double density = distribution.mass[i] / distribution.measure[i];
            sum += density * density * (next - t) * mean_reciprocal(s, t, next);
            t = next;
        }
        return sum;
    };
    if (end - begin == 1 || !(cost(0.0) > 0.0)) return 0.0;
    // The cost is convex in s: golden-section search.
    constexpr double kLimit = 0.999, kGolden = 0.6180339887498949;
    double a = -kLimit, b = kLimit;
    double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
    double cost_c = cost(c), cost_d = cost(d);
    while (b - a > 1e-4) {
        if (cost_c <= cost_d) {
            b = d, d = c, cost_d = cost_c;
            c = b - kGolden * (b - a), cost_c = cost(c);
        } else {
            a = c, c = d, cost_c = cost_d;
            d = a + kGolden * (b - a), cost_d = cost(d);
        }
    }
    return 0.5 * (a + b);
}

} // namespace acdf::compress
