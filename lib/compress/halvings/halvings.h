// A tree of halvings as files hold it (SPEC.md §6.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Nodes in preorder, of one tree or of several.
struct Halvings {
    std::uint32_t code_bits = 8;
    std::uint32_t axis_bits = 1;
    std::vector<std::int8_t> axes;    ///< one a node: the number of a sampled axis of the file, or -1 for a leaf
    std::vector<std::uint16_t> codes; ///< one a halving: share of the lower half, as acdf_halving_share reads it

    std::size_t leaves() const { return axes.size() - codes.size(); }
};

/// Bytes of chunk HALV. `leaves`: of all trees.
std::size_t halvings_bytes(std::size_t leaves, std::uint32_t axis_bits, std::uint32_t code_bits,
                           std::size_t trees = 1);
/// Bits of the number of one of so many axes.
std::uint32_t axis_bits_for(std::size_t axes);
std::vector<std::uint8_t> halvings_chunk(const Halvings& halvings);
/// The same in memory that is used again.
void halvings_chunk(const Halvings& halvings, std::vector<std::uint8_t>& bytes);

} // namespace acdf::compress
