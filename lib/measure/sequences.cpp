#include "measure/sequences.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

constexpr std::uint64_t default_seed = 0;

std::uint64_t row_count(std::uint64_t n) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(std::sqrt(static_cast<double>(n)))));
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
    std::array<std::uint32_t, 2> point = {0, 0};
    std::uint32_t digit = 0x80000000u, direction = 0x80000000u; // direction numbers of the two dimensions
    for (; index != 0; index >>= 1) {
        if (index & 1) {
            point[0] ^= digit;
            point[1] ^= direction;
        }
        digit >>= 1;
        direction ^= direction >> 1;
    }
    return point;
}

} // namespace acdf::measure
