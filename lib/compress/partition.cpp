#include "compress/partition.h"

#include "compress/join.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kMostParts = 8; // of one split; deeper splits along the same axis join its curve anyway
// A split into k parts is worth its gain per knot, but not quite: with half a
// knot on top, a bright spot is cut out by two knots at once even where the
// first one alone gains little more per knot.
constexpr double kKnotOffset = 0.5;

/// Sums over the rows and over the columns of a box.
struct Projections {
    std::vector<Moments> rows, columns;
};

void project(const Target& target, double total, const Box& box, Projections& out) {
    const std::size_t width = box.column_end - box.column_begin;
    out.rows.assign(box.row_end - box.row_begin, Moments{});
    out.columns.assign(width, Moments{});
    double column_measure = 0.0, row_measure = 0.0;
    for (std::size_t c = 0; c < width; ++c) column_measure += target.column_measure[box.column_begin + c];
    for (std::uint32_t r = box.row_begin; r < box.row_end; ++r) {
        const float* row = target.row(r) + box.column_begin;
        const double* measures = target.column_measure.data() + box.column_begin;
        const double weight = target.row_measure[r];
        Moments& sum = out.rows[r - box.row_begin];
        for (std::size_t c = 0; c < width; ++c) {
            const double f = row[c] / total;
            const double flux = f * weight * measures[c], energy = f * flux;
            out.columns[c].flux += flux;
            out.columns[c].energy += energy;
            sum.flux += flux;
            sum.energy += energy;
        }
        sum.measure = weight * column_measure;
        row_measure += weight;
    }
    for (std::size_t c = 0; c < width; ++c)
        out.columns[c].measure = row_measure * target.column_measure[box.column_begin + c];
}

/// A way to divide a box along one axis: where, and how much each knot gains.
struct Division {
    std::vector<std::uint32_t> cuts; ///< ascending, relative to the box
    double gain_per_knot = -1.0;
};

/// Joins steps bottom-up to one part, then takes the number of parts whose gain
/// per knot is largest.
Division divide(const std::vector<Moments>& steps, const Moments& whole) {
    Division division;
    if (steps.size() < 2) return division;
    std::vector<Moments> sums = steps;
    std::vector<double> alone(steps.size());
    double total = 0.0;
    for (std::size_t i = 0; i < steps.size(); ++i) total += alone[i] = steps[i].cost();
    const auto joined = [&](std::size_t a, std::size_t b) {
        Moments sum = sums[a];
        sum.add(sums[b]);
        return sum;
    };
    std::vector<std::uint32_t> borders; // in the order in which they vanish
    std::vector<double> cost;           // the sum before that
    join_neighbours(
        steps.size(), steps.size() - 1,
        [&](std::size_t a, std::size_t b) { return joined(a, b).cost() - alone[a] - alone[b]; },
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

Box slice(const Box& box, Part::Split split, std::uint32_t begin, std::uint32_t end) {
    Box out = box;
    if (split == Part::Split::rows) {
        out.row_begin = box.row_begin + begin;
        out.row_end = box.row_begin + end;
    } else {
        out.column_begin = box.column_begin + begin;
        out.column_end = box.column_begin + end;
    }
    return out;
}

/// The children of a part, by the better of the two axes, or along `forced`.
std::vector<Part> split_part(const Target& target, double total, Part::Split forced, Part& part,
                             Projections& scratch) {
    project(target, total, part.box, scratch);
    const Division by_rows = divide(scratch.rows, part.moments), by_columns = divide(scratch.columns, part.moments);
    bool rows = by_rows.gain_per_knot >= by_columns.gain_per_knot;
    if (forced == Part::Split::rows && !by_rows.cuts.empty()) rows = true;
    if (forced == Part::Split::columns && !by_columns.cuts.empty()) rows = false;
    part.split = rows ? Part::Split::rows : Part::Split::columns;
    const std::vector<std::uint32_t>& cuts = rows ? by_rows.cuts : by_columns.cuts;
    const std::vector<Moments>& steps = rows ? scratch.rows : scratch.columns;
    std::vector<Part> children;
    for (std::size_t k = 0; k <= cuts.size(); ++k) {
        const std::uint32_t begin = k == 0 ? 0 : cuts[k - 1];
        const std::uint32_t end = k < cuts.size() ? cuts[k] : static_cast<std::uint32_t>(steps.size());
        Part child;
        child.box = slice(part.box, part.split, begin, end);
        for (std::uint32_t i = begin; i < end; ++i) child.moments.add(steps[i]);
        children.push_back(child);
    }
    return children;
}

} // namespace

double Moments::cost() const { return std::sqrt(measure * energy); }

Partition::Partition(const Target& target, double total, Part::Split first)
    : target_(target), total_(total), first_(first) {
    Part whole;
    whole.box = {0, target.rows, 0, target.columns};
    Projections projections;
    project(target, total, whole.box, projections);
    for (const Moments& row : projections.rows) whole.moments.add(row);
    parts_.push_back(whole);
}

void Partition::refine(double finest) {
    // Level by level: the parts of a level are independent of each other.
    const auto open = [&](const Part& part) {
        return part.split == Part::Split::none && part.box.texels() > 1 &&
               part.moments.cost() - part.moments.flux > finest;
    };
    std::vector<std::uint32_t> level;
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
        if (open(parts_[i])) level.push_back(i);
    tbb::enumerable_thread_specific<Projections> scratch;
    while (!level.empty()) {
        std::vector<std::vector<Part>> children(level.size());
        tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t k) {
            const Part::Split forced = level[k] == 0 ? first_ : Part::Split::none;
            children[k] = split_part(target_, total_, forced, parts_[level[k]], scratch.local());
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
