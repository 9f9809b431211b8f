// GgxSampler as product sampling asks for a lobe (acdf/product/lobe.h). Its pdf over the cosine stands for the
// BRDF.
#pragma once

#include "measure/samplers/brdf_samplers.h"
#include "measure/samplers/point_samplers.h"
#include "measure/surface_frame.h"

#include <acdf/product/lobe.h>

#include <algorithm>

namespace acdf::measure {

class GgxLobe {
public:
    struct Point {
        double wo[3], scale;
    };

    explicit GgxLobe(double alpha) : ggx_(alpha) {}
    GgxLobe(double alpha_x, double alpha_y) : ggx_(alpha_x, alpha_y) {}

    bool at(const float wo[3], Point& point) const {
        std::copy_n(wo, 3, point.wo);
        point.scale = ggx_.scale(point.wo);
        return wo[2] > 0.0f;
    }
    static float value(const Point&, const float wi[3], float pdf) { return pdf / std::max(0.02f, wi[2]); }
    float pdf(const Point& point, const float wi[3]) const {
        const double w[3] = {wi[0], wi[1], wi[2]};
        return static_cast<float>(ggx_.pdf(point.wo, point.scale, w));
    }
    ProductSample sample(const Point& point, double u0, double u1) const {
        const double u[2] = {below_one(u0), below_one(u1)};
        const BrdfSample s = ggx_.sample(point.wo, u);
        return {{static_cast<float>(s.wi[0]), static_cast<float>(s.wi[1]), static_cast<float>(s.wi[2])},
                static_cast<float>(s.pdf)};
    }

private:
    GgxSampler ggx_;
};

/// The frame of a surface that all samplers here agree on.
inline SurfaceFrame frame_of(const ShadingPoint& point) {
    const double n[3] = {point.n[0], point.n[1], point.n[2]};
    double tangent[3], bitangent[3];
    SurfaceFrame frame;
    measure::surface_frame(n, tangent, bitangent);
    for (int k = 0; k < 3; ++k) {
        frame.tangent[k] = static_cast<float>(tangent[k]);
        frame.bitangent[k] = static_cast<float>(bitangent[k]);
        frame.normal[k] = point.n[k];
    }
    return frame;
}

} // namespace acdf::measure
