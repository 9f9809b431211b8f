#include "measure/samplers/brdf_samplers.h"

#include <acdf/elementary.h>

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

double dot_product(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

} // namespace

BrdfSample CosineSampler::sample(const double wo[3], const double u[2]) {
    BrdfSample out;
    const double r = std::sqrt(u[1]), phi = 2.0 * ACDF_PI * u[0];
    out.wi[0] = r * std::cos(phi);
    out.wi[1] = r * std::sin(phi);
    out.wi[2] = std::sqrt(1.0 - u[1]);
    out.pdf = pdf(wo, out.wi);
    return out;
}

double CosineSampler::pdf(const double wo[3], const double wi[3]) {
    return wo[2] > 0.0 && wi[2] > 0.0 ? wi[2] / ACDF_PI : 0.0;
}

BrdfSample GgxSampler::sample(const double wo[3], const double u[2]) const {
    BrdfSample out;
    if (!(wo[2] > 0.0)) return out;
    // Stretched so that the normals are those of a hemisphere, seen from v; a and b span the plane across it.
    double v[3] = {alpha_x_ * wo[0], alpha_y_ * wo[1], wo[2]};
    const double length = std::sqrt(dot_product(v, v));
    for (double& x : v) x /= length;
    const double across = std::sqrt(v[0] * v[0] + v[1] * v[1]);
    const double a[3] = {across > 0.0 ? -v[1] / across : 1.0, across > 0.0 ? v[0] / across : 0.0, 0.0};
    const double b[3] = {-v[2] * a[1], v[2] * a[0], v[0] * a[1] - v[1] * a[0]};

    // A point of the visible half discs: that of the hemisphere's front, and the other one foreshortened.
    const double r = std::sqrt(u[0]), phi = 2.0 * ACDF_PI * u[1], s = 0.5 * (1.0 + v[2]);
    const double t1 = r * std::cos(phi), edge = std::sqrt(std::max(0.0, 1.0 - t1 * t1));
    const double t2 = (1.0 - s) * edge + s * r * std::sin(phi);
    const double t3 = std::sqrt(std::max(0.0, 1.0 - t1 * t1 - t2 * t2));
    double h[3];
    for (int k = 0; k < 3; ++k) h[k] = t1 * a[k] + t2 * b[k] + t3 * v[k];
    h[0] *= alpha_x_, h[1] *= alpha_y_, h[2] = std::max(0.0, h[2]);
    const double norm = std::sqrt(dot_product(h, h));
    for (double& x : h) x /= norm;

    const double cosine = dot_product(wo, h);
    for (int k = 0; k < 3; ++k) out.wi[k] = 2.0 * cosine * h[k] - wo[k];
    out.pdf = pdf(wo, out.wi);
    return out;
}

double GgxSampler::scale(const double wo[3]) const {
    if (!(wo[2] > 0.0)) return 0.0;
    const double stretched =
        std::sqrt(alpha_x_ * alpha_x_ * wo[0] * wo[0] + alpha_y_ * alpha_y_ * wo[1] * wo[1] + wo[2] * wo[2]);
    // 1 / (pi alpha_x alpha_y) of D, and G1 / (4 cos), G1 = 2 cos / (cos + stretched)
    return 1.0 / (2.0 * ACDF_PI * alpha_x_ * alpha_y_ * (wo[2] + stretched));
}

GgxFit best_ggx(const compress::Reflected& reflected, const std::vector<compress::View>& views,
                std::uint32_t columns, std::uint32_t rows) {
    const build::ReflectedViews light(reflected, views, columns, rows);
    const auto cost = [&](double x) {
        const GgxSampler ggx(std::exp(x));
        return light.relative_variance([&](const double wo[3], const double wi[3]) { return ggx.pdf(wo, wi); });
    };
    // A coarse scan first: the cost of a lobe over a pedestal can have two valleys.
    constexpr int scan = 12;
    const double low = std::log(0.001), step = (std::log(2.0) - low) / scan;
    int best = 0;
    double best_cost = cost(low);
    for (int i = 1; i <= scan; ++i)
        if (const double c = cost(low + step * i); c < best_cost) best = i, best_cost = c;

    const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
    double a = low + step * std::max(0, best - 1), b = low + step * std::min(scan, best + 1);
    double c = b - ratio * (b - a), d = a + ratio * (b - a), cost_c = cost(c), cost_d = cost(d);
    for (int i = 0; i < 18; ++i) {
        if (cost_c < cost_d) {
            b = d, d = c, cost_d = cost_c;
            c = b - ratio * (b - a), cost_c = cost(c);
        } else {
            a = c, c = d, cost_c = cost_d;
            d = a + ratio * (b - a), cost_d = cost(d);
        }
    }
    return cost_c < cost_d ? GgxFit{std::exp(c), cost_c} : GgxFit{std::exp(d), cost_d};
}

} // namespace acdf::measure
