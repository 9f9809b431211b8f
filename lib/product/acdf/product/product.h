// Sampling directions of light from the product of light, cosine and BRDF at a shading point, with their exact
// pdf. C++17, header only, freestanding over acdf/product/cut_sample.h and acdf/brdf.h: no allocation, no
// exceptions, no errors. For kernels define ACDF_METHOD, for example as __host__ __device__.
//
//   // of a VisibleLocalView or LocalEnvironmentView, and a BrdfView
//   acdf::ProductSampler sampler(light.data(), acdf::BrdfLobe(brdf.data()));
//   auto point = sampler.at(acdf::surface_frame(normal), wo); // once a shading point
//   acdf::ProductSample s = sampler.sample(point, u0, u1);    // s.direction, s.pdf in sr^-1
//   float p = sampler.pdf(point, direction);                  // of any direction
//
// The tiles of the local file are a hierarchy whose nodes store the light times cosine in them (Lawrence et al.
// 2005, §7.1). `at` divides those nodes in which light times BRDF is large until a number of sub-regions is
// reached. It evaluates the BRDF once a division, where the new sub-region is lit most, and at a few samples of the
// BRDF's own sampler. Within a sub-region directions follow light and cosine.
//
// The BRDF's own sampler covers lobes that are narrower than a sub-region. It gets a share of the samples, which
// grows with the differences between neighbouring sub-regions and falls with those of the light within the lobe.
// The sub-regions get what it does not give already. The pdf is that of the mixture.
#pragma once

#include <acdf/product/product_cut.h>

namespace acdf {

/// How much work `at` does.
struct ProductOptions {
    /// Into how many parts the sphere is divided, 1 to ACDF_CUT_MAX_PARTS: the BRDF is evaluated about once a part.
    /// More pay where more samples are taken. 1: light times cosine and the BRDF half and half.
    int parts = 64;
};

/// A shading point, ready to be sampled from. Plain data of bounded size.
template <class LobePoint>
struct ProductPoint {
    SurfaceFrame frame;
    AcdfVisiblePoint light; ///< what serves the normal
    AcdfCut cut;            ///< empty where the light's own pdf is used as it is, or not at all
    LobePoint lobe;
    double share; ///< of the samples that the BRDF's own sampler samples; below 0: nothing is sampled
};

/// Made of the light, of a local environment file or of an environment file, and a lobe. Samples at
/// points that rows of codes serve follow the product; all others mix those of the light's own pdf and of the
/// BRDF's half and half. Holds views: valid while their files live. All functions are const, thread-safe, allocate
/// and throw nothing.
template <class AnyLobe>
class ProductSampler {
public:
    using Point = ProductPoint<typename AnyLobe::Point>;

    /// Of a VisibleLocalView: with the visibility cells of the file.
    ACDF_METHOD ProductSampler(const AcdfVisibleLocal& light, const AnyLobe& lobe,
                               const ProductOptions& options = {}) noexcept
        : light_(light), local_(true), lobe_(lobe), parts_(options.parts) {}
    /// Of a LocalEnvironmentView: without them.
    ACDF_METHOD ProductSampler(const AcdfLocal& light, const AnyLobe& lobe,
                               const ProductOptions& options = {}) noexcept
        : light_(acdf_visible_everywhere(&light)), local_(true), lobe_(lobe), parts_(options.parts) {}
    ACDF_METHOD ProductSampler(const AcdfEnvironment& light, const AnyLobe& lobe,
                               const ProductOptions& options = {}) noexcept
        : light_(), local_(false), lobe_(lobe), parts_(options.parts) {
        light_.local.environment = light;
    }

    /// Prepares a shading point, for any number of samples. `wo`: towards the viewer, a unit vector in the frame of
    /// directions.
    ACDF_METHOD Point at(const SurfaceFrame& frame, const float wo[3]) const noexcept {
        return at(nullptr, frame, wo);
    }
    /// The same where the light has visibility cells: at a `position` of its scene; null: anywhere.
    ACDF_METHOD Point at(const float position[3], const SurfaceFrame& frame, const float wo[3]) const noexcept;
    /// The same with a frame of its own around the unit `normal`: for BRDFs that are the same all around it.
    ACDF_METHOD Point at(const float normal[3], const float wo[3]) const noexcept {
        return at(surface_frame(normal), wo);
    }

    /// Samples a direction; u0 and u1 in [0, 1]. pdf in sr^-1; 0 where nothing is sampled: it counts as 0, as do
    /// directions below the surface.
    ACDF_METHOD ProductSample sample(const Point& point, double u0, double u1) const noexcept;
    /// The pdf in sr^-1 of a unit direction; exactly that of `sample` for what it returned. Positive wherever that
    /// of the lobe's own sampler is.
    ACDF_METHOD float pdf(const Point& point, const float direction[3]) const noexcept;

private:
    ACDF_METHOD float light_pdf(const Point& point, const float direction[3]) const noexcept;
    ACDF_METHOD float lobe_pdf(const Point& point, const float direction[3]) const noexcept {
        float wi[3];
        point.frame.to_local(direction, wi);
        return lobe_.pdf(point.lobe, wi);
    }
    ACDF_METHOD static float mixed(const Point& point, float light, float lobe) noexcept;
    AcdfVisibleLocal light_;
    bool local_; ///< or an environment alone
    AnyLobe lobe_;
    int parts_;
};

template <class AnyLobe>
ACDF_METHOD auto ProductSampler<AnyLobe>::at(const float position[3], const SurfaceFrame& frame,
                                             const float wo[3]) const noexcept -> Point {
    Point point;
    float local_wo[3];
    point.frame = frame;
    point.cut.count = 0;
    point.share = -1.0;
    frame.to_local(wo, local_wo);
    point.light.local.what = ACDF_LOCAL_NOTHING;
    if (!lobe_.at(local_wo, point.lobe)) return point;
    if (local_) acdf_visible_at_cells(&light_, position, frame.normal, &point.light);
    else {
        point.light.local.what = ACDF_LOCAL_TREE;
        point.light.local.by.root = light_.local.environment.root;
        point.light.in_cell = point.light.portals = 0;
    }
    point.share = point.light.local.what == ACDF_LOCAL_NOTHING ? 1.0 : 0.5;
    const PointOfLobe<AnyLobe> of_lobe = {light_, point.light, point.frame, lobe_, point.lobe, parts_};
    if (point.light.local.what == ACDF_LOCAL_ROWS) point.share = CutRating<AnyLobe>(of_lobe, point.cut).make();
    return point;
}

template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::light_pdf(const Point& point, const float direction[3]) const noexcept {
    if (!(point.share >= 0.0 && point.share < 1.0)) return 0.0f;
    if (point.light.local.what == ACDF_LOCAL_ROWS)
        return acdf_cut_pdf(&light_, &point.light, &point.cut, direction);
    return acdf_local_pdf_at(&light_.local, &point.light.local, direction);
}

/// Of the mixture, by those of its parts.
template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::mixed(const Point& point, float light, float lobe) noexcept {
    return acdf_float_pdf((1.0 - point.share) * double{light} + point.share * double{lobe});
}

template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::pdf(const Point& point, const float direction[3]) const noexcept {
    if (!(point.share >= 0.0)) return 0.0f;
    const float lobe = lobe_pdf(point, direction); // first: it waits while the light's branches are guessed
    return mixed(point, light_pdf(point, direction), lobe);
}

template <class AnyLobe>
ACDF_METHOD ProductSample ProductSampler<AnyLobe>::sample(const Point& point, double u0, double u1) const noexcept {
    ProductSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    if (!(point.share >= 0.0)) return out;
    const double u = acdf_unit_interval(u0);
    if (u < point.share || !(point.share < 1.0)) {
        const ProductSample s = lobe_.sample(point.lobe, u / point.share, u1);
        if (!(s.pdf > 0.0f)) return out;
        point.frame.to_world(s.direction, out.direction);
        out.pdf = pdf(point, out.direction); // of the direction as it was rounded
        return out;
    }
    const double rest = (u - point.share) / (1.0 - point.share);
    if (point.light.local.what == ACDF_LOCAL_ROWS) {
        out = acdf_cut_sample(&light_, &point.light, &point.cut, rest, u1);
    } else {
        out = acdf_local_sample_at(&light_.local, &point.light.local, rest, u1);
        if (out.pdf > 0.0f) out.pdf = light_pdf(point, out.direction);
    }
    if (out.pdf > 0.0f) out.pdf = mixed(point, out.pdf, lobe_pdf(point, out.direction));
    return out;
}

} // namespace acdf
