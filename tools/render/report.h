// The figures of `acdf render`, as a table for people and as JSON.
#pragma once

#include "tools/render/run.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace acdf::tools {

/// What a run was, beside its figures.
struct RenderRun {
    std::string scene; ///< as the user named it
    ComparisonOptions options;
    Comparison comparison;
    std::optional<Comparison> in_the_open; ///< the same points with nothing in the way
};

/// Files that were written are named by the caller. Keys are stable, numbers exact.
nlohmann::ordered_json render_json(const LoadedScene& scene, const RenderRun& run);

std::string render_table(const LoadedScene& scene, const RenderRun& run);

} // namespace acdf::tools
