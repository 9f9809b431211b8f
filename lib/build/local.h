// From a probe to the bytes of a local environment file, and its exact accuracy.
#pragma once

#include "build/accuracy/local.h"
#include "build/environment.h"
#include "build/progress.h"
#include "compress/local/fit_separate.h"
#include "compress/local/normals.h"
#include "compress/visibility/fit.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::build {

/// Where a scene gathers light, and what hides it there.
struct SceneVisibility {
    compress::VisibilityScene scene; ///< empty: there are no visibility cells
    compress::VisibilityFrame frame;
    std::vector<compress::PortalRectangle> portals; ///< among the cells
    bool beside_cosine = false;                     ///< compress::VisibilitySize
};

/// What `acdf local` was asked for, beside the probe.
struct LocalOptions {
    compress::TargetOptions target;
    compress::Goal goal{compress::Goal::Kind::budget, 0, std::uint64_t{1} << 20,
                        0.0};                 ///< cells: of the shared tree
    std::uint32_t subdivisions = 0;           ///< octahedral bins; 0: as suits the size
    std::uint32_t columns = 0, rows = 0;      ///< lat-long bins, if not 0
    std::uint32_t tiles = 0;                  ///< 0: as suits the size
    double max_weight = 0.0;                  ///< with sharing: of the measured weights; 0: no bound
    std::vector<compress::SceneNormal> scene; ///< empty: all normals
    bool sharing = true;
    compress::BinTarget bin_target = compress::BinTarget::mean; ///< without sharing
    compress::FitOptions fit; ///< of a bin's tree, without sharing: cdf, pdf or uniform
    double cosine_share = 0.0;
    SceneVisibility visibility; ///< only with sharing and a budget
    std::string scene_text;     ///< what `scene` was read from and how, as options in one spelling
    AcdfCodec codec = ACDF_CODEC_NONE;
    compress::Partner mis; ///< of bins that share tiles
};

/// All options that shape the file, in one spelling: its metadata `fit.options`.
std::string option_text(const std::string& reading, const LocalOptions& options);

struct Local {
    std::vector<std::uint8_t> bytes;
    LocalAccuracy accuracy; ///< over normals() of them
    std::uint32_t normals = 0;
};

/// Throws std::invalid_argument where the target has no energy, std::runtime_error where the goal is out of reach.
Local build_local(const compress::Target& target, const Source& source, const LocalOptions& options,
                  const Progress& progress = {});

} // namespace acdf::build
