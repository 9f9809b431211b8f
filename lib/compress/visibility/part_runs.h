// Tiles that follow each other, joined to parts where visibility cells lose least by it.
#pragma once

#include "compress/visibility/sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Light, and where it lies.
struct Spread {
    double light = 0.0;
    std::array<double, 3> middle{}; ///< the sum of directions, each as long as its light

    void add(const Spread& other) {
        light += other.light;
        for (std::size_t k = 0; k < 3; ++k) middle[k] += other.middle[k];
    }
    /// An edge of what hides light crosses it the more likely the wider it is spread.
    double width() const {
        const double length = middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2];
        return std::sqrt(std::max(light * light - length, 0.0));
    }
};

class PartRuns {
public:
    /// `edges`: of tiles, the likelier edges cross it the more of it.
    explicit PartRuns(std::vector<Spread> edges);

    /// What cells see of a part: its `tiles`, from `first` on, have these shares of it.
    void know(const std::vector<VisibilitySums>& cells, std::size_t part, std::uint32_t first,
              const std::vector<double>& shares);
    /// Joins neighbours, those that cost least first, until `count` are left. Returns the first tile of each.
    std::vector<std::uint32_t> join(std::size_t count);

private:
    double rise(std::size_t i) const;
    double root_of_both(std::size_t a, std::size_t b) const;
    void merge(std::size_t a, std::size_t b);

    std::vector<Spread> edges_;
    std::vector<std::uint32_t> first_; ///< of the runs that are left: where they lie in the rest
    std::size_t cells_ = 0;
    std::vector<float> all_, seen_; ///< of each run, one a cell
    std::vector<double> roots_;     ///< of second moments, summed over cells
};

} // namespace acdf::compress
