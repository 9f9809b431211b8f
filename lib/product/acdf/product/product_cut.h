// Shading points of product sampling whose light is a local environment file of rows of codes
// (acdf/product/product.h): into which parts its tree is divided, and which share of the samples they get. C++17,
// header only, freestanding.
#pragma once

#include <acdf/product/cut_sample.h>
#include <acdf/product/part_queue.h>
#include <acdf/product/product_point.h>

namespace acdf {

/// A cut while it is made.
template <class AnyLobe>
class CutRating {
public:
    ACDF_METHOD CutRating(const PointOfLobe<AnyLobe>& of, AcdfCut& cut) noexcept : of_(of), cut_(cut) {}

    /// Returns the share of samples that is left to the lobe's own sampler.
    ACDF_METHOD double make() noexcept;

private:
    /// How many parts are divided at once, so that what is looked at in one need not wait for the others.
    static constexpr int at_once = 4;
    /// Two halves of a part, by number, and what was known of the whole.
    struct Division {
        int lower, upper;
        int unknown; ///< which of the two does not have the whole's heart
        float mean, around;
    };

    ACDF_METHOD void sample_guides() noexcept;
    ACDF_METHOD void look(int count, const int* parts) noexcept;
    ACDF_METHOD Division halve(int part) noexcept;
    ACDF_METHOD void divide() noexcept;

    const PointOfLobe<AnyLobe>& of_;
    AcdfCut& cut_;
    LobeGuides guides_;
    PartRating ratings_[ACDF_CUT_MAX_PARTS];
};

template <class AnyLobe>
ACDF_METHOD void CutRating<AnyLobe>::sample_guides() noexcept {
    float world[LobeGuides::most][3], light[LobeGuides::most];
    of_.sample_guides(world, guides_);
    for (int i = 0; i < guides_.count; ++i) light[i] = acdf_cut_pdf(&of_.light, &of_.at, &cut_, world[i]);
    guides_.weigh(light);
}

/// The lobe at the hearts of some parts.
template <class AnyLobe>
ACDF_METHOD void CutRating<AnyLobe>::look(int count, const int* parts) noexcept {
    float wi[at_once][3];
    for (int i = 0; i < count; ++i) {
        float world[3];
        ratings_[parts[i]].tile = acdf_cut_heart(&of_.light, &of_.at, &cut_, parts[i], world);
        of_.above_surface(world, wi[i]);
    }
    of_.look(count, wi, [&](int i, float value, float pdf) {
        ratings_[parts[i]].value = value;
        ratings_[parts[i]].pdf = pdf;
    });
}

/// Divides a part; all is known of its halves then but the lobe at the heart of one of them.
template <class AnyLobe>
ACDF_METHOD auto CutRating<AnyLobe>::halve(int part) noexcept -> Division {
    acdf_cut_divide(&of_.light, &of_.at, &cut_, part);
    const int last = cut_.count - 1;
    const AcdfCutSplit& split = cut_.split[last - 1];
    PartRating &low = ratings_[part], &high = ratings_[last];
    high = low;
    high.guides = guides_.above(split.place & 1u, split.place >> 1, low.guides);
    low.guides ^= high.guides;
    low.solid_angle = static_cast<float>(acdf_cut_solid_angle(&of_.light, &cut_.part[part]));
    const float rest = high.solid_angle - low.solid_angle;
    high.solid_angle = rest > 0.0f ? rest : 0.0f;
    return {part, last, low.tile >= cut_.part[last].first ? 0 : 1, low.mean, low.around};
}

/// Divides where light times BRDF is large, and the part is.
template <class AnyLobe>
ACDF_METHOD void CutRating<AnyLobe>::divide() noexcept {
    int chosen[at_once] = {0}, count = acdf_cut_divisible(&cut_, 0);
    look(1, chosen);
    ratings_[0].guides = (1u << guides_.count) - 1u;
    ratings_[0].solid_angle = static_cast<float>(4.0 * ACDF_PI);
    ratings_[0].rate(guides_);
    ratings_[0].around = ratings_[0].mean;
    ratings_[0].spread = 1.0f;
    const double most_light =
        cut_.part[0].sum * double{guides_.brightest > 0.0f ? guides_.brightest : ratings_[0].value};
    PartQueue queue(most_light * most_light * (4.0 * ACDF_PI));
    const int most = of_.parts < ACDF_CUT_MAX_PARTS ? of_.parts : ACDF_CUT_MAX_PARTS;
    while (count > 0) {
        Division division[at_once];
        for (int i = 0; i < count; ++i) division[i] = halve(chosen[i]);
        for (int i = 0; i < count; ++i) chosen[i] = division[i].unknown ? division[i].upper : division[i].lower;
        look(count, chosen);
        for (int i = 0; i < count; ++i) {
            const int number[2] = {division[i].lower, division[i].upper};
            PartRating &low = ratings_[number[0]], &high = ratings_[number[1]];
            low.rate(guides_);
            high.rate(guides_);
            const float mean = division[i].mean, larger = low.mean > high.mean ? low.mean : high.mean;
            const float smaller = low.mean < high.mean ? low.mean : high.mean;
            const float most_seen = larger > mean ? larger : mean, least_seen = smaller < mean ? smaller : mean;
            const float change = most_seen > 0.0f ? 1.0f - least_seen / most_seen : 0.0f;
            const float hoped = 0.5f * most_seen + 0.25f * division[i].around;
            for (const int part : number) {
                PartRating& rating = ratings_[part];
                rating.spread = change * change;
                rating.around = hoped;
                if (cut_.part[part].node & ACDF_TOP_TILE) continue;
                const double light = cut_.part[part].sum * double{rating.mean + 0.3f * hoped};
                const double square = light * light * double{rating.solid_angle};
                if (square > 0.0) queue.push(part, square);
            }
        }
        // Early on the order matters: the best part is among few.
        const int some = 1 + cut_.count / 8, room = most - cut_.count;
        const int wanted = some < at_once ? some : at_once, next = wanted < room ? wanted : room;
        for (count = 0; count < next; ++count)
            if ((chosen[count] = queue.pop()) < 0) break;
    }
}

template <class AnyLobe>
ACDF_METHOD double CutRating<AnyLobe>::make() noexcept {
    double share = 0.5;
    acdf_cut_begin(&of_.light, &of_.at, &cut_);
    if (of_.parts > 1) {
        sample_guides();
        divide();
        share = weigh_cut(cut_, guides_, ratings_);
    }
    acdf_cut_finish(&cut_);
    return cut_.count == 0 ? 1.0 : share;
}

} // namespace acdf
