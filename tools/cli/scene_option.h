// The normals of a scene, as options of every subcommand that can be made for them.
#pragma once

#include "input/scene_normals.h"
#include "tools/cli/conversion.h"

#include <acdf/builder.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace acdf::tools {

struct SceneOption {
    std::vector<std::string> paths; ///< none: all normals

    bool given() const { return !paths.empty(); }
    /// The source and these, for Conversion::files.
    std::vector<std::string*> files(std::string& source);

    /// `help`: what the normals of the scene are for.
    void add(CLI::App& command, const std::string& help, const char* group);
    /// Throws CLI::ValidationError where there is an option of the scene, but no scene.
    void check(const CLI::App& command) const;
    /// The option in one spelling, with the SHA-256 of each file. Throws input::Error.
    std::string text() const;
    /// Empty where no scene was given; what was read is noted.
    std::vector<builder::SceneNormal> read(const Note& note) const;
    const input::SceneOptions& input() const { return input_; }

private:
    input::SceneOptions input_;
};

} // namespace acdf::tools
