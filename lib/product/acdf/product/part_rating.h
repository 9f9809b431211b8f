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

/// Numbers are added up by as many others, which do not wait for each other: four vectors.
template <class Real>
constexpr std::size_t side_by_side = 64 / sizeof(Real);
/// As many as there is to be room for.
template <class Real>
constexpr std::size_t room_for(std::size_t count) noexcept {
    return (count + side_by_side<Real> - 1) / side_by_side<Real> * side_by_side<Real>;
}

/// A sum of numbers; those behind them, where there is room, become 0.
template <class Real>
ACDF_METHOD Real padded_sum(Real* x, int count) noexcept {
    constexpr std::size_t side = side_by_side<Real>, half = side / 2;
    const std::size_t numbers = static_cast<std::size_t>(count), all = room_for<Real>(numbers);
    Real sum[side] = {};
    for (std::size_t i = numbers; i < all; ++i) x[i] = 0;
    for (std::size_t i = 0; i < all; i += side)
        for (std::size_t k = 0; k < side; ++k) sum[k] += x[i + k];
    for (std::size_t k = 0; k < half; ++k) sum[k] += sum[k + half];
    for (std::size_t k = 4; k < half; ++k) sum[k - 4] += sum[k];
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// Gives all parts their probabilities, into `left`. Returns the share of samples that is left to the lobe's own
/// sampler: the more the lobe changes within parts, and the less the light within the lobe. 1, and nothing is
/// given, where parts have no light or reflect none. `Most`: of parts, for which `left` has room; `least_share`:
/// what that sampler gets at least; `parts` give the light in one, and its rating.
template <std::size_t Most, class Real, class Parts>
ACDF_METHOD double weigh_parts(int count, const LobeGuides& guides, double least_share, const Parts& parts,
                               Real* left) noexcept {
    // What the value may be elsewhere in a part, beside what was seen: a little of what is around it and of the
    // mean.
    constexpr Real around = Real(0.1), anywhere = Real(0.02);
    constexpr double most_share = 0.8;
    // How much of what the lobe's own sampler gives is left out of the parts, and what they keep at least.
    constexpr double left_out = 0.8, kept = 0.1;
    constexpr std::size_t room = room_for<Real>(Most);
    Real wanted[room], lobe[room], above[room];
    for (int i = 0; i < count; ++i) {
        wanted[i] = parts.light(i);
        lobe[i] = wanted[i] * Real(parts.mean(i));
        above[i] = lobe[i] * Real(parts.spread(i));
    }
    const Real light = padded_sum(wanted, count), reflected = padded_sum(lobe, count);
    if (!(light > 0 && reflected > 0)) return 1.0;
    const double mean = double{reflected} / double{light}, spread = double{padded_sum(above, count)};
    const double share = acdf_clamp(4.0 * (spread / double{reflected}) / (1.0 + 2.0 * guides.variance(mean)),
                                    least_share, most_share);
    const Real least = anywhere * Real(mean), given = Real(left_out * share),
               kept_share = Real(kept * (1.0 - share));
    const Real rest = Real(1.0 - share);
    for (int i = 0; i < count; ++i) {
        wanted[i] = parts.light(i) * (Real(parts.mean(i)) + around * Real(parts.around(i)) + least);
        lobe[i] = given * Real(parts.mass(i));
    }
    const Real whole = padded_sum(wanted, count);
    for (int i = 0; i < count; ++i) wanted[i] /= whole;
    // Raised until what is left of them after the lobe's share adds up to the rest.
    Real scale = 1;
    for (int pass = 0;; ++pass) {
        for (int i = 0; i < count; ++i) {
            const Real p = scale * wanted[i], over = p - lobe[i], floor = kept_share * p;
            left[i] = over > floor ? over : floor;
            above[i] = over > floor ? wanted[i] : Real(0);
        }
        if (pass == 3) break;
        scale += (rest - padded_sum(left, count)) / (Real(0.05) + padded_sum(above, count));
        if (!(scale > Real(0.5))) scale = Real(0.5);
    }
    return share;
}

/// The parts of a cut, to be weighted.
struct CutParts {
    const AcdfCut& cut;
    const PartRating* ratings;

    ACDF_METHOD double light(int i) const noexcept { return cut.part[i].sum; }
    ACDF_METHOD float mean(int i) const noexcept { return ratings[i].mean; }
    ACDF_METHOD float mass(int i) const noexcept { return ratings[i].mass; }
    ACDF_METHOD float around(int i) const noexcept { return ratings[i].around; }
    ACDF_METHOD float spread(int i) const noexcept { return ratings[i].spread; }
};

/// Gives all parts of a cut their probabilities, and returns the share of the lobe's own sampler, as weigh_parts.
ACDF_METHOD inline double weigh_cut(AcdfCut& cut, const LobeGuides& guides, const PartRating* ratings) noexcept {
    double left[room_for<double>(ACDF_CUT_MAX_PARTS)];
    const double share =
        weigh_parts<std::size_t{ACDF_CUT_MAX_PARTS}>(cut.count, guides, 0.03, CutParts{cut, ratings}, left);
    for (int i = 0; share < 1.0 && i < cut.count; ++i) cut.part[i].probability = left[i];
    return share;
}

} // namespace acdf
