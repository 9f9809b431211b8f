// What one can do today to sample from light times cosine times BRDF: the baselines of product_samplers.h.
#pragma once

#include "compress/target.h"
#include "measure/samplers/light_sampler.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <memory>

namespace acdf::measure {

/// Half of the samples of `a`, half of `b`, by chance, with the pdf of both: candidates of resampled importance
/// sampling (ResamplingEstimator). Both must outlive it.
std::unique_ptr<LightSampler> half_and_half(const LightSampler& a, const LightSampler& b);

/// Tiles of a probe, weighted at each point by their light times BRDF times cosine at their middles, the full CDF
/// inside (after Conty Estevez and Lecocq, "Fast Product Importance Sampling of Environment Maps", SIGGRAPH Talks
/// 2018): a tile has the weight flux * (BRDF * cosine + a twentieth of the mean of that over the light). Their
/// combination with the BRDF's own sampler is for MisEstimator. `brdf` is a BRDF file. Throws std::invalid_argument
/// as TilingOnTheFly does.
std::unique_ptr<LightSampler> product_tiles_sampler(const compress::Target& target, std::uint32_t columns,
                                                    std::uint32_t rows, const File& brdf);
/// The same with an isotropic GGX lobe.
std::unique_ptr<LightSampler> product_tiles_sampler(const compress::Target& target, std::uint32_t columns,
                                                    std::uint32_t rows, double alpha);

} // namespace acdf::measure
