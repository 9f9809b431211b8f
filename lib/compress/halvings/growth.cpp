#include "compress/halvings/growth.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace acdf::compress {
namespace {

constexpr float kAhead = 1.0f / 3.0f; // what the gain of two halvings counts
constexpr std::size_t kReportEvery = 4096;

class Growth {
public:
    Growth(const HalvedSums& sums, double integral, const GrowthLimits& limits)
        : sums_(sums), integral_(integral), limits_(limits) {}

    GrownTree run() {
        const std::size_t texels = std::size_t{sums_.grid().shape[0]} * sums_.grid().shape[1];
        tree_.nodes.reserve(2 * std::min(limits_.leaves, texels)); // no copies as it grows
        tree_.cost.reserve(std::min(limits_.leaves, texels));
        total_ = sums_.cost(sums_.whole());
        tree_.nodes.push_back({sums_.whole(), 0, static_cast<float>(total_), -1});
        tree_.cost.push_back(total_);
        consider(0);
        while (!candidates_.empty() && tree_.leaves() < limits_.leaves && !is_reached()) {
            const Candidate best = candidates_.top();
            candidates_.pop();
            halve(best.node);
            if (limits_.done && tree_.leaves() % kReportEvery == 0)
                limits_.done(double(tree_.leaves()) / double(limits_.leaves));
        }
        return std::move(tree_);
    }

private:
    struct Candidate {
        float gain;
        std::uint32_t node;
        bool operator<(const Candidate& other) const {
            return gain != other.gain ? gain < other.gain : node > other.node;
        }
    };

    bool is_reached() const {
        return total_ <= limits_.cost && candidates_.top().gain < std::numeric_limits<float>::max();
    }

    float cost(const HalvedBox& box) const { return static_cast<float>(sums_.cost(box)); }

    /// The least that a box costs once it is halved at most once more.
    float least_cost(const HalvedBox& box, float as_leaf) const {
        float least = as_leaf;
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (sums_.can_halve(box, axis))
                least = std::min(least, cost(sums_.half(box, axis, 0)) + cost(sums_.half(box, axis, 1)));
        return least;
    }

    void consider(std::uint32_t number) {
        GrownNode& node = tree_.nodes[number];
        const bool heavy = limits_.heaviest > 0.0 && leaf_weight(sums_, node, total_, integral_) > limits_.heaviest;
        float best = heavy ? std::numeric_limits<float>::lowest() : 0.0f;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (!sums_.can_halve(node.box, axis)) continue;
            const HalvedBox lower = sums_.half(node.box, axis, 0), upper = sums_.half(node.box, axis, 1);
            const float a = cost(lower), b = cost(upper);
            const float gain =
                std::max(node.cost - (a + b), kAhead * (node.cost - (least_cost(lower, a) + least_cost(upper, b))));
            if (!(gain > best)) continue;
            best = gain;
            node.axis = static_cast<std::int8_t>(axis);
        }
        if (node.axis >= 0) candidates_.push({heavy ? std::numeric_limits<float>::max() : best, number});
    }

    void halve(std::uint32_t number) {
        const auto lower = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes[number].lower = lower;
        const GrownNode node = tree_.nodes[number];
        total_ -= double{node.cost};
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            const HalvedBox half = sums_.half(node.box, static_cast<std::size_t>(node.axis), upper);
            tree_.nodes.push_back({half, 0, cost(half), -1});
            total_ += double{tree_.nodes.back().cost};
        }
        tree_.cost.push_back(total_);
        consider(lower);
        consider(lower + 1);
    }

    const HalvedSums& sums_;
    double integral_, total_ = 0.0;
    const GrowthLimits& limits_;
    GrownTree tree_;
    std::priority_queue<Candidate> candidates_;
};

} // namespace

double leaf_weight(const HalvedSums& sums, const GrownNode& node, double cost, double integral) {
    if (!(node.cost > 0.0f)) return 0.0;
    return sums.peak(node.box) * sums.measure(node.box) * cost / (double{node.cost} * integral);
}

GrownTree grow(const HalvedSums& sums, double integral, const GrowthLimits& limits) {
    return Growth(sums, integral, limits).run();
}

} // namespace acdf::compress
