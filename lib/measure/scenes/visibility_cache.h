// What can be seen of each tile of a probe, at points that are chosen while a picture is made: the idea of
// LuxCore's visibility cache for environment lights.
#pragma once

#include "measure/samplers/tiling.h"
#include "measure/scenes/scene_points.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace acdf::measure {

/// A point of the picture that has none near with a normal like its own becomes a cache point: it sends rays to
/// each tile, sampled by the light in it, and keeps which share of them is not hidden. Other points take the shares
/// of the nearest one. What the rays missed is not lost: a floor is added to all shares.
class VisibilityCache {
public:
    VisibilityCache(const TilingOnTheFly& tiling, const std::vector<ScenePoint>& points);

    /// Factors for the tiles' weights, above 0 and little above 1 at most; null where no cache point serves.
    const float* factors(const ShadingPoint& point) const;
    std::size_t size() const { return entries_.size(); }
    std::uint64_t bytes() const;
    Making making() const { return making_; }

private:
    struct Entry {
        float position[3], n[3];
    };
    void add(const TilingOnTheFly& tiling, const ScenePoint& point);
    float share_seen(const TilingOnTheFly& tiling, std::size_t tile, const ScenePoint& point);
    std::uint64_t cell(const double at[3]) const;

    double radius_ = 0.0;
    std::vector<Entry> entries_;
    std::vector<float> factors_; ///< entries x tiles
    std::size_t tiles_ = 0;
    /// Cells as wide as the radius, each with all entries that may serve in it.
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
    Making making_;
};

} // namespace acdf::measure
