#include "build/accuracy/environment.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/partner.h"
#include "build/accuracy/step_means.h"
#include "build/accuracy/sums.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace acdf::build {
namespace {

using compress::Sum;
using compress::Target;

double range_measure(const AcdfTiltedRange& range, const std::vector<double>& measure) {
    Sum sum;
    for (std::uint32_t i = range.low; i < range.high; ++i) sum.add(measure[i]);
    return sum.value();
}

/// One cell after the other, of a target whose integral (of g) is `total`.
class CellSummer {
public:
    CellSummer(const Target& target, double total) : target_(target), total_(total) {}

    void add(const Cell& cell, Sums& sums) {
        const AcdfTiltedRange &columns = cell.range[0], &rows = cell.range[1];
        const double density = cell.probability / (range_measure(columns, target_.column_measure) *
                                                   range_measure(rows, target_.row_measure));
        range_means(columns, target_.column_measure, column_means_);
        range_means(rows, target_.row_measure, row_means_);
        for (std::uint32_t r = rows.low; r < rows.high; ++r)
            add_row(r, density, columns, row_means_[r - rows.low], sums);
    }

private:
    void add_row(std::uint32_t r, double density, const AcdfTiltedRange& columns, const StepMeans& row,
                 Sums& sums) const {
        const float* values = target_.row(r);
        for (std::uint32_t c = columns.low; c < columns.high; ++c) {
            const StepMeans& column = column_means_[c - columns.low];
            const double f = values[c] / total_; // p*: g, normalised
            const double measure = target_.row_measure[r] * target_.column_measure[c];
            const double p = density * column.g * row.g;
            const double p_square = density * density * column.square * row.square;
            sums.square_error.add(measure * (p_square - 2.0 * p * f + f * f));
            if (!(density > 0.0)) {
                sums.violations += f > 0.0;
                continue;
            }
            // The mean of (f/p - 1)^2 under p, so that a small variance keeps its digits: f^2/p - 2f + p.
            const double reciprocal = column.reciprocal * row.reciprocal / density;
            sums.variance.add(measure *
                              (flat(column, row) ? (f - p) * (f - p) / p : f * f * reciprocal - 2.0 * f + p));
            if (!(f > 0.0)) continue;
            sums.kl.add(measure * (f * (std::log(f / density) - column.logarithm - row.logarithm)));
            const double peak =
                target_.peaks.empty() ? values[c] : target_.peaks[std::size_t{r} * target_.columns + c];
            sums.max_weight = std::max(sums.max_weight, peak / (density * column.smallest * row.smallest));
        }
    }

    static bool flat(const StepMeans& a, const StepMeans& b) { return a.square == 1.0 && b.square == 1.0; }

    const Target& target_;
    double total_;
    std::vector<StepMeans> column_means_, row_means_;
};

/// The cells in the order of the tree, and the first of each run that is summed at once.
struct Work {
    std::vector<Cell> cells;
    std::vector<std::size_t> begin;
};

/// Runs of about the same number of texels; they do not depend on the number of threads, nor does the result.
Work divide(const EnvironmentView& environment) {
    constexpr std::uint64_t kTexels = 1 << 17;
    Work work;
    std::uint64_t texels = kTexels;
    for_each_cell(environment, [&](const Cell& cell) {
        if (texels >= kTexels) {
            work.begin.push_back(work.cells.size());
            texels = 0;
        }
        const AcdfTiltedRange &columns = cell.range[0], &rows = cell.range[1];
        texels += std::uint64_t{columns.high - columns.low} * (rows.high - rows.low);
        work.cells.push_back(cell);
    });
    work.begin.push_back(work.cells.size());
    return work;
}

Sums sum_all(const Work& work, const Target& target, double total) {
    std::vector<Sums> parts(work.begin.size() - 1);
    compress::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
        CellSummer summer(target, total);
        for (std::size_t i = work.begin[k]; i < work.begin[k + 1]; ++i) summer.add(work.cells[i], parts[k]);
    });
    Sums sums;
    for (const Sums& part : parts) sums.add(part);
    return sums;
}

} // namespace

namespace {

constexpr std::uint32_t kPartnerNormals = 64;

Accuracy measure_combined(const File& file, const Target& target) {
    const PartnerAccuracy both = measure_beside_partner(file, target, random_normals(kPartnerNormals));
    Accuracy a;
    a.combined = true;
    a.total = target.total > 0.0 ? target.total : integral(target);
    for_each_cell(file.environment(), [&](const Cell&) { ++a.cells; });
    a.relative_variance = both.relative_variance;
    a.max_weight = both.max_weight;
    a.support_violations = both.support_violations;
    return a;
}

} // namespace

namespace {

void require_same_grid(const File& file, const Target& target) {
    if (file.description().parameterization != target.parameterization)
        throw std::invalid_argument("the file lies on another grid");
    if (file.axis(ACDF_AXIS_PHI).resolution != target.columns ||
        file.axis(ACDF_AXIS_THETA).resolution != target.rows)
        throw std::invalid_argument("the file was made from another resolution");
}

Accuracy measure_alone(const EnvironmentView& environment, const Target& target) {
    Accuracy a;
    const double perfect = integral(target);
    a.total = target.total > 0.0 ? target.total : perfect;
    if (!(perfect > 0.0)) throw std::invalid_argument("a target without energy");
    const Work work = divide(environment);
    const Sums sums = sum_all(work, target, perfect);
    a.cells = work.cells.size();
    a.support_violations = sums.violations;
    a.rms_pdf_error = std::sqrt(std::max(0.0, sums.square_error.value()) / (4.0 * ACDF_PI));
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const double least = least_second_moment(target); // the sums are relative to it
    a.least_variance = std::max(0.0, least - 1.0);
    a.relative_variance =
        sums.violations > 0 ? kInfinite : std::max(0.0, sums.variance.value() * least + (least - 1.0));
    a.kl_divergence = sums.violations > 0 ? kInfinite : std::max(0.0, sums.kl.value());
    a.max_weight = sums.violations > 0 ? kInfinite : sums.max_weight / perfect * std::sqrt(least);
    return a;
}

} // namespace

Accuracy measure_environment(const File& file, const Target& target) {
    require_same_grid(file, target);
    if (file.partner()) return measure_combined(file, target);
    return measure_alone(file.environment(), target);
}

Accuracy measure_whole(const File& file, const Target& target) {
    require_same_grid(file, target);
    return measure_alone(file.local().environment(), target);
}

} // namespace acdf::build
