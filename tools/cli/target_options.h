// Options of every subcommand that fits a probe: whose noise counts, and how the renderer looks the probe up.
#pragma once

#include "build/text/options.h"

#include "tools/cli/choice.h"

#include <acdf/builder.h>

#include <CLI/CLI.hpp>

#include <string>
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

inline void add_target_options(CLI::App& command, builder::TargetOptions& target) {
    add_channels(
        command, target.channels,
        "Whose noise is minimised: luminance (Rec. 709), rgb (the sum over the three channels: for strongly "
        "coloured lights), max (the largest channel), average (all alike), red, green or blue alone");
    constexpr Named<AcdfFilter> filters[] = {{"nearest", ACDF_FILTER_NEAREST}, {"bilinear", ACDF_FILTER_BILINEAR}};
    add_choice(command, "--filter", target.filter, filters,
               "How your renderer looks the map up: nearest or bilinear. Set it right: a lookup that blends light "
               "into dark texels finds light where a nearest fit has none, which is bias")
        ->option_text("NAME [nearest]")
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
