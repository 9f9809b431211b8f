#include "compress/company_target.h"

#include "compress/light.h"
#include "compress/sum.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr int kSteps = 8; // of p and means in turns: the noise falls with each, the last ones by less than 1 %

/// What light counts over a grid of directions: `light` is its weight, to `shift` more of it; the company's
/// effective density there.
struct Levels {
    CoarseMap light, shift, density;

    /// What a density has to follow of radiance L.
    static double followed(double light, double shift, double radiance) {
        return light * std::sqrt(std::max(0.0, radiance * (radiance + shift)));
    }
};

/// Light as points, and the normals that it shines on.
class Lighting {
public:
    Lighting(const Target& target, const NormalBins& normals, const Company& company, const Lobes& lobes,
             const Filling& filling)
        : normals_(normals), lobes_(lobes), filling_(filling), share_(company.share()),
          ratio_(company.light / company.other), difference_(normals.normals.size(), 0.0) {
        grid_.columns = CoarseMap::columns;
        grid_.rows = CoarseMap::rows;
        grid_.parameterization = target.parameterization;
        for (const LightPoint& p : light_points(target)) add(p);
        weigh_normals();
        start();
        for (int step = 0; step < kSteps; ++step) {
            compare_means();
            find_levels();
            fill();
        }
        find_levels();
    }

    const Levels& levels() const { return levels_; }

private:
    struct Point {
        Direction direction;
        double radiance, measure, density = 0.0; ///< of what is drawn
        std::size_t place;                       ///< in the coarse grid
    };

    void add(const LightPoint& p) {
        if (!(p.measure > 0.0) || !(p.amount > 0.0)) return;
        double u[2];
        place_of(p.direction, u);
        const auto column = std::min(static_cast<std::uint32_t>(u[0] * grid_.columns), grid_.columns - 1);
        const auto row = std::min(static_cast<std::uint32_t>(u[1] * grid_.rows), grid_.rows - 1);
        points_.push_back(
            {p.direction, p.amount / p.measure, p.measure, 0.0, std::size_t{row} * grid_.columns + column});
    }
    void place_of(const Direction& d, double u[2]) const {
        const AcdfGrid grid{grid_.columns, grid_.rows, static_cast<std::uint32_t>(grid_.parameterization)};
        const float direction[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        std::uint32_t square[2];
        double position[2] = {0.0, 0.0};
        acdf_grid_square(&grid, direction, square, position);
        u[0] = position[0] / grid_.columns;
        u[1] = position[1] / grid_.rows;
    }

    /// The noise of a normal counts relative to its irradiance, that of the darkest to a tenth of the mean: a few
    /// that are nearly black would decide otherwise.
    void weigh_normals() {
        std::vector<double> irradiance(normals_.normals.size(), 0.0);
        tbb::parallel_for(std::size_t{0}, irradiance.size(), [&](std::size_t n) {
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

    /// For each normal the mean of f over the combined density for samples of ours, less that for the company's.
    /// Since the numbers of samples are fixed, only what deviates from its own mean is noise.
    void compare_means() {
        tbb::parallel_for(std::size_t{0}, difference_.size(), [&](std::size_t n) {
            double sum = 0.0;
            for (const Point& p : points_) {
                const double cosine = dot(p.direction, normals_.normals[n]);
                if (!(cosine > 0.0)) continue;
                const double b = lobes_.density(cosine), f = p.radiance * lobes_.brightness(cosine);
                sum += (p.density - b) * (f / (share_ * p.density + (1.0 - share_) * b)) * p.measure;
            }
            difference_[n] = sum;
        });
    }

    /// Means over normals are those where a density begins to pay, at p = 0: there they decide.
    void find_levels() {
        const double scale = effective_density(lobes_.of_all_normals()) / rms_density(lobes_.of_all_normals());
        tbb::parallel_for(std::size_t{0}, levels_.light.values.size(), [&](std::size_t i) {
            const Direction d =
                direction_at(grid_, double(i / grid_.columns) + 0.5, double(i % grid_.columns) + 0.5);
            double square = 0.0, inverse = 0.0, shift = 0.0;
            for (std::size_t n = 0; n < weight_.size(); ++n) {
                const double cosine = dot(d, normals_.normals[n]);
                if (!(cosine > 0.0) || !(weight_[n] > 0.0)) continue;
                const double brightness = lobes_.brightness(cosine), own = weight_[n] * brightness * brightness;
                const double density = lobes_.density(cosine), at_threshold = own / (density * density);
                square += own;
                inverse += at_threshold;
                shift += at_threshold * difference_[n];
            }
            levels_.light.values[i] = std::sqrt(square);
            levels_.density.values[i] = inverse > 0.0 ? std::sqrt(square / inverse) * scale : 0.0;
            levels_.shift.values[i] = inverse > 0.0 ? 2.0 * (1.0 - share_) / ACDF_PI * (shift / inverse) : 0.0;
        });
    }

    void fill() {
        std::vector<double> followed;
        for (const Point& p : points_)
            followed.push_back(
                Levels::followed(levels_.light.values[p.place], levels_.shift.values[p.place], p.radiance));
        const auto taken = [&](std::size_t i, double nu) {
            const double threshold = nu * levels_.density.values[points_[i].place];
            return followed[i] > 0.0 && threshold > 0.0
                       ? filling_.above(followed[i] / threshold) * threshold * points_[i].measure
                       : 0.0;
        };
        double all = 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) all += followed[i] * points_[i].measure;
        if (!(all > 0.0)) return; // as they were
        double low = 1e-6 * all / ratio_, high = all / ratio_, sum = 0.0;
        for (int step = 0; step < 40; ++step) {
            const double nu = std::sqrt(low * high);
            sum = 0.0;
            for (std::size_t i = 0; i < points_.size(); ++i) sum += taken(i, nu);
            (sum > nu * ratio_ ? low : high) = nu;
        }
        sum = 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) sum += taken(i, low);
        for (std::size_t i = 0; i < points_.size(); ++i)
            points_[i].density = sum > 0.0 ? taken(i, low) / points_[i].measure / sum : 0.0;
    }

    const NormalBins& normals_;
    const Lobes& lobes_;
    const Filling& filling_;
    double share_, ratio_;
    Target grid_;
    std::vector<Point> points_;
    std::vector<double> weight_, difference_; ///< one a normal
    Levels levels_;
};

/// Calls `visit(texel, row, column)` for all texels, rows in parallel.
template <class Visit>
void for_each_texel(const Target& target, const Visit& visit) {
    tbb::parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < target.columns; ++c) visit(std::size_t{r} * target.columns + c, r, c);
    });
}

/// nu n_b at which the shares of all texels come to nu n_l.
double solve_threshold(const Target& target, const std::vector<float>& density, const Filling& filling,
                       double ratio) {
    const auto excess = [&](double nu) {
        std::vector<double> rows(target.rows, 0.0);
        for_each_texel(target, [&](std::size_t i, std::uint32_t r, std::uint32_t c) {
            const double threshold = nu * double{density[i]};
            if (threshold > 0.0)
                rows[r] += filling.above(target.values[i] / threshold) * threshold * target.column_measure[c] *
                           target.row_measure[r];
        });
        Sum sum;
        for (const double row : rows) sum.add(row);
        return sum.value() - nu * ratio;
    };
    const double all = integral(target);
    if (!(all > 0.0)) throw std::invalid_argument("the company leaves nothing to be sampled");
    double low = 1e-6 * all / ratio, high = all / ratio;
    for (int step = 0; step < 40; ++step) {
        const double middle = std::sqrt(low * high);
        (excess(middle) > 0.0 ? low : high) = middle;
    }
    return low;
}

void fill(Target& target, const std::vector<float>& density, double nu) {
    target.left.resize(target.values.size());
    target.least.resize(target.values.size());
    for_each_texel(target, [&](std::size_t i, std::uint32_t, std::uint32_t) {
        const double g = target.values[i], threshold = nu * double{density[i]};
        const double left = threshold > 0.0 ? std::min(g * (g / threshold), 3e38) : 3e38;
        target.left[i] = static_cast<float>(left);
        target.least[i] = static_cast<float>(cell_cost(g, left));
    });
}

} // namespace

Target company_target(const Target& target, const NormalBins& normals, const Company& company) {
    Target out = target;
    out.mean_square = 0.0;
    out.peaks.clear();
    if (company.kind == ACDF_COMPANY_MEAN) {
        const double mean = integral(target) / (4.0 * ACDF_PI);
        out.filling = std::make_shared<const Filling>();
        fill(out, std::vector<float>(target.values.size(), 1.0f), 2.0 * (1.0 - company.share()) * mean);
        return out;
    }
    const Lobes lobes(company.kind);
    const auto filling = std::make_shared<const Filling>(lobes.of_all_normals(), company.heuristic);
    const Lighting lighting(target, normals, company, lobes, *filling);
    const Levels& levels = lighting.levels();
    std::vector<float> density(target.values.size());
    const auto follow = [&](double shifted) {
        for_each_texel(target, [&](std::size_t i, std::uint32_t r, std::uint32_t c) {
            const double column = double(c) / target.columns, row = double(r) / target.rows;
            out.values[i] = static_cast<float>(Levels::followed(
                levels.light.at(column, row), shifted * levels.shift.at(column, row), target.values[i]));
            density[i] = static_cast<float>(levels.density.at(column, row));
        });
    };
    follow(1.0);
    if (!(integral(out) > 0.0)) follow(0.0); // an even sky: wherever samples go, they are worth as little
    out.filling = filling;
    fill(out, density, solve_threshold(out, density, *filling, company.light / company.other));
    return out;
}

} // namespace acdf::compress
