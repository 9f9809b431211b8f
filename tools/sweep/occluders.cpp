#include "tools/sweep/occluders.h"

#include "compress/parallel.h"
#include "measure/scenes/scene_points.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::tools {
namespace {

using Directions = std::vector<std::array<float, 3>>;

/// Of the texels' middles, row-major.
Directions directions_of(const compress::Target& target) {
    Directions out(target.values.size());
    compress::parallel_for(0u, target.rows, [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < target.columns; ++c)
            out[std::size_t{r} * target.columns + c] = texel_middle(target, r, c);
    });
    return out;
}

SurfacePoint surface_point(const measure::ScenePoint& seen, const Directions& directions) {
    SurfacePoint out;
    std::copy_n(seen.shading().n, 3, out.n.begin());
    if (!seen.shadowed()) return out;
    out.hidden.resize(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const std::array<float, 3>& d = directions[i];
        const float cosine = out.n[0] * d[0] + out.n[1] * d[1] + out.n[2] * d[2];
        out.hidden[i] = cosine > 0.0f && seen.hidden({d[0], d[1], d[2]});
    }
    return out;
}

} // namespace

measure::Geometry demo_geometry() {
    return {{{measure::Plane{0.0, 30.0}, 0, true},
             {measure::Sphere{{0.0, 0.0, 1.0}, 1.0}, 0, true},
             {measure::Box3{{-9.0, 1.8, 0.3}, {6.0, 2.2, 7.0}}, 0, false}}};
}

measure::Camera demo_camera() { return {{5.0, -1.5, 2.6}, {0.0, 0.0, 0.75}, 36.0, {0.0, 0.0, 1.0}}; }

std::vector<SurfacePoint> behind_occluders(const compress::Target& target, std::uint32_t count) {
    measure::Scene scene;
    scene.geometry = demo_geometry();
    scene.camera = demo_camera();
    scene.height = std::max(1u, static_cast<std::uint32_t>(std::lround(std::sqrt(0.75 * count))));
    scene.width = std::max(1u, count / scene.height);
    const std::vector<measure::ScenePoint> seen = measure::visible_points(scene).points;
    const Directions directions = directions_of(target);
    std::vector<SurfacePoint> out(seen.size());
    compress::parallel_for(std::size_t{0}, seen.size(),
                           [&](std::size_t i) { out[i] = surface_point(seen[i], directions); });
    return out;
}

} // namespace acdf::tools
