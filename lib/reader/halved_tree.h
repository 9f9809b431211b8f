// Makes what calls on a tree of halvings need, once, when a file is opened. Not installed.
#pragma once

#include "sources.h"

#include <acdf/allocator.h>
#include <acdf/halvings.h>

namespace acdf {

/// What a tree of halvings is made of.
struct HalvedSource {
    const AcdfHalving* nodes;
    u32 count;
    const u32* resolution; ///< of each sampled axis
    u32 axes;              ///< how many are sampled
    u32 parameterization;  ///< AcdfParameterization of the file
    bool lookup;           ///< whether a lookup grid is made, where the tree is of two axes
};

/// Step times this over 2^32 is the square of a step, of 2^bits along an axis. Of an axis with fewer steps than
/// squares, some squares have no step.
inline u32 position_scale(u32 resolution, u32 bits) {
    return static_cast<u32>((u64{1} << (32 + bits)) / resolution);
}

/// The tree, in `block`, which the caller gives back; null where there is no memory. A lookup grid for which there
/// is no memory is left out. Linear in the nodes and the squares of the grid.
AcdfHalvedTree* make_halved_tree(const HalvedSource& source, const AcdfAllocator& allocator,
                                 AcdfBlock& block) noexcept;

} // namespace acdf
