// What a camera sees of a scene: the points at which light is gathered, and what is integrated there.
#pragma once

#include "input/brdf/brdf.h"
#include "measure/samplers/estimator.h"
#include "measure/scenes/scene.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Radiance of a lat-long probe (docs/conventions.md): constant on texels, or interpolated between their centres.
struct ProbeLight {
    std::uint32_t columns = 0, rows = 0;
    const float* rgb = nullptr; ///< rows x columns x 3, >= 0
    AcdfFilter filter = ACDF_FILTER_NEAREST;
    const float* means = nullptr;  ///< of the radiance over each texel, as `rgb`; null: they are the same
    const float* spread = nullptr; ///< mean square of the radiance over a texel, over its mean's; null: 1

    /// The mean over a texel.
    Rgb texel(std::uint32_t column, std::uint32_t row) const {
        const float* t = (means ? means : rgb) + 3 * (std::size_t{row} * columns + column);
        return {double{t[0]}, double{t[1]}, double{t[2]}};
    }
    double spread_of(std::uint32_t column, std::uint32_t row) const {
        return spread ? double{spread[std::size_t{row} * columns + column]} : 1.0;
    }
    Rgb radiance(const float direction[3]) const;
};

struct Material {
    const input::Brdf* brdf = nullptr;
    Rgb tint{1.0, 1.0, 1.0}; ///< multiplies the BRDF
};

/// Rec. 709.
inline double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/// What points refer to; must outlive them and stay where it is.
struct Scene {
    Geometry geometry;
    Camera camera;
    std::uint32_t width = 0, height = 0;
    std::vector<Material> materials;
    ProbeLight light;
};

/// One visible point, and its integrand.
class ScenePoint : public Integrand {
public:
    ScenePoint(const Scene& scene, const Ray& ray, const Hit& hit);

    Rgb operator()(const float wi[3]) const override;
    double unoccluded(const float wi[3]) const override;

    /// BRDF times cosine for a direction of light; black below the horizon.
    Rgb reflected(const Vec3& wi) const;
    bool hidden(const Vec3& wi) const;
    /// Whether anything can be in the way of light.
    bool shadowed() const { return !lonely_; }
    /// The same point without occluders.
    ScenePoint in_the_open() const {
        ScenePoint out = *this;
        out.lonely_ = true;
        return out;
    }
    /// How much of the hemisphere, weighted by the cosine, is behind something: of 32 x 32 strata.
    double share_hidden() const;

    const ShadingPoint& shading() const { return shading_; }
    std::uint32_t material() const { return material_; }

private:
    const Scene* scene_;
    ShadingPoint shading_;
    Vec3 position_, n_, tangent_, bitangent_; ///< of the surface's frame, z is n
    double wo_[3];                            ///< in that frame
    std::uint32_t material_;
    bool lonely_; ///< nothing is in the way of any direction
};

/// The points seen through the centres of pixels, row by row.
struct ScenePoints {
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    std::vector<ScenePoint> points;
    std::vector<std::uint32_t> of_pixel; ///< height x width: index into `points`, or none
};
ScenePoints visible_points(const Scene& scene);

} // namespace acdf::measure
