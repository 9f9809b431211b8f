// How large a fit becomes, or how accurate: --cells, --budget and --target-variance, of which one is enough.
#pragma once

#include "tools/cli/number_range.h"
#include "tools/cli/sizes.h"

#include <acdf/builder.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace acdf::tools {

/// What differs from kind to kind.
struct GoalTexts {
    const char* cells;          ///< what --cells counts
    const char* cells_default;  ///< "N"
    const char* budget_default; ///< "SIZE [64KiB]"
    const char* variance_of;    ///< behind "at most this relative variance"
    std::uint32_t least_cells = 1, most_cells = 1u << 28;
};

inline void add_goal(CLI::App& command, std::uint32_t& cells, std::string& budget, double& variance,
                     const GoalTexts& texts) {
    const char* group = "Size and accuracy";
    command.add_option("--cells", cells, texts.cells)
        ->check(CLI::Range(texts.least_cells, texts.most_cells))
        ->option_text(texts.cells_default)
        ->group(group);
    command
        .add_option(
            "--budget", budget,
            "The most accurate file of at most this size, such as 64KiB or 20kB: to fit a cache, or a download")
        ->check([](const std::string& text) {
            const auto bytes = parse_size(text);
            return bytes && *bytes == 0 ? std::string("needs a size above 0") : std::string();
        })
        ->option_text(texts.budget_default)
        ->group(group);
    command
        .add_option("--target-variance", variance,
                    std::string("The smallest file whose samples have at most this relative variance") +
                        texts.variance_of)
        ->check(positive_number())
        ->option_text("V")
        ->group(group);
}

/// --max-weight; `beyond` adds to its help what holds for one kind alone.
inline void add_max_weight(CLI::App& command, double& max_weight, const char* beyond = "") {
    command
        .add_option(
            "--max-weight", max_weight,
            std::string("No sample has a weight above W times the mean (largest f/p): no fireflies, at the price "
                        "of some cells. It holds for whatever size is asked for, and fails where that is too "
                        "small") +
                beyond)
        ->check(number_range(1.01, 1e9))
        ->option_text("W")
        ->group("Size and accuracy");
}

/// Takes over what was given; else `goal` stays as it is. Throws CLI::ValidationError where
/// there are two, or a budget is no size.
inline void read_goal(const CLI::App& command, const std::string& budget, builder::Goal& goal) {
    using Kind = builder::Goal::Kind;
    const auto given = [&](const char* option) { return command.get_option(option)->count() > 0; };
    if (given("--cells") + given("--budget") + given("--target-variance") > 1)
        throw CLI::ValidationError("one of --cells, --budget and --target-variance is enough");
    if (given("--cells")) goal.kind = Kind::cells;
    if (given("--target-variance")) goal.kind = Kind::variance;
    if (!given("--budget")) return;
    const auto bytes = parse_size(budget);
    if (!bytes) throw CLI::ValidationError("--budget", "needs a size such as 64KiB, 2MB or 20000");
    goal.kind = Kind::budget;
    goal.budget = *bytes;
}

} // namespace acdf::tools
