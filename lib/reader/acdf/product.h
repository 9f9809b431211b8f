// Drawing directions of light from the product of light, cosine and BRDF at a shading point, with their exact
// density. C++17, header only, freestanding over acdf/cut_sample.h and acdf/brdf.h: no allocation, no exceptions,
// no errors. For kernels define ACDF_METHOD, for example as __host__ __device__.
//
//   acdf::ProductSampler sampler(local.data(), acdf::BrdfLobe(brdf.data()));   // of a LocalEnvironmentView, a
//   BrdfView auto point = sampler.at(acdf::surface_frame(normal), wo);                  // once a shading point
//   acdf::ProductSample s = sampler.sample(point, u0, u1);                     // s.direction, s.pdf in sr^-1
//   float p = sampler.pdf(point, direction);                                   // of any direction
//
// The tiles of the local file are a hierarchy whose nodes know the light times cosine in them (Lawrence et al.
// 2005, §7.1). `at` divides those nodes in which light times BRDF is large until a number of parts is reached,
// looking at the BRDF once a division, where the new part is lit most, and at a few samples of the BRDF's own
// sampler. Within a part directions follow light and cosine. What is left, lobes that are narrower than a part, is
// for the BRDF's own sampler: it gets a share of the samples, which grows with the differences between neighbouring
// parts, and the parts get what it does not give already. The density is that of the mixture.
#pragma once

#include <acdf/cut_sample.h>
#include <acdf/lobe.h>

namespace acdf {

/// How much work `at` does.
struct ProductOptions {
    /// Into how many parts the sphere is divided, 1 to ACDF_CUT_MAX_PARTS: the BRDF is evaluated about once a part.
    /// More pay where more samples are drawn. 1: light times cosine and the BRDF half and half.
    int parts = 64;
};

/// A shading point, ready to be drawn from. Plain data of bounded size.
template <class LobePoint>
struct ProductPoint {
    SurfaceFrame frame;
    AcdfLocalPoint light; ///< what serves the normal
    AcdfCut cut;          ///< empty where the light's own density is used as it is, or not at all
    LobePoint lobe;
    double share; ///< of the samples that the BRDF's own sampler draws; below 0: nothing is drawn
};

/// Parts in order of what is to be gained by dividing them, to half an octave.
class PartQueue {
public:
    /// Priorities are told apart from 2^-29 `scale` to 8 `scale`.
    ACDF_METHOD explicit PartQueue(double scale) noexcept : top_(key(8.0 * scale)), filled_(0) {}

    ACDF_METHOD void push(int part, double priority) noexcept {
        const int below = top_ - key(priority), bucket = below < 0 ? 0 : below > 63 ? 63 : below;
        next_[part] = filled_ >> bucket & 1u ? head_[bucket] : -1;
        head_[bucket] = static_cast<std::int8_t>(part);
        filled_ |= std::uint64_t{1} << bucket;
    }
    /// -1 where there is none.
    ACDF_METHOD int pop() noexcept {
        if (filled_ == 0) return -1;
        const auto low = static_cast<std::uint32_t>(filled_);
        const std::uint32_t bucket =
            low ? acdf_lowest_bit(low) : 32 + acdf_lowest_bit(static_cast<std::uint32_t>(filled_ >> 32));
        const int part = head_[bucket];
        head_[bucket] = next_[part];
        if (head_[bucket] < 0) filled_ &= ~(std::uint64_t{1} << bucket);
        return part;
    }

private:
    ACDF_METHOD static int key(double x) noexcept { // twice the binary logarithm, rounded down
        std::uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        return static_cast<int>(bits >> 51);
    }

    int top_;
    std::uint64_t filled_;
    std::int8_t head_[64], next_[ACDF_CUT_MAX_PARTS];
};

/// Made of the light, of a local environment file or of an environment file, and a lobe. Draws from lights that
/// shared tiles describe follow the product; all others mix those of the light's own density and of the BRDF's half
/// and half. Holds views: valid while their files live. All functions are const, thread-safe, allocate and throw
/// nothing.
template <class AnyLobe>
class ProductSampler {
public:
    using Point = ProductPoint<typename AnyLobe::Point>;

    ACDF_METHOD ProductSampler(const AcdfLocal& light, const AnyLobe& lobe,
                               const ProductOptions& options = {}) noexcept
        : light_(light), local_(true), lobe_(lobe), parts_(options.parts) {}
    ACDF_METHOD ProductSampler(const AcdfEnvironment& light, const AnyLobe& lobe,
                               const ProductOptions& options = {}) noexcept
        : light_(), local_(false), lobe_(lobe), parts_(options.parts) {
        light_.environment = light;
    }

    /// Prepares a shading point, for any number of samples. `wo`: towards the viewer, a unit vector in the frame of
    /// directions.
    ACDF_METHOD Point at(const SurfaceFrame& frame, const float wo[3]) const noexcept;
    /// The same with a frame of its own around the unit `normal`: for BRDFs that are the same all around it.
    ACDF_METHOD Point at(const float normal[3], const float wo[3]) const noexcept {
        return at(surface_frame(normal), wo);
    }

    /// Draws a direction; u0 and u1 in [0, 1]. pdf in sr^-1; 0 where nothing is drawn: it counts as 0, as do
    /// directions below the surface.
    ACDF_METHOD ProductSample sample(const Point& point, double u0, double u1) const noexcept;
    /// Density in sr^-1 of a unit direction; exactly that of `sample` for what it returned. Positive wherever that
    /// of the lobe's own sampler is.
    ACDF_METHOD float pdf(const Point& point, const float direction[3]) const noexcept {
        return density(point, direction, light_pdf(point, direction));
    }

private:
    /// What is known of a part while the cut is made.
    struct Rating {
        std::uint32_t tile; ///< of the part's heart
        double value, pdf;  ///< of the lobe there
        double solid_angle;
        double mean;   ///< of the lobe's value over the part
        double mass;   ///< of the lobe's own sampler in it
        double around; ///< of what value it may be, as its parents and siblings tell
        double spread; ///< relative square of how much the value changes across it
    };
    /// A sample of the lobe's own sampler, where the light's positions are counted.
    struct Guide {
        std::uint32_t square[2];
        double value, pdf;
    };
    struct Guides {
        Guide guide[8];
        int drawn, count; ///< how many were asked for, and are above the horizon
        double brightest;
    };

    ACDF_METHOD Guides guides(const Point& point) const noexcept;
    ACDF_METHOD void look(const Point& point, int part, Rating& rating) const noexcept;
    ACDF_METHOD void rate(const Point& point, const Guides& guides, int part, Rating& rating) const noexcept;
    ACDF_METHOD void divide(Point& point, const Guides& guides, Rating* ratings) const noexcept;
    ACDF_METHOD static double weigh(AcdfCut& cut, const Rating* ratings) noexcept;
    ACDF_METHOD float light_pdf(const Point& point, const float direction[3]) const noexcept;
    ACDF_METHOD float density(const Point& point, const float direction[3], float light) const noexcept;

    AcdfLocal light_;
    bool local_; ///< or an environment alone
    AnyLobe lobe_;
    int parts_;
};

template <class AnyLobe>
ACDF_METHOD auto ProductSampler<AnyLobe>::guides(const Point& point) const noexcept -> Guides {
    const AcdfGrid grid = acdf_environment_grid(&light_.environment);
    Guides out;
    out.drawn = parts_ < 32 ? 4 : 8;
    out.count = 0;
    out.brightest = 0.0;
    for (int i = 0; i < out.drawn; ++i) {
        const int reversed = (i & 1) << 2 | (i & 2) | i >> 2; // the points of Hammersley, moved off the borders
        const ProductSample s = lobe_.sample(point.lobe, (i + 0.5) / out.drawn, (reversed + 0.5) / 8.0);
        if (!(s.pdf > 0.0f && s.direction[2] > 0.0f)) continue;
        float world[3];
        double position[2];
        Guide& guide = out.guide[out.count];
        point.frame.to_world(s.direction, world);
        if (!acdf_grid_square(&grid, world, guide.square, position)) continue;
        guide.value = double{lobe_.value(point.lobe, s.direction, s.pdf)};
        guide.pdf = double{s.pdf};
        if (!(guide.value > 0.0 && guide.pdf > 0.0)) continue;
        if (guide.value > out.brightest) out.brightest = guide.value;
        ++out.count;
    }
    return out;
}

/// The lobe at the heart of a part.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::look(const Point& point, int part, Rating& rating) const noexcept {
    float world[3], wi[3];
    rating.tile = acdf_cut_heart(&light_, &point.light, &point.cut, part, world);
    point.frame.to_local(world, wi);
    rating.value = rating.pdf = 0.0;
    if (!(wi[2] > 0.0f)) return;
    const float pdf = lobe_.pdf(point.lobe, wi), value = lobe_.value(point.lobe, wi, pdf);
    rating.value = value > 0.0f ? double{value} : 0.0;
    rating.pdf = pdf > 0.0f ? double{pdf} : 0.0;
}

/// Mean and mass, from the heart, which stands for the whole part, and the guides in it: weighed as two samplers'
/// samples are by the balance heuristic.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::rate(const Point& point, const Guides& guides, int part,
                                               Rating& rating) const noexcept {
    const AcdfCutPart& box = point.cut.part[part];
    const double solid_angle = rating.solid_angle > 1e-15 ? rating.solid_angle : 1e-15;
    const double even = 1.0 / solid_angle, own = 1.0 / (even + guides.drawn * rating.pdf);
    double value = own * rating.value, mass = own * rating.pdf;
    for (int i = 0; i < guides.count; ++i) {
        const Guide& guide = guides.guide[i];
        if (guide.square[0] - box.low[0] >= box.high[0] - box.low[0] ||
            guide.square[1] - box.low[1] >= box.high[1] - box.low[1])
            continue;
        const double weight = 1.0 / (even + guides.drawn * guide.pdf);
        value += weight * guide.value;
        mass += weight * guide.pdf;
    }
    rating.mean = value * even;
    rating.mass = mass;
}

ACDF_METHOD inline double relative_difference(double a, double b) noexcept {
    const double larger = a > b ? a : b;
    return larger > 0.0 ? fabs(a - b) / larger : 0.0;
}

/// Divides where light times BRDF is large, and the part is.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::divide(Point& point, const Guides& guides,
                                                 Rating* ratings) const noexcept {
    AcdfCut& cut = point.cut;
    look(point, 0, ratings[0]);
    ratings[0].solid_angle = 4.0 * ACDF_PI;
    rate(point, guides, 0, ratings[0]);
    ratings[0].around = ratings[0].mean;
    ratings[0].spread = 1.0;
    const double brightest = guides.brightest > 0.0 ? guides.brightest : ratings[0].value;
    PartQueue queue(cut.part[0].sum * brightest * sqrt(4.0 * ACDF_PI));
    const int most = parts_ < ACDF_CUT_MAX_PARTS ? parts_ : ACDF_CUT_MAX_PARTS;
    for (int part = 0; part >= 0 && cut.count < most; part = queue.pop()) {
        if (!acdf_cut_divisible(&cut, part)) continue;
        const Rating parent = ratings[part];
        acdf_cut_divide(&light_, &point.light, &cut, part);
        const int half[2] = {part, cut.count - 1}, known = parent.tile >= cut.part[cut.count - 1].tile ? 1 : 0;
        ratings[half[known]] = parent;
        look(point, half[1 - known], ratings[half[1 - known]]);
        ratings[part].solid_angle = acdf_cut_solid_angle(&light_, &cut.part[part]);
        ratings[half[1]].solid_angle = parent.solid_angle - ratings[part].solid_angle;
        for (int k = 0; k < 2; ++k) rate(point, guides, half[k], ratings[half[k]]);
        const double m[2] = {ratings[half[0]].mean, ratings[half[1]].mean}, larger = m[0] > m[1] ? m[0] : m[1];
        for (int k = 0; k < 2; ++k) {
            Rating& rating = ratings[half[k]];
            const double across = relative_difference(m[0], m[1]), along = relative_difference(parent.mean, m[k]);
            rating.spread = across > along ? across * across : along * along;
            rating.around = 0.5 * (larger > parent.mean ? larger : parent.mean) + 0.25 * parent.around;
            const double priority = cut.part[half[k]].sum * (m[k] + 0.3 * rating.around) * sqrt(rating.solid_angle);
            if (priority > 0.0 && !(cut.part[half[k]].node & ACDF_TILE_FLAG)) queue.push(half[k], priority);
        }
    }
}

/// Gives all parts their probabilities. Returns the share of samples that is left to the lobe's own sampler.
template <class AnyLobe>
ACDF_METHOD double ProductSampler<AnyLobe>::weigh(AcdfCut& cut, const Rating* ratings) noexcept {
    // What the value may be elsewhere in a part, beside what was seen: a little of what is around it and of the
    // mean.
    constexpr double around = 0.1, anywhere = 0.02;
    constexpr double least_share = 0.03, most_share = 0.6;
    // How much of what the lobe's own sampler gives is left out of the parts, and what they keep at least.
    constexpr double left_out = 0.8, kept = 0.1;
    double light = 0.0, reflected = 0.0, spread = 0.0, whole = 0.0;
    for (int i = 0; i < cut.count; ++i) {
        const double both = cut.part[i].sum * ratings[i].mean;
        light += cut.part[i].sum;
        reflected += both;
        spread += both * ratings[i].spread;
    }
    if (!(light > 0.0 && reflected > 0.0)) return 1.0;
    const double share = acdf_clamp(spread / reflected, least_share, most_share);
    for (int i = 0; i < cut.count; ++i) {
        AcdfCutPart& part = cut.part[i];
        part.probability =
            part.sum * (ratings[i].mean + around * ratings[i].around + anywhere * (reflected / light));
        whole += part.probability;
    }
    for (int i = 0; i < cut.count; ++i) cut.part[i].probability /= whole;
    // Raised until what is left of them after the lobe's share adds up to the rest.
    double scale = 1.0;
    for (int pass = 0; pass < 3; ++pass) {
        double sum = 0.0, free = 0.05;
        for (int i = 0; i < cut.count; ++i) {
            const double p = scale * cut.part[i].probability, rest = p - left_out * share * ratings[i].mass;
            const double least = kept * (1.0 - share) * p;
            sum += rest > least ? rest : least;
            if (rest > least) free += cut.part[i].probability;
        }
        scale += (1.0 - share - sum) / free;
        if (!(scale > 0.5)) scale = 0.5;
    }
    for (int i = 0; i < cut.count; ++i) {
        double& probability = cut.part[i].probability;
        const double p = scale * probability, rest = p - left_out * share * ratings[i].mass;
        const double least = kept * (1.0 - share) * p;
        probability = rest > least ? rest : least;
    }
    return share;
}

template <class AnyLobe>
ACDF_METHOD auto ProductSampler<AnyLobe>::at(const SurfaceFrame& frame, const float wo[3]) const noexcept -> Point {
    Point point;
    float local_wo[3];
    point.frame = frame;
    point.cut.count = 0;
    point.share = -1.0;
    frame.to_local(wo, local_wo);
    point.light.what = ACDF_LOCAL_NOTHING;
    if (!lobe_.at(local_wo, point.lobe)) return point;
    if (local_) {
        acdf_local_at(&light_, frame.normal, &point.light);
    } else {
        point.light.what = ACDF_LOCAL_TREE;
        point.light.root = light_.environment.root;
    }
    point.share = point.light.what == ACDF_LOCAL_NOTHING ? 1.0 : 0.5;
    if (point.light.what != ACDF_LOCAL_BLEND) return point;
    acdf_cut_begin(&light_, &point.light, &point.cut);
    if (parts_ > 1) {
        Rating ratings[ACDF_CUT_MAX_PARTS];
        divide(point, guides(point), ratings);
        point.share = weigh(point.cut, ratings);
    }
    acdf_cut_finish(&point.cut);
    if (point.cut.count == 0) point.share = 1.0;
    return point;
}

template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::light_pdf(const Point& point, const float direction[3]) const noexcept {
    if (!(point.share >= 0.0 && point.share < 1.0)) return 0.0f;
    if (point.light.what == ACDF_LOCAL_BLEND) return acdf_cut_pdf(&light_, &point.light, &point.cut, direction);
    return acdf_local_pdf_at(&light_, &point.light, direction);
}

/// Of the mixture; `light` is that of its first part.
template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::density(const Point& point, const float direction[3],
                                                   float light) const noexcept {
    float wi[3];
    if (!(point.share >= 0.0)) return 0.0f;
    point.frame.to_local(direction, wi);
    const double pdf = (1.0 - point.share) * double{light} + point.share * double{lobe_.pdf(point.lobe, wi)};
    if (!(pdf > 0.0)) return 0.0f;
    return static_cast<float>(acdf_clamp(pdf, 1.17549435e-38, 3.402823466e38));
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
    if (point.light.what == ACDF_LOCAL_BLEND) {
        out = acdf_cut_sample(&light_, &point.light, &point.cut, rest, u1);
    } else {
        out = acdf_local_sample_at(&light_, &point.light, rest, u1);
        if (out.pdf > 0.0f) out.pdf = light_pdf(point, out.direction);
    }
    if (out.pdf > 0.0f) out.pdf = density(point, out.direction, out.pdf);
    return out;
}

} // namespace acdf
