// How much light from one direction wants to be sampled beside an MIS partner, where it shines on several normals.
#pragma once

#include "compress/partner.h"

#include <array>
#include <cstddef>

namespace acdf::compress {

/// What light of radiance L from one direction adds to the sum of the noise of all normals, if it is sampled with
/// n_b / n_l times the pdf y: L^2 square(y) + L mean(y). At nodes, with how fast either falls there: y is 0, then
/// from far below the pdf of an MIS partner to where that no longer counts.
struct NoiseCurve {
    static constexpr std::size_t nodes = 24;
    std::array<double, nodes> square{}, mean{}, square_fall{}, mean_fall{};
};

/// For each price of y the least of noise + price y. Only the lower hull of the noise counts: by a heuristic for
/// which a few samples are worse than none, y jumps from 0.
class Demand {
public:
    Demand(const NoiseCurve& curve, double radiance);

    double at(double price) const;
    /// The price from which on anything is sampled; 0: at no price.
    double highest() const { return count_ > 0 ? points_.front().price : 0.0; }
    /// The line light / sqrt(price) - partner that y follows about there, for a price that is positive. Both are 0
    /// where light is not worth any; where its price is too high the line is at most 0.
    struct Line {
        double light = 0.0, partner = 0.0;
    };
    Line line(double price) const;

private:
    struct Point {
        double y, price;
    };
    std::array<Point, NoiseCurve::nodes> points_; ///< by falling price
    std::size_t count_ = 0;
};

/// Makes noise curves from how often, and how much, light shines on normals under each cosine.
class NoiseKernel {
public:
    NoiseKernel(const Lobes& lobes, AcdfHeuristic heuristic);

    static constexpr std::size_t cosines = 64;
    /// Weights by cosine, linear between even steps.
    using Histogram = std::array<double, cosines + 1>;
    static void add(Histogram& histogram, double cosine, double weight) {
        const double place = cosine * double{cosines};
        const auto i = place < double{cosines - 1} ? static_cast<std::size_t>(place) : cosines - 1;
        histogram[i] += weight * (1.0 - (place - double(i)));
        histogram[i + 1] += weight * (place - double(i));
    }

    /// `weights`: how much the noise of normals counts.
    void set_squares(const Histogram& weights, NoiseCurve& curve) const;
    /// `weights`: that times what an estimate gains by its share of weights that goes to the partner.
    void set_means(const Histogram& weights, NoiseCurve& curve) const;

private:
    std::array<Histogram, NoiseCurve::nodes> square_, mean_, square_fall_, mean_fall_;
};

} // namespace acdf::compress
