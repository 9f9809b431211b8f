// What renderers use without acdf, as rows of a sweep. The first is the reference of times.
#pragma once

#include "build/accuracy/local.h"
#include "tools/sweep/build.h"

#include <vector>

namespace acdf::tools {

// Targets (compress::of_texels) must outlive them, and have one channel, else std::invalid_argument.

/// Samplers of the probe's light: the full-resolution CDF, the same downsampled to about each budget, an alias
/// table, a hierarchical warp. `peaks`: of the light in each texel; empty: its values.
std::vector<Candidate> environment_baselines(const compress::Target& target, const std::vector<float>& peaks,
                                             const SweepOptions& options);

/// Samplers of what a diffuse surface reflects.
std::vector<Candidate> local_baselines(const compress::Target& target, const std::vector<build::Normal>& normals);

} // namespace acdf::tools
