#include "compress/brdf/target.h"

#include "compress/sum.h"

#include <acdf/brdf.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace acdf::compress {
namespace {

constexpr double kMostReflected = 1e26; // values below 1e18, weights of three channels of up to 1e6, the Jacobian
constexpr double kBelow = -1e-9;        // cos(theta_i) of what certainly lies below the horizon

/// Angle between a view's azimuth and the nearest of [low, high], all in radians; high - low < 2 pi.
double least_turn(double azimuth, double low, double high) {
    const double width = high - low, turn = 2.0 * ACDF_PI;
    double from = std::fmod(azimuth - low, turn);
    if (from < 0.0) from += turn;
    return from <= width ? 0.0 : std::min(from - width, turn - from);
}

/// theta_o of a view.
struct Height {
    explicit Height(const View& view)
        : cosine(view.cosine()), sine(std::sqrt(std::max(0.0, 1.0 - cosine * cosine))) {}
    double cosine, sine;
};

/// cos(theta_i) of the reflection at a half-vector of relative azimuth phi; the Jacobian |d wi / d wh| is 4 `dot`.
double reflected_cosine(const Height& view, const Latitude& half, double cos_phi, double& dot) {
    dot = view.cosine * half.z + view.sine * half.radius * cos_phi;
    return 2.0 * dot * half.z - view.cosine;
}

/// The part of a square that is the first to rise above the horizon is where theta_h is least and phi_h nearest to
/// the view: cos(theta_i) > 0 means 2 theta_h < pi/2 + atan(tan(theta_o) cos(phi_h - phi_o)).
double first_turn(const HalfGrid& grid, std::uint32_t column, double low_azimuth, double high_azimuth) {
    const double begin = grid.phi(grid.column_knots[column]), end = grid.phi(grid.column_knots[column + 1]);
    return std::min(least_turn(low_azimuth, begin, end), least_turn(begin, low_azimuth, high_azimuth));
}

void add_prior(const HalfGrid& grid, const View& view, std::vector<float>& square) {
    const Height height(view);
    for (std::uint32_t c = 0; c < grid.columns(); ++c) {
        const double cos_phi = std::cos(first_turn(grid, c, view.phi, view.phi));
        for (std::uint32_t r = 0; r < grid.rows(); ++r) {
            double dot;
            if (reflected_cosine(height, grid.edges[r], cos_phi, dot) < kBelow) break;
            const double prior = kPrior * 4.0 * std::max(dot, 1e-3) / ACDF_PI;
            square[std::size_t{r} * grid.columns() + c] += static_cast<float>(prior * prior);
        }
    }
}

} // namespace

void View::direction(double out[3]) const {
    const double s = x * std::sqrt(2.0 - x * x);
    out[0] = s * std::cos(phi);
    out[1] = s * std::sin(phi);
    out[2] = cosine();
}

namespace {

std::vector<std::uint32_t> rows_of_roots(std::uint32_t rows) {
    std::vector<std::uint32_t> out{0};
    for (std::uint32_t r = 1; r <= rows; ++r) {
        const double t = double(r) / rows, sine = std::sin(0.25 * ACDF_PI * t * t);
        const auto knot = static_cast<std::uint32_t>(std::lround(2.0 * sine * sine * HalfGrid::row_resolution));
        if (knot > out.back()) out.push_back(knot);
    }
    out.back() = HalfGrid::row_resolution;
    return out;
}

std::vector<std::uint32_t> halved_rows(std::uint32_t rows) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t r = 0; r <= rows; ++r) out.push_back(acdf_half_row(r * (ACDF_HALF_ROWS / rows)));
    return out;
}

} // namespace

HalfGrid::HalfGrid(std::uint32_t columns, std::uint32_t rows, bool mirrored_)
    : HalfGrid(columns, rows_of_roots(rows), mirrored_) {}

HalfGrid HalfGrid::halved(std::uint32_t columns, std::uint32_t rows, bool mirrored) {
    return {columns, halved_rows(rows), mirrored};
}

HalfGrid::HalfGrid(std::uint32_t columns, std::vector<std::uint32_t> rows, bool mirrored_)
    : mirrored(mirrored_), row_knots(std::move(rows)) {
    for (std::uint32_t c = 0; c <= columns; ++c)
        column_knots.push_back(static_cast<std::uint32_t>(std::uint64_t{c} * column_resolution / columns));
    for (std::uint32_t c = 0; c < columns; ++c)
        column_measure.push_back(2.0 * ACDF_PI * (column_knots[c + 1] - column_knots[c]) / column_resolution);
    for (std::size_t r = 0; r + 1 < row_knots.size(); ++r)
        row_measure.push_back(double(row_knots[r + 1] - row_knots[r]) / row_resolution);
    for (const std::uint32_t knot : row_knots) edges.push_back(latitude(knot));
    for (std::size_t r = 0; r + 1 < row_knots.size(); ++r) {
        const double t = 0.5 * (std::sqrt(double(row_knots[r])) + std::sqrt(double(row_knots[r + 1])));
        middles.push_back(latitude(t * t));
    }
}

double HalfGrid::phi(double column_position) const {
    const double t = column_position / column_resolution;
    return mirrored ? ACDF_PI * t : ACDF_PI * (2.0 * t - 1.0);
}

ViewTarget view_target(const Reflected& reflected, const HalfGrid& grid, const View& view) {
    ViewTarget out;
    out.view = view;
    out.square.assign(grid.size(), 0.0f);
    double wo[3];
    view.direction(wo);
    std::vector<double> cosine(grid.columns()), sine(grid.columns()), values(grid.size(), 0.0);
    for (std::uint32_t c = 0; c < grid.columns(); ++c) {
        const double phi = grid.phi(0.5 * (double(grid.column_knots[c]) + grid.column_knots[c + 1]));
        cosine[c] = std::cos(phi);
        sine[c] = std::sin(phi);
    }
    Sum albedo;
    for (std::uint32_t r = 0; r < grid.rows(); ++r) {
        if (grid.is_thin(r)) { // as the row before it
            const auto row = values.begin() + std::ptrdiff_t(std::size_t{r} * grid.columns());
            std::copy_n(row - grid.columns(), grid.columns(), row);
            continue;
        }
        const auto [hz, radius] = grid.middles[r];
        for (std::uint32_t c = 0; c < grid.columns(); ++c) {
            const double h[3] = {radius * cosine[c], radius * sine[c], hz};
            const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
            const double wi[3] = {2.0 * dot * h[0] - wo[0], 2.0 * dot * h[1] - wo[1], 2.0 * dot * h[2] - wo[2]};
            if (dot <= 0.0 || wi[2] <= 0.0) continue;
            const double f = reflected(wo, wi) * 4.0 * dot;
            if (!(f >= 0.0 && f < kMostReflected))
                throw std::invalid_argument("its values are not finite, or not positive");
            values[std::size_t{r} * grid.columns() + c] = f;
            albedo.add(f * grid.row_measure[r] * grid.column_measure[c]);
        }
    }
    out.albedo = albedo.value();
    if (out.albedo > 0.0)
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double f = values[i] / out.albedo;
            out.square[i] = static_cast<float>(f * f);
        }
    add_prior(grid, view, out.square);
    return out;
}

std::vector<std::uint8_t> visible_squares(const HalfGrid& grid, const View& low, const View& high) {
    const Height heights[] = {Height(low), Height(high)};
    std::vector<std::uint8_t> out(grid.size(), 0);
    for (std::uint32_t c = 0; c < grid.columns(); ++c) {
        const double cos_phi = std::cos(first_turn(grid, c, low.phi, high.phi));
        for (const Height& height : heights) // for each half-vector theta_o has only one bound
            for (std::uint32_t r = 0; r < grid.rows(); ++r) {
                double dot;
                if (reflected_cosine(height, grid.edges[r], cos_phi, dot) < kBelow) break;
                out[std::size_t{r} * grid.columns() + c] = 1;
            }
    }
    return out;
}

} // namespace acdf::compress
