// What BRDF files are asked in tests.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

namespace acdf_test {

/// Views, random numbers and directions: likely ones, and those that are refused or lie at an end.
class BrdfQueries {
public:
    BrdfQueries(const acdf::BrdfView& view, std::size_t count) : wo_(3 * count), wi_(3 * count), u_(2 * count) {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double ends[] = {0.0,           1.0,      -1.0,         0.5,      2.0,
                               1.0 - 0x1p-24, 0x1p-149, std::nan(""), infinity, -infinity};
        for (std::size_t i = 0; i < count; ++i) {
            direction(&wo_[3 * i], std::pow(uniform(random), 1.0 + double(i % 3)), 7.0 * uniform(random));
            for (std::size_t k = 0; k < 2; ++k)
                u_[2 * i + k] = i % 13 == 4 * k ? ends[random() % std::size(ends)] : uniform(random);
            if (i % 7 == 3) wo_[3 * i + 2] *= -1.0f;
            if (i % 31 == 5) wo_[3 * i + i % 3] = not_a_direction(random());
            if (i % 37 == 6) direction(&wo_[3 * i], 1.0, 0.0);
            if (i % 41 == 7) direction(&wo_[3 * i], 1e-6, 3.0);
            // Half of wi are sampled, so that they are where pdfs are large.
            const acdf::DirectionSample s = view.sample(wo()[i], u()[i][0], u()[i][1]);
            if (i % 2 == 0 && s.pdf > 0.0f) std::memcpy(&wi_[3 * i], s.direction, sizeof s.direction);
            else direction(&wi_[3 * i], 2.0 * uniform(random) - 1.0, 7.0 * uniform(random));
            if (i % 17 == 8)
                for (std::size_t k = 0; k < 3; ++k) wi_[3 * i + k] = -wo_[3 * i + k];
            if (i % 19 == 3) { // a half-vector in the surface: the last row
                const double x = double{wo_[3 * i]}, y = double{wo_[3 * i + 1]};
                wi_[3 * i] = float(std::cos(1.0) * x + std::sin(1.0) * y);
                wi_[3 * i + 1] = float(std::cos(1.0) * y - std::sin(1.0) * x);
                wi_[3 * i + 2] = -wo_[3 * i + 2];
            }
            if (i % 29 == 9) wi_[3 * i + i % 3] = not_a_direction(random());
        }
    }

    const float (*wo() const)[3] { return reinterpret_cast<const float(*)[3]>(wo_.data()); }
    const float (*wi() const)[3] { return reinterpret_cast<const float(*)[3]>(wi_.data()); }
    const double (*u() const)[2] { return reinterpret_cast<const double(*)[2]>(u_.data()); }

private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    static void direction(float* out, double z, double phi) {
        const double r = std::sqrt(1.0 - z * z);
        out[0] = float(r * std::cos(phi));
        out[1] = float(r * std::sin(phi));
        out[2] = float(z);
    }
    static float not_a_direction(std::uint64_t random) {
        const float all[] = {std::nanf(""), 1e30f, -std::numeric_limits<float>::infinity(), 1.01f};
        return all[random % std::size(all)];
    }

    std::vector<float> wo_, wi_;
    std::vector<double> u_;
};

} // namespace acdf_test
