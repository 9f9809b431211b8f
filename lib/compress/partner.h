// Fits for an MIS partner: pdfs that are used together with another sampler, by multiple importance sampling.
//
// With n_l samples of the pdf p and n_b of the partner's b, the balance heuristic has the second moment
// sum of f^2 / (n_l p + n_b b): least where n_l p + n_b b = f / nu wherever that is more than the partner gives
// alone, and p = 0 elsewhere (water filling, docs/method.md). For a multiplier nu the cost of a cell of constant p
// does not depend on other cells, so that costs stay additive: with A = sqrt(measure . integral of f^2) and
// D = integral of f^2 / (nu n_b b) a cell costs A - A^2 / 2 D where A < D, and D / 2, left to the partner, where
// not. Both are over 2 nu, so that without an MIS partner A is what it always was.
#pragma once

#include <acdf/layout.h>

#include <vector>

namespace acdf::compress {

/// What a file is made to be combined with.
struct Partner {
    AcdfPartnerKind kind = ACDF_PARTNER_NONE;
    AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE;
    double light = 1.0, other = 1.0; ///< samples of the file and of the partner, in proportion; > 0

    explicit operator bool() const { return kind != ACDF_PARTNER_NONE; }
    double share() const { return light / (light + other); }
};

/// Cost of a cell of A = `alone` and D = `left`; 0: there is no partner.
inline double cell_cost(double alone, double left) {
    if (!(left > 0.0)) return alone;
    return alone < left ? alone - 0.5 * alone * (alone / left) : 0.5 * left;
}

/// What samples add to the second moment of an estimate, over f^2: a of ours and b of the partner's.
double second_moment(double a, double b, AcdfHeuristic heuristic);
/// The weight that the partner's samples have there.
double weight_of_partner(double a, double b, AcdfHeuristic heuristic);
/// How fast both fall with a.
double moment_fall(double a, double b, AcdfHeuristic heuristic);
double weight_fall(double a, double b, AcdfHeuristic heuristic);

/// What light g costs, per measure, that the partner covers up to a threshold: if it is left to the partner (D),
/// and at best. In range of float.
struct Left {
    float left, least;
};
Left left_to_partner(double g, double threshold);

/// A point of a hull, and how steeply it falls from there to the next; 0 for the last.
struct HullPoint {
    double y, cost, slope;
    std::size_t node; ///< its index among the costs
};
/// The lower hull of costs at ascending y, as far as it falls. `out` has room for `count` points; returns how many
/// there are.
std::size_t falling_hull(const double* y, const double* cost, std::size_t count, HullPoint* out);

/// How many samples a cell takes for a multiplier nu, where the partner's pdf is known.
class Filling {
public:
    /// Combined by the balance heuristic: A - A^2 / D.
    Filling() = default;
    /// By the power heuristic a few samples are worse than none: a cell's share jumps from 0.
    explicit Filling(AcdfHeuristic heuristic);

    /// nu n_l times the integral of p over a cell, in the units of A.
    double share(double alone, double left) const;
    /// The same for a pdf: of light x over the threshold at which the partner covers it, over that threshold.
    double above(double x) const;

private:
    struct Knot {
        double x, y;
    };
    std::vector<Knot> knots_; ///< empty: y = x - 1
};

/// The pdfs of an MIS partner around a surface's normal.
class Lobes {
public:
    explicit Lobes(AcdfPartnerKind kind);

    /// The pdf of directions with that cosine to the normal, sr^-1; 0 below it.
    double density(double cosine) const;
    /// What light counts there: pi times that, so the cosine itself for ACDF_PARTNER_COSINE.
    double brightness(double cosine) const { return 3.141592653589793 * density(cosine); }

private:
    bool even_;                   ///< the same everywhere
    std::vector<double> density_; ///< at even steps of the cosine; empty: known
};

} // namespace acdf::compress
