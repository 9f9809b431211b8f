// What renderers use without acdf, as rows of a sweep of a probe.
#pragma once

#include "compress/target.h"
#include "tools/sweep/build.h"

#include <cstdint>
#include <vector>

namespace acdf::tools {

/// The full-resolution CDF, which is the reference of times; an alias table, a hierarchical warp, the same CDF of a
/// picture downsampled to about each budget; tiles that are weighted at each point; the cosine. `target`
/// (compress::of_texels) must outlive them and have one channel, else std::invalid_argument. `peaks`: of the light
/// in each texel; empty: its values.
std::vector<Candidate> probe_baselines(const compress::Target& target, const std::vector<float>& peaks,
                                       const std::vector<std::uint64_t>& budgets);

} // namespace acdf::tools
