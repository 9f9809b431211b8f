// What a renderer does with its map, all at once: --for.
#pragma once

#include "input/probe/probe.h"

#include <string>

namespace CLI {
class App;
}

namespace acdf::tools {

/// docs/conventions.md, "Presets", says where each is read off.
struct Renderer {
    const char* name;
    input::Domain domain;
    AcdfFilter filter;
    const char* channel; ///< of build::channel_names
    const char* there;   ///< our (x, y, z) in its light's frame
    const char* back;    ///< its (X, Y, Z) in ours
};
constexpr Renderer renderers[] = {
    {"pbrt-v4", input::Domain::octahedral, ACDF_FILTER_NEAREST, "average", "(-x, y, z)", "(-X, Y, Z)"},
    {"pbrt-v3", input::Domain::latlong, ACDF_FILTER_BILINEAR, "luminance", "(-x, y, z)", "(-X, Y, Z)"},
    {"mitsuba3", input::Domain::latlong, ACDF_FILTER_BILINEAR, "luminance", "(y, z, x)", "(Z, X, Y)"},
    {"cycles", input::Domain::latlong, ACDF_FILTER_BILINEAR, "average", "(x, y, z)", "(X, Y, Z)"},
    {"luxcore", input::Domain::latlong, ACDF_FILTER_BILINEAR, "luminance", "(-x, y, z)", "(-X, Y, Z)"},
    {"three", input::Domain::latlong, ACDF_FILTER_BILINEAR, "luminance", "(x, z, -y)", "(X, -Z, Y)"},
};

/// The option --for; `chosen` is null until it is given.
void add_renderer(CLI::App& command, const Renderer*& chosen);

/// Sets domain, filter and channel, those left as they are that the command line gave by themselves.
void use_renderer(const CLI::App& command, const Renderer* chosen, input::ProbeOptions& input,
                  builder::TargetOptions& target);

/// What the caller must do with directions: one line.
std::string axes_text(const Renderer& renderer);

} // namespace acdf::tools
