// --view: from where a BRDF is looked at.
#pragma once

#include "tools/commands.h"
#include "tools/plot/brdf.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string>

namespace acdf::tools {

inline CLI::Option* add_view(CLI::App& command, std::string& view, const char* group) {
    return command
        .add_option("--view", view, "For a BRDF, the direction of view in degrees from the normal, and around it")
        ->option_text("THETA[,PHI]")
        ->group(group);
}

/// The unit vector that --view gave, in the surface's frame. Throws Failure where there is none,
/// CLI::ValidationError where it is no direction above the surface.
inline std::array<float, 3> chosen_view(const std::string& path, const File& file, const std::string& view) {
    if (view.empty()) throw Failure(path + ": is a BRDF; choose a direction of view with --view THETA[,PHI]");
    const auto angles = parse_view(view);
    if (!angles)
        throw CLI::ValidationError("--view", "needs angles in degrees such as 60 or 60,30; theta below 90");
    std::array<float, 3> wo{};
    PlottedView{file.brdf(), *angles}.direction(wo.data());
    return wo;
}

inline void refuse_view(const std::string& path, const std::string& view) {
    if (!view.empty()) throw Failure(path + ": is not a BRDF; leave out --view");
}

} // namespace acdf::tools
