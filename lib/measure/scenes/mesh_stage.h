// A mesh as a matte scene under the light of a probe, and points all over it: where files with visibility cells are
// measured.
#pragma once

#include "compress/target.h"
#include "input/mesh/surface.h"
#include "measure/scenes/scene_points.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace acdf::measure {

class MeshStage {
public:
    /// `target`: a lat-long probe of one channel, else std::invalid_argument.
    /// `turned`: as of Geometry. `count` points on both sides of the mesh; the same ones every time.
    MeshStage(std::shared_ptr<const input::MeshSurface> surface, bool turned, const compress::Target& target,
              std::uint32_t count);
    MeshStage(const MeshStage&) = delete;
    MeshStage& operator=(const MeshStage&) = delete;

    const std::vector<ScenePoint>& points() const { return points_; }
    const ProbeLight& light() const { return scene_.light; }

private:
    std::unique_ptr<input::Brdf> matte_;
    std::vector<float> rgb_, spread_;
    Scene scene_;
    std::vector<ScenePoint> points_;
};

/// Relative variances of one sample, of what points reflect; those that see no light are left out. What they are
/// relative to is that of pictures (noise_scale): L^2 + (0.1 mean L)^2, so that a few nearly black points do not
/// decide.
struct StageVariances {
    std::vector<std::vector<double>> of_points; ///< samplers x points with light
    std::vector<std::uint64_t> lost;            ///< one a sampler: texels with light that are never sampled
};

/// By summation over texels (PointSums). Uses all cores; the result does not depend on their number. `progress`, if
/// any, is called with the share that is done, by several threads.
StageVariances variances_on(const MeshStage& stage, const std::vector<const LightSampler*>& samplers,
                            const std::function<void(double)>& progress = {});

} // namespace acdf::measure
