// How many halvings, and how many with codes of rows, suit a size.
#pragma once

#include "compress/halvings/growth.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Bits of a halving in HALV, and in NORM beside codes.
constexpr double kSharedBits = 8 + 3;

/// Bytes of chunks HALV and NORM together, `codes` being those of all rows.
std::size_t row_bytes(std::size_t halvings, std::size_t codes, std::uint32_t code_bits);
/// The most halvings with which these chunks take at most `bytes`.
std::size_t halvings_within(std::uint64_t bytes, std::size_t codes, std::uint32_t code_bits);
/// Whether rows of that many codes may stand in a file, `top` halvings having codes: a reader keeps a number for
/// each row and tile.
bool are_dense(std::size_t rows, std::size_t top, std::size_t codes, std::uint32_t code_bits);
/// About how many halvings, with `row_bits` of codes each, take so many bytes: no more than fit into any file, so
/// that counts can be integers.
double halvings_for(double bytes, double row_bits);

/// The first `halvings` of them, which are the top, as a tree of their own.
std::vector<HalvedNode> first_halvings(const std::vector<HalvedNode>& nodes, std::size_t halvings);

/// How many halvings have codes of rows, `row_bits` each, so that a bit gains alike there and below. `below`: costs
/// of what rows share, which are `unit` times those of the top.
std::size_t choose_top(const HalvedGrowth& top, const HalvedCosts& below, double unit, double row_bits,
                       double bytes);

} // namespace acdf::compress
