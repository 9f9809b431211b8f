#include "compress/moving/codes.h"

#include "compress/halvings/code_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kLeastSteps = 1u << (31 - 24); // of random numbers, on an axis: floats have 24 bits
constexpr std::uint32_t kGuesses = 1u << 12;
constexpr std::size_t kMostOpen = 256; // nodes that wait: one a level of each axis, and one

/// Bits, the lowest of each byte first, in words of 32.
class Words {
public:
    explicit Words(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    void put(std::uint32_t value, std::uint32_t count) {
        held_ |= std::uint64_t{value} << used_;
        used_ += count;
        if (used_ >= 32) flush();
    }
    /// Zeros up to a whole word.
    void pad() {
        if (used_ > 0) flush();
        used_ = 0;
    }

private:
    void flush() {
        const auto word = static_cast<std::uint32_t>(held_);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof word);
        std::memcpy(bytes_.data() + at, &word, sizeof word); // of a little-endian machine, which CMake checks
        held_ >>= 32;
        used_ = used_ > 32 ? used_ - 32 : 0;
    }

    std::vector<std::uint8_t>& bytes_;
    std::uint64_t held_ = 0;
    std::uint32_t used_ = 0;
};

} // namespace

// Between codes for p and q: a^2 / p + b^2 / (1 - p) is the same for both where (a / b)^2 is
// p q / ((1 - p) (1 - q)).
ShareCodes::ShareCodes(std::uint32_t bits)
    : bits_(bits), shares_(std::size_t{1} << bits),
      borders_(shares_.size(), std::numeric_limits<double>::infinity()), guesses_(kGuesses) {
    for (std::uint32_t code = 0; code < shares_.size(); ++code) shares_[code] = acdf_halving_share(code, bits);
    for (std::uint32_t code = 1; code + 1 < last(); ++code) {
        const double p = shares_[code] * 0x1p-31, q = shares_[code + 1] * 0x1p-31;
        const double ratio = std::sqrt(p * q / ((1.0 - p) * (1.0 - q)));
        borders_[code] = ratio / (1.0 + ratio);
    }
    std::uint32_t code = 1;
    for (std::uint32_t i = 0; i < kGuesses; ++i) {
        while (borders_[code] < i / double{kGuesses}) ++code;
        guesses_[i] = static_cast<std::uint16_t>(code);
    }
}

std::uint32_t ShareCodes::best(double share) const {
    std::uint32_t code = guesses_[std::min(static_cast<std::uint32_t>(share * kGuesses), kGuesses - 1)];
    while (borders_[code] < share) ++code;
    return code;
}

MovingCodes::MovingCodes(std::size_t leaves) {
    weights_.reserve(2 * leaves);
    open_.reserve(kMostOpen);
    axes_.reserve(2 * leaves);
    stored_.reserve(leaves);
    bytes_.reserve(halvings_bytes(leaves, kAxisBits, kMostCodeBits) + 8);
    for (const std::uint32_t bits : kCodeBits) codes_.emplace_back(bits);
}

const ShareCodes& MovingCodes::codes_of(std::uint32_t bits) {
    return *std::find_if(codes_.begin(), codes_.end(),
                         [&](const ShareCodes& codes) { return codes.bits() == bits; });
}

void MovingCodes::add_weights(const std::vector<MovingNode>& nodes) {
    weights_.resize(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const MovingNode& node = nodes[i];
        weights_[i] = node.lower ? weights_[node.lower] + weights_[node.lower + 1] : double{node.cost};
    }
}

const std::vector<std::uint8_t>& MovingCodes::store(const MovingSums& sums, const MovingGrowth& grown,
                                                    std::uint32_t code_bits) {
    const std::vector<MovingNode>& nodes = grown.nodes();
    const ShareCodes& codes = codes_of(code_bits);
    add_weights(nodes);
    axes_.clear();
    stored_.clear();
    open_.clear();
    double second_moment = 0.0;
    Part part{0, {{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}}}, lower, upper;
    while (true) {
        lower = upper = part;
        if (divide(nodes[part.node], codes, lower, upper)) {
            open_.push_back(upper);
            part = lower;
            continue;
        }
        axes_.push_back(0);
        const double p = acdf_span_share(&part.steps[0]) * acdf_span_share(&part.steps[1]);
        const double cost = double{nodes[part.node].cost};
        if (p > 0.0) second_moment += cost * (cost / p);
        if (open_.empty()) break;
        part = open_.back();
        open_.pop_back();
    }
    relative_variance_ = std::max(0.0, second_moment / sums.unit() / sums.unit() / sums.mean_square() - 1.0);
    write(code_bits);
    return bytes_;
}

const std::vector<std::uint8_t>& MovingCodes::store_leaf() {
    axes_.assign(1, 0);
    stored_.clear();
    relative_variance_ = 0.0;
    write(kUsualCodeBits);
    return bytes_;
}

bool MovingCodes::divide(const MovingNode& node, const ShareCodes& codes, Part& lower, Part& upper) {
    if (node.lower == 0) return false;
    const double a = weights_[node.lower], b = weights_[node.lower + 1];
    if (!(a + b > 0.0)) return false;
    const bool both = a > 0.0 && b > 0.0;
    AcdfSpan& steps = lower.steps[node.axis];
    const std::uint32_t wide = steps.end[1] - steps.end[0];
    if (both && wide < 2 * kLeastSteps) return false;
    std::uint32_t code = both ? codes.best(a / (a + b)) : a > 0.0 ? codes.last() : 0;
    const auto threshold = [&] { return acdf_halving_threshold(&steps, code, codes.bits(), codes.share(code)); };
    if (both) {
        while (code + 1 < codes.last() && threshold() - steps.end[0] < kLeastSteps) ++code;
        while (code > 1 && steps.end[1] - threshold() < kLeastSteps) --code;
    }
    const std::uint32_t middle = threshold();
    lower.node = node.lower;
    upper.node = node.lower + 1;
    steps.end[1] = upper.steps[node.axis].end[0] = middle;
    axes_.push_back(node.axis == 0 ? 2 : 1); // columns are axis 0 of the file
    stored_.push_back(static_cast<std::uint16_t>(code));
    return true;
}

void MovingCodes::write(std::uint32_t code_bits) {
    leaves_ = axes_.size() - stored_.size();
    const AcdfHalvingsHeader header = {static_cast<std::uint32_t>(stored_.size()), code_bits, {}};
    bytes_.resize(sizeof header);
    std::memcpy(bytes_.data(), &header, sizeof header);
    Words words(bytes_);
    for (const std::uint8_t axis : axes_) words.put(axis == 0 ? 0u : 2u * axis - 1u, axis == 0 ? 1 : 1 + kAxisBits);
    words.pad();
    for (const std::uint16_t code : stored_) words.put(code, code_bits);
    words.pad();
}

} // namespace acdf::compress
