// What parts of a cut are worth to product sampling (acdf/product/product.h): how much of the light in them a lobe
// reflects, and which share of the samples is better left to the lobe's own sampler. C++17, header only,
// freestanding.
#pragma once

#include <acdf/method.h>
#include <acdf/product/cut.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Samples of a lobe's own sampler that lie above the horizon, where the light's positions are counted.
struct LobeGuides {
    static constexpr int most = 4;
    std::uint32_t square[2][most] = {};
    float value[most], pdf[most];
    int sampled = 0, count = 0; ///< how many were asked for, and are above the horizon
    float brightest = 0.0f;
    double weights = 0.0, squares = 0.0; ///< sums of their weights as samples of light times BRDF, and squared

    /// Which of the guides in `some` (a bit each) lie at or above a position on an axis.
    ACDF_METHOD std::uint32_t above(std::uint32_t axis, std::uint32_t position, std::uint32_t some) const noexcept {
        std::uint32_t upper = 0;
        for (int k = 0; k < most; ++k) // all of them: nobody guesses how many `some` are
            upper |= static_cast<std::uint32_t>(square[axis][k] >= position) << k;
        return upper & some;
    }

    /// Sets what they weigh where the light has such pdfs.
    ACDF_METHOD void weigh(const float* light) noexcept {
        for (int i = 0; i < count; ++i) {
            const double weight = double{light[i]} * double{value[i]} / double{pdf[i]};
            weights += weight;
            squares += weight * weight;
        }
    }

    /// Relative variance of one sample of the lobe's own sampler, as the guides estimate it, and what they have
    /// missed where the parts expect a larger mean: small bright tiles in a lobe make it large.
    ACDF_METHOD double variance(double expected) const noexcept {
        constexpr double of_missed = 2.0, unknown = 100.0;
        if (!(weights > 0.0)) return unknown;
        const double mean = weights / sampled, missed = expected / mean - 1.0;
        const double seen = squares / (sampled * mean * mean) - 1.0;
        return seen + (missed > 0.0 ? of_missed * missed : 0.0);
    }
};

/// Estimates of a part while the cut is made.
struct PartRating {
    std::uint32_t tile;   ///< of the part's heart
    std::uint32_t guides; ///< which of them lie in the part, a bit each
    float value, pdf;     ///< of the lobe at the heart
    float solid_angle;
    float mean;   ///< of the lobe's value over the part
    float mass;   ///< of the lobe's own sampler in it
    float around; ///< of what value it may be, estimated from its parents and siblings
    float spread; ///< relative square of how much the value changes across it

    /// Mean and mass, from the heart, which stands for the whole part, and the guides in it: weighted as two
    /// samplers' samples are by the balance heuristic.
    ACDF_METHOD void rate(const LobeGuides& all) noexcept {
        const float expected = solid_angle * static_cast<float>(all.sampled); // over the pdf: guides in it
        const float own = 1.0f / (1.0f + expected * pdf);
        mean = own * value;
        mass = own * pdf;
        for (std::uint32_t mask = guides; mask; mask &= mask - 1) {
            const std::uint32_t k = acdf_lowest_bit(mask);
            const float weight = 1.0f / (1.0f + expected * all.pdf[k]);
            mean += weight * all.value[k];
            mass += weight * all.pdf[k];
        }
        mass *= solid_angle;
    }
};

/// A sum of numbers, one for each part of a cut; those behind them become 0. They are added up by eight others,
/// which do not wait for each other.
ACDF_METHOD inline double sum_of_parts(double (&x)[ACDF_CUT_MAX_PARTS], int count) noexcept {
    constexpr int side = 8;
    static_assert(ACDF_CUT_MAX_PARTS % side == 0);
    double sum[side] = {};
    for (int i = count; i < ACDF_CUT_MAX_PARTS; ++i) x[i] = 0.0;
    for (int i = 0; i < count; i += side)
        for (int k = 0; k < side; ++k) sum[k] += x[i + k];
    for (int k = 0; k < 4; ++k) sum[k] += sum[k + 4];
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// Gives all parts of a cut their probabilities. Returns the share of samples that is left to the lobe's own
/// sampler: the more the lobe changes within parts, and the less the light within the lobe. 1, and nothing is
/// given, where parts have no light or reflect none.
ACDF_METHOD inline double weigh_cut(AcdfCut& cut, const LobeGuides& guides, const PartRating* ratings) noexcept {
    // What the value may be elsewhere in a part, beside what was seen: a little of what is around it and of the
    // mean.
    constexpr double around = 0.1, anywhere = 0.02;
    constexpr double least_share = 0.03, most_share = 0.8;
    // How much of what the lobe's own sampler gives is left out of the parts, and what they keep at least.
    constexpr double left_out = 0.8, kept = 0.1;
    double wanted[ACDF_CUT_MAX_PARTS], lobe[ACDF_CUT_MAX_PARTS], above[ACDF_CUT_MAX_PARTS],
        left[ACDF_CUT_MAX_PARTS];
    const int count = cut.count;
    for (int i = 0; i < count; ++i) {
        wanted[i] = cut.part[i].sum;
        lobe[i] = wanted[i] * double{ratings[i].mean};
        above[i] = lobe[i] * double{ratings[i].spread};
    }
    const double light = sum_of_parts(wanted, count), reflected = sum_of_parts(lobe, count);
    if (!(light > 0.0 && reflected > 0.0)) return 1.0;
    const double mean = reflected / light, spread = sum_of_parts(above, count);
    const double share =
        acdf_clamp(4.0 * (spread / reflected) / (1.0 + 2.0 * guides.variance(mean)), least_share, most_share);
    const double least = anywhere * mean, given = left_out * share, rest = 1.0 - share, kept_share = kept * rest;
    for (int i = 0; i < count; ++i) {
        wanted[i] = cut.part[i].sum * (double{ratings[i].mean} + around * double{ratings[i].around} + least);
        lobe[i] = given * double{ratings[i].mass};
    }
    const double whole = sum_of_parts(wanted, count);
    for (int i = 0; i < count; ++i) wanted[i] /= whole;
    // Raised until what is left of them after the lobe's share adds up to the rest.
    double scale = 1.0;
    for (int pass = 0;; ++pass) {
        for (int i = 0; i < count; ++i) {
            const double p = scale * wanted[i], over = p - lobe[i], floor = kept_share * p;
            left[i] = over > floor ? over : floor;
            above[i] = over > floor ? wanted[i] : 0.0;
        }
        if (pass == 3) break;
        scale += (rest - sum_of_parts(left, count)) / (0.05 + sum_of_parts(above, count));
        if (!(scale > 0.5)) scale = 0.5;
    }
    for (int i = 0; i < count; ++i) cut.part[i].probability = left[i];
    return share;
}

} // namespace acdf
