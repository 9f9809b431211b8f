#include "compress/visibility/cells.h"
#include "compress/parallel.h"
#include "compress/visibility/shared_odds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kBorders = 16;      ///< positions on an axis where a cell may be divided
constexpr float kFloor = 0.02f;             ///< of factors, where it is divided
constexpr float kLeastPoints = 8.0f;        ///< of a cell
constexpr std::uint32_t kCellPoints = 1024; ///< points of a cell that decide where it is divided, about

/// The root of the second moment of the points that are summed, with the best rows for them.
double cost_of(const VisibilitySums& sums, const std::vector<float>& prior, std::vector<float>& work) {
    const std::size_t count = prior.size();
    const float *const all = sums.all.data(), *const seen = sums.seen.data(), *const before = prior.data();
    work.resize(2 * count);
    float *const arrives = work.data(), *const sampled = arrives + count;
    const float points = sums.points;
    for (std::size_t p = 0; p < count; ++p) {
        const float factor = visible_factor(all[p], seen[p], points, {before[p] * before[p], 1.0f}, kFloor);
        arrives[p] = seen[p] / factor;
        sampled[p] = all[p] * factor;
    }
    double moment = 0.0, weight = 0.0;
    for (std::size_t p = 0; p < count; ++p) {
        moment += double{arrives[p]};
        weight += double{sampled[p]};
    }
    return std::sqrt(moment * weight);
}

/// Sums of all steps up to each, from below or from above.
void accumulate(std::vector<VisibilitySums>& steps, bool from_below) {
    for (std::size_t i = 1; i < steps.size(); ++i) {
        const std::size_t k = from_below ? i : steps.size() - 1 - i;
        steps[k].add(steps[from_below ? k - 1 : k + 1]);
    }
}

} // namespace

VisibilityCells::VisibilityCells(const VisibilityParts& parts, const VisibilityLight& light,
                                 const std::vector<VisibilityPoint>& points, const Box& low, const Box& high,
                                 std::uint32_t cells)
    : parts_(parts), light_(light), points_(points) {
    order_.resize(light.points());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    Node root;
    root.low = low;
    root.high = high;
    root.end = static_cast<std::uint32_t>(order_.size());
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
        parallel_for(0u, 2u, [&](std::uint32_t k) { consider(nodes_[child + k]); });
        push(child);
        push(child + 1);
        ++cell_count_;
    }
    number_.assign(nodes_.size(), 0);
    cell_count_ = 0;
    number(0);
}

/// Factors of a node, and where it is divided best.
void VisibilityCells::consider(Node& node) const {
    const std::uint32_t count = node.end - node.begin, stride = std::max(count / kCellPoints, 1u);
    VisibilitySums sums(light_.parts);
    for (std::uint32_t i = node.begin; i < node.end; i += stride) sums.add(light_.of(order_[i]));
    for (std::size_t p = 0; p < light_.parts; ++p)
        node.factors[p] = visible_factor(sums.all[p], sums.seen[p], sums.points,
                                         {node.factors[p] * node.factors[p], 1.0f}, kFloor);
    node.gain = 0.0;
    if (node.depth + 1 >= ACDF_MAX_VISIBILITY_DEPTH || float(count) < 2.0f * kLeastPoints) return;
    std::array<Division, axes> best;
    parallel_for(std::size_t{0}, axes, [&](std::size_t axis) {
        best[axis] = consider_axis(node, sums, stride, static_cast<std::uint32_t>(axis));
    });
    for (const Division& candidate : best)
        if (candidate.gain > node.gain) {
            node.gain = candidate.gain;
            node.axis = candidate.axis;
            node.position = candidate.position;
        }
}

VisibilityCells::Division VisibilityCells::consider_axis(const Node& node, const VisibilitySums& sums,
                                                         std::uint32_t stride, std::uint32_t axis) const {
    Division best;
    float low = points_[order_[node.begin]].coordinate(axis), high = low;
    for (std::uint32_t i = node.begin; i < node.end; i += stride) {
        low = std::min(low, points_[order_[i]].coordinate(axis));
        high = std::max(high, points_[order_[i]].coordinate(axis));
    }
    const float step = (high - low) / kBorders;
    if (!(low + step > low && high - step < high)) return best;
    std::vector<VisibilitySums> lower(kBorders, VisibilitySums(light_.parts));
    const auto border = [&](std::uint32_t k) { return low + step * static_cast<float>(k); };
    for (std::uint32_t i = node.begin; i < node.end; i += stride) {
        const float x = points_[order_[i]].coordinate(axis);
        auto k = static_cast<std::uint32_t>(std::clamp((x - low) / step, 0.0f, float(kBorders - 1)));
        while (k > 0 && x < border(k)) --k;
        while (k + 1 < kBorders && !(x < border(k + 1))) ++k;
        lower[k].add(light_.of(order_[i]));
    }
    std::vector<VisibilitySums> upper = lower;
    accumulate(lower, true);
    accumulate(upper, false);
    std::vector<float> work;
    const double whole = cost_of(sums, node.factors, work);
    std::optional<SharedOdds> odds;
    if (axis >= 3) odds.emplace(parts_, sums, node.factors);
    for (std::uint32_t k = 1; k < kBorders; ++k) {
        if (lower[k - 1].points < kLeastPoints || upper[k].points < kLeastPoints) continue;
        const double together = odds ? std::max(whole, odds->cost(lower[k - 1]) + odds->cost(upper[k])) : whole;
        const double gain =
            together - cost_of(lower[k - 1], node.factors, work) - cost_of(upper[k], node.factors, work);
        if (gain * stride > best.gain) best = {gain * stride, axis, border(k)};
    }
    return best;
}

void VisibilityCells::divide(std::uint32_t index) {
    Node lower = nodes_[index], upper = lower;
    const std::uint32_t axis = lower.axis;
    const auto middle =
        std::stable_partition(order_.begin() + lower.begin, order_.begin() + lower.end,
                              [&](std::uint32_t i) { return points_[i].coordinate(axis) < lower.position; });
    lower.end = upper.begin = static_cast<std::uint32_t>(middle - order_.begin());
    lower.high[axis] = upper.low[axis] = lower.position;
    lower.depth = ++upper.depth;
    nodes_[index].first_child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(std::move(lower));
    nodes_.push_back(std::move(upper));
}

void VisibilityCells::number(std::uint32_t node) {
    nodes_[node].cells.begin = cell_count_;
    if (nodes_[node].first_child == 0) {
        number_[node] = cell_count_++;
        node_of_cell_.push_back(node);
    } else {
        number_[node] = static_cast<std::uint32_t>(walk_.size());
        walk_.push_back(node);
        for (std::uint32_t k = 0; k < 2; ++k) number(nodes_[node].first_child + k);
    }
    nodes_[node].cells.end = cell_count_;
}

std::vector<std::uint32_t> VisibilityCells::regions(std::uint32_t count) const {
    using Entry = std::pair<std::uint32_t, std::uint32_t>; // cells, and number from the back
    std::priority_queue<Entry> queue;
    const auto push = [&](std::uint32_t node) {
        queue.push({nodes_[node].cells.end - nodes_[node].cells.begin, ~node});
    };
    push(0);
    while (queue.size() < count && queue.top().first > 1) {
        const std::uint32_t child = nodes_[~queue.top().second].first_child;
        queue.pop();
        push(child);
        push(child + 1);
    }
    std::vector<std::uint32_t> out;
    for (; !queue.empty(); queue.pop()) out.push_back(~queue.top().second);
    std::sort(out.begin(), out.end(),
              [&](std::uint32_t a, std::uint32_t b) { return cells(a).begin < cells(b).begin; });
    return out;
}

std::vector<VisibilitySums> VisibilityCells::sums(const Range& range) const {
    std::vector<VisibilitySums> out(range.end - range.begin, VisibilitySums(light_.parts));
    for (std::uint32_t cell = range.begin; cell < range.end; ++cell) {
        const Node& node = nodes_[node_of_cell_[cell]];
        for (std::uint32_t i = node.begin; i < node.end; ++i) out[cell - range.begin].add(light_.of(order_[i]));
    }
    return out;
}

std::vector<AcdfVisibilitySplit> VisibilityCells::splits() const {
    std::vector<AcdfVisibilitySplit> out;
    for (const std::uint32_t index : walk_) {
        const Node& node = nodes_[index];
        const auto child = [&](std::uint32_t k) {
            const std::uint32_t c = node.first_child + k;
            return nodes_[c].first_child == 0 ? ACDF_VISIBILITY_ROW | number_[c] : number_[c];
        };
        out.push_back({node.position, node.axis | child(0) << 3, child(1)});
    }
    return out;
}

} // namespace acdf::compress
