// Directions of tests, and random ones.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace acdf_test {

constexpr double kPi = 3.14159265358979323846;

using Normal = std::array<float, 3>;

inline void direction_of(double phi, double z, float direction[3]) {
    const double sin_theta = std::sqrt((1.0 - z) * (1.0 + z));
    direction[0] = static_cast<float>(sin_theta * std::cos(phi));
    direction[1] = static_cast<float>(sin_theta * std::sin(phi));
    direction[2] = static_cast<float>(z);
}

inline double dot(const float a[3], const float b[3]) {
    return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}

/// In [0, 1), the same with every standard library.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Numbers in [0, 1) that belong to an index: SplitMix64 (Steele et al. 2014).
class NumbersOf {
public:
    explicit NumbersOf(std::uint64_t index) : state_(index) {}
    float next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return static_cast<float>(static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53);
    }

private:
    std::uint64_t state_;
};

/// Uniform over the sphere.
inline Normal random_direction(std::mt19937_64& random) {
    const double z = 2.0 * uniform(random) - 1.0, phi = kPi * (2.0 * uniform(random) - 1.0);
    Normal n;
    direction_of(phi, z, n.data());
    return n;
}

} // namespace acdf_test
