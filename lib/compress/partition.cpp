#include "compress/partition.h"

#include "compress/join.h"
#include "compress/sum.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kMostParts = 8; // of one split; deeper splits along the same axis join its curve anyway
// A split into k parts is worth its gain per knot, but not quite: with half a knot on top, a bright spot is cut
// out by two knots at once even where the first one alone gains little more per knot.
constexpr double kKnotOffset = 0.5;

/// For each axis of the grid, sums over the slices of a box across it.
using Projections = std::array<std::vector<Moments>, ACDF_MAX_AXES>;

/// Calls `visit(offset, index)` for every line of the box along the last axis: where in `values` it begins, and
/// its place on the other axes.
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
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis) {
        double across = 1.0;
        for (std::size_t other = 0; other < grid.dimensions(); ++other)
            if (other != axis) across *= extent(grid, box, other);
        out[axis].assign(box.length(axis), Moments{});
        for (std::uint32_t i = 0; i < box.length(axis); ++i)
            out[axis][i].measure = across * grid.measure[axis][box.begin[axis] + i];
    }
}

void project(const Grid& grid, double total, const Box& box, Projections& out) {
    set_measures(grid, box, out);
    const std::size_t last = grid.dimensions() - 1, length = box.length(last);
    const double* measures = grid.measure[last].data() + box.begin[last];
    Moments* along = out[last].data();
    for_each_line(grid, box, [&](std::size_t offset, const auto& index) {
        double weight = 1.0;
        for (std::size_t axis = 0; axis < last; ++axis) weight *= grid.measure[axis][index[axis]];
        const float* values = grid.values + offset;
        const float* peaks = (grid.peaks ? grid.peaks : grid.values) + offset;
        double line_flux = 0.0, line_energy = 0.0, line_peak = 0.0;
        for (std::size_t i = 0; i < length; ++i) {
            const double f = values[i] / total;
            const double flux = f * weight * measures[i], energy = f * flux;
            along[i].flux += flux;
            along[i].energy += energy;
            const double peak = peaks[i] / total;
            along[i].peak = peak > along[i].peak ? peak : along[i].peak;
            line_flux += flux;
            line_energy += energy;
            line_peak = peak > line_peak ? peak : line_peak;
        }
        for (std::size_t axis = 0; axis < last; ++axis) {
            Moments& slice = out[axis][index[axis] - box.begin[axis]];
            slice.flux += line_flux;
            slice.energy += line_energy;
            slice.peak = line_peak > slice.peak ? line_peak : slice.peak;
        }
    });
}

/// A way to divide a box along one axis: where, and how much each knot gains.
struct Division {
    std::vector<std::uint32_t> cuts; ///< ascending, relative to the box
    double gain_per_knot = -1.0;
};

/// Joins steps bottom-up to one part, then takes the number of parts whose gain per knot is largest.
Division divide(const std::vector<Moments>& steps, const Moments& whole) {
    Division division;
    if (steps.size() < 2) return division;
    std::vector<Moments> sums = steps;
    std::vector<double> alone(steps.size());
    double total = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) total += alone[i] = steps[i].cost();
    std::vector<std::uint32_t> borders; // in the order in which they vanish
    std::vector<double> cost;           // the sum before that
    join_neighbours(
        steps.size(), steps.size() - 1,
        [&](std::size_t a, std::size_t b) {
            Moments sum = sums[a];
            sum.add(sums[b]);
            return sum.cost() - alone[a] - alone[b];
        },
        [&](std::size_t a, std::size_t b, double raise) {
            borders.push_back(static_cast<std::uint32_t>(b));
            cost.push_back(total);
            total += raise;
            sums[a].add(sums[b]);
            alone[a] = sums[a].cost();
        });
    const double undivided = whole.cost();
    std::size_t best = 1;
    for (std::size_t knots = 1; knots <= std::min(borders.size(), kMostParts - 1); ++knots) {
        const double gain = (undivided - cost[cost.size() - knots]) / (double(knots) + kKnotOffset);
        if (gain <= division.gain_per_knot) continue;
        division.gain_per_knot = gain;
        best = knots;
    }
    division.cuts.assign(borders.end() - static_cast<std::ptrdiff_t>(best), borders.end());
    std::sort(division.cuts.begin(), division.cuts.end());
    return division;
}

/// The axis whose division gains most a knot, or `forced` where that one can be divided at all.
std::size_t best_axis(const std::vector<Division>& divisions, std::int8_t forced) {
    if (forced != Part::whole && !divisions[static_cast<std::size_t>(forced)].cuts.empty())
        return static_cast<std::size_t>(forced);
    std::size_t best = 0;
    for (std::size_t axis = 1; axis < divisions.size(); ++axis)
        if (divisions[axis].gain_per_knot > divisions[best].gain_per_knot) best = axis;
    return best;
}

/// Divides a part and returns its children.
std::vector<Part> split_part(const Grid& grid, double total, std::int8_t forced, Part& part, Projections& scratch) {
    project(grid, total, part.box, scratch);
    std::vector<Division> divisions;
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
        divisions.push_back(divide(scratch[axis], part.moments));
    const std::size_t axis = best_axis(divisions, forced);
    part.split = static_cast<std::int8_t>(axis);
    const std::vector<std::uint32_t>& cuts = divisions[axis].cuts;
    std::vector<Part> children;
    for (std::size_t k = 0; k <= cuts.size(); ++k) {
        const std::uint32_t begin = k == 0 ? 0 : cuts[k - 1];
        const std::uint32_t end = k < cuts.size() ? cuts[k] : part.box.length(axis);
        Part child;
        child.box = part.box;
        child.box.begin[axis] = part.box.begin[axis] + begin;
        child.box.end[axis] = part.box.begin[axis] + end;
        child.depth = static_cast<std::uint8_t>(part.depth + 1);
        for (std::uint32_t i = begin; i < end; ++i) child.moments.add(scratch[axis][i]);
        children.push_back(child);
    }
    return children;
}

bool divisible(const Grid& grid, const Part& part) {
    for (std::size_t axis = 0; axis < grid.dimensions(); ++axis)
        if (part.box.length(axis) > 1) return part.depth <= ACDF_MAX_DEPTH;
    return false;
}

} // namespace

double Moments::cost() const { return std::sqrt(measure * energy); }

double Moments::weight() const { return energy > 0.0 ? peak * std::sqrt(measure / energy) : 0.0; }

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

Partition::Partition(Grid grid, double total, std::int8_t first)
    : grid_(std::move(grid)), total_(total), first_(first) {
    Box everything;
    everything.end.fill(1);
    for (std::size_t axis = 0; axis < grid_.dimensions(); ++axis) everything.end[axis] = grid_.shape[axis];
    add_first_part(everything, 1);
}

Partition::Partition(Grid grid, double total, const Box& box, std::uint8_t depth)
    : grid_(std::move(grid)), total_(total), first_(Part::whole) {
    add_first_part(box, depth);
}

void Partition::add_first_part(const Box& box, std::uint8_t depth) {
    Part first;
    first.box = box;
    first.depth = depth;
    Projections projections;
    project(grid_, total_, box, projections);
    for (const Moments& slice : projections[0]) first.moments.add(slice);
    parts_.push_back(first);
}

void Partition::refine(double finest, double heaviest) {
    const auto open = [&](const Part& part) {
        const bool worth = part.moments.cost() - part.moments.flux > finest || part.moments.weight() > heaviest;
        return part.split == Part::whole && worth && divisible(grid_, part);
    };
    std::vector<std::uint32_t> level; // parts of a level are independent of each other
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
        if (open(parts_[i])) level.push_back(i);
    tbb::enumerable_thread_specific<Projections> scratch;
    while (!level.empty()) {
        std::vector<std::vector<Part>> children(level.size());
        tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t k) {
            const std::int8_t forced = level[k] == 0 ? first_ : Part::whole;
            children[k] = split_part(grid_, total_, forced, parts_[level[k]], scratch.local());
        });
        std::vector<std::uint32_t> next;
        for (std::size_t k = 0; k < level.size(); ++k) {
            parts_[level[k]].first_child = static_cast<std::uint32_t>(parts_.size());
            parts_[level[k]].children = static_cast<std::uint32_t>(children[k].size());
            for (const Part& child : children[k]) {
                if (open(child)) next.push_back(static_cast<std::uint32_t>(parts_.size()));
                parts_.push_back(child);
            }
        }
        level = std::move(next);
    }
}

} // namespace acdf::compress
