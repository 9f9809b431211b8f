// Directions that are asked for in benchmarks.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace acdf_bench {

using Directions = std::vector<std::array<float, 3>>;

/// Unit vectors, anywhere.
inline Directions uniform_directions(std::size_t count, unsigned seed) {
    constexpr double turn = 2.0 * 3.14159265358979323846;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Directions out(count);
    for (auto& d : out) {
        const double z = 2.0 * uniform(random) - 1.0, phi = turn * uniform(random), r = std::sqrt(1.0 - z * z);
        d = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
    }
    return out;
}

} // namespace acdf_bench
