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
// parts and falls with those of the light within the lobe, and the parts get what it does not give already. The
// density is that of the mixture.
#pragma once

#include <acdf/cut_sample.h>
#include <acdf/lobe.h>
#include <acdf/part_queue.h>

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
    ACDF_METHOD Point at(const SurfaceFrame& frame, const float wo[3]) const noexcept {
        return at(nullptr, frame, wo);
    }
    /// The same where the light's file tells places apart: at a `position` of its scene; null: anywhere.
    ACDF_METHOD Point at(const float position[3], const SurfaceFrame& frame, const float wo[3]) const noexcept;
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
        std::uint32_t tile;   ///< of the part's heart
        std::uint32_t guides; ///< which of them lie in the part, a bit each
        float value, pdf;     ///< of the lobe at the heart
        float solid_angle;
        float mean;   ///< of the lobe's value over the part
        float mass;   ///< of the lobe's own sampler in it
        float around; ///< of what value it may be, as its parents and siblings tell
        float spread; ///< relative square of how much the value changes across it
    };
    /// A sample of the lobe's own sampler, where the light's positions are counted.
    struct Guide {
        std::uint32_t square[2];
        float value, pdf;
    };
    struct Guides {
        Guide guide[8];
        int drawn, count; ///< how many were asked for, and are above the horizon
        float brightest;
        double weights, squares; ///< sums of the weights that they have as samples of light times BRDF, and squared
    };
    /// Beyond this the lobe's value and density are not told apart: no sum of products overflows.
    static constexpr float most_value = 1e18f;

    ACDF_METHOD static float bounded(float x) noexcept;
    ACDF_METHOD Guides guides(const Point& point) const noexcept;
    ACDF_METHOD void look(const Point& point, int part, Rating& rating) const noexcept;
    ACDF_METHOD static void rate(const Guides& guides, Rating& rating) noexcept;
    ACDF_METHOD void share_guides(const AcdfCutSplit& split, const Guides& guides, Rating* half[2]) const noexcept;
    ACDF_METHOD void share_angle(const AcdfCutPart& lower, const AcdfCutSplit& split, const AcdfCutPart& upper,
                                 Rating* half[2]) const noexcept;
    ACDF_METHOD void divide(Point& point, const Guides& guides, Rating* ratings) const noexcept;
    ACDF_METHOD static double lobe_variance(const Guides& guides, double expected) noexcept;
    ACDF_METHOD static double weigh(AcdfCut& cut, const Guides& guides, const Rating* ratings) noexcept;
    ACDF_METHOD float light_pdf(const Point& point, const float direction[3]) const noexcept;
    ACDF_METHOD float density(const Point& point, const float direction[3], float light) const noexcept;

    AcdfLocal light_;
    bool local_; ///< or an environment alone
    AnyLobe lobe_;
    int parts_;
};

template <class AnyLobe>
ACDF_METHOD float ProductSampler<AnyLobe>::bounded(float x) noexcept {
    return x < most_value ? x > 0.0f ? x : 0.0f : most_value;
}

template <class AnyLobe>
ACDF_METHOD auto ProductSampler<AnyLobe>::guides(const Point& point) const noexcept -> Guides {
    const AcdfGrid grid = acdf_environment_grid(&light_.environment);
    Guides out;
    out.drawn = parts_ < 32 ? 4 : 8;
    out.count = 0;
    out.brightest = 0.0f;
    out.weights = out.squares = 0.0;
    for (int i = 0; i < out.drawn; ++i) {
        const int reversed = (i & 1) << 2 | (i & 2) | i >> 2; // the points of Hammersley, moved off the borders
        const ProductSample s = lobe_.sample(point.lobe, (i + 0.5) / out.drawn, (reversed + 0.5) / 8.0);
        if (!(s.pdf > 0.0f && s.direction[2] > 0.0f)) continue;
        float world[3];
        Guide& guide = out.guide[out.count];
        point.frame.to_world(s.direction, world);
        if (!acdf_local_square(&grid, world, guide.square)) continue;
        guide.value = bounded(lobe_.value(point.lobe, s.direction, s.pdf));
        guide.pdf = bounded(s.pdf);
        if (!(guide.value > 0.0f && guide.pdf > 0.0f)) continue;
        const double light = double{acdf_local_light_pdf(&light_, &point.light, world)};
        const double weight = light * double{guide.value} / double{guide.pdf};
        out.weights += weight;
        out.squares += weight * weight;
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
    rating.value = rating.pdf = 0.0f;
    if (!(wi[2] > 0.0f)) return;
    const float pdf = lobe_.pdf(point.lobe, wi);
    rating.value = bounded(lobe_.value(point.lobe, wi, pdf));
    rating.pdf = bounded(pdf);
}

/// Mean and mass, from the heart, which stands for the whole part, and the guides in it: weighed as two samplers'
/// samples are by the balance heuristic.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::rate(const Guides& guides, Rating& rating) noexcept {
    const float expected = rating.solid_angle * static_cast<float>(guides.drawn); // over the density: guides in it
    const float own = 1.0f / (1.0f + expected * rating.pdf);
    rating.mean = own * rating.value;
    rating.mass = own * rating.pdf;
    for (std::uint32_t mask = rating.guides; mask; mask &= mask - 1) {
        const Guide& guide = guides.guide[acdf_lowest_bit(mask)];
        const float weight = 1.0f / (1.0f + expected * guide.pdf);
        rating.mean += weight * guide.value;
        rating.mass += weight * guide.pdf;
    }
    rating.mass *= rating.solid_angle;
}

template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::share_guides(const AcdfCutSplit& split, const Guides& guides,
                                                       Rating* half[2]) const noexcept {
    const std::uint32_t axis = split.place & 7u, position = split.place >> 3, all = half[0]->guides;
    std::uint32_t upper = 0;
    for (std::uint32_t mask = all; mask; mask &= mask - 1) {
        const std::uint32_t k = acdf_lowest_bit(mask);
        upper |= static_cast<std::uint32_t>(guides.guide[k].square[axis] >= position) << k;
    }
    half[0]->guides = all ^ upper;
    half[1]->guides = upper;
}

/// Solid angles of the halves of a part, of which half[0] has the whole.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::share_angle(const AcdfCutPart& lower, const AcdfCutSplit& split,
                                                      const AcdfCutPart& upper, Rating* half[2]) const noexcept {
    const std::uint32_t axis = split.place & 7u;
    const float whole = half[0]->solid_angle;
    float part;
    if (axis == 0 || light_.environment.parameterization == ACDF_PARAM_OCTAHEDRAL)
        part = whole * static_cast<float>(lower.high[axis] - lower.low[axis]) /
               static_cast<float>(upper.high[axis] - lower.low[axis]);
    else part = static_cast<float>(acdf_cut_solid_angle(&light_, &lower));
    half[0]->solid_angle = part;
    half[1]->solid_angle = part < whole ? whole - part : 0.0f;
}

/// Divides where light times BRDF is large, and the part is.
template <class AnyLobe>
ACDF_METHOD void ProductSampler<AnyLobe>::divide(Point& point, const Guides& guides,
                                                 Rating* ratings) const noexcept {
    AcdfCut& cut = point.cut;
    look(point, 0, ratings[0]);
    ratings[0].guides = (1u << guides.count) - 1u;
    ratings[0].solid_angle = static_cast<float>(4.0 * ACDF_PI);
    rate(guides, ratings[0]);
    ratings[0].around = ratings[0].mean;
    ratings[0].spread = 1.0f;
    const double most_light =
        cut.part[0].sum * double{guides.brightest > 0.0f ? guides.brightest : ratings[0].value};
    PartQueue queue(most_light * most_light * (4.0 * ACDF_PI));
    const int most = parts_ < ACDF_CUT_MAX_PARTS ? parts_ : ACDF_CUT_MAX_PARTS;
    for (int part = acdf_cut_divisible(&cut, 0) ? 0 : -1; part >= 0 && cut.count < most; part = queue.pop()) {
        acdf_cut_divide(&light_, &point.light, &cut, part);
        const int last = cut.count - 1, number[2] = {part, last};
        Rating* half[2] = {&ratings[part], &ratings[last]};
        const float mean = half[0]->mean, around = half[0]->around;
        const int known = half[0]->tile >= cut.part[last].tile ? 1 : 0; // which of them has the heart
        *half[1] = *half[0];
        look(point, number[1 - known], *half[1 - known]);
        share_guides(cut.split[last - 1], guides, half);
        share_angle(cut.part[part], cut.split[last - 1], cut.part[last], half);
        for (Rating* rating : half) rate(guides, *rating);
        const float larger = half[0]->mean > half[1]->mean ? half[0]->mean : half[1]->mean;
        const float smaller = half[0]->mean > half[1]->mean ? half[1]->mean : half[0]->mean;
        const float most_seen = larger > mean ? larger : mean, least_seen = smaller < mean ? smaller : mean;
        const float change = most_seen > 0.0f ? 1.0f - least_seen / most_seen : 0.0f;
        const float hoped = 0.5f * most_seen + 0.25f * around;
        for (int k = 0; k < 2; ++k) {
            Rating& rating = *half[k];
            rating.spread = change * change;
            rating.around = hoped;
            if (cut.part[number[k]].node & ACDF_TILE_FLAG) continue;
            const double light = cut.part[number[k]].sum * double{rating.mean + 0.3f * hoped};
            const double square = light * light * double{rating.solid_angle};
            if (square > 0.0) queue.push(number[k], square);
        }
    }
}

/// Relative variance of one sample of the lobe's own sampler, as the guides tell, and what they have missed where
/// the parts expect a larger mean: small lights in a lobe make it large.
template <class AnyLobe>
ACDF_METHOD double ProductSampler<AnyLobe>::lobe_variance(const Guides& guides, double expected) noexcept {
    constexpr double of_missed = 2.0, unknown = 100.0;
    if (!(guides.weights > 0.0)) return unknown;
    const double mean = guides.weights / guides.drawn, missed = expected / mean - 1.0;
    const double seen = guides.squares / (guides.drawn * mean * mean) - 1.0;
    return seen + (missed > 0.0 ? of_missed * missed : 0.0);
}

/// Gives all parts their probabilities. Returns the share of samples that is left to the lobe's own sampler: the
/// more the lobe changes within parts, and the less the light within the lobe.
template <class AnyLobe>
ACDF_METHOD double ProductSampler<AnyLobe>::weigh(AcdfCut& cut, const Guides& guides,
                                                  const Rating* ratings) noexcept {
    // What the value may be elsewhere in a part, beside what was seen: a little of what is around it and of the
    // mean.
    constexpr double around = 0.1, anywhere = 0.02;
    constexpr double least_share = 0.03, most_share = 0.8;
    // How much of what the lobe's own sampler gives is left out of the parts, and what they keep at least.
    constexpr double left_out = 0.8, kept = 0.1;
    double light = 0.0, reflected = 0.0, spread = 0.0, whole = 0.0;
    for (int i = 0; i < cut.count; ++i) {
        const double both = cut.part[i].sum * double{ratings[i].mean};
        light += cut.part[i].sum;
        reflected += both;
        spread += both * double{ratings[i].spread};
    }
    if (!(light > 0.0 && reflected > 0.0)) return 1.0;
    const double variance = lobe_variance(guides, reflected / light);
    const double share = acdf_clamp(4.0 * (spread / reflected) / (1.0 + 2.0 * variance), least_share, most_share);
    const double least = anywhere * (reflected / light);
    for (int i = 0; i < cut.count; ++i) {
        AcdfCutPart& part = cut.part[i];
        part.probability = part.sum * (double{ratings[i].mean} + around * double{ratings[i].around} + least);
        whole += part.probability;
    }
    for (int i = 0; i < cut.count; ++i) cut.part[i].probability /= whole;
    // Raised until what is left of them after the lobe's share adds up to the rest.
    double scale = 1.0;
    for (int pass = 0; pass < 3; ++pass) {
        double sum = 0.0, free = 0.05;
        for (int i = 0; i < cut.count; ++i) {
            const double p = scale * cut.part[i].probability, rest = p - left_out * share * double{ratings[i].mass};
            const double least = kept * (1.0 - share) * p;
            sum += rest > least ? rest : least;
            if (rest > least) free += cut.part[i].probability;
        }
        scale += (1.0 - share - sum) / free;
        if (!(scale > 0.5)) scale = 0.5;
    }
    for (int i = 0; i < cut.count; ++i) {
        double& probability = cut.part[i].probability;
        const double p = scale * probability, rest = p - left_out * share * double{ratings[i].mass};
        const double least = kept * (1.0 - share) * p;
        probability = rest > least ? rest : least;
    }
    return share;
}

template <class AnyLobe>
ACDF_METHOD auto ProductSampler<AnyLobe>::at(const float position[3], const SurfaceFrame& frame,
                                             const float wo[3]) const noexcept -> Point {
    Point point;
    float local_wo[3];
    point.frame = frame;
    point.cut.count = 0;
    point.share = -1.0;
    frame.to_local(wo, local_wo);
    point.light.what = ACDF_LOCAL_NOTHING;
    if (!lobe_.at(local_wo, point.lobe)) return point;
    if (local_) {
        if (position) acdf_local_at_cells(&light_, position, frame.normal, &point.light);
        else acdf_local_at(&light_, frame.normal, &point.light);
    } else {
        point.light.what = ACDF_LOCAL_TREE;
        point.light.root = light_.environment.root;
    }
    point.share = point.light.what == ACDF_LOCAL_NOTHING ? 1.0 : 0.5;
    if (point.light.what != ACDF_LOCAL_BLEND) return point;
    acdf_cut_begin(&light_, &point.light, &point.cut);
    if (parts_ > 1) {
        Rating ratings[ACDF_CUT_MAX_PARTS];
        const Guides drawn = guides(point);
        divide(point, drawn, ratings);
        point.share = weigh(point.cut, drawn, ratings);
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
