#include "measure/samplers/brdf_table.h"

#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/elementary.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::measure {
namespace {

void direction(double theta, double phi, double out[3]) {
    out[0] = std::sin(theta) * std::cos(phi);
    out[1] = std::sin(theta) * std::sin(phi);
    out[2] = std::cos(theta);
}

/// Reflects wo at h; returns wo . h.
double reflect(const double wo[3], const double h[3], double wi[3]) {
    const double dot = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
    for (int k = 0; k < 3; ++k) wi[k] = 2.0 * dot * h[k] - wo[k];
    return dot;
}

/// Where in a bin or a cell views and half-vectors are taken. Borders are approached, not met: at theta_o = 90
/// degrees nothing is reflected.
const std::vector<double> centre = {0.5}, positions = {1e-6, 0.5, 1.0 - 1e-6};

std::size_t step_of(double fraction, std::uint32_t steps) {
    return static_cast<std::size_t>(std::clamp(fraction * steps, 0.0, steps - 1.0));
}

} // namespace

TabulatedBrdf::TabulatedBrdf(const compress::Reflected& reflected, bool isotropic, BrdfTableKind kind,
                             BrdfTableSize size)
    : size_(size) {
    if (size.theta_o == 0 || size.phi_o == 0 || size.theta_h == 0 || size.phi_h == 0)
        throw std::invalid_argument("a table of a BRDF needs at least one step of each angle");
    if (!isotropic && size.phi_o == 1)
        throw std::invalid_argument("a table of an anisotropic BRDF needs several steps of phi_o");
    mass_.resize(size.view_bins() * size.cells());
    conditional_.resize(mass_.size());
    marginal_.resize(size.view_bins() * size.theta_h);
    const bool turned = isotropic && size.phi_h % size.phi_o == 0;
    compress::parallel_for(std::uint32_t{0}, size.theta_o, [&](std::uint32_t i) {
        for (std::uint32_t j = 0; j < size.phi_o; ++j) {
            if (j > 0 && turned) copy_turned(i, j);
            else fill_bin(reflected, kind, i, j);
        }
        for (std::uint32_t j = 0; j < size.phi_o; ++j) make_cdfs(std::size_t{i} * size.phi_o + j);
    });
}

void TabulatedBrdf::fill_bin(const compress::Reflected& reflected, BrdfTableKind kind, std::uint32_t theta_o,
                             std::uint32_t phi_o) {
    const bool mean = kind == BrdfTableKind::mean, relative = size_.phi_o == 1;
    std::vector<double> square(size_.cells());
    for (const double s : mean ? positions : centre)
        for (const double t : mean && !relative ? positions : centre) {
            double wo[3];
            direction(0.5 * ACDF_PI * (theta_o + s) / size_.theta_o,
                      relative ? 0.0 : 2.0 * ACDF_PI * (phi_o + t) / size_.phi_o - ACDF_PI, wo);
            add_view(reflected, mean, wo, square);
        }
    double* const mass = &mass_[(std::size_t{theta_o} * size_.phi_o + phi_o) * size_.cells()];
    for (std::size_t cell = 0; cell < square.size(); ++cell)
        mass[cell] = std::sqrt(square[cell]) * cell_solid_angle(cell / size_.phi_h);
}

void TabulatedBrdf::add_view(const compress::Reflected& reflected, bool mean, const double wo[3],
                             std::vector<double>& square) const {
    std::vector<double> light(size_.cells()), prior(size_.cells());
    compress::Sum integral;
    for (std::size_t cell = 0; cell < size_.cells(); ++cell) {
        const std::size_t row = cell / size_.phi_h, column = cell % size_.phi_h;
        for (const double y : mean ? positions : centre)
            for (const double x : mean ? positions : centre) {
                if ((y == 0.5) != (x == 0.5)) continue; // corners and centre
                double h[3], wi[3];
                direction(0.5 * ACDF_PI * (static_cast<double>(row) + y) / size_.theta_h,
                          2.0 * ACDF_PI * (static_cast<double>(column) + x) / size_.phi_h - ACDF_PI, h);
                const double dot = reflect(wo, h, wi);
                if (!(dot > 0.0 && wi[2] > 0.0)) continue;
                const double f = reflected(wo, wi) * 4.0 * dot, p = compress::kPrior * 4.0 * dot / ACDF_PI;
                light[cell] += f * f;
                prior[cell] += mean ? p * p : 0.0;
                integral.add(f * cell_solid_angle(row));
            }
    }
    const double points = mean ? 5.0 : 1.0, whole = integral.value() / points;
    const double scale = whole > 0.0 ? 1.0 / (points * whole * whole) : 0.0;
    for (std::size_t cell = 0; cell < square.size(); ++cell)
        square[cell] += light[cell] * scale + prior[cell] / points;
}

void TabulatedBrdf::copy_turned(std::uint32_t theta_o, std::uint32_t phi_o) {
    const std::size_t first = std::size_t{theta_o} * size_.phi_o * size_.cells();
    const std::size_t shift = std::size_t{phi_o} * (size_.phi_h / size_.phi_o);
    for (std::size_t cell = 0; cell < size_.cells(); ++cell) {
        const std::size_t row = cell / size_.phi_h, column = cell % size_.phi_h;
        mass_[first + phi_o * size_.cells() + row * size_.phi_h + (column + shift) % size_.phi_h] =
            mass_[first + cell];
    }
}

void TabulatedBrdf::make_cdfs(std::size_t bin) {
    compress::Sum sum;
    double* const mass = &mass_[bin * size_.cells()];
    for (std::size_t cell = 0; cell < size_.cells(); ++cell) sum.add(mass[cell]);
    const double scale = sum.value() > 0.0 ? 1.0 / sum.value() : 0.0;
    double below = 0.0;
    for (std::size_t row = 0; row < size_.theta_h; ++row) {
        double left = 0.0;
        double* const cdf = &conditional_[bin * size_.cells() + row * size_.phi_h];
        for (std::size_t column = 0; column < size_.phi_h; ++column) {
            mass[row * size_.phi_h + column] *= scale;
            cdf[column] = left += mass[row * size_.phi_h + column];
        }
        for (std::size_t column = 0; column < size_.phi_h; ++column)
            cdf[column] = left > 0.0 ? cdf[column] / left : (static_cast<double>(column) + 1.0) / size_.phi_h;
        marginal_[bin * size_.theta_h + row] = below += left;
    }
    for (std::size_t row = 0; row < size_.theta_h && below > 0.0; ++row)
        marginal_[bin * size_.theta_h + row] /= below;
}

std::size_t TabulatedBrdf::bin_of(const double wo[3]) const {
    const double theta = std::atan2(std::hypot(wo[0], wo[1]), wo[2]) / (0.5 * ACDF_PI);
    const double phi = (std::atan2(wo[1], wo[0]) + ACDF_PI) / (2.0 * ACDF_PI);
    return step_of(theta, size_.theta_o) * size_.phi_o + step_of(phi, size_.phi_o);
}

double TabulatedBrdf::turn(const double wo[3]) const { return size_.phi_o == 1 ? std::atan2(wo[1], wo[0]) : 0.0; }

double TabulatedBrdf::cell_solid_angle(std::size_t row) const {
    const double step = 0.5 * ACDF_PI / size_.theta_h, middle = step * (static_cast<double>(row) + 0.5);
    return 2.0 * std::sin(middle) * std::sin(0.5 * step) * 2.0 * ACDF_PI / size_.phi_h; // differences of cosines
}

BrdfSample TabulatedBrdf::sample(const double wo[3], const double u[2]) const {
    BrdfSample out;
    if (!(wo[2] > 0.0)) return out;
    const std::size_t bin = bin_of(wo);
    // The first entry above u; the entry before it is where the cell begins.
    const auto invert = [](const double* cdf, std::size_t count, double v, double& fraction) {
        v = std::clamp(v, 0.0, 1.0 - 0x1p-53);
        const auto at = static_cast<std::size_t>(std::upper_bound(cdf, cdf + count, v) - cdf);
        if (at == count) return count; // black
        const double begin = at > 0 ? cdf[at - 1] : 0.0;
        fraction = (v - begin) / (cdf[at] - begin);
        return at;
    };
    double s = 0.0, t = 0.0;
    const std::size_t row = invert(&marginal_[bin * size_.theta_h], size_.theta_h, u[1], t);
    if (row == size_.theta_h) return out;
    const std::size_t first = bin * size_.cells() + row * size_.phi_h;
    const std::size_t column = invert(&conditional_[first], size_.phi_h, u[0], s);

    const double step = 0.5 * ACDF_PI / size_.theta_h;
    const double low = std::cos(step * static_cast<double>(row)),
                 high = std::cos(step * (static_cast<double>(row) + 1.0));
    const double theta = std::acos(std::clamp(low + t * (high - low), -1.0, 1.0));
    double h[3];
    direction(theta, 2.0 * ACDF_PI * (static_cast<double>(column) + s) / size_.phi_h - ACDF_PI + turn(wo), h);
    const double dot = reflect(wo, h, out.wi);
    if (dot > 0.0 && out.wi[2] > 0.0) out.pdf = mass_[first + column] / (cell_solid_angle(row) * 4.0 * dot);
    return out;
}

double TabulatedBrdf::pdf(const double wo[3], const double wi[3]) const {
    if (!(wo[2] > 0.0 && wi[2] > 0.0)) return 0.0;
    const double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
    const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    const double theta = std::atan2(std::hypot(h[0], h[1]), h[2]) / (0.5 * ACDF_PI);
    double phi = (std::atan2(h[1], h[0]) - turn(wo) + ACDF_PI) / (2.0 * ACDF_PI);
    phi -= std::floor(phi);
    const std::size_t row = step_of(theta, size_.theta_h), column = step_of(phi, size_.phi_h);
    const double dot = 0.5 * length; // wo . wh
    return mass_[bin_of(wo) * size_.cells() + row * size_.phi_h + column] / (cell_solid_angle(row) * 4.0 * dot);
}

std::size_t TabulatedBrdf::bytes() const {
    return sizeof(double) * (mass_.size() + conditional_.size() + marginal_.size());
}

} // namespace acdf::measure
