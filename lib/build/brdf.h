// From a BRDF to the bytes of an .acdf file, and its exact accuracy.
#pragma once

#include "build/accuracy/brdf.h"
#include "build/progress.h"
#include "build/reflectance.h"
#include "compress/brdf/fit.h"
#include "compress/store/store.h"
#include "compress/target.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::build {

/// Views on which accuracy is measured: cos(theta_o) uniform in [0.1, 1].
constexpr std::uint32_t kMeasuredViews = 64;

/// What `acdf brdf` was asked for, beside the BRDF.
struct BrdfFileOptions {
    compress::BrdfOptions fit; ///< symmetry, max_weight and file_size are set by build_brdf
    double max_weight = 0.0;   ///< of rows that are shared: of the measured weights; 0: what costs next to nothing
    AcdfChannels channels = ACDF_CHANNELS_WEIGHTED;
    compress::ChannelWeights weights;
    float diffuse_share = 0.0f; ///< of a cosine lobe, in [0, 1)
    AcdfCodec codec = ACDF_CODEC_NONE;
    /// Not stored in the file: for callers who measure by themselves.
    std::uint32_t measured_views = kMeasuredViews;
};

/// All options that shape the file, in one spelling: its metadata `fit.options`.
std::string option_text(const BrdfFileOptions& options);

struct BrdfFile {
    std::vector<std::uint8_t> bytes; ///< the whole file
    BrdfAccuracy accuracy;           ///< of the stored pdfs, over random views
    std::uint32_t theta_views = 0, phi_views = 0;
};

/// rho cos(theta_i) as one number: the weighted sum, the largest, or (separate channels, whose noise adds up) the
/// root of the sum of squares of the channels. `brdf` must live as long.
compress::Reflected reflected_light(const Brdf& brdf, AcdfChannels channels,
                                    const compress::ChannelWeights& weights);

/// Whether what it reflects to either side of a view is known to be the same.
Sides sides(const Brdf& brdf);

/// The file of a fit, with zeros for what is not known yet.
std::vector<std::uint8_t> brdf_bytes(const compress::BrdfFit& fit, const BrdfFileOptions& options,
                                     const compress::Metadata& metadata);

/// Throws std::invalid_argument where nothing is reflected, std::runtime_error where the goal is out of reach.
BrdfFile build_brdf(const Brdf& brdf, const BrdfFileOptions& options, const Progress& progress = {});

} // namespace acdf::build
