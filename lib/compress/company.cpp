#include "compress/company.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kCosines = 64;

/// What a sample of each, a of ours and b of the company's, adds to the second moment over f^2.
double reciprocal(double a, double b, AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return 1.0 / (a + b);
    const double most = std::max(a, b), x = std::min(a, b) / most; // squares stay in range
    const double squares = 1.0 + x * x;
    return (1.0 + x * x * x) / (squares * squares) / most;
}

/// Density of light that a GGX lobe draws for a view: visible normals (Heitz, JCGT 2018), reflected.
double ggx_density(double alpha, const std::array<double, 3>& wo, const std::array<double, 3>& wi) {
    std::array<double, 3> h{};
    double length = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        h[k] = wo[k] + wi[k];
        length += h[k] * h[k];
    }
    const double cosine = h[2] / std::sqrt(length), square = alpha * alpha;
    const double base = cosine * cosine * (square - 1.0) + 1.0;
    const double distribution = square / (ACDF_PI * base * base);
    const double tangent = (1.0 - wo[2] * wo[2]) / (wo[2] * wo[2]);
    const double shadowing = 2.0 / (1.0 + std::sqrt(1.0 + square * tangent));
    return distribution * shadowing / (4.0 * wo[2]);
}

/// The mean density of lobes for light of one cosine: half of them that of a matte surface, the others glossy ones,
/// seen from all sides.
double brdf_density(double cosine) {
    constexpr double widths[] = {0.5, 0.25, 0.1};
    constexpr std::size_t views = 4, azimuths = 64;
    constexpr double weight = 0.5 / double(std::size(widths) * views * azimuths);
    double sum = 0.5 * cosine / ACDF_PI;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    for (const double alpha : widths)
        for (std::size_t v = 0; v < views; ++v) {
            const double up = (double(v) + 0.5) / double(views);
            const std::array<double, 3> wo{std::sqrt(1.0 - up * up), 0.0, up};
            for (std::size_t k = 0; k < azimuths; ++k) {
                double s, c;
                acdf_sincospi((double(k) + 0.5) / double(azimuths), &s, &c);
                sum += weight * ggx_density(alpha, wo, {sine * c, sine * s, cosine});
            }
        }
    return sum;
}

} // namespace

double effective_density(const std::vector<Lobe>& lobes) {
    double first = 0.0, second = 0.0;
    for (const Lobe& lobe : lobes) {
        first += lobe.weight * lobe.density;
        second += lobe.weight * lobe.density * lobe.density;
    }
    return second / first;
}

double rms_density(const std::vector<Lobe>& lobes) {
    double weight = 0.0, second = 0.0;
    for (const Lobe& lobe : lobes) {
        weight += lobe.weight;
        second += lobe.weight * lobe.density * lobe.density;
    }
    return std::sqrt(second / weight);
}

Filling::Filling(const std::vector<Lobe>& lobes, AcdfHeuristic heuristic) {
    // With y = n_l p over n_b times the effective density and x = light over threshold, x^2 kappa(y) + y is to be
    // least; kappa falls from 1. Only y on the lower hull of kappa ever are best.
    const double effective = effective_density(lobes);
    double whole = 0.0;
    for (const Lobe& lobe : lobes) whole += lobe.weight * lobe.density * lobe.density;
    const auto kappa = [&](double y) {
        double sum = 0.0;
        for (const Lobe& lobe : lobes)
            if (lobe.density > 0.0)
                sum +=
                    lobe.weight * lobe.density * lobe.density * reciprocal(effective * y, lobe.density, heuristic);
        return effective * sum / whole;
    };
    std::vector<Knot> hull{{0.0, 1.0}}; // of y and kappa here
    const auto slope = [](const Knot& a, const Knot& b) { return (a.y - b.y) / (b.x - a.x); };
    for (double y = 1e-3; y < 1e5; y *= 1.05) {
        const Knot next{y, kappa(y)};
        while (hull.size() > 1 && slope(hull.back(), next) >= slope(hull[hull.size() - 2], hull.back()))
            hull.pop_back();
        hull.push_back(next);
    }
    knots_.push_back({std::sqrt(1.0 / slope(hull[0], hull[1])), hull[1].x});
    for (std::size_t i = 1; i + 1 < hull.size(); ++i) {
        const double both = slope(hull[i - 1], hull[i]) * slope(hull[i], hull[i + 1]);
        knots_.push_back({std::sqrt(1.0 / std::sqrt(both)), hull[i].x});
    }
}

double Filling::above(double x) const {
    if (knots_.empty()) return std::max(0.0, x - 1.0);
    if (!(x > knots_.front().x)) return 0.0;
    if (!(x < knots_.back().x)) return x - (knots_.back().x - knots_.back().y);
    const auto next =
        std::upper_bound(knots_.begin(), knots_.end(), x, [](double v, const Knot& knot) { return v < knot.x; });
    const Knot &a = *(next - 1), &b = *next;
    return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

double Filling::share(double alone, double left) const {
    if (!(left > 0.0) || !(alone > 0.0)) return alone;
    const double x = left / alone;
    if (!(x < 1e300)) return alone;
    return alone * (above(x) / x);
}

Lobes::Lobes(AcdfCompanyKind kind) {
    if (kind == ACDF_COMPANY_MEAN || kind == ACDF_COMPANY_TABLE) {
        all_.push_back({1.0, 1.0 / (4.0 * ACDF_PI)});
        return;
    }
    for (std::size_t i = 0; i < kCosines; ++i) {
        const double cosine = (double(i) + 0.5) / double(kCosines);
        if (kind != ACDF_COMPANY_COSINE) density_.push_back(brdf_density(cosine));
        all_.push_back({1.0 / double(kCosines), density_.empty() ? cosine / ACDF_PI : density_.back()});
    }
}

double Lobes::density(double cosine) const {
    if (all_.size() == 1) return all_.front().density;
    if (!(cosine > 0.0)) return 0.0;
    if (density_.empty()) return cosine / ACDF_PI;
    const double place = std::clamp(cosine * double(kCosines) - 0.5, 0.0, double(kCosines) - 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), kCosines - 2);
    return density_[i] + (place - double(i)) * (density_[i + 1] - density_[i]);
}

} // namespace acdf::compress
