// Visibility cells learned from shadow rays at the points of a picture, for acdf render.
#pragma once

#include "measure/samplers/light_samplers.h"
#include "measure/scenes/scene_points.h"

#include <acdf/builder.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::tools {

/// A sampler and the file that it samples from.
struct LearnedSampler {
    std::shared_ptr<const File> file;
    measure::LightSamplerPtr sampler; ///< its making() is the learning pass
};

/// Makes a local file, and learns in passes of a sample for each of `points`; a quarter of `bytes` is for the
/// file's light, the rest for visibility cells. `beside_cosine`: of builder::LearnOptions.
LearnedSampler learned_sampler(const builder::Target& target, const std::vector<measure::ScenePoint>& points,
                               std::uint64_t bytes, bool beside_cosine);

} // namespace acdf::tools
