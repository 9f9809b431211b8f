// Tables of the RGL material database: interpolation, and the warp that draws from them (Dupuy and Jakob 2018, §4;
// marginal and conditional CDFs of a bilinear density).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::input {

/// The slices of a table around a view and their weights (sum 1): linear in phi and in theta, constant outside.
struct RglMix {
    std::array<std::size_t, 4> slice;
    std::array<double, 4> weight;
    std::size_t count = 0;
};

/// Increasing view angles that a file has slices for, radians; slice = i_phi * theta.size() + i_theta.
struct RglNodes {
    std::vector<float> phi, theta;

    std::size_t slices() const { return phi.size() * theta.size(); }
    RglMix mix(double view_phi, double view_theta) const;
};

/// slices x channels x rows x columns values at the corners of a grid over the unit square, bilinear between them;
/// rows and columns are at least 2. x in [0, 1] runs along columns, y along rows.
struct RglTable {
    std::size_t columns = 0, rows = 0, channels = 1;
    std::vector<float> values;

    std::size_t slice_size() const { return columns * rows; }
    double at(const RglMix& mix, std::size_t index, std::size_t channel = 0) const;
    double bilinear(const RglMix& mix, double x, double y, std::size_t channel = 0) const;
};

/// A density over the unit square for each view, and the map from uniform numbers to it, rows (y) first. Between
/// slices densities and CDFs are interpolated alike, so they stay each other's derivative.
class RglWarp {
public:
    RglWarp() = default;
    /// `table`: one channel, values >= 0 with some > 0 in each slice; scaled here so that each integrates to 1.
    explicit RglWarp(RglTable table);

    struct Point {
        double x = 0.0, y = 0.0;
        double pdf = 0.0; ///< of the density at the point within the square (for invert: at the one given)
    };
    double pdf(const RglMix& mix, double x, double y) const;
    Point sample(const RglMix& mix, double u, double v) const; ///< u, v in [0, 1]: for columns and rows
    Point invert(const RglMix& mix, double x, double y) const; ///< the u, v that sample() maps to (x, y)
    std::size_t bytes() const;
    const RglTable& table() const { return density_; }

private:
    double row_mass(const RglMix& mix, std::size_t row) const; ///< integral of the density along a row's corners
    double cells() const { return static_cast<double>((density_.columns - 1) * (density_.rows - 1)); }
    double marginal(const RglMix& mix, std::size_t row) const;
    double conditional(const RglMix& mix, std::size_t row, std::size_t column, double t) const;

    RglTable density_;               ///< scaled so that the sum over cells of their mean is 1
    std::vector<float> marginal_;    ///< slices x rows: mass below a row
    std::vector<float> conditional_; ///< slices x rows x columns: mass of a row's corners left of a column
};

} // namespace acdf::input
