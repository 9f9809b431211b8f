// BRDFs of the RGL material database: Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material
// Acquisition and Rendering", ACM TOG 37(6), 2018.
#pragma once

#include "input/brdf/brdf.h"
#include "input/brdf/rgl_tensor.h"
#include "input/brdf/rgl_warp.h"

namespace acdf::input {

/// What a .bsdf file holds. x of ndf, sigma and vndf is sqrt(2 theta / pi), y is (phi + pi) / (2 pi); x, y of
/// luminance and colour are the numbers that `vndf` warps to a half-vector.
struct RglTables {
    RglNodes nodes;      ///< of the view
    RglTable ndf, sigma; ///< distribution of normals over half-vectors; projected area over views; no slices
    RglTable colour;     ///< rho cos(theta_i), less the factor `jacobian`; three channels: linear sRGB
    RglWarp vndf;        ///< visible normals
    RglWarp luminance;
    bool isotropic = true; ///< half-vectors count phi from the view's
    bool jacobian = true;  ///< values are to be multiplied by ndf / (4 sigma)
    int reduction = 1;     ///< 2, 4: the nodes of phi cover a half or a quarter; the rest is mirrored
    std::string description;
    std::vector<std::string> notes;
    double asymmetry = 0.0; ///< as Brdf::asymmetry
};

/// A view folded into the range of the nodes, and the slices around it.
template <class Real>
struct RglView {
    Real wo[3] = {0, 0, 1};
    Real sign_x = 1, sign_y = 1; ///< by which x and y of all directions are multiplied
    Real theta = 0, phi = 0;
    RglMix<Real> mix;

    void fold(Real w[3]) const { w[0] *= sign_x, w[1] *= sign_y; }
};
template <class Real>
RglView<Real> rgl_view(const RglTables& tables, const Real wo[3]);

/// A half-vector as a position in the tables.
template <class Real>
struct RglHalf {
    Real x = 0, y = 0;
    Real jacobian = 1; ///< steradians of wi per unit of (x, y)
};
template <class Real>
RglHalf<Real> rgl_half(const RglTables& tables, const RglView<Real>& view, const Real wi[3]);

class RglBrdf : public Brdf {
public:
    explicit RglBrdf(RglTables tables);
    /// As published: the view (wo) is the direction that the tables are indexed by. Spectra are turned into linear
    /// sRGB when read; values that come out negative (out of gamut) are 0, as the authors' RGB files have it.
    void evaluate(const double wo[3], const double wi[3], double rgb[3]) const override;
    const RglTables& tables() const { return tables_; }

private:
    RglTables tables_;
    std::uint64_t number_; ///< of no other object of this process
};

/// `name` goes into messages. Throws Error for anything but a sound RGB or spectral .bsdf file.
std::unique_ptr<RglBrdf> parse_rgl(const std::string& name, const std::uint8_t* data, std::size_t size);

/// Weights with which spectra at these wavelengths (nm, increasing) become linear sRGB: 3 x wavelengths. CIE 1931
/// by the fit of Wyman, Sloan and Shirley (JCGT 2(2), 2013); equal energy; a constant spectrum keeps its value.
/// Empty where the wavelengths do not cover all three.
std::vector<double> srgb_weights(const std::vector<float>& wavelengths);

} // namespace acdf::input
