#include "measure/scenes/scene_points.h"

#include "measure/map_lookup.h"
#include "measure/surface_frame.h"

#include <acdf/sample.h>

#include <algorithm>

namespace acdf::measure {
namespace {

void to_float(const Vec3& v, float out[3]) {
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(v[k]);
}

/// Whether a point of object `own`, seen from outside, can lie behind `other` at all.
bool may_hide(const Object& other, bool own, bool inside) {
    if (std::holds_alternative<Mesh>(other.shape)) return true;
    // All other shapes are convex: seen from outside, none hides a direction above its own horizon.
    if (own) return inside && !std::holds_alternative<Plane>(other.shape);
    return true;
}

bool is_inside(const Shape& shape, const Hit& hit) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return dot(hit.position - sphere->centre, hit.n) < 0.0;
    if (const auto* box = std::get_if<Box3>(&shape))
        return dot(hit.position - 0.5 * (box->low + box->high), hit.n) < 0.0;
    return false;
}

} // namespace

Rgb ProbeLight::radiance(const float direction[3]) const {
    MapLookup::Blend blend;
    if (!MapLookup(columns, rows, ACDF_PARAM_LATLONG, filter).find(direction, blend)) return {};
    Rgb out{};
    for (std::size_t i = 0; i < blend.texel.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) out[k] += blend.weight[i] * double{rgb[3 * blend.texel[i] + k]};
    return out;
}

ScenePoint::ScenePoint(const Scene& scene, const Ray& ray, const Hit& hit)
    : scene_(&scene), position_(hit.position), n_(hit.n), material_(scene.geometry.objects[hit.object].material) {
    surface_frame(n_.data(), tangent_.data(), bitangent_.data());
    const Vec3 wo = -1.0 * ray.direction;
    wo_[0] = dot(wo, tangent_);
    wo_[1] = dot(wo, bitangent_);
    wo_[2] = dot(wo, n_);
    to_float(n_, shading_.n);
    to_float(wo, shading_.wo);
    const bool turned = scene.geometry.turned;
    to_float(turned ? Vec3{position_[1], position_[2], position_[0]} : position_, shading_.position);
    lonely_ = true;
    for (std::uint32_t i = 0; i < scene.geometry.objects.size(); ++i) {
        const Object& object = scene.geometry.objects[i];
        if (may_hide(object, i == hit.object, is_inside(object.shape, hit))) lonely_ = false;
    }
}

Rgb ScenePoint::reflected(const Vec3& wi) const {
    const double cosine = dot(wi, n_);
    if (!(cosine > 0.0)) return {};
    const double local[3] = {dot(wi, tangent_), dot(wi, bitangent_), cosine};
    Rgb rho;
    const Material& material = scene_->materials[material_];
    material.brdf->evaluate(wo_, local, rho.data());
    for (std::size_t k = 0; k < 3; ++k) rho[k] *= cosine * material.tint[k];
    return rho;
}

bool ScenePoint::hidden(const Vec3& wi) const { return !lonely_ && scene_->geometry.hidden(position_, n_, wi); }

double ScenePoint::share_hidden() const {
    constexpr std::uint32_t strata = 32;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < strata; ++i)
        for (std::uint32_t k = 0; k < strata; ++k) {
            const double square = (i + 0.5) / strata, radius = std::sqrt(square);
            double sine, cosine;
            acdf_sincospi(2.0 * (k + 0.5) / strata - 1.0, &sine, &cosine);
            count += hidden(radius * cosine * tangent_ + radius * sine * bitangent_ + std::sqrt(1.0 - square) * n_);
        }
    return count / double{strata * strata};
}

Rgb ScenePoint::operator()(const float wi[3]) const {
    const Vec3 direction{wi[0], wi[1], wi[2]};
    Rgb out = reflected(direction);
    const Rgb light = scene_->light.radiance(wi);
    for (std::size_t k = 0; k < 3; ++k) out[k] *= light[k];
    if (luminance(out) > 0.0 && hidden(direction)) return {};
    return out;
}

double ScenePoint::unoccluded(const float wi[3]) const {
    Rgb out = reflected({wi[0], wi[1], wi[2]});
    if (!(luminance(out) > 0.0)) return 0.0;
    const Rgb light = scene_->light.radiance(wi);
    for (std::size_t k = 0; k < 3; ++k) out[k] *= light[k];
    return luminance(out);
}

ScenePoints visible_points(const Scene& scene) {
    ScenePoints out;
    out.of_pixel.assign(std::size_t{scene.width} * scene.height, ScenePoints::none);
    for (std::uint32_t y = 0; y < scene.height; ++y)
        for (std::uint32_t x = 0; x < scene.width; ++x) {
            const Ray ray = scene.camera.ray(x, y, scene.width, scene.height);
            const std::optional<Hit> hit = scene.geometry.trace(ray);
            if (!hit) continue;
            out.of_pixel[std::size_t{y} * scene.width + x] = static_cast<std::uint32_t>(out.points.size());
            out.points.emplace_back(scene, ray, *hit);
        }
    return out;
}

} // namespace acdf::measure
