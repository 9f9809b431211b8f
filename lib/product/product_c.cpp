// Product sampling from C: acdf::ProductSampler made for each call, which copies a few words.
#include <acdf/product/product.h>
#include <acdf/product/product_c.h>

#include <cstring>
#include <new>

namespace {

/// An AcdfLobe as ProductSampler asks for it.
class CLobe {
public:
    struct Point {
        float wo[3];
    };

    explicit CLobe(const AcdfLobe& lobe) noexcept : lobe_(lobe) {}
    static bool at(const float wo[3], Point& point) noexcept {
        std::memcpy(point.wo, wo, sizeof point.wo);
        return acdf_are_finite(wo) && wo[2] > 0.0f;
    }
    float value(const Point& point, const float wi[3], float) const noexcept {
        return lobe_.value(lobe_.data, point.wo, wi);
    }
    float pdf(const Point& point, const float wi[3]) const noexcept { return lobe_.pdf(lobe_.data, point.wo, wi); }
    acdf::ProductSample sample(const Point& point, double u0, double u1) const noexcept {
        return lobe_.sample(lobe_.data, point.wo, u0, u1);
    }

private:
    AcdfLobe lobe_;
};

acdf::BrdfLobe lobe_of(const AcdfBrdf& brdf) { return acdf::BrdfLobe(brdf); }

template <class AnyLobe>
void at(const AcdfLocal& light, const AnyLobe& lobe, int parts, const float frame[9], const float wo[3],
        AcdfProductPoint* out) noexcept {
    using Sampler = acdf::ProductSampler<AnyLobe>;
    static_assert(sizeof(typename Sampler::Point) <= sizeof(AcdfProductPoint));
    static_assert(alignof(typename Sampler::Point) <= alignof(AcdfProductPoint));
    acdf::SurfaceFrame axes;
    std::memcpy(axes.tangent, frame, sizeof axes.tangent);
    std::memcpy(axes.bitangent, frame + 3, sizeof axes.bitangent);
    std::memcpy(axes.normal, frame + 6, sizeof axes.normal);
    new (out->bytes) typename Sampler::Point(Sampler(light, lobe, {parts}).at(axes, wo));
}

template <class AnyLobe>
const typename acdf::ProductSampler<AnyLobe>::Point& point_in(const AcdfProductPoint* point) noexcept {
    return *reinterpret_cast<const typename acdf::ProductSampler<AnyLobe>::Point*>(point->bytes);
}

template <class AnyLobe>
acdf::ProductSample sample(const AcdfLocal& light, const AnyLobe& lobe, const AcdfProductPoint* point, double u0,
                           double u1) noexcept {
    return acdf::ProductSampler<AnyLobe>(light, lobe).sample(point_in<AnyLobe>(point), u0, u1);
}

template <class AnyLobe>
float pdf(const AcdfLocal& light, const AnyLobe& lobe, const AcdfProductPoint* point,
          const float direction[3]) noexcept {
    return acdf::ProductSampler<AnyLobe>(light, lobe).pdf(point_in<AnyLobe>(point), direction);
}

} // namespace

void acdf_product_at(const AcdfLocal* light, const AcdfBrdf* brdf, int parts, const float frame[9],
                     const float wo[3], AcdfProductPoint* point) {
    at(*light, lobe_of(*brdf), parts, frame, wo, point);
}
AcdfDirectionSample acdf_product_sample(const AcdfLocal* light, const AcdfBrdf* brdf, const AcdfProductPoint* point,
                                        double u0, double u1) {
    return sample(*light, lobe_of(*brdf), point, u0, u1);
}
float acdf_product_pdf(const AcdfLocal* light, const AcdfBrdf* brdf, const AcdfProductPoint* point,
                       const float direction[3]) {
    return pdf(*light, lobe_of(*brdf), point, direction);
}

void acdf_product_lobe_at(const AcdfLocal* light, const AcdfLobe* lobe, int parts, const float frame[9],
                          const float wo[3], AcdfProductPoint* point) {
    at(*light, CLobe(*lobe), parts, frame, wo, point);
}
AcdfDirectionSample acdf_product_lobe_sample(const AcdfLocal* light, const AcdfLobe* lobe,
                                             const AcdfProductPoint* point, double u0, double u1) {
    return sample(*light, CLobe(*lobe), point, u0, u1);
}
float acdf_product_lobe_pdf(const AcdfLocal* light, const AcdfLobe* lobe, const AcdfProductPoint* point,
                            const float direction[3]) {
    return pdf(*light, CLobe(*lobe), point, direction);
}
