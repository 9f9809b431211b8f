// Sequences of points in the unit square for `acdf sample`: the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

namespace acdf::measure {

enum class SequenceKind { random, stratified, sobol };

/// n points in [0, 1)^2, one by one.
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

} // namespace acdf::measure
