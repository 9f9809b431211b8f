#include "compress/halvings/coder.h"

#include "compress/halvings/code_bits.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::size_t kMostOpen = 256; // nodes that wait: one a level of each axis, and one

} // namespace

TreeCoder::TreeCoder(std::array<std::uint32_t, 2> axes, std::uint32_t least_steps)
    : axes_(axes), least_steps_(least_steps) {
    for (const std::uint32_t bits : kCodeBits) codes_.emplace_back(bits);
    open_.reserve(kMostOpen);
}

void TreeCoder::reserve(std::size_t leaves) {
    weights_.reserve(2 * leaves);
    out_.axes.reserve(2 * leaves);
    out_.codes.reserve(leaves);
}

const HalvingCodes& TreeCoder::codes_of(std::uint32_t bits) const {
    return *std::find_if(codes_.begin(), codes_.end(),
                         [&](const HalvingCodes& codes) { return codes.bits() == bits; });
}

/// Where a partner is enough everywhere, there are none: then costs.
void TreeCoder::add_weights(const HalvedCosts& costs, const std::vector<HalvedNode>& nodes) {
    for (const bool by_cost : {false, true}) {
        for (std::size_t i = weights_.size(); i-- > 0;) {
            const HalvedNode& node = nodes[i];
            weights_[i] = is_halved(node) ? weights_[node.lower] + weights_[node.lower + 1]
                          : by_cost       ? double{node.cost}
                                          : costs.weight(node.box);
        }
        if (weights_[0] > 0.0) return;
    }
}

const Halvings& TreeCoder::code(const HalvedCosts& costs, const HalvedGrowth& grown, std::size_t leaves,
                                std::uint32_t code_bits) {
    const std::vector<HalvedNode>& nodes = grown.nodes();
    const HalvingCodes& codes = codes_of(code_bits);
    weights_.resize(2 * leaves - 1);
    add_weights(costs, nodes);
    out_.code_bits = code_bits;
    out_.axes.clear();
    out_.codes.clear();
    open_.clear();
    double second_moment = 0.0;
    max_weight_ = 0.0;
    Part part{0, {{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}}}, lower, upper;
    while (true) {
        lower = upper = part;
        const HalvedNode& node = nodes[part.node];
        if (divide(node, codes, lower, upper)) {
            open_.push_back(upper);
            part = lower;
            continue;
        }
        out_.axes.push_back(-1);
        if (const double p = acdf_span_share(&part.steps[0]) * acdf_span_share(&part.steps[1]); p > 0.0) {
            const double alone = costs.alone(node.box);
            second_moment += alone * (alone / p);
            max_weight_ = std::max(max_weight_, costs.peak(node.box) / p);
        }
        if (open_.empty()) break;
        part = open_.back();
        open_.pop_back();
    }
    relative_variance_ = std::max(0.0, second_moment / costs.least_square() - 1.0);
    return out_;
}

const Halvings& TreeCoder::leaf() {
    out_.code_bits = kUsualCodeBits;
    out_.axes.assign(1, -1);
    out_.codes.clear();
    relative_variance_ = max_weight_ = 0.0;
    return out_;
}

bool TreeCoder::divide(const HalvedNode& node, const HalvingCodes& codes, Part& lower, Part& upper) {
    if (!is_halved(node)) return false;
    const double a = weights_[node.lower], b = weights_[node.lower + 1];
    if (!(a + b > 0.0)) return false;
    AcdfSpan& steps = lower.steps[node.axis];
    const std::uint32_t wide = steps.end[1] - steps.end[0];
    if (a > 0.0 && b > 0.0 && wide < 2 * least_steps_) return false;
    const std::uint32_t code = codes.best(wide, a, b, least_steps_, least_steps_);
    lower.node = node.lower;
    upper.node = node.lower + 1;
    steps.end[1] = upper.steps[node.axis].end[0] = steps.end[0] + codes.lower(wide, code);
    out_.axes.push_back(static_cast<std::int8_t>(axes_[static_cast<std::size_t>(node.axis)]));
    out_.codes.push_back(static_cast<std::uint16_t>(code));
    return true;
}

} // namespace acdf::compress
