#ifndef ACDF_INPUT_BRDF_H
#define ACDF_INPUT_BRDF_H

#include <memory>
#include <string>
#include <vector>

namespace acdf::input {

/// A BRDF rho(wo, wi) in sr^-1, three channels (r, g, b). Directions are unit, z along the normal.
class Brdf {
public:
    virtual ~Brdf() = default;

    /// 0 where wo or wi is at or below the horizon. Never negative, always finite. Thread-safe.
    virtual void evaluate(const double wo[3], const double wi[3], double rgb[3]) const = 0;

    bool isotropic = true;  ///< rho depends on phi_i - phi_o only
    bool mirror = true;     ///< and not on its sign, but for `asymmetry`
    double asymmetry = 0.0; ///< mean |rho - mirrored rho| over mean rho: 0 for models, at most 1e-3 where `mirror`
    std::string name;       ///< file name without folders, or the model's text
    std::vector<std::string> notes; ///< what a user should know, e.g. "1234 negative entries taken as 0"
    std::string sha256;             ///< of the file; empty for models
};

/// Opens a measured BRDF, or makes an analytic one:
///
/// | source | is |
/// |---|---|
/// | `*.binary` | MERL: Matusik et al., "A Data-Driven Reflectance Model", 2003 |
/// | `*.bsdf` | tensor file of Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition
/// and Rendering", 2018 | | `*.npy` | values at the cell centres of (theta_o, phi_o, theta_h, phi_h), see
/// brdf_npy.h | | `lambert`, `ggx:alpha=0.1[,0.3]`, `cook-torrance:m=0.2,n=1.5,k=0`, `blinn:e=100` | models, see
/// brdf_models.h |
///
/// Throws std::runtime_error with one clear line: what is wrong and what would help.
std::unique_ptr<Brdf> open_brdf(const std::string& source);

} // namespace acdf::input

#endif
