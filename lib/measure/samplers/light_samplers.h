// Every sampler of this library, and of files, as a LightSampler.
//
// Targets, files and tables are referred to, not copied, and must outlive what is made of them. Targets are
// lat-long probes (compress::of_texels); where one is black, or not of that kind, these functions throw
// std::invalid_argument.
#pragma once

#include "compress/target.h"
#include "measure/samplers/alias_table.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/light_sampler.h"

#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::measure {

class ScenePoint;
using LightSamplerPtr = std::unique_ptr<LightSampler>;

// ---- of the light ----

/// FullCdf. Directions below the horizon are sampled in vain, as where "rejection" rejects them and samples no
/// others.
LightSamplerPtr full_cdf_sampler(const compress::Target& target);
/// TilingOnTheFly, of columns x rows tiles.
LightSamplerPtr tiling_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows);

/// DownsampledCdf, of columns x rows cells.
LightSamplerPtr downsampled_cdf_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows);
/// AliasTable.
LightSamplerPtr alias_sampler(const compress::Target& target, AliasNumbers numbers = AliasNumbers::two);
/// HierarchicalWarp.
LightSamplerPtr hierarchical_sampler(const compress::Target& target);
/// CompensatedCdf: without support where little light is, for MisEstimator with a
/// sampler of the surface; biased on its own.
LightSamplerPtr compensated_sampler(const compress::Target& target, double s = 1.0);

/// TilingOnTheFly with the visibility of its tiles at cache points (VisibilityCache), made for `points`; its
/// making() is not 0.
LightSamplerPtr visibility_sampler(const compress::Target& target, std::uint32_t columns, std::uint32_t rows,
                                   const std::vector<ScenePoint>& points);

/// IdealRow: light x cosine on all texels, made anew at each point; with `shares` > 0 filled up for as many samples
/// of ours for one of the cosine.
LightSamplerPtr ideal_sampler(const compress::Target& target, double shares = 0.0);

// ---- of the surface ----

/// CosineHemisphere.
LightSamplerPtr cosine_sampler();
/// GgxSampler. Views below the surface sample nothing.
LightSamplerPtr ggx_sampler(double alpha);
/// TabulatedBrdf. Views below the surface sample nothing.
LightSamplerPtr tabulated_brdf_sampler(const TabulatedBrdf& table);

// ---- of files ----

/// What an open file takes in memory: its bytes, what was inflated of them, and the tables made at load.
std::uint64_t memory_of(const File& file);

/// A file of an environment, a local environment or a BRDF; std::invalid_argument for tables. `bytes` is memory_of.
/// BRDFs are turned to the surface's frame (surface_frame); views below the surface sample nothing.
LightSamplerPtr file_sampler(const File& file);
/// One of the environments of a file of several maps. `bytes` counts their tables, too.
LightSamplerPtr sky_sampler(const File& file, const MixedEnvironment& sky);
/// A local environment by normals alone, also where it stores visibility cells.
LightSamplerPtr normals_alone_sampler(const File& file);

} // namespace acdf::measure
