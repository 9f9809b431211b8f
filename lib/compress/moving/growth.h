// Grows a tree of halvings over the sums of a frame, many leaves at a time.
#pragma once

#include "compress/moving/sums.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// A node: its box, what it costs as a leaf, and the axis that it is best halved on.
struct MovingNode {
    MovingBox box;
    std::uint32_t lower = 0; ///< number of the lower half, which the upper one follows; 0: a leaf
    float cost = 0.0f;
    float gain = 0.0f;     ///< what halving it gains
    std::int8_t axis = -1; ///< 0: rows, 1: columns; -1: none gains anything
};

/// What a tree is to be: so many bits a code, and the most leaves that codes of so many bits may have.
struct MovingSize {
    std::uint32_t code_bits;
    std::size_t leaves;
};

/// Halves, in rounds, the leaves that lower the sum of costs most, by the measure of compress/halvings/growth.h.
/// The leaves of a round are about alike in what they gain, and the last rounds are small: the tree is nearly the
/// one that halves one leaf after the other. Memory is taken once.
class MovingGrowth {
public:
    /// `sizes`: from the most bits, and the fewest leaves, on.
    explicit MovingGrowth(std::vector<MovingSize> sizes);

    /// Grows the tree. `round` is called after each with the share that is there.
    void run(const MovingSums& sums, const Loop& loop, const std::function<void(double)>& round);

    /// The nodes; halves follow what they are halves of.
    const std::vector<MovingNode>& nodes() const { return nodes_; }
    std::size_t leaves() const { return (nodes_.size() + 1) / 2; }
    /// Relative variance of one sample, with shares as they are before they are rounded to codes.
    double variance(const MovingSums& sums) const { return variance_of(total_, sums); }
    std::uint32_t code_bits() const { return size_.code_bits; } ///< that suit the tree

private:
    static double variance_of(double total, const MovingSums& sums) {
        const double cost = total / sums.unit();
        return cost * (cost / sums.mean_square()) - 1.0;
    }
    void begin(const MovingSums& sums);
    std::size_t choose();
    std::uint64_t rank(const std::vector<std::uint64_t>& of, std::size_t count);
    static void move(std::vector<std::uint64_t>& from, std::uint64_t least, std::vector<std::uint64_t>& to);
    void halve(const MovingSums& sums, const Loop& loop);
    void predict(const MovingSums& sums);

    std::vector<MovingSize> sizes_;
    MovingSize size_;
    bool predicted_ = false;
    std::vector<MovingNode> nodes_;
    /// Keys of leaves: gain and number. Those of `next_` are not below `least_`, those of `later_` are.
    std::vector<std::uint64_t> next_, later_, chosen_, ranked_;
    std::uint64_t least_ = 0;
    double total_ = 0.0;                                 ///< of the costs of leaves
    std::vector<std::pair<std::size_t, double>> totals_; ///< leaves, and their total, after each round
};

} // namespace acdf::compress
