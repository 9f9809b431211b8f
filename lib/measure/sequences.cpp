#include "measure/sequences.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

constexpr std::uint64_t default_seed = 0;

std::uint64_t row_count(std::uint64_t n) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(std::sqrt(static_cast<double>(n)))));
}

std::uint32_t reversed(std::uint32_t x) {
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0F0F0F0Fu) << 4 | (x >> 4 & 0x0F0F0F0Fu);
    x = (x & 0x00FF00FFu) << 8 | (x >> 8 & 0x00FF00FFu);
    return x << 16 | x >> 16;
}

} // namespace

Sequence::Sequence(SequenceKind kind, std::uint64_t n, std::optional<std::uint64_t> seed)
    : kind_(kind), n_(n), rows_(row_count(n)), random_(seed.value_or(default_seed)) {
    if (kind == SequenceKind::sobol && seed) {
        const std::uint64_t bits = random_();
        shift_ = {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
    }
}

std::array<double, 2> Sequence::next() {
    switch (kind_) {
    case SequenceKind::stratified:
        return next_stratified();
    case SequenceKind::sobol:
        return next_sobol();
    case SequenceKind::random:
        break;
    }
    const double u0 = uniform();
    return {u0, uniform()};
}

void Sequence::next(double* point, std::size_t dimensions) {
    if (kind_ == SequenceKind::random) {
        std::generate_n(point, dimensions, [this] { return uniform(); });
        return;
    }
    const std::array<double, 2> pair = next();
    std::copy_n(pair.begin(), std::min<std::size_t>(dimensions, 2), point);
}

// Not std::uniform_real_distribution: the standard leaves its arithmetic to the library.
double Sequence::uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

// Any n, not only products: row i of R holds the points i n / R to (i + 1) n / R, has a height in proportion to
// their number, and is cut into as many equal boxes. So every box has the area 1 / n.
std::array<double, 2> Sequence::next_stratified() {
    const auto first_of = [this](std::uint64_t row) { return row * (n_ / rows_) + std::min(row, n_ % rows_); };
    const std::uint64_t count = first_of(row_ + 1) - first_of(row_);
    const double n = static_cast<double>(n_);
    const double u0 = (static_cast<double>(in_row_) + uniform()) / static_cast<double>(count);
    const double u1 = (static_cast<double>(first_of(row_)) + static_cast<double>(count) * uniform()) / n;
    if (++in_row_ == count) ++row_, in_row_ = 0;
    constexpr double below_one = 1.0 - 0x1p-53; // the sums may round up
    return {std::min(u0, below_one), std::min(u1, below_one)};
}

std::array<double, 2> Sequence::next_sobol() {
    const auto point = sobol_point(static_cast<std::uint32_t>(index_++));
    return {(point[0] ^ shift_[0]) * 0x1p-32, (point[1] ^ shift_[1]) * 0x1p-32};
}

std::array<std::uint32_t, 2> sobol_point(std::uint32_t index) {
    const std::uint32_t digits = reversed(index);
    // Pascal's triangle modulo 2, which is made of [[1, 1], [0, 1]] by Kronecker products: a step a factor.
    std::uint32_t second = digits;
    second ^= (second & 0x0000FFFFu) << 16;
    second ^= (second & 0x00FF00FFu) << 8;
    second ^= (second & 0x0F0F0F0Fu) << 4;
    second ^= (second & 0x33333333u) << 2;
    second ^= (second & 0x55555555u) << 1;
    return {digits, second};
}

std::uint64_t mixed(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return bits ^ (bits >> 31);
}

// Sums, products and shifts to the left carry upwards alone: on reversed digits a digit depends on those before it.
std::uint32_t owen_scramble(std::uint32_t fraction, std::uint32_t seed) {
    std::uint32_t x = reversed(fraction);
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return reversed(x);
}

ScrambledSobol::ScrambledSobol(std::uint64_t seed) {
    const std::uint64_t a = mixed(seed), b = mixed(a + 0x9E3779B97F4A7C15u);
    order_ = static_cast<std::uint32_t>(a);
    seeds_[0] = static_cast<std::uint32_t>(b);
    seeds_[1] = static_cast<std::uint32_t>(b >> 32);
}

// A scrambled index moves whole blocks of 2^k indices that begin at a multiple of 2^k to others of that kind.
std::array<double, 2> ScrambledSobol::next() {
    const std::array<std::uint32_t, 2> point = sobol_point(owen_scramble(index_++, order_));
    return {owen_scramble(point[0], seeds_[0]) * 0x1p-32, owen_scramble(point[1], seeds_[1]) * 0x1p-32};
}

} // namespace acdf::measure
