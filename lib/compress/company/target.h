// The target of an environment map that is made for a company.
#pragma once

#include "compress/company.h"
#include "compress/local/normals.h"
#include "compress/target.h"

namespace acdf::compress {

/// For light as it counts at normals of a scene, whose noise is relative to their own irradiance: what a density
/// has to follow beside the company, and from which light on that leaves anything to do. The noise is that of
/// estimates with a fixed number of samples of each (docs/method.md). ACDF_COMPANY_MEAN: of the light itself, above
/// 2 (1 - share) times its mean (Karlik et al., SIGGRAPH Asia 2019). Throws std::invalid_argument where no normal
/// sees any light.
Target company_target(const Target& target, const NormalBins& normals, const Company& company);

} // namespace acdf::compress
