// Options of every subcommand that fits a probe: whose noise counts, and how the renderer looks the probe up.
#pragma once

#include "build/text/options.h"

#include "tools/cli/choice.h"

#include <acdf/builder.h>

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace acdf::tools {

inline void add_channels(CLI::App& command, builder::Channels& channels, const char* help) {
    std::vector<std::string> names;
    for (const build::ChannelName& channel : build::channel_names) names.push_back(channel.name);
    command
        .add_option_function<std::string>(
            "--channel",
            [&channels](const std::string& name) {
                for (const build::ChannelName& channel : build::channel_names)
                    if (name == channel.name)
                        channels = {channel.channels, {channel.weights.r, channel.weights.g, channel.weights.b}};
            },
            help)
        ->check(CLI::IsMember(names).description(""))
        ->option_text("NAME [luminance]")
        ->group("Fit");
}

/// How a renderer looks a map up; `into`: as of add_choice.
template <class Into>
CLI::Option* add_filter(CLI::App& command, Into&& into, const char* help) {
    constexpr Named<AcdfFilter> filters[] = {{"nearest", ACDF_FILTER_NEAREST}, {"bilinear", ACDF_FILTER_BILINEAR}};
    return add_choice(command, "--filter", std::forward<Into>(into), filters, help);
}

inline void add_target_options(CLI::App& command, builder::TargetOptions& target) {
    add_channels(
        command, target.channels,
        "Whose noise is minimised: luminance (Rec. 709), rgb (the sum over the three channels: for strongly "
        "coloured lights), max (the largest channel), average (all alike), red, green or blue alone");
    add_filter(command, target.filter,
               "How your renderer looks the map up: bilinear, or nearest. A bilinear file serves nearest lookups, "
               "too, with a little more noise; a nearest file is biased under bilinear lookups, which blend light "
               "into dark texels")
        ->option_text("NAME [bilinear]")
        ->group("Fit");
    constexpr Named<builder::Wrap> wraps[] = {{"clamp", builder::Wrap::clamp}, {"repeat", builder::Wrap::repeat}};
    add_choice(command, "--wrap", target.wrap, wraps,
               "What a bilinear lookup finds within half a texel of the poles of a lat-long map, and beyond the "
               "sides of a disc: clamp (the row itself), or repeat (the row at the other end, as textures that "
               "repeat have it: Cycles, pbrt-v3, LuxCore)")
        ->option_text("NAME [clamp]")
        ->group("Fit");
}

} // namespace acdf::tools
