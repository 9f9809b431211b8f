// Options of every subcommand that reads a probe.
#pragma once

#include "input/probe/probe.h"

#include "tools/cli/choice.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace acdf::tools {

/// `name` is another where --projection means that of an output.
inline void add_projection(CLI::App& command, input::Projection& projection, const char* name = "--projection") {
    constexpr Named<input::Projection> names[] = {
        {"auto", input::Projection::automatic},        {"latlong", input::Projection::latlong},
        {"angular", input::Projection::angular},       {"mirrorball", input::Projection::mirrorball},
        {"cube-cross", input::Projection::cube_cross}, {"octahedral", input::Projection::octahedral}};
    add_choice(command, name, projection, names,
               "How the probe lays out directions: auto (metadata, then shape), latlong, angular (Debevec), "
               "mirrorball, cube-cross, octahedral (equal-area). Set it where auto refuses")
        ->option_text("NAME [auto]")
        ->group("Input");
}

/// The faces of a cube, as six files or in a strip.
inline void add_faces(CLI::App& command, std::optional<input::Faces>& faces) {
    command
        .add_option_function<std::string>(
            "--faces",
            [&faces](const std::string& text) {
                input::Faces parsed;
                if (!input::parse_faces(text, parsed))
                    throw CLI::ValidationError("--faces",
                                               "needs directx, opengl, openexr, or six faces in the order "
                                               "of the files, such as +x,-x,+y,-y,+z,-z");
                faces = parsed;
            },
            "The probe is six faces of a cube: six files, or one strip (1:6, 6:1, 2:3, 3:2). Their order is +X -X "
            "+Y -Y +Z -Z for directx (pictures as seen from inside), opengl (mirrored pictures) and openexr (texel "
            "centres on the borders). Any other order is six of +x,-x,+y,-y,+z,-z (px, posx, right ... too), with "
            "pictures as in directx")
        ->option_text("ORDER")
        ->group("Input");
}

/// The grid that a fit lies on.
inline void add_domain(CLI::App& command, input::Domain& domain) {
    constexpr Named<input::Domain> names[] = {{"source", input::Domain::source},
                                              {"latlong", input::Domain::latlong},
                                              {"octahedral", input::Domain::octahedral}};
    add_choice(command, "--domain", domain, names,
               "The grid that the fit lies on: source (the texels of a lat-long or octahedral probe; for other "
               "probes the grid of the two that loses least), latlong, octahedral (equal-area). The noise reported "
               "is that of a renderer that looks the probe itself up, whatever the grid")
        ->option_text("NAME [source]")
        ->group("Input");
}

/// Options for values that are not radiance, and for probes without any light.
inline void add_repairs(CLI::App& command, input::ProbeOptions& options) {
    constexpr Named<build::BadPixels> policies[] = {
        {"zero", build::BadPixels::zero}, {"clamp", build::BadPixels::clamp}, {"error", build::BadPixels::error}};
    add_choice(command, "--bad-pixels", options.bad_pixels, policies,
               "Treatment of NaN, infinite and negative values: zero; clamp (+infinity becomes 65504 in files of "
               "half floats, in others the largest finite value of its channel; the other bad values become 0); "
               "error (refuse the probe). The command counts and reports them")
        ->option_text("NAME [zero]")
        ->group("Input");
    constexpr Named<bool> when_black[] = {{"error", false}, {"uniform", true}};
    add_choice(command, "--on-black", options.uniform_if_black, when_black,
               "Treatment of a probe without any light: error, or uniform (all directions are equally likely; the "
               "total is next to 0)")
        ->option_text("NAME [error]")
        ->group("Input");
}

} // namespace acdf::tools
