// The numbers of one pixel and one seed: independent, or points that are spread more evenly than those.
#pragma once

#include "measure/sequences.h"

#include <array>
#include <cstdint>
#include <random>

namespace acdf::measure {

/// What pairs of numbers are sampled from.
enum class Numbers {
    independent,
    sobol, ///< each set of pairs is a part of the two-dimensional Sobol' sequence, scrambled anew (ScrambledSobol)
};

/// A set is what one sampler samples for one estimate. Sets are independent of each other: a sequence of many
/// dimensions is padded from such of two.
class Random {
public:
    explicit Random(std::uint64_t seed, Numbers numbers = Numbers::independent)
        : generator_(seed), numbers_(numbers) {}

    /// The next 64 bits, independent of all others.
    std::uint64_t operator()() { return generator_(); }

    /// Pairs from here on are of a new set.
    void begin_set() {
        if (numbers_ == Numbers::sobol) set_ = ScrambledSobol(generator_());
    }
    /// The next point of the set, in [0, 1)^2.
    std::array<double, 2> pair() {
        if (numbers_ == Numbers::sobol) return set_.next();
        const double u0 = unit(generator_());
        return {u0, unit(generator_())};
    }
    /// In [0, 1), independent of all others.
    double uniform() { return unit(generator_()); }

private:
    static double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

    std::mt19937_64 generator_;
    Numbers numbers_;
    ScrambledSobol set_{0};
};

inline double uniform(Random& random) { return random.uniform(); }

} // namespace acdf::measure
