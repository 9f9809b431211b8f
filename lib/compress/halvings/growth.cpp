#include "compress/halvings/growth.h"

#include "compress/halvings/code_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace acdf::compress {
namespace {

constexpr float kAhead = 1.0f / 3.0f;  // what the gain of two halvings counts
constexpr std::size_t kAtOnce = 32;    // so few that are left are halved in one round
constexpr std::size_t kOfThread = 128; // nodes that are worth a thread's while
constexpr double kPredictedFrom = 0.7; // of the leaves of the smallest tree: those of larger ones are foreseen
constexpr float kHeavy = std::numeric_limits<float>::max(); // the gain of leaves that are too heavy

/// The better axis of a node, and what it gains: costs of the halves and quarters that halving it may make.
class Look {
public:
    Look(const HalvedCosts& costs, HalvedNode& node) : costs_(costs), axes_(costs.axes()), node_(node) {}

    void run() {
        const HalvedBox box = node_.box;
        const HalvedTable* table = costs_.squares();
        if (table && 4 * box.rows < table->complete_rows() && 4 * box.columns < table->complete_columns())
            from_table(*table);
        else one_by_one();
    }

private:
    static float quarters(float a, float b, float c, float d, float e) {
        return std::min(a, std::min(b + c, d + e));
    }

    void consider(std::int8_t axis, float a, float b, float least_a, float least_b) {
        const float gain = std::max(node_.cost - (a + b), kAhead * (node_.cost - (least_a + least_b)));
        if (!(gain > node_.gain)) return;
        node_.gain = gain;
        node_.axis = axis;
    }

    /// All boxes are in the table.
    void from_table(const HalvedTable& table) {
        const std::uint32_t r = node_.box.rows, c = node_.box.columns;
        const HalvedAxis &rows = axes_.rows, &columns = axes_.columns;
        const float* own = table.of_rows(r);
        const float* half[2] = {table.of_rows(2 * r), table.of_rows(2 * r + 1)};
        float cost[16], scale[16];
        const float row = rows.root(r), column = columns.root(c);
        for (std::uint32_t k = 0; k < 2; ++k) {
            cost[k] = half[k][c];
            scale[k] = rows.root(2 * r + k) * column;
            cost[2 + k] = own[2 * c + k];
            scale[2 + k] = columns.root(2 * c + k) * row;
        }
        for (std::uint32_t k = 0; k < 4; ++k) {
            cost[4 + k] = table.of_rows(4 * r + k)[c];
            scale[4 + k] = rows.root(4 * r + k) * column;
            cost[8 + k] = own[4 * c + k];
            scale[8 + k] = columns.root(4 * c + k) * row;
            cost[12 + k] = half[k / 2][2 * c + k % 2];
            scale[12 + k] = rows.root(2 * r + k / 2) * columns.root(2 * c + k % 2);
        }
        for (float& of : cost) of = std::sqrt(of);
        for (std::size_t k = 0; k < 16; ++k) cost[k] *= scale[k];
        consider(0, cost[0], cost[1], quarters(cost[0], cost[4], cost[5], cost[12], cost[13]),
                 quarters(cost[1], cost[6], cost[7], cost[14], cost[15]));
        consider(1, cost[2], cost[3], quarters(cost[2], cost[8], cost[9], cost[12], cost[14]),
                 quarters(cost[3], cost[10], cost[11], cost[13], cost[15]));
    }

    /// The least that a box costs once it is halved at most once more.
    float least_cost(HalvedBox box, float as_leaf) const {
        float least = as_leaf;
        for (int axis = 0; axis < 2; ++axis)
            if (axes_.can_halve(box, axis))
                least = std::min(least, costs_.cost(half(box, axis, 0)) + costs_.cost(half(box, axis, 1)));
        return least;
    }
    void one_by_one() {
        for (int axis = 0; axis < 2; ++axis) {
            if (!axes_.can_halve(node_.box, axis)) continue;
            const HalvedBox lower = half(node_.box, axis, 0), upper = half(node_.box, axis, 1);
            const float a = costs_.cost(lower), b = costs_.cost(upper);
            consider(static_cast<std::int8_t>(axis), a, b, least_cost(lower, a), least_cost(upper, b));
        }
    }

    const HalvedCosts& costs_;
    const HalvedAxes& axes_;
    HalvedNode& node_;
};

constexpr std::uint32_t kNoNode = 0xFFFFFFFFu;

/// Larger gains first, of equal ones the lower number.
std::uint64_t key_of(float gain, std::uint32_t node) {
    std::uint32_t bits; // of positive floats they are in order
    std::memcpy(&bits, &gain, sizeof bits);
    return std::uint64_t{bits} << 32 | (kNoNode - node);
}
float gain_of(std::uint64_t key) {
    const auto bits = static_cast<std::uint32_t>(key >> 32);
    float gain;
    std::memcpy(&gain, &bits, sizeof gain);
    return gain;
}
std::uint32_t node_of(std::uint64_t key) { return kNoNode - static_cast<std::uint32_t>(key); }

} // namespace

HalvedGrowth::HalvedGrowth(std::vector<TreeSize> sizes, GrowthLimits limits)
    : sizes_(std::move(sizes)), limits_(limits), size_(sizes_.back()) {}

void HalvedGrowth::reserve() {
    const std::size_t most = sizes_.back().leaves;
    nodes_.reserve(2 * most);
    for (auto* keys : {&next_, &later_, &chosen_, &ranked_}) keys->reserve(most + 1);
    totals_.reserve(most);
}

void HalvedGrowth::run(const HalvedCosts& costs, const Loop& loop, const std::function<void(double)>& round) {
    begin(costs);
    grow(costs, loop, round);
}

void HalvedGrowth::run_below(std::vector<HalvedNode> top, const HalvedCosts& costs, const Loop& loop,
                             const std::function<void(double)>& round) {
    clear();
    nodes_ = std::move(top);
    double total = 0.0;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].lower != 0) continue;
        nodes_[i].axis = -1;
        nodes_[i].cost = costs.cost(nodes_[i].box);
        total += double{nodes_[i].cost};
        totals_.push_back(total);
    }
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
        if (nodes_[i].lower == 0) look_later(costs, i);
    grow(costs, loop, round);
}

void HalvedGrowth::grow(const HalvedCosts& costs, const Loop& loop, const std::function<void(double)>& round) {
    while (leaves() < size_.leaves && !is_reached() && choose() > 0) {
        halve(costs, loop);
        predict(costs);
        if (round) round(std::min(1.0, double(leaves()) / double(size_.leaves)));
    }
}

void HalvedGrowth::clear() {
    nodes_.clear();
    next_.clear();
    later_.clear();
    totals_.clear();
    least_ = 0;
    heavy_ = 0;
    size_ = sizes_.back();
    predicted_ = sizes_.size() == 1;
}

/// One leaf where the map is as even as sums in floats are exact.
void HalvedGrowth::begin(const HalvedCosts& costs) {
    clear();
    nodes_.emplace_back();
    nodes_[0].cost = costs.cost({});
    totals_.push_back(double{nodes_[0].cost});
    if (costs.variance(totals_[0]) < kEven) return;
    look_later(costs, 0);
}

void HalvedGrowth::look_later(const HalvedCosts& costs, std::uint32_t node) {
    look(costs, nodes_[node]);
    if (nodes_[node].axis < 0) return;
    later_.push_back(key_of(nodes_[node].gain, node));
    heavy_ += nodes_[node].gain == kHeavy;
}

void HalvedGrowth::look(const HalvedCosts& costs, HalvedNode& node) const {
    const bool heavy = limits_.heaviest > 0.0 && leaf_weight(costs, node, totals_.back()) > limits_.heaviest;
    node.gain = heavy ? -kHeavy : 0.0f;
    Look(costs, node).run();
    if (heavy) node.gain = kHeavy;
}

/// The key of which there are `count` that are not smaller.
std::uint64_t HalvedGrowth::rank(const std::vector<std::uint64_t>& of, std::size_t count) {
    ranked_ = of;
    const auto at = ranked_.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(ranked_.begin(), at, ranked_.end(), [](std::uint64_t a, std::uint64_t b) { return a > b; });
    return *at;
}

/// Moves those that are not below `least` to the end of `to`.
void HalvedGrowth::move(std::vector<std::uint64_t>& from, std::uint64_t least, std::vector<std::uint64_t>& to) {
    std::size_t kept = 0;
    for (const std::uint64_t key : from)
        if (key >= least) to.push_back(key);
        else from[kept++] = key;
    from.resize(kept);
}

/// Takes what is halved next; how many that are.
std::size_t HalvedGrowth::choose() {
    const std::size_t left = (predicted_ ? size_ : sizes_.front()).leaves - leaves();
    const std::size_t most = left > kAtOnce ? left / 2 : left;
    chosen_.clear();
    if (next_.empty() && !later_.empty()) {
        if (predicted_ && later_.size() > 2 * left) { // the others will not be halved
            const std::uint64_t least = rank(later_, left);
            later_.erase(
                std::remove_if(later_.begin(), later_.end(), [&](std::uint64_t key) { return key < least; }),
                later_.end());
        }
        const float largest = gain_of(*std::max_element(later_.begin(), later_.end()));
        least_ = left > kAtOnce ? key_of(limits_.alike * largest, kNoNode) : 0;
        const auto many =
            std::count_if(later_.begin(), later_.end(), [&](std::uint64_t key) { return key >= least_; });
        if (static_cast<std::size_t>(many) > most) least_ = rank(later_, most);
        move(later_, least_, next_);
    }
    if (next_.size() > most) move(next_, rank(next_, most), chosen_);
    else chosen_.swap(next_);
    std::sort(chosen_.begin(), chosen_.end(), std::greater<>());
    return chosen_.size();
}

void HalvedGrowth::halve(const HalvedCosts& costs, const Loop& loop) {
    const std::size_t before = nodes_.size();
    nodes_.resize(before + 2 * chosen_.size());
    loop.run(chosen_.size(), kOfThread, [&](std::size_t first, std::size_t last, std::size_t) {
        for (std::size_t i = first; i < last; ++i) {
            HalvedNode& node = nodes_[node_of(chosen_[i])];
            node.lower = static_cast<std::uint32_t>(before + 2 * i);
            for (std::uint32_t upper = 0; upper < 2; ++upper) {
                HalvedNode& lower_or_upper = nodes_[node.lower + upper];
                lower_or_upper = {};
                lower_or_upper.box = half(node.box, node.axis, upper);
                lower_or_upper.cost = costs.cost(lower_or_upper.box);
                look(costs, lower_or_upper);
            }
        }
    });
    for (const std::uint64_t key : chosen_) {
        const HalvedNode& node = nodes_[node_of(key)];
        heavy_ -= node.gain == kHeavy;
        totals_.push_back(totals_.back() + double{nodes_[node.lower].cost} + double{nodes_[node.lower + 1].cost} -
                          double{node.cost});
    }
    for (std::size_t i = before; i < nodes_.size(); ++i) {
        if (nodes_[i].axis < 0) continue;
        heavy_ += nodes_[i].gain == kHeavy;
        const std::uint64_t key = key_of(nodes_[i].gain, static_cast<std::uint32_t>(i));
        (key >= least_ ? next_ : later_).push_back(key);
    }
}

/// Once there are nearly as many leaves as the most bits allow, it shows how the variance falls with their number.
void HalvedGrowth::predict(const HalvedCosts& costs) {
    if (predicted_ || double(leaves()) < kPredictedFrom * double(sizes_.front().leaves)) return;
    predicted_ = true;
    const std::size_t earlier = std::max<std::size_t>(leaves() / 2, 1);
    const double now = std::max(costs.variance(cost(leaves())), 1e-12);
    const double slope = leaves() > earlier ? std::log(std::max(costs.variance(cost(earlier)) / now, 1.0)) /
                                                  std::log(double(leaves()) / double(earlier))
                                            : 0.0;
    double best = std::numeric_limits<double>::infinity();
    for (const TreeSize& size : sizes_) {
        const double grown = std::max(1.0, double(size.leaves) / double(leaves()));
        const double loss = now * std::pow(grown, -slope) + predicted_loss(size.leaves, size.code_bits);
        if (loss >= best) continue;
        best = loss;
        size_ = size;
    }
}

} // namespace acdf::compress
