// What a renderer does with its map, all at once: --for.
#pragma once

#include "input/probe/probe.h"

#include <acdf/renderers.h>

#include <string>

namespace CLI {
class App;
}

namespace acdf::tools {

/// The option --for; `chosen` is null until it is given.
void add_renderer(CLI::App& command, const builder::Renderer*& chosen);

/// Sets domain, filter, wrap and channel, those left as they are that the command line gave by themselves.
void use_renderer(const CLI::App& command, const builder::Renderer* chosen, input::ProbeOptions& input,
                  builder::TargetOptions& target);

/// Sets the MIS partner that suits, but for what the command line gave by itself. Returns whether one was set.
bool use_partner(const CLI::App& command, const builder::Partner& suits, builder::Partner& partner);

/// Why a file is for that partner, and what must hold: one line.
std::string partner_text(const builder::Renderer& renderer, const builder::Partner& partner);

/// What the caller must do with directions of a map of that projection: one line.
std::string axes_text(const builder::Renderer& renderer, builder::Projection projection);

} // namespace acdf::tools
