// Counts normals by direction, in memory that does not grow with their number.
#pragma once

#include "input/normals/scene.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace acdf::input {

class NormalHistogram {
public:
    explicit NormalHistogram(UpAxis up) : up_(up) {}

    /// Adds a normal of any length > 0; one that is zero or not finite is counted as skipped.
    void add(double x, double y, double z, double weight);
    void skip() { ++skipped_; }

    /// The mean of the normals in each cell that has any, in the order of the cells.
    std::vector<WeightedNormal> normals() const;
    std::uint64_t skipped() const { return skipped_; }

private:
    /// Sums of what fell into a cell of the octahedral map.
    struct Cell {
        double x = 0.0, y = 0.0, z = 0.0, weight = 0.0;
    };
    UpAxis up_;
    std::unordered_map<std::uint32_t, Cell> cells_; ///< at most 2^20
    std::uint64_t skipped_ = 0;
};

} // namespace acdf::input
