// The normals at which rows of bins are mixed, by which rows are made.
#pragma once

#include "compress/local/halved/moments.h"
#include "compress/local/normals.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A normal that samples from a mixture of rows.
struct Mixture {
    std::array<std::uint32_t, 3> bin{};
    std::array<float, 3> weight{}; ///< as a reader weighs the rows; 0: there is none
    float length = 1.0f; ///< |x| + |y| + |z| of the place on a face being the subdivisions: what it weighs in all
    double frequency = 0.0;
};

/// The middle of each triangle of bins that are stored, and each of these bins alone.
struct Mixtures {
    explicit Mixtures(const NormalBins& bins);

    Normals normals; ///< unit
    std::vector<Mixture> of;
    std::vector<std::vector<std::uint32_t>> near; ///< of each bin, those that its row serves
};

} // namespace acdf::compress
