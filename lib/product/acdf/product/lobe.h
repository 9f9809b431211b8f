// What product sampling asks of a BRDF (acdf/product/product.h): of a file, or a renderer's own. C++17, header
// only, freestanding. For kernels define ACDF_METHOD, for example as __host__ __device__.
#pragma once

#include <acdf/brdf.h>
#include <acdf/method.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

using ProductSample = AcdfDirectionSample;

/// A surface's axes in the frame of directions: orthogonal unit vectors.
struct SurfaceFrame {
    float tangent[3], bitangent[3], normal[3];

    ACDF_METHOD void to_local(const float w[3], float out[3]) const noexcept {
        out[0] = tangent[0] * w[0] + tangent[1] * w[1] + tangent[2] * w[2];
        out[1] = bitangent[0] * w[0] + bitangent[1] * w[1] + bitangent[2] * w[2];
        out[2] = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
    }
    ACDF_METHOD void to_world(const float w[3], float out[3]) const noexcept {
        for (int k = 0; k < 3; ++k) out[k] = w[0] * tangent[k] + w[1] * bitangent[k] + w[2] * normal[k];
    }
};

/// Some frame around a unit normal (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
ACDF_METHOD inline SurfaceFrame surface_frame(const float n[3]) noexcept {
    const float sign = n[2] < 0.0f ? -1.0f : 1.0f, a = -1.0f / (sign + n[2]), b = n[0] * n[1] * a;
    return {{1.0f + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
            {b, sign + n[1] * n[1] * a, -n[1]},
            {n[0], n[1], n[2]}};
}

/// A BRDF file as a lobe: what ProductSampler asks of one. Directions are in the surface's frame, z its normal.
class BrdfLobe {
public:
    /// What is looked up once for a view. Plain data.
    using Point = AcdfBrdfView;

    ACDF_METHOD explicit BrdfLobe(const AcdfBrdf& data) noexcept : data_(data) {}

    /// False where nothing is reflected to `wo`: it is below the surface or no unit vector.
    ACDF_METHOD bool at(const float wo[3], Point& point) const noexcept {
        return acdf_brdf_view(&data_, wo, &point) != 0;
    }
    /// The BRDF (without cosine), times any positive number that is the same for all directions, where `pdf` is
    /// that of wi, which lies above the surface.
    ACDF_METHOD float value(const Point&, const float wi[3], float pdf) const noexcept {
        return pdf / (wi[2] > 0.02f ? wi[2] : 0.02f);
    }
    /// sr^-1, of the lobe's own sampler.
    ACDF_METHOD float pdf(const Point& point, const float wi[3]) const noexcept {
        return acdf_brdf_view_pdf(&data_, &point, wi);
    }
    ACDF_METHOD ProductSample sample(const Point& point, double u0, double u1) const noexcept {
        return acdf_brdf_view_sample(&data_, &point, u0, u1);
    }

private:
    AcdfBrdf data_;
};

/// Sample i of `sampled`, at most 4, that look for a lobe: the points of Hammersley, moved off the borders.
template <class AnyLobe>
ACDF_METHOD ProductSample guide(const AnyLobe& lobe, const typename AnyLobe::Point& point, int i,
                                int sampled) noexcept {
    const int reversed = (i & 1) << 2 | (i & 2) | i >> 2;
    return lobe.sample(point, (i + 0.5) / sampled, (reversed + 0.5) / 8.0);
}

/// A renderer's own BRDF as a lobe. Callables over unit vectors in the surface's frame, wo above the surface:
/// value(wo, wi): the BRDF up to a factor; sample(wo, u0, u1): a ProductSample; pdf(wo, wi): its pdf, which
/// must be positive wherever the BRDF is, and should be about proportional to BRDF times cosine.
template <class Value, class Sample, class Pdf>
class Lobe {
public:
    struct Point {
        float wo[3];
    };

    ACDF_METHOD Lobe(Value value, Sample sample, Pdf pdf) noexcept : value_(value), sample_(sample), pdf_(pdf) {}

    ACDF_METHOD bool at(const float wo[3], Point& point) const noexcept {
        for (int k = 0; k < 3; ++k) point.wo[k] = wo[k];
        return acdf_are_finite(wo) && wo[2] > 0.0f;
    }
    ACDF_METHOD float value(const Point& point, const float wi[3], float) const noexcept {
        return static_cast<float>(value_(point.wo, wi));
    }
    ACDF_METHOD float pdf(const Point& point, const float wi[3]) const noexcept {
        return static_cast<float>(pdf_(point.wo, wi));
    }
    ACDF_METHOD ProductSample sample(const Point& point, double u0, double u1) const noexcept {
        return sample_(point.wo, u0, u1);
    }

private:
    Value value_;
    Sample sample_;
    Pdf pdf_;
};

} // namespace acdf
