#include "tools/sweep/surface.h"

#include "build/accuracy/texel_cosines.h"
#include "compress/fit/tiles.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::tools {

std::array<float, 3> texel_middle(const compress::Target& target, std::uint32_t row, std::uint32_t column) {
    compress::Box texel;
    texel.begin[0] = row;
    texel.end[0] = row + 1;
    texel.begin[1] = column;
    texel.end[1] = column + 1;
    const std::array<double, 3> middle = compress::centre(target, texel);
    return {static_cast<float>(middle[0]), static_cast<float>(middle[1]), static_cast<float>(middle[2])};
}

std::vector<float> texel_pdfs(const compress::Target& target, const measure::LightSampler& sampler) {
    std::vector<float> out(target.values.size());
    compress::parallel_for(0u, target.rows, [&](std::uint32_t r) {
        const std::unique_ptr<measure::PointSampler> point = sampler.point_sampler();
        point->move_to({});
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            out[std::size_t{r} * target.columns + c] = point->pdf(texel_middle(target, r, c).data());
        }
    });
    return out;
}

std::vector<SurfacePoint> in_the_open(const std::vector<build::Normal>& normals) {
    std::vector<SurfacePoint> out;
    for (const build::Normal& n : normals) out.push_back({n, {}});
    return out;
}

namespace {

/// Integrals over what a point sees. With p + b instead of p, weights of the balance heuristic are p / (p +
/// b).
struct Sums {
    compress::Sum irradiance, alone, partner, sampled, cosine;
    bool violated = false;

    void add_row(const double row[5], double measure) {
        irradiance.add(row[0] * measure);
        alone.add(row[1] * measure);
        partner.add(row[2] * measure);
        sampled.add(row[3] * measure);
        cosine.add(row[4] * measure);
    }
    PointVariance result() const {
        PointVariance out;
        const double e = irradiance.value();
        out.irradiance = e;
        if (!(e > 0.0)) return out;
        out.alone = violated ? HUGE_VAL : std::max(0.0, alone.value() - e * e);
        // Of one sample of each (Veach and Guibas, SIGGRAPH 1995); one of both together has twice that.
        const double of_two = partner.value() - sampled.value() * sampled.value() - cosine.value() * cosine.value();
        out.partner = 2.0 * std::max(0.0, of_two);
        return out;
    }
};

PointVariance variance_at(const compress::Target& target, const build::TexelCosines& cosines,
                          const std::vector<float>& pdf, const SurfacePoint& point) {
    Sums sums;
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const std::size_t first = std::size_t{r} * target.columns;
        const float* light = target.row(r);
        const float* mean = target.means.size() == 1 ? target.means[0].data() + first : light;
        const float* p = pdf.data() + first;
        double row[5] = {};
        cosines.for_each_above(point.n.data(), r, [&](std::uint32_t c, double cosine) {
            if (light[c] == 0.0f || (!point.hidden.empty() && point.hidden[first + c])) return;
            const double g = double{light[c]} * cosine, own = p[c], b = cosine / ACDF_PI;
            const double lit = double{mean[c]} * cosine * target.column_measure[c], part = lit / (own + b);
            const double square = g * g * target.column_measure[c];
            row[0] += lit;
            row[2] += square / (own + b);
            row[3] += own * part;
            row[4] += b * part;
            if (own > 0.0) row[1] += square / own;
            else sums.violated = true;
        });
        sums.add_row(row, target.row_measure[r]);
    }
    return sums.result();
}

} // namespace

std::vector<PointVariance> point_variances(const compress::Target& target, const std::vector<float>& pdf,
                                           const std::vector<SurfacePoint>& points) {
    const build::TexelCosines cosines(target);
    std::vector<PointVariance> out(points.size());
    compress::parallel_for(std::size_t{0}, points.size(),
                           [&](std::size_t i) { out[i] = variance_at(target, cosines, pdf, points[i]); });
    return out;
}

SurfaceVariances summary(const std::vector<PointVariance>& points, Scale scale) {
    double mean = 0.0;
    for (const PointVariance& point : points) mean += point.irradiance / static_cast<double>(points.size());
    const double floor = scale == Scale::picture ? 0.1 * mean : 0.0;
    std::vector<double> alone, partner;
    for (const PointVariance& point : points) {
        const double e2 = point.irradiance * point.irradiance + floor * floor;
        alone.push_back(e2 > 0.0 ? point.alone / e2 : 0.0);
        partner.push_back(e2 > 0.0 ? point.partner / e2 : 0.0);
    }
    return {spread_of(std::move(alone)), spread_of(std::move(partner))};
}

Lit over_normals(const std::vector<build::Normal>& normals,
                 const std::function<double(const float n[3])>& variance) {
    std::vector<double> each(normals.size());
    compress::parallel_for(std::size_t{0}, normals.size(),
                           [&](std::size_t i) { each[i] = variance(normals[i].data()); });
    return spread_of(std::move(each));
}

Lit spread_of(std::vector<double> variances) {
    Lit out{0.0, 0.0, 0.0};
    if (variances.empty()) return out;
    for (const double v : variances) out.mean += v / static_cast<double>(variances.size());
    std::sort(variances.begin(), variances.end());
    out.median = 0.5 * (variances[(variances.size() - 1) / 2] + variances[variances.size() / 2]);
    out.worst = variances.back();
    return out;
}

} // namespace acdf::tools
