// The target of an environment map that is made for an MIS partner.
#pragma once

#include "compress/local/normals.h"
#include "compress/partner.h"
#include "compress/target.h"

namespace acdf::compress {

/// For light as it counts at normals of a scene, whose noise is relative to their own irradiance: what a pdf
/// has to follow beside the partner, and from which light on that leaves anything to do. The noise is that of
/// estimates with a fixed number of samples of each (docs/method.md). ACDF_PARTNER_MEAN: of the light itself, above
/// 2 (1 - share) times its mean (Karlik et al., SIGGRAPH Asia 2019). Throws std::invalid_argument where no normal
/// sees any light.
Target partner_target(const Target& target, const NormalBins& normals, const Partner& partner);

} // namespace acdf::compress
