#include "compress/halvings/halvings.h"

#include "compress/halvings/codes.h"

#include "compress/halvings/bit_writer.h"

#include <acdf/halvings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace acdf::compress {
namespace {

/// Of random numbers, on an axis: floats, which have 24 bits, reach every cell of so many.
constexpr std::uint32_t kStepsOfFloats = 1u << (31 - 24);

class Quantiser {
public:
    Quantiser(const HalvedSums& sums, const GrownTree& grown, std::size_t leaves, std::uint32_t code_bits,
              double integral)
        : sums_(sums), grown_(grown), leaves_(leaves), integral_(integral), codes_(code_bits) {
        out_.halvings.code_bits = code_bits;
        out_.halvings.axes.reserve(2 * leaves - 1);
        out_.halvings.codes.reserve(leaves - 1);
        add_weights();
    }

    Quantised run() {
        std::vector<Part> open{{0, {{{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}}}}};
        while (!open.empty()) {
            const Part part = open.back();
            open.pop_back();
            Part lower, upper;
            if (!divide(part, lower, upper)) {
                end(part);
                continue;
            }
            open.push_back(upper);
            open.push_back(lower);
        }
        return std::move(out_);
    }

private:
    struct Part {
        std::uint32_t node = 0;
        std::array<AcdfSpan, 2> steps{};
    };

    /// Where a partner is enough everywhere, there are none: then costs.
    void add_weights() {
        for (const bool by_cost : {false, true}) {
            weights_.assign(2 * leaves_ - 1, 0.0);
            for (std::size_t i = weights_.size(); i-- > 0;) {
                const GrownNode& node = grown_.nodes[i];
                weights_[i] = grown_.is_halved(i, leaves_) ? weights_[node.lower] + weights_[node.lower + 1]
                              : by_cost                    ? double{node.cost}
                                                           : sums_.weight(node.box);
            }
            if (weights_[0] > 0.0) return;
        }
    }

    bool divide(const Part& part, Part& lower, Part& upper) {
        const GrownNode& node = grown_.nodes[part.node];
        if (!grown_.is_halved(part.node, leaves_) || !(weights_[part.node] > 0.0)) return false;
        const auto axis = static_cast<std::size_t>(node.axis);
        const AcdfSpan steps = part.steps[axis];
        const double a = weights_[node.lower], b = weights_[node.lower + 1];
        const std::uint32_t wide = steps.end[1] - steps.end[0];
        if (a > 0.0 && b > 0.0 && wide < 2 * least_steps_) return false;
        const std::uint32_t code = codes_.best(wide, a, b, least_steps_, least_steps_);
        lower = upper = part;
        lower.node = node.lower;
        upper.node = node.lower + 1;
        lower.steps[axis].end[1] = upper.steps[axis].end[0] = steps.end[0] + codes_.lower(wide, code);
        out_.halvings.axes.push_back(static_cast<std::int8_t>(sums_.grid().axes[axis]));
        out_.halvings.codes.push_back(static_cast<std::uint16_t>(code));
        return true;
    }

    void end(const Part& part) {
        const GrownNode& node = grown_.nodes[part.node];
        out_.halvings.axes.push_back(-1);
        const double p = acdf_span_share(&part.steps[0]) * acdf_span_share(&part.steps[1]);
        if (!(p > 0.0)) return;
        const double alone = sums_.alone(node.box);
        out_.second_moment += alone * (alone / p);
        if (integral_ > 0.0)
            out_.max_weight =
                std::max(out_.max_weight, sums_.peak(node.box) * sums_.measure(node.box) / (p * integral_));
    }

    const HalvedSums& sums_;
    const GrownTree& grown_;
    std::size_t leaves_;
    double integral_;
    /// A bound on weights needs the smallest shares as they are: all 31 bits of random numbers.
    std::uint32_t least_steps_ = integral_ > 0.0 ? 1 : kStepsOfFloats;
    HalvingCodes codes_;
    std::vector<double> weights_;
    Quantised out_;
};

} // namespace

Quantised quantise(const HalvedSums& sums, const GrownTree& grown, std::size_t leaves, std::uint32_t code_bits,
                   double integral) {
    return Quantiser(sums, grown, leaves, code_bits, integral).run();
}

std::size_t halvings_bytes(std::size_t leaves, std::uint32_t axis_bits, std::uint32_t code_bits) {
    const std::size_t structure = 2 * leaves - 1 + (leaves - 1) * axis_bits, codes = (leaves - 1) * code_bits;
    return sizeof(AcdfHalvingsHeader) + (structure + 31) / 32 * 4 + (codes + 31) / 32 * 4;
}

std::vector<std::uint8_t> halvings_chunk(const Halvings& halvings) {
    const AcdfHalvingsHeader header = {static_cast<std::uint32_t>(halvings.codes.size()), halvings.code_bits, {}};
    std::vector<std::uint8_t> bytes(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    BitWriter bits(bytes);
    for (const std::int8_t axis : halvings.axes)
        if (axis < 0) bits.put(0, 1);
        else bits.put(1u | static_cast<std::uint32_t>(axis) << 1, 1 + halvings.axis_bits);
    bits.pad();
    for (const std::uint16_t code : halvings.codes) bits.put(code, halvings.code_bits);
    bits.pad();
    return bytes;
}

} // namespace acdf::compress
