#include "measure/scenes/point_sums.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

struct Texel {
    Vec3 direction;
    float rounded[3];
    double solid_angle;
};
Texel texel_of(const ProbeLight& light, std::uint32_t column, std::uint32_t row) {
    const double above = acdf_row_z(row, light.rows), below = acdf_row_z(row + 1, light.rows);
    const double z = 0.5 * (above + below), radius = std::sqrt((1.0 - z) * (1.0 + z));
    double sine, cosine;
    acdf_sincospi(1.0 - 2.0 * (column + 0.5) / light.columns, &sine, &cosine);
    Texel out{{radius * cosine, radius * sine, z}, {}, (above - below) * 2.0 * ACDF_PI / light.columns};
    for (std::size_t k = 0; k < 3; ++k) out.rounded[k] = static_cast<float>(out.direction[k]);
    return out;
}

double value(const ScenePoint& point, const ProbeLight& light, std::uint32_t column, std::uint32_t row,
             const Texel& t) {
    Rgb out = point.reflected(t.direction);
    const Rgb radiance = light.texel(column, row);
    for (std::size_t k = 0; k < 3; ++k) out[k] *= radiance[k];
    const double f = luminance(out);
    return f > 0.0 && !point.hidden(t.direction) ? f : 0.0;
}

} // namespace

PartsAtPoint::PartsAtPoint(const SamplerParts& of, const ScenePoint& point) {
    for (const SamplerParts::Part& part : of.parts) {
        parts_.push_back(part.of_material[point.material()]->point_sampler());
        parts_.back()->move_to(point.shading());
        samples_.push_back(part.samples);
        all_ += part.samples;
    }
}

double PartsAtPoint::density(const float direction[3], std::vector<double>& own) const {
    double mean = 0.0;
    own.clear();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        own.push_back(double{parts_[i]->pdf(direction)});
        mean += own.back() * samples_[i] / all_;
    }
    return mean;
}

double PartsAtPoint::estimate(const ScenePoint& point, const ProbeLight& light, std::mt19937_64& random) const {
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    double sum = 0.0;
    std::vector<double> own;
    for (std::size_t part = 0; part < parts_.size(); ++part)
        for (std::uint32_t i = 0; i < samples_[part]; ++i) {
            const double u = uniform(), v = uniform();
            const AcdfDirectionSample s = parts_[part]->sample(u, v);
            std::uint32_t at[2];
            double ignored;
            if (!(s.pdf > 0.0f) || !acdf_sphere_square(light.columns, light.rows, s.direction, at, &ignored))
                continue;
            const double f = value(point, light, at[0], at[1], texel_of(light, at[0], at[1]));
            if (f > 0.0) sum += f / (parts_.size() == 1 ? double{s.pdf} : density(s.direction, own));
        }
    return sum / all_;
}

/// Multi-sample variance by the balance heuristic: the integral of f^2/p, p the mean pdf, less for each part
/// its share of the samples times the square of its mean (Veach and Guibas, SIGGRAPH 1995).
class PointMoments {
public:
    explicit PointMoments(const PartsAtPoint& of) : of_(of), means_(of.parts_.size(), 0.0) {}

    /// `spread`: of f^2 over the texel, beside the square of its mean f.
    void add(double f, double spread, const Texel& t) {
        const double p = of_.density(t.rounded, own_);
        if (!(p > 0.0)) {
            ++lost;
            return;
        }
        square_ += spread * f * f / p * t.solid_angle;
        for (std::size_t i = 0; i < own_.size(); ++i) means_[i] += own_[i] * f / p * t.solid_angle;
    }
    double variance() const {
        double out = square_;
        for (std::size_t i = 0; i < means_.size(); ++i) out -= means_[i] * means_[i] * of_.samples_[i] / of_.all_;
        return std::max(out, 0.0);
    }

    std::uint32_t lost = 0;

private:
    const PartsAtPoint& of_;
    std::vector<double> means_, own_;
    double square_ = 0.0;
};

PointSums sums_at(const ScenePoint& point, const ProbeLight& light, const std::vector<PartsAtPoint>& samplers) {
    PointSums out;
    std::vector<PointMoments> moments(samplers.begin(), samplers.end());
    for (std::uint32_t row = 0; row < light.rows; ++row)
        for (std::uint32_t column = 0; column < light.columns; ++column) {
            const Texel t = texel_of(light, column, row);
            const double f = value(point, light, column, row, t);
            if (!(f > 0.0)) continue;
            out.mean += f * t.solid_angle;
            for (PointMoments& one : moments) one.add(f, light.spread_of(column, row), t);
        }
    for (const PointMoments& one : moments) {
        out.variance.push_back(one.variance());
        out.lost.push_back(one.lost);
    }
    return out;
}

} // namespace acdf::measure
