#include "build/text/options.h"

#include "build/text/format_names.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace acdf::build {
namespace {

bool same(const compress::ChannelWeights& a, const compress::ChannelWeights& b) {
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

template <typename Number>
std::string shortest(Number value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

} // namespace

std::string option_number(double value) { return shortest(value); }
std::string option_number(float value) { return shortest(value); }

std::string accuracy_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.8e", std::clamp(value, 0.0, 9.99e99));
    return text;
}

std::string target_text(const compress::TargetOptions& target) {
    std::string text;
    if (target.channels != ACDF_CHANNELS_WEIGHTED || !same(target.weights, {})) {
        const auto* const end = std::end(channel_names);
        const auto* const known = std::find_if(std::begin(channel_names), end, [&](const ChannelName& name) {
            return name.channels == target.channels && same(name.weights, target.weights);
        });
        const compress::ChannelWeights& w = target.weights;
        text += "--channel " +
                (known != end ? std::string(known->name)
                              : option_number(w.r) + "," + option_number(w.g) + "," + option_number(w.b)) +
                " ";
    }
    return target.filter == ACDF_FILTER_BILINEAR ? text : text + "--filter " + filter_name(target.filter) + " ";
}

std::string fit_text(AcdfFit fit) { return fit == ACDF_FIT_VARIANCE ? "" : "--fit " + fit_name(fit) + " "; }

std::string codec_text(AcdfCodec codec) {
    return codec == ACDF_CODEC_NONE ? "" : "--compress " + codec_name(codec) + " ";
}

std::string goal_text(const compress::Goal& goal) {
    switch (goal.kind) {
    case compress::Goal::Kind::budget:
        return "--budget " + std::to_string(goal.budget);
    case compress::Goal::Kind::variance:
        return "--target-variance " + option_number(goal.variance);
    default:
        return "--cells " + std::to_string(goal.cells);
    }
}

} // namespace acdf::build
