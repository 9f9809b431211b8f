// One tree of halvings for several maps, with a row of codes for each at its top (docs/notes/moving.md).
#pragma once

#include "compress/fit/fit.h"
#include "compress/halvings/rows.h"

#include <acdf/layout.h>

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A map of an indexed environment, without what lies in the cone of its sun.
struct IndexedMap {
    const Target* grid = nullptr; ///< shape and measures
    std::vector<float> values;    ///< in place of those of `grid`
    double weight = 1.0;          ///< of samples, the share that the tree has
};

/// What chunks HALV and MAPS hold of the tree: a row a map, of all halvings with codes.
struct IndexedTree : RowHalvings {
    double variance = 0.0; ///< what maps have, mean: of one sample, relative, times `weight`
};

/// The best tree whose two chunks take at most `bytes`, but for what MAPS holds beside codes. All maps have one
/// grid and light. Deterministic for any number of threads. Throws std::runtime_error where no tree fits.
IndexedTree fit_indexed(const std::vector<IndexedMap>& maps, std::uint64_t bytes, const Progress& progress);

/// Chunk MAPS.
std::vector<std::uint8_t> maps_chunk(const IndexedTree& tree, const std::vector<double>& coordinates,
                                     const std::vector<AcdfMap>& maps, std::uint32_t sun);

} // namespace acdf::compress
