// A tree of halvings as files hold it (SPEC.md §6.2), and how a grown one becomes that.
#pragma once

#include "compress/halvings/growth.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Nodes in preorder.
struct Halvings {
    std::uint32_t code_bits = 8;
    std::uint32_t axis_bits = 1;
    std::vector<std::int8_t> axes;    ///< one a node: the number of a sampled axis of the file, or -1 for a leaf
    std::vector<std::uint16_t> codes; ///< one a halving: share of the lower half, as acdf_halving_share reads it

    std::size_t leaves() const { return axes.size() - codes.size(); }
};

/// The part of a tree that is kept once it is stored.
struct Quantised {
    Halvings halvings;
    double second_moment = 0.0; ///< sum of the squares of alone / p of all leaves, times p (PAPER.md §5)
    double max_weight = 0.0;    ///< the largest f / p over the mean, where asked for
};

/// The tree of the first `leaves` leaves of `grown`. Leaves get the probability nearest to their share of all
/// weights (HalvedSums::weight) that can be stored, but never 0 if they have any. A node whose random numbers are
/// too few to be divided becomes a leaf. `integral`: that of f, to find the largest weight; 0: not asked for.
Quantised quantise(const HalvedSums& sums, const GrownTree& grown, std::size_t leaves, std::uint32_t code_bits,
                   double integral = 0.0);

/// Bytes of chunk HALV.
std::size_t halvings_bytes(std::size_t leaves, std::uint32_t axis_bits, std::uint32_t code_bits);
std::vector<std::uint8_t> halvings_chunk(const Halvings& halvings);

} // namespace acdf::compress
