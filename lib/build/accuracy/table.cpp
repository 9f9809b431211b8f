#include "build/accuracy/table.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/sums.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace acdf::build {
namespace {

using compress::Grid;
using compress::Sum;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// One bin: its grid with the measure of each axis normalised to 1.
class Bin {
public:
    explicit Bin(const Grid& grid) : grid_(grid), measure_(grid.measure) {
        double volume = 1.0;
        for (std::vector<double>& steps : measure_) {
            Sum length;
            for (double step : steps) length.add(step);
            for (double& step : steps) step /= length.value();
            volume *= length.value();
        }
        total_ = integral(grid) / volume;
    }

    bool lit() const { return total_ > 0.0; }

    void add(const TableCell& cell, Sums& sums) const {
        double volume = 1.0;
        for (std::size_t axis = 0; axis < grid_.dimensions(); ++axis) {
            const AcdfSpan& span = cell.box[axis];
            Sum length;
            for (std::uint32_t i = span.end[0]; i < span.end[1]; ++i) length.add(measure_[axis][i]);
            volume *= length.value();
        }
        add_axis(0, 0, cell, cell.probability / volume, 1.0, sums);
    }

private:
    void add_axis(std::size_t axis, std::size_t offset, const TableCell& cell, double p, double measure,
                  Sums& sums) const {
        const AcdfSpan& span = cell.box[axis];
        const bool last = axis + 1 == grid_.dimensions();
        for (std::uint32_t i = span.end[0]; i < span.end[1]; ++i) {
            const std::size_t at = offset * grid_.shape[axis] + i;
            if (last) add_value(grid_.values[at] / total_, p, measure * measure_[axis][i], sums);
            else add_axis(axis + 1, at, cell, p, measure * measure_[axis][i], sums);
        }
    }

    static void add_value(double f, double p, double measure, Sums& sums) {
        const double error = f - p;
        sums.square_error.add(measure * error * error);
        if (!(p > 0.0)) {
            sums.violations += f > 0.0;
            return;
        }
        sums.variance.add(measure * error * error / p);
        if (!(f > 0.0)) return;
        sums.kl.add(measure * f * std::log(f / p));
        sums.max_weight = std::max(sums.max_weight, f / p);
    }

    const Grid& grid_;
    std::vector<std::vector<double>> measure_;
    double total_ = 0.0;
};

/// The cells in the order of the tree, and the first of each run that is summed at once: runs of about the same
/// number of grid points, whatever the number of threads.
struct TableWork {
    std::vector<TableCell> cells;
    std::vector<std::size_t> begin;
};

TableWork divide(const File& file, std::uint32_t bin, const Grid& grid) {
    constexpr std::uint64_t kPoints = 1 << 17;
    TableWork work;
    std::uint64_t points = kPoints;
    for_each_table_cell(file, bin, [&](const TableCell& cell) {
        if (points >= kPoints) {
            work.begin.push_back(work.cells.size());
            points = 0;
        }
        std::uint64_t inside = 1;
        for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
            inside *= cell.box[axis].end[1] - cell.box[axis].end[0];
        points += inside;
        work.cells.push_back(cell);
    });
    work.begin.push_back(work.cells.size());
    return work;
}

Sums sum_cells(const TableWork& work, const Bin& bin) {
    std::vector<Sums> parts(work.begin.size() - 1);
    compress::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
        for (std::size_t i = work.begin[k]; i < work.begin[k + 1]; ++i) bin.add(work.cells[i], parts[k]);
    });
    Sums sums;
    for (const Sums& part : parts) sums.add(part);
    return sums;
}

std::uint64_t positive_values(const Grid& grid) {
    std::size_t count = 1;
    for (std::uint32_t length : grid.shape) count *= length;
    return static_cast<std::uint64_t>(
        std::count_if(grid.values, grid.values + count, [](float v) { return v > 0; }));
}

BinAccuracy measure_bin(const File& file, std::uint32_t index, const Grid& grid) {
    const Bin bin(grid);
    BinAccuracy a;
    a.lit = bin.lit();
    if (!a.lit) return a;
    if (file.bin(index).share > 0.0f) {
        const TableWork work = divide(file, index, grid);
        const Sums sums = sum_cells(work, bin);
        a.cells = work.cells.size();
        a.support_violations = sums.violations;
        a.relative_variance = std::max(0.0, sums.variance.value());
        a.square_error = std::max(0.0, sums.square_error.value());
        a.kl_divergence = std::max(0.0, sums.kl.value());
        a.max_weight = sums.max_weight;
    } else {
        a.support_violations = positive_values(grid); // nothing is ever sampled here
    }
    if (a.support_violations > 0) a.relative_variance = a.kl_divergence = a.max_weight = kInfinite;
    return a;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

} // namespace

void check_shapes(const File& file, const std::vector<Grid>& bins) {
    const std::uint32_t axes = file.description().axis_count;
    if (bins.size() != file.description().bin_count) throw std::invalid_argument("another number of bins");
    for (const Grid& grid : bins)
        for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
            if (grid.axes[axis] >= axes || file.axis(grid.axes[axis]).resolution != grid.shape[axis])
                throw std::invalid_argument("the file was made from another resolution");
}

std::vector<BinAccuracy> measure_bins(const File& file, const std::vector<Grid>& bins) {
    check_shapes(file, bins);
    std::vector<BinAccuracy> out(bins.size());
    compress::parallel_for(std::size_t{0}, bins.size(), [&](std::size_t i) {
        out[i] = measure_bin(file, static_cast<std::uint32_t>(i), bins[i]);
    });
    if (std::none_of(out.begin(), out.end(), [](const BinAccuracy& a) { return a.lit; }))
        throw std::invalid_argument("a table without energy");
    return out;
}

TableAccuracy summary(const std::vector<BinAccuracy>& bins) {
    TableAccuracy out;
    Sum variance, square_error, kl;
    std::vector<double> variances;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const BinAccuracy& bin = bins[i];
        if (!bin.lit) continue;
        variance.add(bin.relative_variance);
        square_error.add(bin.square_error);
        kl.add(bin.kl_divergence);
        if (variances.empty() || bin.relative_variance > out.worst) {
            out.worst = bin.relative_variance;
            out.worst_bin = static_cast<std::uint32_t>(i);
        }
        variances.push_back(bin.relative_variance);
        out.max_weight = std::max(out.max_weight, bin.max_weight);
        out.support_violations += bin.support_violations;
        out.cells += bin.cells;
    }
    out.lit_bins = static_cast<std::uint32_t>(variances.size());
    if (variances.empty()) return out;
    const auto n = static_cast<double>(variances.size());
    out.median = median(variances);
    out.rms_pdf_error = std::sqrt(square_error.value() / n);
    // A compensated sum of infinities is NaN.
    out.relative_variance = out.support_violations > 0 ? kInfinite : variance.value() / n;
    out.kl_divergence = out.support_violations > 0 ? kInfinite : kl.value() / n;
    return out;
}

} // namespace acdf::build
