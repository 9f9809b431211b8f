// How many bits the codes of a tree of halvings get.
#pragma once

#include "compress/halvings/growth.h"
#include "compress/halvings/halvings.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

constexpr std::uint32_t kAxisBits = 1; // two axes
constexpr std::uint32_t kCodeBits[] = {6, 7, 8, 9, 10, 12};
constexpr std::uint32_t kFewestCodeBits = kCodeBits[0], kMostCodeBits = 12;
constexpr std::uint32_t kUsualCodeBits = 8;
constexpr double kEven = 4e-6; // relative variance of one cell, below which there is nothing to halve

/// The most leaves of so many trees that fit into a chunk; 0: not even one each.
inline std::size_t leaves_within(std::uint64_t bytes, std::uint32_t code_bits, std::uint32_t axis_bits = kAxisBits,
                                 std::size_t trees = 1) {
    const std::uint64_t bits = std::min<std::uint64_t>(bytes, std::uint64_t{1} << 32) * 8;
    std::size_t leaves =
        std::min<std::uint64_t>(bits / (2 + axis_bits + code_bits) + trees, std::uint64_t{ACDF_MOST_HALVINGS});
    while (leaves >= trees && halvings_bytes(leaves, axis_bits, code_bits, trees) > bytes) --leaves;
    return leaves >= trees ? leaves : 0;
}

/// What rounding to codes adds to the relative variance: a code of 8 bits about 1.3e-5 a level of the tree, one of
/// b bits 4^(8 - b) times that.
inline double predicted_loss(std::size_t leaves, std::uint32_t code_bits) {
    return 1.3e-5 * std::log2(double(leaves) + 1.0) * std::exp2(2.0 * (8.0 - double(code_bits)));
}

/// Codes of so few bits that rounding hardly adds to the noise of a tree.
inline std::uint32_t enough_code_bits(std::size_t leaves, double variance) {
    std::uint32_t bits = kUsualCodeBits;
    while (bits < 10 && variance < 4.0 * predicted_loss(leaves, bits)) ++bits;
    return bits;
}

/// The trees that fit into a chunk, from the most bits on.
inline std::vector<TreeSize> sizes_within(std::uint64_t bytes, std::vector<std::uint32_t> code_bits) {
    std::sort(code_bits.begin(), code_bits.end(), std::greater<>());
    std::vector<TreeSize> out;
    for (const std::uint32_t bits : code_bits)
        if (const std::size_t most = leaves_within(bytes, bits); most > 0) out.push_back({bits, most});
    return out;
}

} // namespace acdf::compress
