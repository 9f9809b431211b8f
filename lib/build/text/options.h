// Options in the words of the command line, each in one spelling and none that has its default: the metadata
// `fit.options` of a file, so that the same text, source and program mean the same bytes.
#pragma once

#include "compress/fit/fit.h"
#include "compress/target.h"

#include <string>

namespace acdf::build {

/// A name on the command line for what a renderer is noisy in.
struct ChannelName {
    const char* name;
    AcdfChannels channels;
    compress::ChannelWeights weights;
};
constexpr ChannelName channel_names[] = {
    {"luminance", ACDF_CHANNELS_WEIGHTED, {}},
    {"rgb", ACDF_CHANNELS_SEPARATE, {1.0, 1.0, 1.0}},
    {"max", ACDF_CHANNELS_LARGEST, {1.0, 1.0, 1.0}},
    {"red", ACDF_CHANNELS_WEIGHTED, {1.0, 0.0, 0.0}},
    {"green", ACDF_CHANNELS_WEIGHTED, {0.0, 1.0, 0.0}},
    {"blue", ACDF_CHANNELS_WEIGHTED, {0.0, 0.0, 1.0}},
    {"average", ACDF_CHANNELS_WEIGHTED, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}},
};

/// The shortest decimal number that reads back as `value`.
std::string option_number(double value);
std::string option_number(float value);

// Each ends in a space, or is empty where all is as by default.
std::string target_text(const compress::TargetOptions& target); ///< "--channel rgb --filter nearest "
std::string fit_text(AcdfFit fit);                              ///< "--fit cdf "
std::string codec_text(AcdfCodec codec);                        ///< "--compress zlib "

/// "--budget 65536"; never left out.
std::string goal_text(const compress::Goal& goal);

/// A decimal number of fixed width, for metadata: what accuracy is reached must not change the size that a budget
/// is compared with.
std::string accuracy_text(double value);

} // namespace acdf::build
