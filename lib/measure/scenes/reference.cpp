#include "measure/scenes/reference.h"

#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/sample.h>

#include <atomic>
#include <cmath>

namespace acdf::measure {
namespace {

struct Azimuth {
    double cosine, sine;
};

Azimuth azimuth(double column, std::uint32_t columns) {
    Azimuth out{};
    acdf_sincospi(1.0 - 2.0 * column / columns, &out.sine, &out.cosine);
    return out;
}

Vec3 direction(const Azimuth& azimuth, double z) {
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    return {radius * azimuth.cosine, radius * azimuth.sine, z};
}

/// The centres of texels, halving azimuth and solid angle.
struct Centres {
    explicit Centres(const ProbeLight& light) {
        for (std::uint32_t c = 0; c < light.columns; ++c) azimuths.push_back(azimuth(c + 0.5, light.columns));
        compress::Sum flux;
        for (std::uint32_t r = 0; r < light.rows; ++r) {
            const double above = acdf_row_z(r, light.rows), below = acdf_row_z(r + 1, light.rows);
            z.push_back(0.5 * (above + below));
            solid_angle.push_back((above - below) * 2.0 * ACDF_PI / light.columns);
            for (std::uint32_t c = 0; c < light.columns; ++c)
                flux.add(luminance(light.texel(c, r)) * solid_angle[r]);
        }
        bright = kRefinedShare * flux.value();
    }
    std::vector<Azimuth> azimuths;
    std::vector<double> z, solid_angle;
    double bright; ///< luminance times solid angle of a texel that is refined wherever it may be seen
};

Rgb lit(const ScenePoint& point, const Vec3& wi) {
    const Rgb reflected = point.reflected(wi);
    return luminance(reflected) > 0.0 && !point.hidden(wi) ? reflected : Rgb{};
}

/// The mean of what is reflected from a texel.
Rgb refined(const ScenePoint& point, const ProbeLight& light, std::uint32_t column, std::uint32_t row) {
    const double above = acdf_row_z(row, light.rows), below = acdf_row_z(row + 1, light.rows);
    Rgb mean{};
    for (std::uint32_t i = 0; i < kRefinement; ++i) {
        const double z = above + (below - above) * ((i + 0.5) / kRefinement);
        for (std::uint32_t k = 0; k < kRefinement; ++k) {
            const Vec3 wi = direction(azimuth(column + (k + 0.5) / kRefinement, light.columns), z);
            const float rounded[3] = {static_cast<float>(wi[0]), static_cast<float>(wi[1]),
                                      static_cast<float>(wi[2])};
            const Rgb part = lit(point, wi), radiance = light.radiance(rounded);
            for (std::size_t c = 0; c < 3; ++c) mean[c] += part[c] * radiance[c] / (kRefinement * kRefinement);
        }
    }
    return mean;
}

struct Term {
    std::uint32_t column, row;
    bool bright; ///< a sun, say, is refined also where its centre is hidden
    Rgb value;
};

class PointSum {
public:
    PointSum(const ProbeLight& light, const Centres& centres, const ScenePoint& point)
        : light_(light), centres_(centres), point_(point) {}

    Rgb value() {
        for (std::uint32_t row = 0; row < light_.rows; ++row) add_row(row);
        const double most = kRefinedShare * luminance(total());
        for (const Term& term : candidates_)
            if (term.bright || luminance(term.value) > most) refine(term);
        return total();
    }

private:
    void add_row(std::uint32_t row) {
        const float* n = point_.shading().n;
        const double z = centres_.z[row], radius = std::sqrt((1.0 - z) * (1.0 + z));
        const double below = -ACDF_PI / light_.rows; // a texel's corner may be above the horizon
        Rgb sum{};
        for (std::uint32_t column = 0; column < light_.columns; ++column) {
            const Azimuth& a = centres_.azimuths[column];
            const Vec3 wi{radius * a.cosine, radius * a.sine, z};
            if (n[0] * wi[0] + n[1] * wi[1] + n[2] * wi[2] <= below) continue;
            const Rgb radiance = light_.texel(column, row);
            const double flux = luminance(radiance) * centres_.solid_angle[row];
            if (!(flux > 0.0)) continue;
            Rgb term = lit(point_, wi);
            for (std::size_t k = 0; k < 3; ++k) {
                term[k] *= radiance[k] * centres_.solid_angle[row];
                sum[k] += term[k];
            }
            const bool bright = flux > centres_.bright;
            // A term of at most that share of the sum so far cannot be a larger share of the whole.
            if (bright || luminance(term) > kRefinedShare * so_far_)
                candidates_.push_back({column, row, bright, term});
        }
        for (std::size_t k = 0; k < 3; ++k) sum_[k].add(sum[k]);
        so_far_ += luminance(sum);
    }
    void refine(const Term& term) {
        const Rgb mean = refined(point_, light_, term.column, term.row);
        for (std::size_t k = 0; k < 3; ++k) sum_[k].add(mean[k] * centres_.solid_angle[term.row] - term.value[k]);
    }
    Rgb total() const { return {sum_[0].value(), sum_[1].value(), sum_[2].value()}; }

    const ProbeLight& light_;
    const Centres& centres_;
    const ScenePoint& point_;
    compress::Sum sum_[3];
    double so_far_ = 0.0;
    std::vector<Term> candidates_;
};

} // namespace

std::vector<Rgb> reference(const ProbeLight& light, const std::vector<ScenePoint>& points,
                           const std::function<void(double)>& progress) {
    const Centres centres(light);
    std::vector<Rgb> out(points.size());
    std::atomic<std::size_t> done{0};
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        out[i] = PointSum(light, centres, points[i]).value();
        if (progress) progress(static_cast<double>(++done) / static_cast<double>(points.size()));
    });
    return out;
}

} // namespace acdf::measure
