#include "compress/tables/costs.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kOfTwoHalvings = 1.0 / 3.0; // what the gain of two halvings counts
constexpr double kRoundingOfCost = 1e-10;    // of a box's cost: less is rounding
constexpr double kUnseen = 0.1; // what cannot be seen yet counts: a spot in the middle gains by three halvings

/// What halving a box gains, by sums of its parts.
class Halving {
public:
    /// `scale`, `left_scale`: what roots of sums of squares and sums of what is left to a partner are multiplied
    /// with.
    Halving(const TableBox& box, double measure, double cost, std::size_t axes, const BoxSums& squares,
            double scale, const BoxSums* left, double left_scale)
        : box_(box), measure_(measure), cost_(cost), axes_(axes), squares_(squares), scale_(scale), left_(left),
          left_scale_(left_scale) {}

    double gain(std::size_t axis) const {
        const TableBox::Span& span = box_.axis[axis];
        double costs = 0.0, least = 0.0;
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            const double measure = share(span, upper) * measure_;
            const double cost =
                cost_of(measure, squares_.of_half(axis, upper), left_ ? left_->of_half(axis, upper) : 0.0);
            costs += cost;
            least += least_of(axis, upper, measure, cost);
        }
        return std::max(cost_ - costs, kOfTwoHalvings * (cost_ - least));
    }

private:
    static double share(const TableBox::Span& span, std::uint32_t upper) {
        const double lower = double(span.middle() - span.low) / double(span.length());
        return upper ? 1.0 - lower : lower;
    }

    double cost_of(double measure, double square, double left) const {
        return cell_cost(std::sqrt(measure * square) * scale_, left * left_scale_);
    }

    /// The least that a half costs once it is halved at most once more.
    double least_of(std::size_t axis, std::uint32_t upper, double measure, double as_leaf) const {
        double least = as_leaf;
        for (std::size_t b = 0; b < axes_; ++b) {
            const TableBox::Span span = b == axis ? half(box_, axis, upper).axis[b] : box_.axis[b];
            if (!span.can_halve()) continue;
            double costs = 0.0;
            for (std::uint32_t j = 0; j < 2; ++j) {
                const auto part = [&](const BoxSums& sums) {
                    return b == axis ? sums.quarter[axis][2 * upper + j] : sums.of_pair(axis, upper, b, j);
                };
                costs += cost_of(share(span, j) * measure, part(squares_), left_ ? part(*left_) : 0.0);
            }
            least = std::min(least, costs);
        }
        return least;
    }

    const TableBox& box_;
    double measure_, cost_;
    std::size_t axes_;
    const BoxSums& squares_;
    double scale_;
    const BoxSums* left_;
    double left_scale_;
};

/// The longest axis; -1: none can be halved.
std::int8_t longest_axis(const TableBox& box) {
    std::int8_t out = -1;
    std::uint32_t longest = 1;
    for (std::size_t axis = 0; axis < box.axis.size(); ++axis) {
        if (box.axis[axis].length() <= longest) continue;
        longest = box.axis[axis].length();
        out = static_cast<std::int8_t>(axis);
    }
    return out;
}

} // namespace

TableCosts::TableCosts(const std::vector<Grid>& bins, double heaviest) : heaviest_(heaviest) {
    for (std::size_t number = 0; number < bins.size(); ++number) {
        const Grid& grid = bins[number];
        std::size_t count = 1;
        for (const std::uint32_t length : grid.shape) count *= length;
        const double sum = integral(grid) * double(count);
        if (!(sum > 0.0)) continue;
        bins_.push_back({&grid, number, double(count), sum});
        numbers_ += count;
    }
}

TableBox TableCosts::whole(std::uint32_t tree) const {
    TableBox out;
    for (std::size_t axis = 0; axis < axes(); ++axis) out.axis[axis] = {0, bins_[tree].grid->shape[axis]};
    return out;
}

TableBox TableCosts::box_of(const std::vector<TableNode>& nodes, std::uint32_t node) const {
    std::array<std::uint32_t, 31 * ACDF_MAX_AXES> path{}; // a level of each axis
    std::size_t depth = 0;
    for (; nodes[node].parent != node; node = nodes[node].parent) path[depth++] = node;
    TableBox out = whole(nodes[node].tree);
    for (; depth-- > 0; node = path[depth])
        out = half(out, static_cast<std::size_t>(nodes[node].axis), path[depth] - nodes[node].lower);
    return out;
}

TableNode TableCosts::root(std::uint32_t tree) const {
    TableNode out;
    out.tree = out.parent = tree;
    look(whole(tree), out);
    return out;
}

std::array<TableNode, 2> TableCosts::halves_of(const std::vector<TableNode>& nodes, std::uint32_t node) const {
    const TableBox box = box_of(nodes, node);
    std::array<TableNode, 2> out;
    for (std::uint32_t upper = 0; upper < 2; ++upper) {
        out[upper].tree = nodes[node].tree;
        out[upper].parent = node;
        look(half(box, static_cast<std::size_t>(nodes[node].axis), upper), out[upper]);
    }
    return out;
}

double TableCosts::weight(const TableNode& node) const {
    const Filling* filling = bins_[node.tree].grid->filling;
    return filling ? filling->share(node.alone, node.left) : node.alone;
}

void TableCosts::look(const TableBox& box, TableNode& node) const {
    const Bin& bin = bins_[node.tree];
    const Grid& grid = *bin.grid;
    BoxSums squares, left;
    sum_box({grid.shape, grid.values, true}, box, squares);
    if (grid.left) sum_box({grid.shape, grid.left, false}, box, left);
    double measure = 1.0;
    for (std::size_t axis = 0; axis < axes(); ++axis) measure *= double(box.axis[axis].length()) / grid.shape[axis];
    const double scale = std::sqrt(bin.count) / bin.sum;
    node.alone = std::sqrt(measure * squares.all) * scale;
    node.left = left.all / bin.sum;
    const double cost = node.cost(), rounding = kRoundingOfCost * cost;
    if (!(cost > 0.0)) return;
    if (heaviest_ > 0.0) {
        const double largest = static_cast<double>(largest_in({grid.shape, grid.values, false}, box));
        node.peak = static_cast<float>(largest * (bin.count / bin.sum) * measure);
        node.heavy = static_cast<double>(node.peak) > heaviest_ * node.alone;
    }
    const Halving halving(box, measure, cost, axes(), squares, scale, grid.left ? &left : nullptr, 1.0 / bin.sum);
    double best = rounding;
    for (std::size_t axis = 0; axis < axes(); ++axis) {
        if (!box.axis[axis].can_halve()) continue;
        const double gain = halving.gain(axis);
        if (!(gain > best)) continue;
        best = gain;
        node.axis = static_cast<std::int8_t>(axis);
    }
    const double at_best = sum_in({grid.shape, grid.left ? grid.least : grid.values, false}, box) / bin.sum;
    const double unseen = kUnseen * (cost - at_best);
    node.promise = static_cast<float>(std::max(best, unseen));
    if (node.axis < 0 && (unseen > rounding || node.heavy)) node.axis = longest_axis(box);
}

} // namespace acdf::compress
