// From the texts of samplers to estimators, all tables built once.
#pragma once

#include "build/own_terms.h"
#include "input/brdf/brdf.h"
#include "measure/samplers/estimator.h"
#include "measure/scenes/scene_points.h"
#include "tools/render/sampler_spec.h"

#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {

/// Estimators of a scene, one a material each.
struct BuiltSampler {
    std::vector<const measure::Estimator*> of_material;
    std::uint64_t bytes = 0;    ///< all that its samples read, of all materials
    double build_seconds = 0.0; ///< 0 for what was built before
    measure::Making making;     ///< of a picture
    bool ours = false;          ///< samples from an .acdf file, alone or combined
};

class SamplerBuilder {
public:
    /// `brdfs`: one a material, which are referred to and must outlive the builder, as `geometry` and `points`,
    /// where there are such: positions are those on the one, caches are made for the others. Files are relative to
    /// `data`; of files of several maps it is the environment `at` coordinates (tools/cli/coordinates.h).
    /// `normals`: those that the camera sees, for samplers that are made for them.
    SamplerBuilder(const builder::Target& target, std::vector<const input::Brdf*> brdfs, std::string data,
                   std::vector<builder::SceneNormal> normals = {}, const measure::Geometry* geometry = nullptr,
                   const std::vector<measure::ScenePoint>* points = nullptr, std::vector<std::string> at = {});
    ~SamplerBuilder();
    SamplerBuilder(const SamplerBuilder&) = delete;
    SamplerBuilder& operator=(const SamplerBuilder&) = delete;

    /// Valid as long as the builder. Throws SpecError, Failure or std::exception, which name the sampler.
    BuiltSampler build(const SamplerSpec& spec, std::uint32_t samples);
    /// What one samples from that is no mis(...), ris or strata.
    const measure::LightSampler& single(const SamplerSpec& spec, std::size_t material, std::uint32_t samples);

private:
    struct Store;
    std::unique_ptr<Store> store_;
};

} // namespace acdf::tools
