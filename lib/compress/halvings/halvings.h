// A tree of halvings as files hold it (SPEC.md §6.2).
#pragma once

#include <cstddef>
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

/// Bytes of chunk HALV.
std::size_t halvings_bytes(std::size_t leaves, std::uint32_t axis_bits, std::uint32_t code_bits);
std::vector<std::uint8_t> halvings_chunk(const Halvings& halvings);
/// The same in memory that is used again.
void halvings_chunk(const Halvings& halvings, std::vector<std::uint8_t>& bytes);

} // namespace acdf::compress
