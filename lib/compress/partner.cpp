#include "compress/partner.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kCosines = 64;

/// The pdf of light that a GGX lobe samples for a view: visible normals (Heitz, JCGT 2018), reflected.
double ggx_pdf(double alpha, const std::array<double, 3>& wo, const std::array<double, 3>& wi) {
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

/// The mean pdf of lobes for light of one cosine: half of them that of a matte surface, the others glossy ones,
/// seen from all sides.
double brdf_pdf(double cosine) {
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
                sum += weight * ggx_pdf(alpha, wo, {sine * c, sine * s, cosine});
            }
        }
    return sum;
}

} // namespace

double second_moment(double a, double b, AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return 1.0 / (a + b);
    const double most = std::max(a, b), x = std::min(a, b) / most; // squares stay in range
    const double squares = 1.0 + x * x;
    return (1.0 + x * x * x) / (squares * squares) / most;
}

double weight_of_partner(double a, double b, AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return b / (a + b);
    const double most = std::max(a, b), x = a / most, y = b / most;
    return y * y / (x * x + y * y);
}

double moment_fall(double a, double b, AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return 1.0 / ((a + b) * (a + b));
    const double most = std::max(a, b), x = a / most, y = b / most, squares = x * x + y * y;
    return x * (x * x * x + 4.0 * y * y * y - 3.0 * x * y * y) / (squares * squares * squares) / (most * most);
}

double weight_fall(double a, double b, AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return b / ((a + b) * (a + b));
    const double most = std::max(a, b), x = a / most, y = b / most, squares = x * x + y * y;
    return 2.0 * x * y * y / (squares * squares) / most;
}

Left left_to_partner(double g, double threshold) {
    const double left = threshold > 0.0 ? std::min(g * (g / threshold), 3e38) : g > 0.0 ? 3e38 : 0.0;
    return {static_cast<float>(left), static_cast<float>(cell_cost(g, left))};
}

std::size_t falling_hull(const double* y, const double* cost, std::size_t count, HullPoint* out) {
    const auto slope = [&](const HullPoint& a, std::size_t k) { return (a.cost - cost[k]) / (y[k] - a.y); };
    std::size_t last = 0;
    out[0] = {y[0], cost[0], 0.0, 0};
    for (std::size_t k = 1; k < count; ++k) {
        double to_next = slope(out[last], k);
        while (last > 0 && to_next >= out[last - 1].slope) to_next = slope(out[--last], k);
        if (!(to_next > 0.0)) continue;
        out[last].slope = to_next;
        out[++last] = {y[k], cost[k], 0.0, k};
    }
    return last + 1;
}

Filling::Filling(AcdfHeuristic heuristic) {
    if (heuristic == ACDF_HEURISTIC_BALANCE) return;
    // With y = n_l p over n_b b and x = light over threshold, x^2 moment(y) + y is to be least; the moment falls
    // from 1, and only y on its hull ever are best.
    std::vector<double> y{0.0}, moment{1.0};
    for (double next = 1e-3; next < 1e5; next *= 1.05) {
        y.push_back(next);
        moment.push_back(second_moment(next, 1.0, heuristic));
    }
    std::vector<HullPoint> hull(y.size());
    hull.resize(falling_hull(y.data(), moment.data(), y.size(), hull.data()));
    knots_.push_back({std::sqrt(1.0 / hull[0].slope), hull[1].y});
    for (std::size_t i = 1; i + 1 < hull.size(); ++i)
        knots_.push_back({std::sqrt(1.0 / std::sqrt(hull[i - 1].slope * hull[i].slope)), hull[i].y});
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

Lobes::Lobes(AcdfPartnerKind kind) : even_(kind == ACDF_PARTNER_MEAN || kind == ACDF_PARTNER_TABLE) {
    if (even_ || kind == ACDF_PARTNER_COSINE) return;
    for (std::size_t i = 0; i < kCosines; ++i) density_.push_back(brdf_pdf((double(i) + 0.5) / double(kCosines)));
}

double Lobes::density(double cosine) const {
    if (even_) return 1.0 / (4.0 * ACDF_PI);
    if (!(cosine > 0.0)) return 0.0;
    if (density_.empty()) return cosine / ACDF_PI;
    const double place = std::clamp(cosine * double(kCosines) - 0.5, 0.0, double(kCosines) - 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), kCosines - 2);
    return density_[i] + (place - double(i)) * (density_[i + 1] - density_[i]);
}

} // namespace acdf::compress
