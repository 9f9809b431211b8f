// Pearson's chi-square test with pooling of rare outcomes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace acdf_test {

/// The regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0: by its series below a + 1, by its
/// continued fraction above (Abramowitz and Stegun 1964, 6.5.29 and 6.5.31).
inline double gamma_q(double a, double x) {
    if (!(x > 0.0)) return 1.0;
    const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (double n = a + 1.0; term > sum * 1e-17; n += 1.0) sum += term *= x / n;
        return std::max(0.0, 1.0 - scale * sum);
    }
    // Modified Lentz evaluation of 1/(x+1-a- 1(1-a)/(x+3-a- 2(2-a)/(x+5-a- ...))).
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int i = 1; i < 100000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return scale * h;
}

struct ChiSquare {
    double statistic = 0.0;
    int degrees = 0;
    double p_value = 1.0;
    bool impossible = false; ///< something of probability 0 was observed
};

/// Tests counts against `probability` (sum 1). Outcomes expected fewer than 5 times are pooled.
inline ChiSquare chi_square(const std::vector<std::uint32_t>& observed, const std::vector<double>& probability) {
    double samples = 0.0;
    for (std::uint32_t n : observed) samples += n;
    ChiSquare test;
    double pooled_observed = 0.0, pooled_expected = 0.0;
    int outcomes = 0;
    const auto add = [&](double count, double expected) {
        test.statistic += (count - expected) * (count - expected) / expected;
        ++outcomes;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        const double expected = samples * probability[i];
        if (!(probability[i] > 0.0)) {
            test.impossible |= observed[i] > 0;
        } else if (expected < 5.0) {
            pooled_observed += observed[i];
            pooled_expected += expected;
        } else {
            add(observed[i], expected);
        }
    }
    // What remains too rare to judge is left out: the statistic then only loses a little power.
    if (pooled_expected >= 5.0) add(pooled_observed, pooled_expected);
    test.degrees = outcomes - 1;
    if (test.degrees > 0) test.p_value = gamma_q(0.5 * test.degrees, 0.5 * test.statistic);
    return test;
}

/// The significance of each of `tests` independent tests that together reject a truth with chance `family`
/// (Sidak 1967).
inline double sidak(double family, int tests) { return -std::expm1(std::log1p(-family) / tests); }

} // namespace acdf_test
