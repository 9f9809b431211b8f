// A BRDF as fits see it: something to evaluate, and what is known of it.
#pragma once

#include <string>
#include <vector>

namespace acdf::build {

/// No channel of a BRDF reaches this, in sr^-1: sums of squares of weighted values stay finite.
constexpr double kMostReflectance = 1e18;

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

} // namespace acdf::build
