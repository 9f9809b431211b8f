// Cells of trees as parts of the eight pieces of the sphere (acdf/shader/pieces.h).
#pragma once

#include "shader/tables/growable.h"

#include <acdf/grid.h>
#include <acdf/shader/pieces.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A cell as the traversal of a tree finds it.
struct Cell {
    double probability;
    std::uint32_t first[2], last[2]; ///< positions
    bool dark;
};

/// The part of a cell's side that lies in one piece of the sphere.
struct Side {
    std::uint32_t piece; ///< quarter, or whether it is south
    double low, high;    ///< random numbers, of those that sample the cell
    double local[2];     ///< at low and high: local azimuth, or 1 - |z|
    double margin[2];    ///< of `local`, in which nothing is sure
    double key;          ///< of acdf_direction_keys, at low; of azimuths alone
};

/// A sample stays this angle (radians) inside its piece: four times ACDF_BORDER, for what floats round.
constexpr double kSideMargin = 0x1p-20;

/// Cuts cells of a lat-long grid.
class Sides {
public:
    Sides(std::uint32_t columns, std::uint32_t rows) : columns_(columns), rows_(rows) {}

    /// Trigonometry of each column and row once, unless they are more than `most`. False where memory fails.
    bool remember(std::size_t most);
    /// Of axis 0 into out[5]; returns how many.
    int azimuths(const Cell& cell, Side* out) const;
    /// Of axis 1 into out[2]; returns how many.
    int heights(const Cell& cell, Side* out) const;
    /// The pdf of a cell, sr^-1; 0 for a dark one.
    float density(const Cell& cell) const;

private:
    /// What the trigonometry of a border between rows gives.
    struct Row {
        double z, cap; ///< cosine, 1 - |cosine|
        double margin; ///< of the angle, as a difference of z
    };
    double tangent(std::uint32_t column) const {
        return column < tangents_.size() ? tangents_[column] : tangent_of(column, columns_);
    }
    static double tangent_of(std::uint32_t column, std::uint32_t columns);
    Row row(std::uint32_t row) const { return row < heights_.size() ? heights_[row] : row_of(row, rows_); }
    static Row row_of(std::uint32_t row, std::uint32_t rows);

    std::uint32_t columns_, rows_;
    Growable<double> tangents_;
    Growable<Row> heights_;
};

} // namespace acdf
