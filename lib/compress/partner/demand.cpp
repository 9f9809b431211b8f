#include "compress/partner/demand.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kFirstNode = 0.004, kNodeRatio = 1.5; // of nodes, sr^-1
constexpr double kMostPartner = 1.0;                   // sr^-1; where y jumps a line would be as steep

std::array<double, NoiseCurve::nodes> all_nodes() {
    std::array<double, NoiseCurve::nodes> out{};
    double y = kFirstNode;
    for (std::size_t k = 1; k < out.size(); ++k, y *= kNodeRatio) out[k] = y;
    return out;
}
const std::array<double, NoiseCurve::nodes> kNodes = all_nodes();

double sum_of_products(const NoiseKernel::Histogram& a, const NoiseKernel::Histogram& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

} // namespace

Demand::Demand(const NoiseCurve& curve, double radiance) {
    std::array<double, NoiseCurve::nodes> noise;
    for (std::size_t k = 0; k < noise.size(); ++k)
        noise[k] = radiance * (radiance * curve.square[k] + curve.mean[k]);
    std::array<HullPoint, NoiseCurve::nodes> hull;
    const std::size_t size = falling_hull(kNodes.data(), noise.data(), noise.size(), hull.data());
    const auto push = [&](double y, double price) {
        if (price > 0.0 && (count_ == 0 || price < points_[count_ - 1].price)) points_[count_++] = {y, price};
    };
    const bool jumps = size > 1 && hull[1].node > 1;
    if (jumps) push(hull[1].y, hull[0].slope);
    for (std::size_t i = jumps ? 2 : 0; i < size; ++i) {
        const std::size_t k = hull[i].node;
        push(hull[i].y, radiance * (radiance * curve.square_fall[k] + curve.mean_fall[k]));
    }
}

Demand::Line Demand::line(double price) const {
    if (count_ == 0) return {};
    const auto root = [](double x) { return 1.0 / std::sqrt(x); };
    std::size_t i = 1;
    while (i + 1 < count_ && points_[i].price > price) ++i;
    const Point &a = points_[i - 1], &b = points_[std::min(i, count_ - 1)];
    const double first = root(a.price), light = count_ > 1 ? (b.y - a.y) / (root(b.price) - first) : a.y / first;
    const double partner = std::clamp(light * first - a.y, 0.0, kMostPartner);
    if (!(price < highest())) return {partner / first, partner};
    return {(light * (root(price) - first) + a.y + partner) / root(price), partner};
}

double Demand::at(double price) const {
    if (!(price < highest())) return 0.0;
    const Line found = line(price);
    return found.light / std::sqrt(price) - found.partner;
}

NoiseKernel::NoiseKernel(const Lobes& lobes, AcdfHeuristic heuristic) {
    for (std::size_t k = 0; k < NoiseCurve::nodes; ++k)
        for (std::size_t i = 0; i <= cosines; ++i) {
            const double cosine = std::max(double(i), 1e-6) / double(cosines), b = lobes.density(cosine);
            const double bright = lobes.brightness(cosine);
            square_[k][i] = bright * (bright * second_moment(kNodes[k], b, heuristic));
            mean_[k][i] = bright * weight_of_partner(kNodes[k], b, heuristic);
            square_fall_[k][i] = bright * (bright * moment_fall(kNodes[k], b, heuristic));
            mean_fall_[k][i] = bright * weight_fall(kNodes[k], b, heuristic);
        }
}

void NoiseKernel::set_squares(const Histogram& weights, NoiseCurve& curve) const {
    for (std::size_t k = 0; k < NoiseCurve::nodes; ++k) {
        curve.square[k] = sum_of_products(weights, square_[k]);
        curve.square_fall[k] = sum_of_products(weights, square_fall_[k]);
    }
}

void NoiseKernel::set_means(const Histogram& weights, NoiseCurve& curve) const {
    for (std::size_t k = 0; k < NoiseCurve::nodes; ++k) {
        curve.mean[k] = sum_of_products(weights, mean_[k]);
        curve.mean_fall[k] = sum_of_products(weights, mean_fall_[k]);
    }
}

} // namespace acdf::compress
