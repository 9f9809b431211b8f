// How noisy an environment file and its partner are together, over normals.
#pragma once

#include "build/accuracy/environment.h"
#include "build/accuracy/local.h"

namespace acdf::build {

/// Of diffuse surfaces of those normals, lit by the target (see Accuracy::combined).
struct PartnerAccuracy {
    double relative_variance = 0.0;       ///< mean over the normals that see light
    double max_weight = 0.0;              ///< largest f over combined pdf, over its mean
    std::uint64_t support_violations = 0; ///< of both together
};

/// The file is an environment with an MIS partner, of the target's grid. The same for any number of threads.
PartnerAccuracy measure_beside_partner(const File& file, const compress::Target& target,
                                       const std::vector<Normal>& normals);

/// The share of all samples to take from that file for the least second moment of estimates, summed over normals
/// relative to their irradiance: a multiple of 1/32. 1 where no normal sees any light.
double recommended_light_share(const File& file, const compress::Target& target,
                               const std::vector<Normal>& normals);

} // namespace acdf::build
