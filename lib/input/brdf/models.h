// Analytic BRDFs, for tests and for scenes without data. All are reciprocal and reflect at most what they receive.
#pragma once

#include "input/brdf/brdf.h"

namespace acdf::input {

/// | text | rho(wo, wi) |
/// |---|---|
/// | `lambert` | albedo / pi; `albedo=1` |
/// | `ggx:alpha=0.1`, `ggx:0.1` or `ggx:alpha=0.1,0.3` | D F G / (4 cos cos): GGX normals (Walter et al. 2007), the
/// second alpha along y; Smith's height-correlated masking (Heitz 2014); Fresnel of Schlick 1994 with reflectance
/// `f0=1` at normal incidence | | `cook-torrance:m=0.2,n=1.5,k=0` | the same with Beckmann normals of slope m, the
/// masking of V-cavities (Cook and Torrance 1982) and the exact unpolarised Fresnel term of the index n + ik | |
/// `blinn:e=100` | (n . h)^e (e+2)(e+4) / (8 pi (2^(-e/2) + e)): albedo 1 at normal incidence, less elsewhere;
/// `albedo=1` |
///
/// The key of a first number may be left out: alpha, m, e and the albedo of lambert. `albedo`, `f0`, `n` and `k`
/// take one number or three (r, g, b). Ranges: alpha and m in [1e-4, 10], e in [0, 1e7], n in [0.01, 100], k in [0,
/// 100], f0 and albedo in [0, 1]. Throws Error, naming what is wrong, for any other text.
std::unique_ptr<Brdf> model_brdf(const std::string& text);

/// Whether the text before any ':' is the name of a model.
bool is_model(const std::string& text);

} // namespace acdf::input
