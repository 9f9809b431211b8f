// How many bins, bits and tiles suit a local environment map on one tree of halvings.
#pragma once

#include "compress/local/halved/growth.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Of bins the share that has a code at a halving, about.
constexpr double kSeen = 0.58;
/// Bits of a halving in HALV, and in NORM beside codes.
constexpr double kSharedBits = 8 + 3;

/// Subdivisions of the octahedron, and bits of a code in rows.
struct RowSize {
    std::uint32_t subdivisions = 8, code_bits = 7;
};

/// The relative variance that mixing rows of bins adds, where the octahedron has 8 subdivisions.
double mixing_variance(const Blocks& blocks, const BlockMoments& light, const std::vector<HalvedNode>& top,
                       const NormalBins& bins);

/// The size that leaves the least noise in `bytes`: bins that are further apart mix worse, bins that are closer
/// leave bytes for fewer tiles. `fixed`: if not 0, the subdivisions.
RowSize choose_rows(const HalvedGrowth& top, double mixing, double bytes, double of_bin, std::uint32_t fixed);

/// How many halvings have codes of rows, `row_bits` each, so that a bit gains alike there and below. `below`: costs
/// of what rows share, which are `unit` times those of the top.
std::size_t choose_top(const HalvedGrowth& top, const HalvedCosts& below, double unit, double row_bits,
                       double bytes);

} // namespace acdf::compress
