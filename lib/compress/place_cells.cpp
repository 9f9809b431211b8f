#include "compress/place_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kSteps = 16;      ///< places on an axis where a cell may be divided
constexpr std::uint32_t kLeastPoints = 8; ///< of a cell

/// The root of the second moment of the points that are summed, with the best rows for them.
double cost_of(const PlaceSums& sums, const std::vector<float>& prior) {
    double moment = 0.0, weight = 0.0;
    for (std::size_t p = 0; p < prior.size(); ++p) {
        const double all = std::max(sums.all[p], 0.0), seen = std::max(sums.seen[p], 0.0);
        const double factor = place_factor(all, seen, sums.points, double{prior[p]}, {});
        moment += seen / factor;
        weight += all * factor;
    }
    return std::sqrt(moment * weight);
}

/// Moves what `step` holds from the upper to the lower side.
void move_down(const PlaceSums& step, PlaceSums& lower, PlaceSums& upper) {
    lower.points += step.points;
    upper.points -= step.points;
    for (std::size_t p = 0; p < step.all.size(); ++p) {
        lower.all[p] += step.all[p];
        lower.seen[p] += step.seen[p];
        upper.all[p] -= step.all[p];
        upper.seen[p] -= step.seen[p];
    }
}

} // namespace

double place_factor(double all, double seen, double points, double prior, const PlaceCaution& caution) {
    const double before = prior * prior, unit = points > 0.0 ? caution.prior * all / points : 0.0;
    const double share = all > 0.0 ? std::min((seen + unit * before) / (all + unit), 1.0) : before;
    return caution.floor + (1.0 - caution.floor) * std::sqrt(share);
}

PlaceCells::PlaceCells(const PlaceLight& light, const std::vector<PlacePoint>& points, const Box& low,
                       const Box& high, std::uint32_t cells)
    : light_(light), points_(points) {
    order_.resize(points.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    Node root;
    root.low = low;
    root.high = high;
    root.end = static_cast<std::uint32_t>(points.size());
    root.factors.assign(light.parts, 0.7f);
    consider(root);
    nodes_.push_back(std::move(root));
    using Entry = std::pair<double, std::uint32_t>; // gain, and number from the back: for equal gains the older one
    std::priority_queue<Entry> queue;
    const auto push = [&](std::uint32_t index) {
        if (nodes_[index].gain > 0.0) queue.push({nodes_[index].gain, ~index});
    };
    push(0);
    cell_count_ = 1;
    while (cell_count_ < cells && !queue.empty()) {
        const std::uint32_t index = ~queue.top().second;
        queue.pop();
        divide(index);
        const std::uint32_t child = nodes_[index].first_child;
        tbb::parallel_for(0u, 2u, [&](std::uint32_t k) { consider(nodes_[child + k]); });
        push(child);
        push(child + 1);
        ++cell_count_;
    }
    number_.assign(nodes_.size(), 0);
    cell_count_ = 0;
    number(0);
}

/// Factors of a node, and where it is divided best.
void PlaceCells::consider(Node& node) const {
    PlaceSums sums(light_.parts);
    for (std::uint32_t i = node.begin; i < node.end; ++i) sums.add(light_, order_[i], 1.0);
    for (std::size_t p = 0; p < light_.parts; ++p)
        node.factors[p] =
            static_cast<float>(place_factor(sums.all[p], sums.seen[p], sums.points, double{node.factors[p]}, {}));
    node.gain = 0.0;
    if (node.depth + 1 >= ACDF_MAX_PLACE_SPLITS_DEEP || node.end - node.begin < 2 * kLeastPoints) return;
    std::array<Division, axes> best;
    tbb::parallel_for(std::size_t{0}, axes, [&](std::size_t axis) {
        best[axis] = consider_axis(node, sums, static_cast<std::uint32_t>(axis));
    });
    for (const Division& candidate : best)
        if (candidate.gain > node.gain) {
            node.gain = candidate.gain;
            node.axis = candidate.axis;
            node.position = candidate.position;
        }
}

PlaceCells::Division PlaceCells::consider_axis(const Node& node, const PlaceSums& sums, std::uint32_t axis) const {
    Division best;
    float low = points_[order_[node.begin]].coordinate(axis), high = low;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        low = std::min(low, points_[order_[i]].coordinate(axis));
        high = std::max(high, points_[order_[i]].coordinate(axis));
    }
    const float step = (high - low) / kSteps;
    if (!(low + step > low && high - step < high)) return best;
    std::vector<PlaceSums> steps(kSteps, PlaceSums(light_.parts));
    const auto border = [&](std::uint32_t k) { return low + step * static_cast<float>(k); };
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const float x = points_[order_[i]].coordinate(axis);
        auto k = static_cast<std::uint32_t>(std::clamp((x - low) / step, 0.0f, float(kSteps - 1)));
        while (k > 0 && x < border(k)) --k;
        while (k + 1 < kSteps && !(x < border(k + 1))) ++k;
        steps[k].add(light_, order_[i], 1.0);
    }
    PlaceSums lower(light_.parts), upper = sums;
    const double whole = cost_of(sums, node.factors);
    for (std::uint32_t k = 1; k < kSteps; ++k) {
        move_down(steps[k - 1], lower, upper);
        if (lower.points < kLeastPoints || upper.points < kLeastPoints) continue;
        const double gain = whole - cost_of(lower, node.factors) - cost_of(upper, node.factors);
        if (gain > best.gain) best = {gain, axis, border(k)};
    }
    return best;
}

void PlaceCells::divide(std::uint32_t index) {
    Node lower = nodes_[index], upper = lower;
    const std::uint32_t axis = lower.axis;
    const auto middle =
        std::stable_partition(order_.begin() + lower.begin, order_.begin() + lower.end,
                              [&](std::uint32_t i) { return points_[i].coordinate(axis) < lower.position; });
    lower.end = upper.begin = static_cast<std::uint32_t>(middle - order_.begin());
    lower.high[axis] = upper.low[axis] = lower.position;
    lower.parent = upper.parent = index;
    lower.depth = ++upper.depth;
    nodes_[index].first_child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(std::move(lower));
    nodes_.push_back(std::move(upper));
}

void PlaceCells::number(std::uint32_t node) {
    if (nodes_[node].first_child == 0) {
        number_[node] = cell_count_++;
        node_of_cell_.push_back(node);
        return;
    }
    number_[node] = static_cast<std::uint32_t>(walk_.size());
    walk_.push_back(node);
    for (std::uint32_t k = 0; k < 2; ++k) number(nodes_[node].first_child + k);
}

/// The smallest extent of the cells below a node that touch its low (or high) side on an axis.
double PlaceCells::thinnest(std::uint32_t index, std::uint32_t axis, bool at_low) const {
    const Node& node = nodes_[index];
    if (node.first_child == 0) return double{node.high[axis]} - double{node.low[axis]};
    if (node.axis == axis) return thinnest(node.first_child + (at_low ? 0 : 1), axis, at_low);
    return std::min(thinnest(node.first_child, axis, at_low), thinnest(node.first_child + 1, axis, at_low));
}

std::vector<AcdfPlaceSplit> PlaceCells::splits(double blend) const {
    std::vector<AcdfPlaceSplit> out;
    for (const std::uint32_t index : walk_) {
        const Node& node = nodes_[index];
        const double width =
            std::min(thinnest(node.first_child, node.axis, false), thinnest(node.first_child + 1, node.axis, true));
        const auto child = [&](std::uint32_t k) {
            const std::uint32_t c = node.first_child + k;
            return nodes_[c].first_child == 0 ? ACDF_PLACE_ROW | number_[c] : number_[c];
        };
        out.push_back({node.position, static_cast<float>(blend * width), node.axis | child(0) << 3, child(1)});
    }
    return out;
}

} // namespace acdf::compress
