#include "measure/accuracy.h"

#include "compress/sum.h"
#include "measure/cells.h"
#include "measure/full_cdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace acdf::measure {
namespace {

using compress::Sum;
using compress::Target;

/// Means over one grid step of functions of the tilt density g, which is linear there, from g0 to g1.
struct StepMeans {
    double g = 1.0, square = 1.0, reciprocal = 1.0, logarithm = 0.0, smallest = 1.0;
};

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

/// StepMeans of each grid step in a cell's range on one axis.
void range_means(const AcdfRange& range, const std::vector<double>& measure, std::vector<StepMeans>& out) {
    out.assign(range.high - range.low, StepMeans{});
    if (range.tilt == 0.0) return;
    Sum length;
    for (std::uint32_t i = range.low; i < range.high; ++i) length.add(measure[i]);
    double g = 1.0 - range.tilt;
    Sum t;
    for (std::uint32_t i = range.low; i < range.high; ++i) {
        t.add(measure[i] / length.value());
        const double next = acdf_tilt_density(range.tilt, std::min(1.0, t.value()));
        out[i - range.low] = step_means(g, next);
        g = next;
    }
}

double range_measure(const AcdfRange& range, const std::vector<double>& measure) {
    Sum sum;
    for (std::uint32_t i = range.low; i < range.high; ++i) sum.add(measure[i]);
    return sum.value();
}

/// Sums over cells; each adds the texels it covers.
class Accumulator {
public:
    explicit Accumulator(const Target& target) : target_(target), total_(integral(target)) {
        if (!(total_ > 0.0)) throw std::invalid_argument("a target without energy");
    }

    void add(const Cell& cell) {
        ++cells_;
        const AcdfRange &columns = cell.range[0], &rows = cell.range[1];
        const double density = cell.probability / (range_measure(columns, target_.column_measure) *
                                                   range_measure(rows, target_.row_measure));
        range_means(columns, target_.column_measure, column_means_);
        range_means(rows, target_.row_measure, row_means_);
        for (std::uint32_t r = rows.low; r < rows.high; ++r) add_row(r, density, columns, row_means_[r - rows.low]);
    }

    Accuracy result() const {
        Accuracy a;
        a.total = total_;
        a.cells = cells_;
        a.support_violations = violations_;
        // Around 1, so that a small variance keeps its digits: the mean of (f/p - 1)^2 under p.
        a.relative_variance =
            violations_ ? std::numeric_limits<double>::infinity() : std::max(0.0, variance_.value());
        a.kl_divergence = violations_ ? std::numeric_limits<double>::infinity() : std::max(0.0, kl_.value());
        a.rms_pdf_error = std::sqrt(std::max(0.0, square_error_.value()) / (4.0 * ACDF_PI));
        a.max_weight = violations_ ? std::numeric_limits<double>::infinity() : max_weight_;
        a.relative_variance_full_cdf = full_cdf_relative_variance(target_);
        return a;
    }

private:
    void add_row(std::uint32_t r, double density, const AcdfRange& columns, const StepMeans& row) {
        const float* values = target_.row(r);
        for (std::uint32_t c = columns.low; c < columns.high; ++c) {
            const StepMeans& column = column_means_[c - columns.low];
            const double f = values[c] / total_; // p*
            const double measure = target_.row_measure[r] * target_.column_measure[c];
            const double p = density * column.g * row.g;
            const double p_square = density * density * column.square * row.square;
            square_error_.add(measure * (p_square - 2.0 * p * f + f * f));
            if (!(density > 0.0)) {
                violations_ += f > 0.0;
                continue;
            }
            // (f/p - 1)^2 p = f^2/p - 2f + p, in means over the texel.
            const double reciprocal = column.reciprocal * row.reciprocal / density;
            variance_.add(measure * (flat(column, row) ? (f - p) * (f - p) / p : f * f * reciprocal - 2.0 * f + p));
            if (!(f > 0.0)) continue;
            kl_.add(measure * (f * (std::log(f / density) - column.logarithm - row.logarithm)));
            max_weight_ = std::max(max_weight_, f / (density * column.smallest * row.smallest));
        }
    }

    static bool flat(const StepMeans& a, const StepMeans& b) { return a.square == 1.0 && b.square == 1.0; }

    const Target& target_;
    double total_;
    Sum variance_, square_error_, kl_;
    double max_weight_ = 0.0;
    std::uint64_t violations_ = 0, cells_ = 0;
    std::vector<StepMeans> column_means_, row_means_;
};

} // namespace

Accuracy measure_environment(const File& file, const Target& target) {
    if (file.axis(ACDF_AXIS_PHI).resolution != target.columns ||
        file.axis(ACDF_AXIS_THETA).resolution != target.rows)
        throw std::invalid_argument("the file was made from another resolution");
    Accumulator sums(target);
    for_each_cell(file, file.bin(0).root, [&](const Cell& cell) { sums.add(cell); });
    return sums.result();
}

} // namespace acdf::measure
