// Where BRDFs come from: files of measurements, and models.
#pragma once

#include "build/reflectance.h"

#include <memory>
#include <string>

namespace acdf::input {

using build::Brdf;

/// Opens a measured BRDF, or makes an analytic one:
///
/// | source | is |
/// |---|---|
/// | `*.binary` | MERL: Matusik et al., "A Data-Driven Reflectance Model", 2003 |
/// | `*.bsdf` | tensor file of Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition
/// and Rendering", 2018 | | `*.npy` | values at the cell centres of (theta_o, phi_o, theta_h, phi_h), see
/// table.h | | `lambert`, `ggx:alpha=0.1[,0.3]`, `cook-torrance:m=0.2,n=1.5,k=0`, `blinn:e=100` | models, see
/// models.h |
///
/// Throws std::runtime_error with one clear line: what is wrong and what would help.
std::unique_ptr<Brdf> open_brdf(const std::string& source);

} // namespace acdf::input
