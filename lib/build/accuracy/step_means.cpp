#include "build/accuracy/step_means.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {
namespace {

/// Of g from g0 to g1.
StepMeans step_means(double g0, double g1) {
    StepMeans m;
    const double x = (g1 - g0) / g0;
    m.g = 0.5 * (g0 + g1);
    m.square = (g0 * g0 + g0 * g1 + g1 * g1) / 3.0;
    m.reciprocal = (std::abs(x) < 1e-5 ? 1.0 - x * (0.5 - x / 3.0) : std::log1p(x) / x) / g0;
    m.logarithm = std::log(g0) + (std::abs(x) < 1e-4 ? x * (0.5 - x / 6.0 * (1.0 - 0.5 * x))
                                                     : ((1.0 + x) * std::log1p(x) - x) / x);
    m.smallest = std::min(g0, g1);
    return m;
}

} // namespace

void range_means(const AcdfTiltedRange& range, const std::vector<double>& measure, std::vector<StepMeans>& out) {
    out.assign(range.high - range.low, StepMeans{});
    if (range.tilt == 0.0) return;
    compress::Sum length;
    for (std::uint32_t i = range.low; i < range.high; ++i) length.add(measure[i]);
    double g = 1.0 - range.tilt;
    compress::Sum t;
    for (std::uint32_t i = range.low; i < range.high; ++i) {
        t.add(measure[i] / length.value());
        const double next = acdf_tilt_pdf(range.tilt, std::min(1.0, t.value()));
        out[i - range.low] = step_means(g, next);
        g = next;
    }
}

} // namespace acdf::build
