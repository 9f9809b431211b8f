// Lat-long maps whose rows repeat, as a texture's do: what lies beyond the first row is the last one.
#pragma once

#include "build/probe/projection.h"
#include "compress/target.h"

namespace acdf::build {

/// Whether lookups of a map meet its rows at the other end.
inline bool has_repeated_rows(const Map& map, const compress::TargetOptions& options) {
    return map.repeats && map.layout == Layout::latlong && options.filter == ACDF_FILTER_BILINEAR;
}

/// Corrects the first and the last row of a bilinear target of a lat-long map on its own texels, which was made as
/// if lookups stopped at the poles: within half a texel of a pole they blend with the row at the other end. `first`
/// and `last`: those rows of the map, RGB. Exact along a row, by quadrature across it, as the target is.
void repeat_rows(compress::Target& target, const float* first, const float* last,
                 const compress::TargetOptions& options);

} // namespace acdf::build
