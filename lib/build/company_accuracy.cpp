#include "build/company_accuracy.h"

#include "build/cells.h"
#include "build/combination.h"
#include "build/texel_cosines.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

namespace acdf::build {
namespace {

constexpr std::size_t kShares = 31; // shares that are tried

/// Of one normal.
struct OfNormal {
    Combination combination{0.5, ACDF_HEURISTIC_BALANCE};
    std::array<double, kShares> second{}; ///< by the balance heuristic, with each share
};

/// sr^-1, of each texel.
std::vector<double> densities(const File& file, const compress::Target& target) {
    std::vector<double> out(std::size_t{target.columns} * target.rows);
    const AcdfEnvironment environment = file.environment().data();
    const AcdfGrid grid = acdf_environment_grid(&environment);
    for_each_cell(file, file.bin(0).root, [&](const Cell& cell) {
        if (cell.range[0].tilt != 0.0 || cell.range[1].tilt != 0.0)
            throw std::invalid_argument("tilted curves beside a company");
        const double p = cell.probability / acdf_grid_solid_angle(&grid, cell.range);
        for (std::uint32_t r = cell.range[1].low; r < cell.range[1].high; ++r)
            for (std::uint32_t c = cell.range[0].low; c < cell.range[0].high; ++c)
                out[std::size_t{r} * target.columns + c] = p;
    });
    return out;
}

class Measure {
public:
    Measure(const File& file, const compress::Target& target)
        : company_(*file.company()), target_(target), density_(densities(file, target)), cosines_(target) {}

    OfNormal of(const Normal& n) const {
        OfNormal out;
        out.combination = row_sum();
        const float length = std::hypot(n[0], n[1], n[2]);
        const float unit[3] = {n[0] / length, n[1] / length, n[2] / length};
        for (std::uint32_t r = 0; r < target_.rows; ++r) {
            Combination row = row_sum();
            std::array<double, kShares> second{};
            cosines_.for_each_above(unit, r, [&](std::uint32_t c, double cosine) {
                const std::size_t i = std::size_t{r} * target_.columns + c;
                const double f = double{target_.values[i]} * cosine, b = cosine / ACDF_PI, p = density_[i];
                const double omega = target_.row_measure[r] * target_.column_measure[c];
                if (!(f > 0.0)) return;
                row.add(f, omega, p, b);
                for (std::size_t k = 0; k < kShares; ++k)
                    second[k] += f / (share(k) * p + (1.0 - share(k)) * b) * f * omega;
            });
            out.combination.add(row);
            for (std::size_t k = 0; k < kShares; ++k) out.second[k] += second[k];
        }
        return out;
    }

    static double share(std::size_t k) { return (double(k) + 1.0) / (double(kShares) + 1.0); }

private:
    Combination row_sum() const { return {double{company_.share}, static_cast<AcdfHeuristic>(company_.heuristic)}; }

    const AcdfCompany& company_;
    const compress::Target& target_;
    std::vector<double> density_;
    TexelCosines cosines_;
};

} // namespace

CompanyAccuracy measure_beside_company(const File& file, const compress::Target& target,
                                       const std::vector<Normal>& normals) {
    const Measure measure(file, target);
    std::vector<OfNormal> of(normals.size());
    tbb::parallel_for(std::size_t{0}, normals.size(), [&](std::size_t i) { of[i] = measure.of(normals[i]); });
    CompanyAccuracy out;
    std::array<double, kShares> second{};
    double mean = 0.0, lit = 0.0;
    for (const OfNormal& one : of) mean += one.combination.integral() / double(of.size());
    for (const OfNormal& one : of) {
        out.support_violations += one.combination.violations();
        const double e = one.combination.integral();
        if (!(e > 0.0)) continue;
        lit += 1.0;
        out.relative_variance += one.combination.relative_variance();
        out.max_weight = std::max(out.max_weight, one.combination.max_weight());
        for (std::size_t k = 0; k < kShares; ++k) second[k] += one.second[k] / (e * e + 0.01 * mean * mean);
    }
    if (!(lit > 0.0)) return out;
    out.relative_variance /= lit;
    const auto best = std::min_element(second.begin(), second.end()) - second.begin();
    out.recommended_share = Measure::share(static_cast<std::size_t>(best));
    return out;
}

} // namespace acdf::build
