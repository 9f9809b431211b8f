// The light of tiles as their cells sample it.
#pragma once

#include "compress/halvings/rows.h"
#include "compress/local/halved/growth.h"
#include "compress/local/halved/moments.h"

#include <vector>

namespace acdf::compress {

/// Moments of h, which in a cell is the square of its light times its measure over its share of a tile's samples:
/// the integral of h cos^2 over a tile is the second moment of one that has all samples. `squares`: those of the
/// square of light.
BlockMoments light_of_tiles(const Blocks& blocks, const SharedLight& shared, const BlockMoments& squares,
                            const RowTree& tree, const std::vector<HalvedNode>& nodes);

} // namespace acdf::compress
