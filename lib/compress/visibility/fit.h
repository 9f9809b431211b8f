// The fit of visibility cells: cells of a scene, and for each what of the light reaches it.
#pragma once

#include "compress/store/store.h"
#include "compress/visibility/light.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// Positions of the scene become those of cells by x' = t[0] x + t[1] y + t[2] z + t[3], a row a coordinate.
struct VisibilityFrame {
    float transform[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

struct VisibilitySize {
    std::uint64_t bytes = 3 << 20; ///< of the chunks, at most (but for those of one cell)
    bool beside_cosine = false;    ///< for what as many samples of the cosine leave over
};

/// The chunk PLAC, and PORT where the scene has portals, for a local environment on one tree of halvings;
/// positions of the scene's points are those of cells. The same for any number of threads. Throws
/// std::invalid_argument where it is on none, and where there are no points.
std::vector<Chunk> fit_visibility(const AcdfLocal& local, std::uint32_t bins, const VisibilityScene& scene,
                                  const VisibilityFrame& frame, const VisibilitySize& size,
                                  const std::function<void(double)>& progress = {});

} // namespace acdf::compress
