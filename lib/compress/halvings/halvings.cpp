#include "compress/halvings/halvings.h"

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

/// The shares that codes stand for.
std::vector<std::uint32_t> shares_of(std::uint32_t code_bits) {
    std::vector<std::uint32_t> shares(std::size_t{1} << code_bits);
    for (std::uint32_t code = 0; code < shares.size(); ++code) shares[code] = acdf_halving_share(code, code_bits);
    return shares;
}

class Quantiser {
public:
    Quantiser(const HalvedSums& sums, const GrownTree& grown, std::size_t leaves, std::uint32_t code_bits,
              double integral)
        : sums_(sums), grown_(grown), leaves_(leaves), integral_(integral), shares_(shares_of(code_bits)),
          last_code_((1u << code_bits) - 1) {
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
        const bool both = a > 0.0 && b > 0.0;
        if (both && steps.end[1] - steps.end[0] < 2 * least_steps_) return false;
        const std::uint32_t code = both ? best_code(steps, a, b) : a > 0.0 ? last_code_ : 0;
        lower = upper = part;
        lower.node = node.lower;
        upper.node = node.lower + 1;
        lower.steps[axis].end[1] = upper.steps[axis].end[0] = threshold(steps, code);
        out_.halvings.axes.push_back(static_cast<std::int8_t>(sums_.grid().axes[axis]));
        out_.halvings.codes.push_back(static_cast<std::uint16_t>(code));
        return true;
    }

    std::uint32_t threshold(const AcdfSpan& steps, std::uint32_t code) const {
        return acdf_halving_threshold(&steps, code, out_.halvings.code_bits, shares_[code]);
    }

    /// The code that makes a^2 / p + b^2 / (1 - p) smallest, of those that leave both halves enough steps.
    std::uint32_t best_code(const AcdfSpan& steps, double a, double b) const {
        const std::uint32_t wide = steps.end[1] - steps.end[0];
        const auto lower = [&](std::uint32_t code) { return threshold(steps, code) - steps.end[0]; };
        const auto loss = [&](std::uint32_t code) {
            return a * (a / lower(code)) + b * (b / (wide - lower(code)));
        };
        const auto share = static_cast<std::uint32_t>(a / (a + b) * 0x1p31);
        const auto above = std::lower_bound(shares_.begin(), shares_.end(), share) - shares_.begin();
        std::uint32_t code = std::clamp(static_cast<std::uint32_t>(above), 1u, last_code_ - 1);
        if (code > 1 && loss(code - 1) < loss(code)) --code;
        while (code + 1 < last_code_ && lower(code) < least_steps_) ++code;
        while (code > 1 && wide - lower(code) < least_steps_) --code;
        return code;
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
    std::vector<std::uint32_t> shares_;
    std::uint32_t last_code_;
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
