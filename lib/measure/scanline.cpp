#include "measure/scanline.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::measure {
namespace {

using compress::Curve;
using compress::Sum;

/// The integral of p*^2 less 1 of a row; -1 where it is black.
double contrast_of(const float* row, std::uint32_t texels) {
    Sum sum;
    for (std::uint32_t i = 0; i < texels; ++i) sum.add(row[i]);
    const double mean = sum.value() / texels;
    if (!(mean > 0.0)) return -1.0;
    Sum deviation;
    for (std::uint32_t i = 0; i < texels; ++i) deviation.add((row[i] / mean - 1.0) * (row[i] / mean - 1.0));
    return deviation.value() / texels;
}

} // namespace

Scanline::Scanline(const compress::Target& target, std::uint32_t row) {
    if (row >= target.rows) throw std::invalid_argument("the probe has no such row");
    values_.assign(target.row(row), target.row(row) + target.columns);
    Sum sum;
    for (const float value : values_) sum.add(value);
    if (!(sum.value() > 0.0)) throw std::invalid_argument("there is no light in the row");
    row_.measure.assign(target.columns, 1.0 / target.columns);
    for (const float value : values_) row_.mass.push_back(value / sum.value());
    for (std::uint32_t segments = 1; segments <= texels(); ++segments)
        uniform_error_.push_back(rms_error(fit(ACDF_FIT_UNIFORM, segments)));
}

Curve Scanline::fit(AcdfFit fit, std::uint32_t segments) const {
    compress::CurveBudget budget;
    budget.segments = segments;
    if (fit == ACDF_FIT_UNIFORM) return compress::fit_curve_uniform(row_, budget);
    return fit == ACDF_FIT_CDF ? compress::fit_curve_cdf(row_, budget) : compress::fit_curve_pdf(row_, budget);
}

double Scanline::rms_error(const Curve& curve) const {
    Sum sum;
    std::uint32_t i = 0;
    for (std::size_t s = 0; s < curve.segments(); ++s) {
        const std::uint32_t begin = i, end = s < curve.knots.size() ? curve.knots[s] : texels();
        const double length = end - begin, density = curve.probability[s] * texels() / length;
        const double slope = curve.tilts.empty() ? 0.0 : curve.tilts[s] * density; // from the middle to the end
        for (; i < end; ++i) {
            const double middle = 2.0 * (i - begin + 0.5) / length - 1.0;
            const double difference = density + slope * middle - row_.mass[i] * texels();
            sum.add(difference * difference + slope * slope / (3.0 * length * length));
        }
    }
    return std::sqrt(sum.value() / texels());
}

std::uint32_t Scanline::uniform_segments(double rms_error) const {
    const auto enough = [&](double error) { return error <= rms_error; };
    const auto first = std::find_if(uniform_error_.begin(), uniform_error_.end(), enough);
    return first == uniform_error_.end() ? texels()
                                         : static_cast<std::uint32_t>(first - uniform_error_.begin()) + 1;
}

double Scanline::contrast() const { return contrast_of(values_.data(), texels()); }

KnotGain knot_gain(const Scanline& scanline, AcdfFit fit, std::uint32_t segments) {
    const Curve curve = scanline.fit(fit, segments);
    KnotGain out;
    out.segments = static_cast<std::uint32_t>(curve.segments());
    out.rms_error = scanline.rms_error(curve);
    out.uniform_segments = scanline.uniform_segments(out.rms_error);
    return out;
}

std::uint32_t choose_row(const compress::Target& target, RowChoice choice) {
    std::uint32_t best = target.rows;
    double best_contrast = 0.0;
    const std::uint32_t skipped = target.rows / 4;
    for (std::uint32_t r = skipped; r < target.rows - skipped; ++r) {
        const double contrast = contrast_of(target.row(r), target.columns);
        if (contrast < 0.0) continue;
        const bool better = choice == RowChoice::smooth ? contrast < best_contrast : contrast > best_contrast;
        if (best < target.rows && !better) continue;
        best = r;
        best_contrast = contrast;
    }
    if (best == target.rows) throw std::invalid_argument("there is no light in any row");
    return best;
}

} // namespace acdf::measure
