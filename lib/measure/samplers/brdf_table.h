// A BRDF's fully tabulated CDFs over (theta_o, phi_o, theta_h, phi_h): the baseline of Lawrence et al. 2005, §6.2,
// after Matusik, "A Data-Driven Reflectance Model", PhD thesis, MIT 2003.
#pragma once

#include "measure/samplers/brdf_samplers.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Steps of each angle; the default is the paper's. theta in [0, pi/2], phi in [-pi, pi], all in equal steps. With
/// one step of phi_o azimuths count from the view's, which only isotropic BRDFs allow.
struct BrdfTableSize {
    std::uint32_t theta_o = 32, phi_o = 16, theta_h = 256, phi_h = 32;

    std::size_t view_bins() const { return std::size_t{theta_o} * phi_o; }
    std::size_t cells() const { return std::size_t{theta_h} * phi_h; } ///< of a bin
};

enum class BrdfTableKind {
    centre, ///< as described: the light of the view at the bin's centre, at the centre of each cell; biased between
    mean,   ///< repaired: the root of the mean of (f / integral of f)^2 over 3x3 views of the bin and five
            ///< half-vectors of the cell, corners included, with the prior that files have too (compress::kPrior)
};

/// Every view is served by the bin that it lies in, also if the BRDF is isotropic: give views of any azimuth. In a
/// cell the pdf is constant per solid angle of wh.
class TabulatedBrdf {
public:
    /// `isotropic`: the bins of all phi_o are made from those of the first. Uses all cores; the result does not
    /// depend on their number. Throws std::invalid_argument for a size that the BRDF does not allow.
    TabulatedBrdf(const compress::Reflected& reflected, bool isotropic, BrdfTableKind kind,
                  BrdfTableSize size = {});

    BrdfSample sample(const double wo[3], const double u[2]) const; ///< u (phi_h, theta_h) in [0, 1]
    double pdf(const double wo[3], const double wi[3]) const;
    /// Of a probability and a cumulative one for each cell, in double precision: 65 MiB at the paper's size, which
    /// says 65 MB.
    std::size_t bytes() const;

private:
    void fill_bin(const compress::Reflected& reflected, BrdfTableKind kind, std::uint32_t theta_o,
                  std::uint32_t phi_o);
    void add_view(const compress::Reflected& reflected, bool mean, const double wo[3],
                  std::vector<double>& square) const;
    void copy_turned(std::uint32_t theta_o, std::uint32_t phi_o);
    void make_cdfs(std::size_t bin);
    std::size_t bin_of(const double wo[3]) const;
    double turn(const double wo[3]) const; ///< what is added to the table's azimuths
    double cell_solid_angle(std::size_t row) const;

    BrdfTableSize size_;
    std::vector<double> mass_;        ///< bins x theta_h x phi_h, sum of a bin 1 (or 0: black)
    std::vector<double> conditional_; ///< bins x theta_h x phi_h: up to and with this cell, in its row; ends at 1
    std::vector<double> marginal_;    ///< bins x theta_h: up to and with this row; ends at 1
};

} // namespace acdf::measure
