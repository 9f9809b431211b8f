// From a probe to the bytes of an environment file: target, fit, cascade, file, and its exact accuracy.
#pragma once

#include "build/accuracy/environment.h"
#include "build/progress.h"
#include "compress/fit/fit.h"
#include "compress/local/normals.h"
#include "compress/partner.h"
#include "compress/store/store.h"

#include <acdf/builder.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::build {

/// The largest file that is searched for a goal of variance, about: beyond, the search would take gigabytes, and
/// the file come near to what it stands for. A budget may be larger.
constexpr std::uint64_t kMostBytesForVariance = 16 << 20;

/// What `acdf env` was asked for, beside the probe.
struct EnvironmentOptions {
    compress::TargetOptions target;
    compress::FitOptions fit; ///< without an order, fits of two levels are made both ways, the better one kept
    AcdfCodec codec = ACDF_CODEC_NONE;
    compress::Partner mis;                    ///< of trees of the variance fit alone
    std::vector<compress::SceneNormal> scene; ///< that the partner lights; empty: all normals
    std::string scene_text;                   ///< what `scene` was read from and how, as options in one spelling
};

struct Environment {
    std::vector<std::uint8_t> bytes;      ///< the whole file
    Accuracy accuracy;                    ///< of the stored pdf, after quantization
    std::optional<compress::Order> order; ///< which axis was split first, where that was tried or asked for
};

/// Where a probe came from, for the metadata.
using Source = builder::Source;

/// All options that shape the file, in one spelling: its metadata `fit.options`.
std::string option_text(const std::string& reading, const EnvironmentOptions& options);

/// Throws std::invalid_argument where the target has no energy, std::runtime_error where the goal is out of reach.
Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress = {});

/// "phi" or "z".
const char* to_string(compress::Order order);

} // namespace acdf::build
