// Tables of the RGL material database: interpolation, and the warp that samples from them (Dupuy and Jakob 2018,
// §4; marginal and conditional CDFs of a bilinear pdf).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::input {

// Real: float as its authors' program computes, double to evaluate what was measured. Values are floats in both.

/// The slices of a table around a view and their weights (sum 1): linear in phi and in theta, constant outside.
template <class Real>
struct RglMix {
    std::array<std::size_t, 4> slice;
    std::array<Real, 4> weight;
    std::size_t count = 0;
};

/// Increasing view angles that a file has slices for, radians; slice = i_phi * theta.size() + i_theta.
struct RglNodes {
    std::vector<float> phi, theta;

    std::size_t slices() const { return phi.size() * theta.size(); }
    template <class Real>
    RglMix<Real> mix(Real view_phi, Real view_theta) const;
};

/// slices x channels x rows x columns values at the corners of a grid over the unit square, bilinear between them;
/// rows and columns are at least 2. x in [0, 1] runs along columns, y along rows.
struct RglTable {
    std::size_t columns = 0, rows = 0, channels = 1;
    std::vector<float> values;

    std::size_t slice_size() const { return columns * rows; }
    template <class Real>
    Real at(const RglMix<Real>& mix, std::size_t index, std::size_t channel = 0) const;
    /// A point as the corner below it and how far it is from there to the next one along columns and rows.
    template <class Real>
    struct Place {
        std::size_t corner;
        Real column, row;
    };
    template <class Real>
    Place<Real> place(Real x, Real y) const;
    template <class Real>
    Real bilinear(const RglMix<Real>& mix, const Place<Real>& place, std::size_t channel = 0) const;
};

/// A pdf over the unit square for each view, and the map from uniform numbers to it, rows (y) first. Between
/// slices pdfs and CDFs are interpolated alike, so they stay each other's derivative.
class RglWarp {
public:
    RglWarp() = default;
    /// `table`: one channel, values >= 0 with some > 0 in each slice; scaled here so that each integrates to 1.
    explicit RglWarp(RglTable table);

    template <class Real>
    struct Point {
        Real x = 0, y = 0;
        Real pdf = 0; ///< of the pdf at the point within the square (for invert: at the one given)
    };
    template <class Real>
    Real pdf(const RglMix<Real>& mix, Real x, Real y) const;
    template <class Real>
    Point<Real> sample(const RglMix<Real>& mix, Real u, Real v) const; ///< u, v in [0, 1]: for columns and rows
    template <class Real>
    Point<Real> invert(const RglMix<Real>& mix, Real x, Real y) const; ///< the u, v that sample() maps to (x, y)
    std::size_t bytes() const;
    const RglTable& table() const { return density_; }

private:
    /// Integral of the pdf along a row's corners.
    template <class Real>
    Real row_mass(const RglMix<Real>& mix, std::size_t row) const;
    template <class Real>
    Real cells() const {
        return static_cast<Real>((density_.columns - 1) * (density_.rows - 1));
    }
    template <class Real>
    Real marginal(const RglMix<Real>& mix, std::size_t row) const;
    template <class Real>
    Real conditional(const RglMix<Real>& mix, std::size_t row, std::size_t column, Real t) const;

    RglTable density_;               ///< scaled so that the sum over cells of their mean is 1
    std::vector<float> marginal_;    ///< slices x rows: mass below a row
    std::vector<float> conditional_; ///< slices x rows x columns: mass of a row's corners left of a column
};

} // namespace acdf::input
