// What every sampler of incident light must pass at a point: the integral of its pdf, that samples report it,
// and chi-square.
#pragma once

#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"
#include "tests/lib/measure/samplers/square_texels.h"

#include "measure/samplers/light_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace acdf_test {

inline acdf::measure::ShadingPoint shading_point(const float n[3], const float wo[3]) {
    acdf::measure::ShadingPoint point;
    std::copy_n(n, 3, point.n);
    std::copy_n(wo, 3, point.wo);
    return point;
}
/// Seen from above.
inline acdf::measure::ShadingPoint facing(const Normal& n) { return shading_point(n.data(), n.data()); }

/// Bins of a lat-long grid, each summed over fine x fine directions evenly in phi and z; or of the octahedral
/// square, evenly in u and v.
struct SphereBins {
    std::uint32_t columns, rows, fine = 1;
    bool square = false;

    std::size_t count() const { return std::size_t{columns} * rows; }
    std::size_t operator()(const float w[3]) const {
        if (square) return square_texel(columns, rows, w);
        const double x = w[0], y = w[1], z = w[2];
        const double column = columns * (0.5 - std::atan2(y, x) / (2.0 * kPi));
        const double row = rows * std::atan2(std::hypot(x, y), z) / kPi;
        return std::size_t(std::min(row, rows - 1.0)) * columns + std::size_t(std::min(column, columns - 1.0));
    }
    template <class Visit> // visit(bin, direction, solid angle)
    void for_each(const Visit& visit) const {
        if (square)
            return for_each_square_direction(
                columns, rows, fine, [&](std::size_t bin, const double* d, double omega) {
                    const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]),
                                        static_cast<float>(d[2])};
                    visit(bin, w, omega);
                });
        for (std::uint32_t r = 0; r < rows; ++r) {
            const double top = std::cos(kPi * r / rows), foot = std::cos(kPi * (r + 1.0) / rows);
            const double omega = (top - foot) * 2.0 * kPi / columns / (double(fine) * fine);
            for (std::uint32_t i = 0; i < fine; ++i)
                for (std::uint32_t j = 0; j < columns * fine; ++j) {
                    float w[3];
                    direction_of(kPi - 2.0 * kPi * (j + 0.5) / (double(columns) * fine),
                                 top + (foot - top) * (i + 0.5) / fine, w);
                    visit(std::size_t{r} * columns + j / fine, w, omega);
                }
        }
    }
};

struct SamplerCheck {
    int samples = 20000;
    double tolerance = 1e-5;  ///< of the integral of the pdf, which bins sum up
    double disagreeing = 0.0; ///< share of samples whose pdf may differ from pdf(): at borders of cells
    double significance = sidak(0.01, 200);
};

/// What is sampled in vain has an outcome of its own: what the integral of the pdf lacks of 1.
inline void expect_samples_as_its_pdf(const acdf::measure::LightSampler& sampler,
                                      const acdf::measure::ShadingPoint& at, const SphereBins& bins,
                                      const std::string& name, const SamplerCheck& check = {},
                                      double integral = 1.0) {
    const auto point = sampler.point_sampler();
    point->move_to(at);
    std::vector<double> probability(bins.count() + 1, 0.0);
    double sum = 0.0;
    bins.for_each([&](std::size_t bin, const float* w, double omega) {
        const float p = point->pdf(w);
        ASSERT_TRUE(std::isfinite(p) && p >= 0.0f) << name;
        probability[bin] += p * omega;
        sum += p * omega;
    });
    EXPECT_NEAR(sum, integral, check.tolerance) << name;
    probability.back() = std::max(0.0, 1.0 - sum);
    if (probability.back() < check.tolerance) probability.back() = 0.0;
    std::vector<std::uint32_t> observed(probability.size(), 0);
    std::mt19937_64 random(21);
    int disagree = 0;
    for (int i = 0; i < check.samples; ++i) {
        const double u0 = uniform(random), u1 = uniform(random);
        const AcdfDirectionSample s = point->sample(u0, u1);
        if (!(s.pdf > 0.0f)) {
            ++observed.back();
            continue;
        }
        ++observed[bins(s.direction)];
        disagree += !(std::abs(point->pdf(s.direction) / s.pdf - 1.0f) < 1e-4f);
    }
    EXPECT_LE(disagree, check.disagreeing * check.samples) << name;
    const ChiSquare test = chi_square(observed, probability);
    EXPECT_FALSE(test.impossible) << name;
    EXPECT_GT(test.p_value, check.significance) << name;
}

} // namespace acdf_test
