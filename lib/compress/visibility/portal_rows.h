// What visibility cells store of portals: how much of each piece is seen, and what comes in another way.
#pragma once

#include "compress/store/store.h"
#include "compress/visibility/portal_maps.h"
#include "compress/visibility/rows.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Chunk PORT, with a row a cell by rays from its points. The same for any number of threads.
/// Throws std::invalid_argument where nothing arrives through a portal.
Chunk portal_chunk(const AcdfLocal& local, const PortalSet& set, const PointsOfCells& of,
                   const std::vector<VisibilityPoint>& points, std::uint32_t cells, const Occluded& occluded);

} // namespace acdf::compress
