// Samplers of light times cosine times BRDF, for renderings and timings: acdf/product/product.h over files.
#pragma once

#include "measure/samplers/light_sampler.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <memory>

namespace acdf::measure {

/// Into how many parts a point is divided that gets `samples`: twelve times as many up to 64, then as many as
/// samples up to 96; at least 8. Where more parts no longer paid at equal time (docs/product.md).
int product_parts(std::uint32_t samples);

/// `light`: a file of an environment or a local environment. `parts` as in ProductOptions. `bytes` is that of the
/// files. Throws std::invalid_argument where a file is of another kind.
std::unique_ptr<LightSampler> product_sampler(const File& light, const File& brdf, int parts);
/// The same with an isotropic GGX lobe as the BRDF.
std::unique_ptr<LightSampler> product_sampler(const File& light, double alpha, int parts);

} // namespace acdf::measure
