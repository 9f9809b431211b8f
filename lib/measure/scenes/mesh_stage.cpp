#include "measure/scenes/mesh_stage.h"

#include "compress/parallel.h"
#include "measure/scenes/point_sums.h"
#include "measure/scenes/render.h"
#include "measure/sequences.h"

#include <atomic>
#include <stdexcept>

namespace acdf::measure {

MeshStage::MeshStage(std::shared_ptr<const input::MeshSurface> surface, bool turned, const compress::Target& target,
                     std::uint32_t count)
    : matte_(input::open_brdf("lambert")) {
    if (target.means.size() > 1 || target.parameterization != ACDF_PARAM_LATLONG)
        throw std::invalid_argument("positions are measured under a lat-long probe of one channel");
    const std::vector<float>& means = target.means.empty() ? target.values : target.means[0];
    for (const float value : means) rgb_.insert(rgb_.end(), 3, value);
    scene_.light = {target.columns, target.rows, rgb_.data()};
    if (!target.means.empty()) {
        for (std::size_t i = 0; i < means.size(); ++i) {
            const double ratio = means[i] > 0.0f ? double{target.values[i]} / double{means[i]} : 1.0;
            spread_.push_back(static_cast<float>(ratio * ratio));
        }
        scene_.light.spread = spread_.data();
    }
    scene_.materials = {{matte_.get(), {1.0, 1.0, 1.0}}};
    scene_.geometry.objects = {{Mesh{surface}, 0, true}};
    scene_.geometry.turned = turned;
    if (surface->triangles().count() == 0) return;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = sobol_point(i + 1);
        const input::MeshSurface::Point at = surface->at(u[0] * 0x1p-32, u[1] * 0x1p-32, input::is_front(i));
        const Ray from_above{at.position + at.normal, -1.0 * at.normal};
        points_.emplace_back(scene_, from_above, Hit{1.0, at.position, at.normal, 0});
    }
}

StageVariances variances_on(const MeshStage& stage, const std::vector<const LightSampler*>& samplers,
                            const std::function<void(double)>& progress) {
    const std::vector<ScenePoint>& points = stage.points();
    std::vector<SamplerParts> parts;
    for (const LightSampler* sampler : samplers) parts.push_back({{{{sampler}, 1}}});
    std::vector<PointSums> sums(points.size());
    std::atomic<std::size_t> done{0};
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        std::vector<PartsAtPoint> at;
        for (const SamplerParts& one : parts) at.emplace_back(one, points[i]);
        sums[i] = sums_at(points[i], stage.light(), at);
        if (progress) progress(static_cast<double>(++done) / static_cast<double>(points.size()));
    });
    std::vector<Rgb> seen;
    for (const PointSums& point : sums)
        if (point.mean > 0.0) seen.push_back({point.mean, point.mean, point.mean});
    const std::vector<double> scale = noise_scale(seen);
    StageVariances out{std::vector<std::vector<double>>(samplers.size()), {}};
    out.lost.assign(samplers.size(), 0);
    std::size_t next = 0;
    for (const PointSums& point : sums) {
        if (!(point.mean > 0.0)) continue;
        for (std::size_t k = 0; k < samplers.size(); ++k) {
            out.of_points[k].push_back(point.variance[k] / scale[next]);
            out.lost[k] += point.lost[k];
        }
        ++next;
    }
    return out;
}

} // namespace acdf::measure
