#include "compress/partner/target.h"

#include "compress/local/light.h"
#include "compress/parallel.h"
#include "compress/partner/demand.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kCurveColumns = 128, kCurveRows = 64; // of directions whose noise curves are found
constexpr int kTurns = 8; // of p and means in turns: the noise falls with each, the last ones by less than 0.1 %

/// Light as points, and the normals that it shines on.
class Lighting {
public:
    Lighting(const Target& target, const NormalBins& normals, const Partner& partner)
        : normals_(normals), lobes_(partner.kind), kernel_(lobes_, partner.heuristic),
          heuristic_(partner.heuristic), share_(partner.share()), difference_(normals.normals.size(), 0.0),
          curves_(std::size_t{kCurveColumns} * kCurveRows), used_(curves_.size(), false) {
        grid_.columns = kCurveColumns;
        grid_.rows = kCurveRows;
        grid_.parameterization = target.parameterization;
        for (const LightPoint& p : light_points(target)) add(p);
        weigh_normals();
        start();
        find_curves([&](std::size_t n) { return weight_[n]; }, &NoiseKernel::set_squares);
        for (int step = 0; step < kTurns; ++step) {
            compare_means();
            if (step + 1 == kTurns) used_.assign(used_.size(), true); // texels lie where no point does
            find_curves([&](std::size_t n) { return 2.0 * (1.0 - share_) * weight_[n] * difference_[n]; },
                        &NoiseKernel::set_means);
            fill();
        }
    }

    /// What light from a position of the sphere, in fractions of columns and rows, wants at the price that all pay.
    Demand::Line line(double column, double row, double radiance) const {
        const auto i = std::size_t(row * grid_.rows) * grid_.columns + std::size_t(column * grid_.columns);
        return Demand(curves_[i], radiance).line(price_);
    }

private:
    struct Point {
        Direction direction;
        double radiance, measure, density = 0.0; ///< of what is sampled
        std::size_t place;                       ///< in the coarse grid
    };

    void add(const LightPoint& p) {
        if (!(p.measure > 0.0) || !(p.amount > 0.0)) return;
        points_.push_back({p.direction, p.amount / p.measure, p.measure, 0.0, place_of(p.direction)});
        used_[points_.back().place] = true;
    }
    std::size_t place_of(const Direction& d) const {
        const AcdfGrid grid{grid_.columns, grid_.rows, static_cast<std::uint32_t>(grid_.parameterization)};
        const float direction[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        std::uint32_t square[2] = {0, 0};
        double position[2];
        acdf_grid_square(&grid, direction, square, position);
        return std::size_t{square[1]} * grid_.columns + square[0];
    }

    /// The noise of a normal counts relative to its irradiance, that of the darkest to a tenth of the mean: a few
    /// that are nearly black would decide otherwise.
    void weigh_normals() {
        std::vector<double> irradiance(normals_.normals.size(), 0.0);
        parallel_for(std::size_t{0}, irradiance.size(), [&](std::size_t n) {
            for (const Point& p : points_)
                irradiance[n] += p.radiance * p.measure * lobes_.brightness(dot(p.direction, normals_.normals[n]));
        });
        double mean = 0.0;
        for (std::size_t n = 0; n < irradiance.size(); ++n) mean += normals_.weight[n] * irradiance[n];
        if (!(mean > 0.0)) throw std::invalid_argument("no normal sees any light");
        for (std::size_t n = 0; n < irradiance.size(); ++n) {
            const double e = irradiance[n] / mean;
            weight_.push_back(irradiance[n] > 0.0 ? normals_.weight[n] / (e * e + 0.01) : 0.0);
        }
    }

    /// What exceeds the mean radiance.
    void start() {
        double flux = 0.0, sum = 0.0;
        for (const Point& p : points_) flux += p.radiance * p.measure;
        for (Point& p : points_)
            sum += p.measure * (p.density = std::max(0.0, p.radiance - flux / (4.0 * ACDF_PI)));
        for (Point& p : points_) p.density = sum > 0.0 ? p.density / sum : p.radiance / flux;
    }

    /// For each normal the mean of what a sample of ours adds, less that of the partner's. Since the numbers of
    /// samples are fixed, only what deviates from its own mean is noise.
    void compare_means() {
        parallel_for(std::size_t{0}, difference_.size(), [&](std::size_t n) {
            double ours = 0.0, theirs = 0.0;
            if (weight_[n] > 0.0)
                for (const Point& p : points_) {
                    const double cosine = dot(p.direction, normals_.normals[n]);
                    if (!(cosine > 0.0)) continue;
                    const double f = p.radiance * lobes_.brightness(cosine) * p.measure;
                    const double weight =
                        weight_of_partner(share_ * p.density, (1.0 - share_) * lobes_.density(cosine), heuristic_);
                    ours += f * (1.0 - weight);
                    theirs += f * weight;
                }
            difference_[n] = ours / share_ - theirs / (1.0 - share_);
        });
    }

    /// Sets, by `set`, what curves are of histograms of the weights that `weight` returns for normals.
    template <class Weight>
    void find_curves(const Weight& weight,
                     void (NoiseKernel::*set)(const NoiseKernel::Histogram&, NoiseCurve&) const) {
        parallel_for(std::size_t{0}, curves_.size(), [&](std::size_t i) {
            if (set == &NoiseKernel::set_means && !used_[i]) return;
            const Direction d =
                direction_at(grid_, double(i / grid_.columns) + 0.5, double(i % grid_.columns) + 0.5);
            NoiseKernel::Histogram histogram{};
            for (std::size_t n = 0; n < weight_.size(); ++n) {
                const double cosine = weight_[n] > 0.0 ? dot(d, normals_.normals[n]) : 0.0;
                if (cosine > 0.0) NoiseKernel::add(histogram, cosine, weight(n));
            }
            (kernel_.*set)(histogram, curves_[i]);
        });
    }

    /// Samples all that is worth the price at which the samples are as many as there are.
    void fill() {
        std::vector<Demand> demands;
        for (const Point& p : points_) demands.emplace_back(curves_[p.place], p.radiance);
        const auto asked = [&](double price) {
            double sum = 0.0;
            for (std::size_t i = 0; i < points_.size(); ++i) sum += demands[i].at(price) * points_[i].measure;
            return sum;
        };
        const double wanted = share_ / (1.0 - share_);
        double low = 0.0, high = 0.0;
        for (const Demand& demand : demands) high = std::max(high, demand.highest());
        if (!(high > 0.0)) return; // as they were
        for (low = high; low > 1e-30 * high && asked(low) < wanted; low *= 1e-2) high = low;
        for (int step = 0; step < 40; ++step) {
            const double price = std::sqrt(low * high);
            (asked(price) > wanted ? low : high) = price;
        }
        price_ = low;
        const double sum = asked(price_);
        if (!(sum > 0.0)) return;
        for (std::size_t i = 0; i < points_.size(); ++i) points_[i].density = demands[i].at(price_) / sum;
    }

    const NormalBins& normals_;
    Lobes lobes_;
    NoiseKernel kernel_;
    AcdfHeuristic heuristic_;
    double share_, price_ = 1.0;
    Target grid_;
    std::vector<Point> points_;
    std::vector<double> weight_, difference_; ///< one a normal
    std::vector<NoiseCurve> curves_;          ///< of directions of the grid
    std::vector<bool> used_;                  ///< whether a point has that direction
};

/// Calls `visit(texel, row, column)` for all texels, rows in parallel.
template <class Visit>
void for_each_texel(const Target& target, const Visit& visit) {
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < target.columns; ++c) visit(std::size_t{r} * target.columns + c, r, c);
    });
}

/// nu n_b at which the shares of all texels come to nu n_l.
double solve_threshold(const Target& target, const std::vector<float>& density, double ratio) {
    const auto excess = [&](double nu) {
        std::vector<double> rows(target.rows, 0.0);
        for_each_texel(target, [&](std::size_t i, std::uint32_t r, std::uint32_t c) {
            const double above = target.values[i] - nu * double{density[i]};
            if (above > 0.0) rows[r] += above * target.column_measure[c] * target.row_measure[r];
        });
        Sum sum;
        for (const double row : rows) sum.add(row);
        return sum.value() - nu * ratio;
    };
    const double all = integral(target);
    if (!(all > 0.0)) throw std::invalid_argument("the partner leaves nothing to be sampled");
    double low = 1e-6 * all / ratio, high = all / ratio;
    for (int step = 0; step < 40; ++step) {
        const double middle = std::sqrt(low * high);
        (excess(middle) > 0.0 ? low : high) = middle;
    }
    return low;
}

/// What cells cost beside an MIS partner of that pdf.
void fill(Target& target, const std::vector<float>& density, double nu) {
    target.filling = std::make_shared<const Filling>();
    target.left.resize(target.values.size());
    target.least.resize(target.values.size());
    for_each_texel(target, [&](std::size_t i, std::uint32_t, std::uint32_t) {
        const Left left = left_to_partner(target.values[i], nu * double{density[i]});
        target.left[i] = left.left;
        target.least[i] = left.least;
    });
}

/// The same light times a power of two, so that the brightest texel has from 1/2 to 1: results from it are
/// in the range of floats. Pdfs do not change.
Target in_range(const Target& given) {
    Target target = of_values(given);
    target.mean_square = 0.0;
    int exponent = 0;
    std::frexp(*std::max_element(target.values.begin(), target.values.end()), &exponent);
    for (float& value : target.values) value = std::ldexp(value, -exponent);
    return target;
}

} // namespace

Target partner_target(const Target& given, const NormalBins& normals, const Partner& partner) {
    const Target target = in_range(given);
    Target out = target;
    std::vector<float> density(target.values.size(), 1.0f);
    if (partner.kind == ACDF_PARTNER_MEAN) {
        fill(out, density, 2.0 * (1.0 - partner.share()) * integral(target) / (4.0 * ACDF_PI));
        return out;
    }
    const Lighting lighting(target, normals, partner);
    for_each_texel(target, [&](std::size_t i, std::uint32_t r, std::uint32_t c) {
        const Demand::Line line =
            lighting.line(double(c) / target.columns, double(r) / target.rows, target.values[i]);
        out.values[i] = static_cast<float>(line.light);
        density[i] = static_cast<float>(line.partner);
    });
    fill(out, density, solve_threshold(out, density, partner.light / partner.other));
    return out;
}

} // namespace acdf::compress
