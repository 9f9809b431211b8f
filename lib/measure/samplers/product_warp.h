// Random numbers bent towards a BRDF in front of a sampler of light: Hart, Pharr, Müller, Lopes, McGuire, Shirley,
// "Practical Product Sampling by Fitting and Composing Warps", EGSR 2020. A baseline of product_samplers.h.
#pragma once

#include "measure/samplers/light_sampler.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <memory>

namespace acdf::measure {

/// `light`: a file of an environment or a local environment; `brdf` a BRDF file. At each point the BRDF (of an
/// environment times the cosine) is evaluated where the light's sampler takes 4 x 4 stratified pairs of numbers; a
/// bilinear pdf over the unit square is fitted to that by least squares, nowhere less than a tenth of the mean.
/// Numbers are sampled from it and handed to the light. The pdf of a direction is that of the light times that
/// of the numbers that sample it. Throws std::invalid_argument where a file is of another kind.
std::unique_ptr<LightSampler> product_warp_sampler(const File& light, const File& brdf);
/// The same with an isotropic GGX lobe as the BRDF.
std::unique_ptr<LightSampler> product_warp_sampler(const File& light, double alpha);

} // namespace acdf::measure
