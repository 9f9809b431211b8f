// Numbers, vectors and directions as careless callers have them.
#pragma once

#include <acdf/elementary.h>

#include <cmath>
#include <cstdint>

namespace acdf_test {

/// splitmix64: cheap to start, as each input starts one.
class FuzzRandom {
public:
    explicit FuzzRandom(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(next() % n); }
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

    /// A random number as careless callers have them: mostly in [0, 1), the ends, beyond them, NaN.
    double any_u() {
        static const double edges[] = {0.0,      1.0,       0.5,   1.0 - 0x1p-24, 1.0 - 0x1p-53, 0x1p-30,
                                       0x1p-149, 0x1p-1074, -0.25, 1.5,           HUGE_VAL,      std::nan("")};
        return below(3) == 0 ? edges[below(sizeof edges / sizeof *edges)] : uniform();
    }
    /// A vector in [-1, 1]^3: often along axes, in planes of the seam and of the equator, at times not finite.
    void any_vector(float v[3]) {
        static const float edges[] = {0.0f, -0.0f, 1.0f, -1.0f, 0x1p-24f, 1e-38f, 3e38f, HUGE_VALF, std::nanf("")};
        const std::uint32_t choice = below(8);
        for (int k = 0; k < 3; ++k)
            v[k] = choice == 0   ? edges[below(sizeof edges / sizeof *edges)]
                   : choice == 1 ? static_cast<float>(static_cast<int>(below(3)) - 1)
                                 : static_cast<float>(2.0 * uniform() - 1.0);
    }
    void unit_vector(float v[3], bool upper) {
        const double z = below(8) == 0 ? static_cast<double>(below(2)) : upper ? uniform() : 2.0 * uniform() - 1.0;
        const double phi = below(8) == 0 ? 0.5 * ACDF_PI * below(4) : 2.0 * ACDF_PI * uniform();
        const double r = std::sqrt(1.0 - z * z);
        v[0] = static_cast<float>(r * std::cos(phi));
        v[1] = static_cast<float>(r * std::sin(phi));
        v[2] = static_cast<float>(z);
    }
    /// Number n of many: each fourth may be no direction.
    void mostly_unit_vector(int n, float v[3], bool upper) {
        if (n % 4 == 3) any_vector(v);
        else unit_vector(v, upper);
    }

private:
    std::uint64_t state_;
};

inline constexpr int samples_a_file = 24;

} // namespace acdf_test
