#include "measure/ratio.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace acdf::measure {
namespace {

struct Moments {
    double mean = 0.0, standard_error = 0.0;
};

Moments moments(const std::vector<double>& x) {
    Moments out;
    const auto count = static_cast<double>(x.size());
    for (const double value : x) out.mean += value / count;
    double square = 0.0;
    for (const double value : x) square += (value - out.mean) * (value - out.mean);
    out.standard_error = std::sqrt(square / (count - 1.0) / count);
    return out;
}

} // namespace

double student_t(std::size_t degrees) {
    constexpr double few[] = {12.706, 4.303, 3.182, 2.776, 2.571};
    if (degrees == 0) return std::numeric_limits<double>::infinity();
    if (degrees <= std::size(few)) return few[degrees - 1];
    // Expansion about the normal quantile (Fisher and Cornish 1960): three digits from six degrees on.
    constexpr double z = 1.959963985, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    const double n = static_cast<double>(degrees);
    return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
           (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

Interval mean_interval(const std::vector<double>& measured) {
    const Moments m = moments(measured);
    const double half = student_t(measured.size() - 1) * m.standard_error;
    return {m.mean, m.mean - half, m.mean + half};
}

Interval ratio_interval(const std::vector<double>& a, const std::vector<double>& b) {
    const Moments ma = moments(a), mb = moments(b);
    if (!(ma.mean > 0.0) || !(mb.mean > 0.0))
        return {ma.mean / mb.mean, 0.0, std::numeric_limits<double>::infinity()};
    const double ratio = ma.mean / mb.mean;
    const double error = std::hypot(ma.standard_error / ma.mean, mb.standard_error / mb.mean);
    const double factor = std::exp(student_t(std::min(a.size(), b.size()) - 1) * error);
    return {ratio, ratio / factor, ratio * factor};
}

Interval product(const Interval& a, const Interval& b) {
    const double value = a.value * b.value;
    if (!(a.low > 0.0) || !(b.low > 0.0)) return {value, 0.0, std::numeric_limits<double>::infinity()};
    const double factor = std::exp(std::hypot(std::log(a.high / a.value), std::log(b.high / b.value)));
    return {value, value / factor, value * factor};
}

} // namespace acdf::measure
