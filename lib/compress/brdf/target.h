// What a BRDF file approximates: for each view the reflected light over half-vectors.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// rho(wo, wi) max(0, cos(theta_i)) as one number >= 0, for unit vectors above the surface (z is its normal).
/// Reciprocity is not assumed. Called by several threads at once.
using Reflected = std::function<double(const double wo[3], const double wi[3])>;

/// What is known of a BRDF beside its values.
struct BrdfSymmetry {
    bool isotropic = true; ///< depends on the difference of azimuths alone: one indexed axis
    bool mirrored = true;  ///< and not on its sign: half the table, exactly
};

/// A direction of view. `x` is sqrt(1 - cos(theta_o)), phi in (-pi, pi].
struct View {
    double x = 0.0, phi = 0.0;

    double cosine() const { return 1.0 - x * x; }
    void direction(double out[3]) const;
};

/// Half-vectors of one theta_h.
struct Latitude {
    explicit Latitude(double cap) : z(1.0 - cap), radius(std::sqrt(cap * (2.0 - cap))) {}
    double z, radius; ///< cosine and sine of theta_h
};

/// A grid of half-vectors: columns in phi_h, rows in theta_h, finest where highlights are. Knots are positions on
/// the file's axes, whose measure is that of solid angle: phi_h and cos(theta_h).
struct HalfGrid {
    static constexpr std::uint32_t column_resolution = 1u << 16, row_resolution = 1u << 28;

    /// Rows are equal steps of the root of theta_h, as published measurements tabulate it.
    HalfGrid(std::uint32_t columns, std::uint32_t rows, bool mirrored);
    /// Rows are those of a tree of halvings (ACDF_HALF_ROWS), or as many of them together as make `rows`, a power
    /// of two. So are columns.
    static HalfGrid halved(std::uint32_t columns, std::uint32_t rows, bool mirrored);

    bool mirrored;                           ///< columns cover [0, pi], else [-pi, pi]
    std::vector<std::uint32_t> column_knots; ///< columns + 1
    std::vector<std::uint32_t> row_knots;    ///< rows + 1
    std::vector<double> column_measure;      ///< radians, of both sides if mirrored
    std::vector<double> row_measure;         ///< differences of cosines
    std::vector<Latitude> edges;             ///< of the rows' knots
    std::vector<Latitude> middles;           ///< of the rows, halfway in sqrt(1 - z)

    std::uint32_t columns() const { return static_cast<std::uint32_t>(column_measure.size()); }
    std::uint32_t rows() const { return static_cast<std::uint32_t>(row_measure.size()); }
    std::size_t size() const { return column_measure.size() * row_measure.size(); }
    /// Whether a row is looked at as the one before it: of those at the pole of a tree of halvings few are.
    bool is_thin(std::uint32_t row) const {
        return row_knots[row + 1] - row_knots[row] <= 2 && (row & (row - 1)) != 0;
    }
    double phi(double column_position) const;
    /// Of a position, which is 1 - cos(theta_h) in steps of the file's axis.
    Latitude latitude(double row_position) const { return Latitude(row_position / row_resolution); }

private:
    HalfGrid(std::uint32_t columns, std::vector<std::uint32_t> rows, bool mirrored);
};

/// The least share of all stored albedos that a bin is stored with: black views keep a pdf.
constexpr double kLeastShare = 1e-12;

/// The square of a view's normalised pdf over the half-vectors: what a fit needs to know of it.
struct ViewTarget {
    View view;
    double albedo = 0.0;       ///< integral of rho cos; 0: nothing is reflected, and `square` is the prior
    std::vector<float> square; ///< row-major, (f / albedo)^2 in 1 / sr^2 of half-vectors, and the prior
};

/// f is taken at the centre of each square, times the Jacobian 4 |wo . wh|. To its square is added, wherever any
/// part of a square reflects above the horizon, that of a small diffuse pdf (kPrior of all): a value that the
/// centres miss then still meets a pdf. In an isotropic BRDF phi_h counts from the azimuth of the view.
ViewTarget view_target(const Reflected& reflected, const HalfGrid& grid, const View& view);
constexpr double kPrior = 0.001;

/// Squares (1: yes) of which some half-vector reflects above the horizon for some view with x in [low.x, high.x]
/// and phi in [low.phi, high.phi] (isotropic: phi of both is 0). Exact.
std::vector<std::uint8_t> visible_squares(const HalfGrid& grid, const View& low, const View& high);

} // namespace acdf::compress
