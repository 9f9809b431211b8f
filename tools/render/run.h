// Renders a scene with several samplers, and compares them.
#pragma once

#include "input/brdf/brdf.h"
#include "input/probe/probe.h"
#include "measure/ratio.h"
#include "measure/scenes/render.h"
#include "measure/scenes/render_time.h"
#include "tools/cli/progress.h"
#include "tools/render/sampler_spec.h"
#include "tools/render/scene_file.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// A scene with all that it names. Points into itself: it stays where it is.
struct LoadedScene {
    SceneFile file;
    input::Probe probe;
    std::vector<std::unique_ptr<input::Brdf>> brdfs; ///< one a material
    std::vector<float> means; ///< of the light over each texel, as the probe's pixels; empty: those
    measure::Scene scene;
    measure::ScenePoints points;

    LoadedScene() = default;
    LoadedScene(const LoadedScene&) = delete;
    LoadedScene& operator=(const LoadedScene&) = delete;
};

/// Reads the probe and the BRDFs; file names in a scene are relative to `data`. Throws SceneError and input::Error.
std::unique_ptr<LoadedScene> load_scene(const SceneFile& file, const std::string& data);

struct ComparisonOptions {
    std::vector<SamplerSpec> samplers; ///< the first is the baseline
    std::uint32_t samples = 20;
    measure::RenderOptions render;
    bool reference = true; ///< exact, by summation; else the mean of all pictures
    bool timing = true;
    double shadow_ray_ns = 0.0; ///< added for each shadow ray: what it costs in the user's renderer beyond this one
    measure::TimingOptions time;
};

/// What was measured of one sampler. Ratios are gains over the baseline: above 1 is better.
struct Compared {
    SamplerSpec spec;
    bool ours = false; ///< samples from an .acdf file, alone or combined
    std::uint64_t bytes = 0;
    double build_seconds = 0.0;
    measure::Rendering rendering;
    std::vector<double> noise;           ///< relative variance of an estimate, mean over points; one a seed
    measure::Interval relative_variance; ///< of the above
    double median = 0.0;                 ///< over points, not seeds
    bool scales = true;                  ///< n times the samples have an n-th of the variance
    std::vector<double> nanoseconds;     ///< of an estimate, with its part of `making`; one a round
    measure::Making making;              ///< of what has to be made anew for a picture
    std::vector<double> relative_variance_of_points;
    measure::Interval equal_samples{1.0, 1.0, 1.0};
    measure::Interval equal_time{1.0, 1.0, 1.0};
    double bias = 0.0;                 ///< of the mean luminance of all points, relative
    double bias_standard_errors = 0.0; ///< the same over its standard error
    double share_above = 0.0, least_share_above = 0.0;
    double shadow_rays = 0.0; ///< of an estimate

    /// Whether the interval of its relative variance says anything: one that reaches below 0 shows that rare, very
    /// bright samples decide, of which there were too few.
    bool resolved() const { return relative_variance.low > 0.0 || relative_variance.value == 0.0; }
};

struct Comparison {
    std::vector<measure::Rgb> reference;
    std::vector<Compared> samplers;
    double sky_hidden = 0.0; ///< share of the cosine-weighted hemisphere behind something, mean over points
};

/// Above 1: `a` is better than `b`.
measure::Interval gain_at_equal_samples(const Compared& a, const Compared& b);
measure::Interval gain_at_equal_time(const Compared& a, const Compared& b);

class SamplerBuilder;

/// `points`: of the scene; those of in_the_open() to compare as if nothing were in the way. `reference`: of the
/// same points, where it is known already.
Comparison compare(const measure::Scene& scene, const std::vector<measure::ScenePoint>& points,
                   SamplerBuilder& builder, const ComparisonOptions& options, const build::Progress& progress = {},
                   std::vector<measure::Rgb> reference = {});

/// One sentence each: who is best by equal samples and by equal time, and whether that is sure. What is not
/// resolved takes no part.
std::vector<std::string> verdict(const Comparison& comparison, bool timed);

/// Two samplers whose order is another where light is hidden, beyond the noise of both runs.
struct Overtaking {
    const Compared* winner = nullptr; ///< where light is hidden
    const Compared* loser = nullptr;
};
/// By `gain`, one of the two above; `hidden` and `open` have the same samplers.
using Gain = measure::Interval (*)(const Compared& a, const Compared& b);
std::vector<Overtaking> overtakings(const Comparison& hidden, const Comparison& open, Gain gain);

} // namespace acdf::tools
