#include "compress/fit/polish.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

constexpr int kPasses = 8; // most lines take three
constexpr std::int64_t kWindow = 4;
constexpr double kLeastGain = 1e-12; // of the sum of costs, which is at least 1: rounding
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A line of steps: costs of its segments from prefix sums.
class PolishedLine {
public:
    PolishedLine(const Grid& grid, double total)
        : grid_(grid), total_(total), measure_(grid.shape[0] + 1, 0.0), energy_(measure_) {
        for (std::uint32_t i = 0; i < grid.shape[0]; ++i) {
            const double f = grid.values[i] / total;
            measure_[i + 1] = measure_[i] + grid.measure[0][i];
            energy_[i + 1] = energy_[i] + f * f * grid.measure[0][i];
        }
    }

    double cost(std::uint32_t begin, std::uint32_t end) const {
        return std::sqrt((measure_[end] - measure_[begin]) * (energy_[end] - energy_[begin]));
    }

    /// Without the rounding of prefix sums, in which small terms beside large ones are lost.
    Moments moments(std::uint32_t begin, std::uint32_t end) const {
        Moments sum;
        const float* peaks = grid_.peaks ? grid_.peaks : grid_.values;
        for (std::uint32_t i = begin; i < end; ++i) {
            const double f = grid_.values[i] / total_, flux = f * grid_.measure[0][i];
            sum.add({grid_.measure[0][i], f * flux, flux, 0.0, peaks[i] / total_});
        }
        return sum;
    }

private:
    const Grid& grid_;
    double total_;
    std::vector<double> measure_, energy_; ///< of all steps before each
};

using Knots = std::vector<std::uint32_t>; ///< with both ends

/// Where a knot may go, and the best way to get there.
struct KnotPosition {
    std::uint32_t at = 0;
    double cost = kInfinite;  ///< of all segments before it
    std::size_t previous = 0; ///< which position the knot before it takes
};

/// The knot_positions of knot i, in order: up to kWindow strides either way. The ends of the line stay.
std::vector<KnotPosition> knot_positions(const Knots& knots, std::size_t i, std::uint32_t stride) {
    if (i == 0 || i + 1 == knots.size()) return {{knots[i], i == 0 ? 0.0 : kInfinite, 0}};
    std::vector<KnotPosition> out;
    for (std::int64_t k = -kWindow; k <= kWindow; ++k) {
        const std::int64_t at = knots[i] + k * std::int64_t{stride};
        if (at > 0 && at < knots.back()) out.push_back({static_cast<std::uint32_t>(at), kInfinite, 0});
    }
    return out;
}

/// The best joint move of all knots: dynamic programming over the knots in order, over a range of knot_positions
/// each. Returns what it gained.
double move_knots(const PolishedLine& line, std::uint32_t stride, Knots& knots) {
    std::vector<std::vector<KnotPosition>> table{knot_positions(knots, 0, stride)};
    double before = 0.0;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        before += line.cost(knots[i - 1], knots[i]);
        table.push_back(knot_positions(knots, i, stride));
        for (KnotPosition& place : table[i])
            for (std::size_t k = 0; k < table[i - 1].size() && table[i - 1][k].at < place.at; ++k) {
                const double cost = table[i - 1][k].cost + line.cost(table[i - 1][k].at, place.at);
                if (cost < place.cost) place.cost = cost, place.previous = k;
            }
    }
    const double gain = before - table.back()[0].cost;
    if (!(gain > kLeastGain)) return 0.0;
    std::size_t k = 0;
    for (std::size_t i = knots.size(); i-- > 1; k = table[i][k].previous) knots[i] = table[i][k].at;
    return gain;
}

/// From about the length of a segment down to a step.
std::uint32_t largest_stride(const Knots& knots) {
    const std::size_t length = knots.back() / (knots.size() - 1);
    std::uint32_t stride = 1;
    while (stride * 4 * kWindow <= length) stride *= 4;
    return stride;
}

void rewrite(const PolishedLine& line, const Knots& knots, std::size_t index, double& cost, Flattened& flat) {
    Curve& curve = flat.cascade.curves[index];
    curve.knots.assign(knots.begin() + 1, knots.end() - 1);
    cost = 0.0;
    for (std::size_t s = 0; s + 1 < knots.size(); ++s) {
        const Moments moments = line.moments(knots[s], knots[s + 1]);
        curve.probability[s] = moments.cost();
        flat.weights[index][s] = static_cast<float>(moments.weight());
        cost += moments.cost();
    }
    for (double& probability : curve.probability) probability /= cost;
}

} // namespace

void polish(const Partition& partition, std::size_t bin, Flattened& flat) {
    const Grid& grid = partition.grid();
    const std::uint32_t root = flat.cascade.roots[bin];
    const Curve& curve = flat.cascade.curves[root];
    if (grid.dimensions() != 1 || curve.knots.empty()) return;
    const PolishedLine line(grid, partition.total());
    Knots knots{0};
    knots.insert(knots.end(), curve.knots.begin(), curve.knots.end());
    knots.push_back(grid.shape[0]);
    for (std::uint32_t stride = largest_stride(knots); stride > 0; stride /= 4)
        for (int pass = 0; pass < kPasses && move_knots(line, stride, knots) > 0.0; ++pass) {
        }
    rewrite(line, knots, root, flat.cost[bin], flat);
}

} // namespace acdf::compress
