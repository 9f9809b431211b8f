// From a grown tree to the bytes of chunk HALV (SPEC.md §6.2), in memory that is taken once.
#pragma once

#include "compress/moving/growth.h"

#include <acdf/halvings.h>

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The shares that codes of some bits stand for, and which of them suits a share best.
class ShareCodes {
public:
    explicit ShareCodes(std::uint32_t bits);

    std::uint32_t bits() const { return bits_; }
    std::uint32_t last() const { return static_cast<std::uint32_t>(shares_.size()) - 1; }
    std::uint32_t share(std::uint32_t code) const { return shares_[code]; }
    /// The code, neither the first nor the last, that costs least where the lower half has this share of the
    /// weight.
    std::uint32_t best(double share) const;

private:
    std::uint32_t bits_;
    std::vector<std::uint32_t> shares_;
    std::vector<double> borders_; ///< of each code the share from which on the next one is better
    std::vector<std::uint16_t> guesses_;
};

/// Stores trees. Leaves get the probability nearest to their share of the costs, as compress/halvings/halvings.h
/// does.
class MovingCodes {
public:
    /// For trees of at most so many leaves.
    explicit MovingCodes(std::size_t leaves);

    /// The chunk's bytes; they are there until the next call.
    const std::vector<std::uint8_t>& store(const MovingSums& sums, const MovingGrowth& grown,
                                           std::uint32_t code_bits);
    /// The same of a tree of one leaf.
    const std::vector<std::uint8_t>& store_leaf();

    /// Of the tree that was stored last, of one sample.
    double relative_variance() const { return relative_variance_; }
    std::size_t leaves() const { return leaves_; }

private:
    struct Part {
        std::uint32_t node;
        AcdfSpan steps[2];
    };

    const ShareCodes& codes_of(std::uint32_t bits);
    void add_weights(const std::vector<MovingNode>& nodes);
    bool divide(const MovingNode& node, const ShareCodes& codes, Part& lower, Part& upper);
    void write(std::uint32_t code_bits);

    std::vector<ShareCodes> codes_;
    std::vector<double> weights_;
    std::vector<Part> open_;
    std::vector<std::uint8_t> axes_; ///< a node each: 0 leaf, 1 columns, 2 rows
    std::vector<std::uint16_t> stored_;
    std::vector<std::uint8_t> bytes_;
    double relative_variance_ = 0.0;
    std::size_t leaves_ = 0;
};

} // namespace acdf::compress
