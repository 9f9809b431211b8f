#include "build/accuracy/partner.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/combination.h"
#include "build/accuracy/fine_texels.h"
#include "build/accuracy/texel_cosines.h"
#include "compress/parallel.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace acdf::build {
namespace {

constexpr std::size_t kGuess = 8; // every so manieth normal guesses which it is

/// sr^-1, of each texel.
std::vector<double> densities(const File& file, const FineTexels& texels) {
    const compress::Target& target = texels.target();
    std::vector<double> out(std::size_t{target.columns} * target.rows);
    const AcdfEnvironment environment = file.environment().data();
    const AcdfGrid grid = acdf_environment_grid(&environment);
    for_each_cell(file.environment(), [&](const Cell& cell) {
        if (cell.range[0].tilt != 0.0 || cell.range[1].tilt != 0.0)
            throw std::invalid_argument("tilted curves in a file for an MIS partner");
        const double p = cell.probability / acdf_grid_solid_angle(&grid, untilted(cell.range).data());
        const std::array<AcdfTiltedRange, 2> range = texels.box(cell.range);
        for (std::uint32_t r = range[1].low; r < range[1].high; ++r)
            for (std::uint32_t c = range[0].low; c < range[0].high; ++c)
                out[std::size_t{r} * target.columns + c] = p;
    });
    return out;
}

class Measure {
public:
    Measure(const File& file, const compress::Target& target, Texels texels)
        : partner_(*file.partner()), texels_(target, texels), target_(texels_.target()),
          density_(densities(file, texels_)), cosines_(target_) {}

    Combination of(const Normal& n) const {
        const Combination none{double{partner_.share}, static_cast<AcdfHeuristic>(partner_.heuristic)};
        Combination out = none;
        for (std::uint32_t r = 0; r < target_.rows; ++r) {
            Combination row = none;
            for_each_lit(n, r, [&](double f, double omega, double p, double b, std::size_t i) {
                double means[3];
                const std::size_t channels = compress::means_of(target_, i, means);
                const double cosine = ACDF_PI * b;
                for (std::size_t k = 0; k < channels; ++k) means[k] *= cosine;
                row.add(f, means, channels, omega, p, b);
            });
            out.add(row);
        }
        return out;
    }

    /// Second moments of the integrand of a normal by the balance heuristic, with `Count` shares from number
    /// `first` on.
    template <std::size_t Count>
    std::array<double, Count> second_moments(const Normal& n, std::size_t first) const {
        std::array<double, Count> out{}, share{};
        for (std::size_t k = 0; k < Count; ++k) share[k] = recommendable_share(first + k);
        for (std::uint32_t r = 0; r < target_.rows; ++r) {
            std::array<double, Count> row{};
            for_each_lit(n, r, [&](double f, double omega, double p, double b, std::size_t) {
                for (std::size_t k = 0; k < Count; ++k)
                    row[k] += f / (share[k] * p + (1.0 - share[k]) * b) * f * omega;
            });
            for (std::size_t k = 0; k < Count; ++k) out[k] += row[k];
        }
        return out;
    }

    double irradiance(const Normal& n) const {
        double sum = 0.0;
        for (std::uint32_t r = 0; r < target_.rows; ++r)
            for_each_lit(n, r, [&](double f, double omega, double, double, std::size_t) { sum += f * omega; });
        return sum;
    }

private:
    template <class Visit>
    void for_each_lit(const Normal& n, std::uint32_t r, const Visit& visit) const {
        const float length = std::hypot(n[0], n[1], n[2]);
        const float unit[3] = {n[0] / length, n[1] / length, n[2] / length};
        cosines_.for_each_above(unit, r, [&](std::uint32_t c, double cosine) {
            const std::size_t i = std::size_t{r} * target_.columns + c;
            const double f = double{target_.values[i]} * cosine;
            if (f > 0.0)
                visit(f, target_.row_measure[r] * target_.column_measure[c], density_[i], cosine / ACDF_PI, i);
        });
    }

    const AcdfPartner& partner_;
    const FineTexels texels_;
    const compress::Target& target_;
    std::vector<double> density_;
    TexelCosines cosines_;
};

/// The sum over normals, relative to their own irradiance, of second moments with `Count` shares from `first` on.
template <std::size_t Count>
std::array<double, Count> sum_moments(const Measure& measure, const std::vector<Normal>& normals,
                                      const std::vector<double>& irradiance, std::size_t every, std::size_t first) {
    double mean = 0.0;
    for (const double e : irradiance) mean += e / double(irradiance.size());
    std::vector<std::array<double, Count>> of(normals.size());
    compress::parallel_for(std::size_t{0}, (normals.size() + every - 1) / every, [&](std::size_t i) {
        if (irradiance[i * every] > 0.0) of[i * every] = measure.second_moments<Count>(normals[i * every], first);
    });
    std::array<double, Count> sum{};
    for (std::size_t i = 0; i < of.size(); i += every)
        for (std::size_t k = 0; k < Count; ++k)
            sum[k] += of[i][k] / (irradiance[i] * irradiance[i] + 0.01 * mean * mean);
    return sum;
}

template <std::size_t Count>
std::size_t least(const std::array<double, Count>& of) {
    return static_cast<std::size_t>(std::min_element(of.begin(), of.end()) - of.begin());
}

} // namespace

PartnerAccuracy measure_beside_partner(const File& file, const compress::Target& target,
                                       const std::vector<Normal>& normals) {
    const Measure measure(file, target, Texels::divided);
    std::vector<Combination> of(normals.size(), Combination{0.5, ACDF_HEURISTIC_BALANCE});
    compress::parallel_for(std::size_t{0}, normals.size(), [&](std::size_t i) { of[i] = measure.of(normals[i]); });
    PartnerAccuracy out;
    double lit = 0.0;
    for (const Combination& one : of) {
        out.support_violations += one.violations();
        if (!(one.integral() > 0.0)) continue;
        lit += 1.0;
        out.relative_variance += one.relative_variance();
        out.max_weight = std::max(out.max_weight, one.max_weight());
    }
    if (lit > 0.0) out.relative_variance /= lit;
    return out;
}

double recommended_light_share(const File& file, const compress::Target& target,
                               const std::vector<Normal>& normals) {
    const Measure measure(file, target, Texels::own);
    std::vector<double> irradiance(normals.size());
    compress::parallel_for(std::size_t{0}, normals.size(),
                           [&](std::size_t i) { irradiance[i] = measure.irradiance(normals[i]); });
    if (std::none_of(irradiance.begin(), irradiance.end(), [](double e) { return e > 0.0; })) return 1.0;
    // The sum is convex: a share with less than both beside it has the least of all. A few normals guess which.
    std::size_t best = least(sum_moments<recommendable_shares>(measure, normals, irradiance, kGuess, 0));
    for (;;) {
        const std::size_t first = std::clamp<std::size_t>(best, 1, recommendable_shares - 2) - 1;
        const std::size_t found = first + least(sum_moments<3>(measure, normals, irradiance, 1, first));
        if (found == best) return recommendable_share(best);
        best = found;
    }
}

} // namespace acdf::build
