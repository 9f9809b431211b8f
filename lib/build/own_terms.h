// Between the public library and this project's own terms: for programs of ours that hand it what lib/ has read,
// and measure what it makes.
#pragma once

#include "build/reflectance.h"
#include "compress/target.h"

#include <acdf/builder.h>

namespace acdf::builder {

/// The function that is fitted. `target` is not empty, and the reference lives as long as a copy of it.
const compress::Target& grid_of(const Target& target);

/// A target in the library's terms. Throws build::NoEnergy.
Target target_of(compress::Target grid, const TargetOptions& options);

/// `brdf` must outlive what is made.
Brdf described(const build::Brdf& brdf);

/// Whether a transform of visibility cells (its linear part) mirrors: triangles are then wound the other way round.
bool mirrors(const float transform[3][4]);

} // namespace acdf::builder
