// Options of every subcommand that reads a probe.
#pragma once

#include "input/probe.h"

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace acdf::tools {

/// `name` is another where --projection means that of an output.
inline void add_projection(CLI::App& command, input::Projection& projection, const char* name = "--projection") {
    const std::map<std::string, input::Projection> names{
        {"auto", input::Projection::automatic},        {"latlong", input::Projection::latlong},
        {"angular", input::Projection::angular},       {"mirrorball", input::Projection::mirrorball},
        {"cube-cross", input::Projection::cube_cross}, {"octahedral", input::Projection::octahedral}};
    command
        .add_option(name, projection,
                    "How the probe lays out directions: auto (metadata, then shape), latlong, angular (Debevec), "
                    "mirrorball, cube-cross, octahedral (equal-area). Set it where auto refuses")
        ->transform(CLI::CheckedTransformer(names).description(""))
        ->option_text("NAME [auto]")
        ->group("Input");
}

} // namespace acdf::tools
