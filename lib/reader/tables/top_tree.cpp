#include "tables/top_tree.h"

namespace acdf {

u64 TopTree::tiles_below(u32 node) const {
    u64 count = 1;
    for_each_split(node, [&](u32, u32) { return ++count, true; });
    return count;
}

AcdfTopTile TopTree::tile(u32 node, const double* heights) const {
    const AcdfGrid grid = {parts_.axes[0].resolution, parts_.axes[1].resolution,
                           parts_.description->parameterization};
    const bool sphere = grid.parameterization != ACDF_PARAM_HALF_ANGLE;
    return {sphere ? acdf_box_scale(heights, &grid, box) : 0.0, node, {steps[0], steps[1]}, {box[0], box[1]}};
}

u32 top_lookup_bits(const Parts& parts, u32 splits) {
    constexpr u32 most_bits = 7;
    u32 bits = 0;
    while (bits < most_bits && splits >> 2 * bits > 0 && 2u << bits < parts.axes[ACDF_AXIS_PHI].resolution &&
           2u << bits < parts.axes[ACDF_AXIS_THETA].resolution)
        ++bits;
    return bits;
}

} // namespace acdf
