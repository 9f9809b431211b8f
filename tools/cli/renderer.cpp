#include "tools/cli/renderer.h"

#include "build/text/options.h"

#include <CLI/CLI.hpp>

#include <vector>

namespace acdf::tools {

void add_renderer(CLI::App& command, const Renderer*& chosen) {
    std::vector<std::string> names;
    for (const Renderer& renderer : renderers) names.emplace_back(renderer.name);
    command
        .add_option_function<std::string>(
            "--for",
            [&chosen](const std::string& name) {
                for (const Renderer& renderer : renderers)
                    if (name == renderer.name) chosen = &renderer;
            },
            "The renderer that will use the file: sets --domain, --filter and --channel as it looks its map up, "
            "but for "
            "those that are given by themselves, and tells which axes to swap: pbrt-v4, pbrt-v3, mitsuba3, cycles, "
            "luxcore, three")
        ->check(CLI::IsMember(names).description(""))
        ->option_text("NAME")
        ->group("Input");
}

void use_renderer(const CLI::App& command, const Renderer* chosen, input::ProbeOptions& input,
                  builder::TargetOptions& target) {
    if (!chosen) return;
    const auto given = [&](const char* option) { return command.get_option(option)->count() > 0; };
    if (!given("--domain")) input.domain = chosen->domain;
    if (!given("--filter")) target.filter = chosen->filter;
    if (given("--channel")) return;
    for (const build::ChannelName& channel : build::channel_names)
        if (channel.name == std::string(chosen->channel))
            target.channels = {channel.channels, {channel.weights.r, channel.weights.g, channel.weights.b}};
}

std::string axes_text(const Renderer& renderer) {
    return std::string("in ") + renderer.name + " a drawn (x, y, z) is " + renderer.there +
           " in the frame of the light; ask for the density of its (X, Y, Z) as " + renderer.back;
}

} // namespace acdf::tools
