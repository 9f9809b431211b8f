// Sequences of points in the unit square: the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

namespace acdf::measure {

enum class SequenceKind { random, stratified, sobol };

/// n points in [0, 1)^2, one by one: those of `acdf sample`.
class Sequence {
public:
    /// `seed` of `sobol`: none is the plain sequence, any number a random digital shift of it.
    Sequence(SequenceKind kind, std::uint64_t n, std::optional<std::uint64_t> seed);

    std::array<double, 2> next();
    /// A point in [0, 1)^dimensions: any number of them for `random`, 2 for the others.
    void next(double* point, std::size_t dimensions);

private:
    SequenceKind kind_;
    std::uint64_t n_, rows_;
    std::uint64_t index_ = 0;
    std::uint64_t row_ = 0, in_row_ = 0; // stratified: where point index_ lies
    std::array<std::uint32_t, 2> shift_ = {0, 0};
    std::mt19937_64 random_;

    double uniform();
    std::array<double, 2> next_stratified();
    std::array<double, 2> next_sobol();
};

/// The two-dimensional Sobol' point of 32-bit fixed-point digits: van der Corput, and the dimension of the
/// polynomial x + 1 (Sobol' 1967; Bratley and Fox 1988). Together a (0, 2)-sequence in base 2.
std::array<std::uint32_t, 2> sobol_point(std::uint32_t index);

/// The finalizer of splitmix64: a bijection whose every output bit depends on every input bit.
std::uint64_t mixed(std::uint64_t bits);

/// A nested uniform scrambling in base 2 (Owen 1995) of a 32-bit fraction: each digit is flipped or not by a hash
/// of the digits before it and of `seed`. The hash is that of Laine and Karras (EGSR 2011) as Burley (JCGT 9(4),
/// 2020) uses it, with the constants of Vegdahl (2021). Points of a (0, 2)-sequence stay one.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed);

/// The Sobol' points of two dimensions, their order and both coordinates scrambled by seeds made of `seed`. Every
/// point is uniform in the square, so that sums over any number of them are unbiased; the first 2^k are a
/// (0, k, 2)-net. Different seeds are as good as independent: pairs of many dimensions are padded with them.
class ScrambledSobol {
public:
    explicit ScrambledSobol(std::uint64_t seed);

    /// In [0, 1)^2.
    std::array<double, 2> next();

private:
    std::uint32_t index_ = 0, order_, seeds_[2];
};

} // namespace acdf::measure
