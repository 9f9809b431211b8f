// The figures of `acdf render`, as a table for people and as JSON.
#pragma once

#include "tools/render/run.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// What a run was, beside its figures.
/// The comparison with one kind of random numbers.
struct RenderPass {
    measure::Numbers numbers = measure::Numbers::independent;
    Comparison comparison;
    std::optional<Comparison> in_the_open; ///< where objects that are not seen hide light: the same without any
};

/// "independent", "sobol".
const char* to_string(measure::Numbers numbers);

struct RenderRun {
    std::string scene; ///< its file's name
    ComparisonOptions options;
    std::vector<RenderPass> passes; ///< one or two; pictures are those of the first
};

/// Files that were written are named by the caller. Keys are stable, numbers exact. Indented, with a line end.
std::string render_json(const LoadedScene& scene, const RenderRun& run);

std::string render_table(const LoadedScene& scene, const RenderRun& run);

} // namespace acdf::tools
