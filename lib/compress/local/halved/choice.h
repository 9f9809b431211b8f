// How many bins, bits and tiles suit a local environment map on one tree of halvings.
#pragma once

#include "compress/local/halved/growth.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Of bins the share that has a code at a halving, about.
constexpr double kSeen = 0.58;

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

} // namespace acdf::compress
