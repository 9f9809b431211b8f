// Sums over the cells of a file that give its accuracy.
#pragma once

#include "compress/sum.h"

#include <algorithm>
#include <cstdint>

namespace acdf::build {

/// Sums over cells. Each texel's terms are added to those of the cells before it.
struct Sums {
    compress::PlainerSum variance, square_error, kl;
    double max_weight = 0.0;
    std::uint64_t violations = 0;

    void add(const Sums& other) {
        variance.add(other.variance.value());
        square_error.add(other.square_error.value());
        kl.add(other.kl.value());
        max_weight = std::max(max_weight, other.max_weight);
        violations += other.violations;
    }
};

} // namespace acdf::build
