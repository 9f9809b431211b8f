// What every sampler of reflected light must pass: chi-square against its pdf, its integral, and that the
// pdf it reports is the one it evaluates.
#pragma once

#include "measure/samplers/brdf_samplers.h"
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace acdf_test {

inline acdf::compress::View view_at(double cosine, double phi = 0.4) { return {std::sqrt(1.0 - cosine), phi}; }

/// wi in bins of a polar map about the mirror direction's half-vector: 16 of theta_h in steps of its square root
/// and 12 of phi_h; one more for what falls below the horizon.
class HalfBins {
public:
    static constexpr int rows = 16, columns = 12, count = rows * columns + 1, below = rows * columns;

    explicit HalfBins(const acdf::compress::View& view) : view_(view) { view.direction(wo_); }
    int operator()(const double wi[3]) const {
        if (!(wi[2] > 0.0)) return below;
        const double h[3] = {wo_[0] + wi[0], wo_[1] + wi[1], wo_[2] + wi[2]};
        const double t = std::sqrt(std::atan2(std::hypot(h[0], h[1]), h[2]) / (0.5 * kPi));
        double phi = (std::atan2(h[1], h[0]) - view_.phi) / (2.0 * kPi);
        phi -= std::floor(phi);
        return std::min(int(t * rows), rows - 1) * columns + std::min(int(phi * columns), columns - 1);
    }
    /// Integral of a pdf over each bin, by a midpoint sum whose squares lie inside bins; the last one is the
    /// rest.
    template <class Pdf>
    std::vector<double> integrate(const Pdf& pdf, int fine) const {
        std::vector<double> out(count, 0.0);
        double sum = 0.0;
        for (int r = 0; r < rows * fine; ++r) {
            const auto theta = [&](double i) { return 0.5 * kPi * std::pow(i / (rows * fine), 2); };
            const double middle = theta(r + 0.5), band = std::cos(theta(r)) - std::cos(theta(r + 1.0));
            for (int c = 0; c < columns * fine; ++c) {
                const double phi = view_.phi + 2.0 * kPi * (c + 0.5) / (columns * fine);
                const double h[3] = {std::sin(middle) * std::cos(phi), std::sin(middle) * std::sin(phi),
                                     std::cos(middle)};
                const double dot = wo_[0] * h[0] + wo_[1] * h[1] + wo_[2] * h[2];
                const double wi[3] = {2.0 * dot * h[0] - wo_[0], 2.0 * dot * h[1] - wo_[1],
                                      2.0 * dot * h[2] - wo_[2]};
                if (!(dot > 0.0 && wi[2] > 0.0)) continue;
                const double p = pdf(wo_, wi) * 4.0 * dot * band * 2.0 * kPi / (columns * fine);
                out[std::size_t(r / fine * columns + c / fine)] += p;
                sum += p;
            }
        }
        out[below] = 1.0 - sum;
        return out;
    }
    const double* wo() const { return wo_; }

private:
    acdf::compress::View view_;
    double wo_[3];
};

/// `sampler` has sample(wo, u) and pdf(wo, wi). `fine`: squares of the sum along a bin.
template <class Sampler>
void expect_samples_as_its_pdf(const Sampler& sampler, const acdf::compress::View& view, const std::string& name,
                               int fine = 24, std::uint32_t samples = 40000) {
    const HalfBins bins(view);
    const auto pdf = [&](const double wo[3], const double wi[3]) { return sampler.pdf(wo, wi); };
    std::vector<double> probability = bins.integrate(pdf, fine);
    EXPECT_GT(probability[HalfBins::below], -2e-3) << name; // the rest of an integral of at most 1
    probability[HalfBins::below] = std::max(0.0, probability[HalfBins::below]);
    std::vector<std::uint32_t> observed(HalfBins::count);
    std::mt19937_64 random(11);
    std::uint32_t disagree = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const double u[2] = {uniform(random), uniform(random)};
        const acdf::measure::BrdfSample s = sampler.sample(bins.wo(), u);
        const double length2 = s.wi[0] * s.wi[0] + s.wi[1] * s.wi[1] + s.wi[2] * s.wi[2];
        ASSERT_NEAR(length2, 1.0, 1e-9) << name;
        if (!(s.wi[2] > 0.0)) {
            ASSERT_EQ(s.pdf, 0.0) << name;
        }
        const double evaluated = sampler.pdf(bins.wo(), s.wi);
        disagree += !(std::abs(evaluated - s.pdf) <= 1e-4 * s.pdf);
        ++observed[std::size_t(bins(s.wi))];
    }
    // At the border of a cell rounding may find its neighbour.
    EXPECT_LE(disagree, samples / 10000) << name;
    const double below = double(observed[HalfBins::below]) / samples;
    EXPECT_NEAR(below, probability[HalfBins::below], 5.0 * std::sqrt((below + 1e-3) / samples) + 2e-3) << name;
    probability[HalfBins::below] = below; // the sum leaves a little there that no sample finds
    const ChiSquare test = chi_square(observed, probability);
    EXPECT_GT(test.degrees, 5) << name;
    EXPECT_GT(test.p_value, sidak(1e-3, 60)) << name << ": chi-square " << test.statistic << " of " << test.degrees;
    EXPECT_FALSE(test.impossible) << name;
}

} // namespace acdf_test
