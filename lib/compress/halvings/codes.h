// Which code of a halving stands for a share best.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Random numbers that are floats, which have 24 bits, reach every cell of so many steps of an axis.
constexpr std::uint32_t kStepsOfFloats = 1u << (31 - 24);

/// The shares that codes of so many bits stand for.
class HalvingCodes {
public:
    explicit HalvingCodes(std::uint32_t bits);

    std::uint32_t bits() const { return bits_; }
    /// Of `wide` steps of random numbers those that a code gives to the lower half.
    std::uint32_t lower(std::uint32_t wide, std::uint32_t code) const;
    /// The code that makes a^2 / p + b^2 / (1 - p) smallest, of those that leave the halves so many steps; the
    /// first or the last where a or b is 0.
    std::uint32_t best(std::uint32_t wide, double a, double b, double least_a, double least_b) const;
    /// How many steps a node has at least, so that some code leaves its halves so many: more than their sum, for
    /// codes are coarse. best() then leaves them.
    double least(double least_a, double least_b) const;

private:
    std::uint32_t nearest(double share) const;
    std::uint32_t last() const { return static_cast<std::uint32_t>(shares_.size()) - 1; }

    std::uint32_t bits_;
    std::vector<std::uint32_t> shares_;
    std::vector<double> borders_; ///< of each code the share from which on the next one is better
    std::vector<std::uint16_t> guesses_;
};

} // namespace acdf::compress
