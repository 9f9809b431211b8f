#include "compress/tables/coder.h"

#include <acdf/layout.h>

#include <algorithm>

namespace acdf::compress {

TableCoder::TableCoder(const TableCosts& costs, const TableOrder& order) : costs_(costs), nodes_(order.nodes()) {
    out_.axis_bits = axis_bits_for(costs.axes());
}

/// Where a partner is enough in all of a tree, there are no weights: then costs.
void TableCoder::add_weights() {
    const auto fill = [&](const auto& takes, const auto& of_leaf) {
        for (std::size_t i = weights_.size(); i-- > 0;) {
            const TableNode& node = nodes_[i];
            if (takes(node.tree))
                weights_[i] = is_halved(node) ? weights_[node.lower] + weights_[node.lower + 1] : of_leaf(node);
        }
    };
    fill([](std::uint32_t) { return true; }, [&](const TableNode& node) { return costs_.weight(node); });
    std::vector<char> by_cost;
    for (std::size_t tree = 0; tree < costs_.trees(); ++tree) by_cost.push_back(!(weights_[tree] > 0.0));
    if (std::find(by_cost.begin(), by_cost.end(), 1) == by_cost.end()) return;
    fill([&](std::uint32_t tree) { return by_cost[tree] != 0; }, [](const TableNode& node) { return node.cost(); });
}

const Halvings& TableCoder::code(std::size_t leaves, const HalvingCodes& codes) {
    weights_.resize(2 * leaves - costs_.trees());
    add_weights();
    out_.code_bits = codes.bits();
    out_.axes.clear();
    out_.codes.clear();
    roots_.clear();
    second_moment_ = max_weight_ = 0.0;
    for (std::uint32_t tree = 0; tree < costs_.trees(); ++tree) {
        const auto first = static_cast<std::uint32_t>(out_.codes.size());
        code_tree(tree, codes);
        roots_.push_back(out_.codes.size() > first ? first : std::uint32_t{ACDF_NO_ROOT});
    }
    relative_variance_ = std::max(0.0, second_moment_ / double(costs_.trees()) - 1.0);
    return out_;
}

void TableCoder::code_tree(std::uint32_t tree, const HalvingCodes& codes) {
    Part part{tree, {}}, lower, upper;
    for (AcdfSpan& steps : part.steps) steps = {{0, ACDF_STEPS}};
    while (true) {
        lower = upper = part;
        if (divide(nodes_[part.node], codes, lower, upper)) {
            open_.push_back(upper);
            part = lower;
            continue;
        }
        end(part);
        if (open_.empty()) return;
        part = open_.back();
        open_.pop_back();
    }
}

/// A leaf.
void TableCoder::end(const Part& part) {
    const TableNode& node = nodes_[part.node];
    out_.axes.push_back(-1);
    double p = 1.0;
    for (std::size_t axis = 0; axis < costs_.axes(); ++axis) p *= acdf_span_share(&part.steps[axis]);
    if (!(p > 0.0)) return;
    second_moment_ += node.alone * (node.alone / p);
    max_weight_ = std::max(max_weight_, static_cast<double>(node.peak) / p);
}

bool TableCoder::divide(const TableNode& node, const HalvingCodes& codes, Part& lower, Part& upper) {
    if (!is_halved(node)) return false;
    const double a = weights_[node.lower], b = weights_[node.lower + 1];
    if (!(a + b > 0.0)) return false;
    const auto axis = static_cast<std::size_t>(node.axis);
    AcdfSpan& steps = lower.steps[axis];
    const std::uint32_t wide = steps.end[1] - steps.end[0];
    if (a > 0.0 && b > 0.0 && wide < 2) return false;
    const std::uint32_t code = codes.best(wide, a, b, 1.0, 1.0);
    lower.node = node.lower;
    upper.node = node.lower + 1;
    steps.end[1] = upper.steps[axis].end[0] = steps.end[0] + codes.lower(wide, code);
    out_.axes.push_back(node.axis);
    out_.codes.push_back(static_cast<std::uint16_t>(code));
    return true;
}

} // namespace acdf::compress
