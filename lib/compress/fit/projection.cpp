#include "compress/fit/projection.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kLines = 4;  // summed side by side: each alone would wait for its last addition
constexpr std::size_t kTile = 128; // steps of them that stay in the cache

/// A line of the box along the last axis.
struct LineSums {
    const float *values = nullptr, *peaks = nullptr; ///< from the box's first step on
    double weight = 1.0;                             ///< its measure on the other axes
    std::array<std::uint32_t, ACDF_MAX_AXES> index;  ///< its position on them
};

struct LineSum {
    double flux = 0.0, energy = 0.0;
    float peak = 0.0f;
};

/// Calls `visit(offset, index)` for every line of the box along the last axis: where in `values` it begins, and
/// its position on the other axes.
template <class Visit>
void for_each_line(const Grid& grid, const Box& box, const Visit& visit) {
    const std::size_t last = grid.dimensions() - 1;
    std::array<std::uint32_t, ACDF_MAX_AXES> index = box.begin;
    for (;;) {
        std::size_t offset = 0;
        for (std::size_t axis = 0; axis <= last; ++axis) offset = offset * grid.shape[axis] + index[axis];
        visit(offset, index);
        std::size_t axis = last;
        while (axis > 0 && ++index[axis - 1] == box.end[axis - 1]) {
            index[axis - 1] = box.begin[axis - 1];
            --axis;
        }
        if (axis == 0) return;
    }
}

/// The measure of a box on one axis.
double extent(const Grid& grid, const Box& box, std::size_t axis) {
    double sum = 0.0;
    for (std::uint32_t i = box.begin[axis]; i < box.end[axis]; ++i) sum += grid.measure[axis][i];
    return sum;
}

void set_measures(const Grid& grid, const Box& box, Projections& out) {
    std::array<double, ACDF_MAX_AXES> extents{};
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis) extents[axis] = extent(grid, box, axis);
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis) {
        double across = 1.0;
        for (std::size_t other = 0; other < grid.dimensions(); ++other)
            if (other != axis) across *= extents[other];
        out[axis].reset(box.length(axis));
        for (std::uint32_t i = 0; i < box.length(axis); ++i)
            out[axis].measure[i] = across * grid.measure[axis][box.begin[axis] + i];
    }
}

/// f . measure and f^2 . measure of the steps of a piece of a line, which are also added to those `along` the axis.
void weigh(const float* values, std::size_t count, double total, double weight, const double* measures,
           double* __restrict flux, double* __restrict energy, double* __restrict flux_along,
           double* __restrict energy_along) {
    for (std::size_t i = 0; i < count; ++i) {
        const double f = values[i] / total;
        const double step = f * weight * measures[i];
        flux[i] = step;
        energy[i] = f * step;
        flux_along[i] += flux[i];
        energy_along[i] += energy[i];
    }
}

void raise_peaks(const float* peaks, std::size_t count, float* __restrict along) {
    for (std::size_t i = 0; i < count; ++i) along[i] = peaks[i] > along[i] ? peaks[i] : along[i];
}

/// Adds so many lines, in order, to the slices across the last axis, and sums each from its first step to its last.
template <std::size_t Lines>
void add_lines(const LineSums* lines, std::size_t length, double total, const double* measures, Slices& along,
               LineSum* sums) {
    double flux[Lines][kTile], energy[Lines][kTile];
    LineSum sum[Lines];
    for (std::size_t begin = 0; begin < length; begin += kTile) {
        const std::size_t count = std::min(kTile, length - begin);
        for (std::size_t l = 0; l < Lines; ++l) {
            weigh(lines[l].values + begin, count, total, lines[l].weight, measures + begin, flux[l], energy[l],
                  along.flux.data() + begin, along.energy.data() + begin);
            raise_peaks(lines[l].peaks + begin, count, along.peak.data() + begin);
        }
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t l = 0; l < Lines; ++l) {
                sum[l].flux += flux[l][i];
                sum[l].energy += energy[l][i];
                const float peak = lines[l].peaks[begin + i];
                sum[l].peak = peak > sum[l].peak ? peak : sum[l].peak;
            }
    }
    std::copy(sum, sum + Lines, sums);
}

/// Lines that are gathered until there are enough of them.
class Gathered {
public:
    Gathered(const Grid& grid, double total, const Box& box, Projections& out)
        : grid_(grid), box_(box), out_(out), total_(total), last_(grid.dimensions() - 1) {}

    void add(const LineSums& line) {
        lines_[count_++] = line;
        if (count_ == kLines) {
            add_lines<kLines>(lines_, box_.length(last_), total_, measures(), out_[last_], sums_);
            add_to_slices();
        }
    }
    /// What is left.
    void finish() {
        for (std::size_t l = 0; l < count_; ++l)
            add_lines<1>(lines_ + l, box_.length(last_), total_, measures(), out_[last_], sums_ + l);
        add_to_slices();
    }

private:
    const double* measures() const { return grid_.measure[last_].data() + box_.begin[last_]; }
    void add_to_slices() {
        for (std::size_t l = 0; l < count_; ++l)
            for (std::size_t axis = 0; axis < last_; ++axis) {
                const std::size_t slice = lines_[l].index[axis] - box_.begin[axis];
                out_[axis].flux[slice] += sums_[l].flux;
                out_[axis].energy[slice] += sums_[l].energy;
                out_[axis].peak[slice] = std::max(out_[axis].peak[slice], sums_[l].peak);
            }
        count_ = 0;
    }

    const Grid& grid_;
    const Box& box_;
    Projections& out_;
    double total_;
    std::size_t last_, count_ = 0;
    LineSums lines_[kLines];
    LineSum sums_[kLines];
};

/// Beside an MIS partner: what slices cost at best takes the place of their flux, and what they cost if left to it
/// comes with it.
void add_partner(const Grid& grid, double total, const Box& box, Projections& out) {
    const std::size_t last = grid.dimensions() - 1;
    for (std::size_t axis = 0; axis <= last; ++axis) {
        std::fill(out[axis].flux.begin(), out[axis].flux.end(), 0.0);
        out[axis].left.assign(out[axis].size(), 0.0);
    }
    for_each_line(grid, box, [&](std::size_t offset, const auto& index) {
        double weight = 1.0 / total, least = 0.0, left = 0.0;
        for (std::size_t axis = 0; axis < last; ++axis) weight *= grid.measure[axis][index[axis]];
        const double* measures = grid.measure[last].data() + box.begin[last];
        for (std::size_t i = 0; i < box.length(last); ++i) {
            const double step = weight * measures[i];
            const double own_least = grid.least[offset + i] * step, own_left = grid.left[offset + i] * step;
            least += own_least;
            left += own_left;
            out[last].flux[i] += own_least;
            out[last].left[i] += own_left;
        }
        for (std::size_t axis = 0; axis < last; ++axis) {
            out[axis].flux[index[axis] - box.begin[axis]] += least;
            out[axis].left[index[axis] - box.begin[axis]] += left;
        }
    });
}

} // namespace

double Moments::cost() const { return cell_cost(std::sqrt(measure * energy), left); }

double Moments::share(const Filling* filling) const {
    const double alone = std::sqrt(measure * energy);
    return filling ? filling->share(alone, left) : alone;
}

double Moments::weight() const { return energy > 0.0 ? peak * std::sqrt(measure / energy) : 0.0; }

void Slices::reset(std::size_t count) {
    measure.assign(count, 0.0);
    energy.assign(count, 0.0);
    flux.assign(count, 0.0);
    left.clear();
    peak.assign(count, 0.0f);
}

Moments Slices::sum(std::size_t begin, std::size_t end, double total) const {
    Moments out;
    for (std::size_t i = begin; i < end; ++i)
        out.add({measure[i], energy[i], flux[i], left.empty() ? 0.0 : left[i], double{peak[i]}});
    out.peak /= total;
    return out;
}

void project(const Grid& grid, double total, const Box& box, Projections& out) {
    set_measures(grid, box, out);
    const std::size_t last = grid.dimensions() - 1;
    Gathered gathered(grid, total, box, out);
    LineSums line;
    for_each_line(grid, box, [&](std::size_t offset, const auto& index) {
        line.weight = 1.0;
        for (std::size_t axis = 0; axis < last; ++axis) line.weight *= grid.measure[axis][index[axis]];
        line.values = grid.values + offset;
        line.peaks = (grid.peaks ? grid.peaks : grid.values) + offset;
        line.index = index;
        gathered.add(line);
    });
    gathered.finish();
    if (grid.left) add_partner(grid, total, box, out);
}

double integral(const Grid& grid) {
    Box all;
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis) all.end[axis] = grid.shape[axis];
    const std::size_t last = grid.dimensions() - 1;
    Sum total;
    for_each_line(grid, all, [&](std::size_t offset, const auto& index) {
        double weight = 1.0;
        for (std::size_t axis = 0; axis < last; ++axis) weight *= grid.measure[axis][index[axis]];
        Sum line;
        for (std::size_t i = 0; i < grid.shape[last]; ++i)
            line.add(grid.values[offset + i] * grid.measure[last][i]);
        total.add(line.value() * weight);
    });
    return total.value();
}

} // namespace acdf::compress
