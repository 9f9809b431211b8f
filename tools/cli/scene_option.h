// The normals of a scene, as options of every subcommand that can be made for them.
#pragma once

#include "input/normals/scene.h"
#include "tools/cli/conversion.h"
#include "tools/cli/scene_axes.h"

#include <acdf/renderers.h>

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace acdf::tools {

/// --scene-up.
CLI::Option* add_scene_up(CLI::App& command, input::UpAxis& up, const std::string& help);

struct SceneOption {
    std::vector<std::string> paths; ///< none: all normals

    bool given() const { return !paths.empty(); }
    /// The source and these, for Conversion::files.
    std::vector<std::string*> files(std::string& source);

    /// `help`: what the normals of the scene are for.
    void add(CLI::App& command, const std::string& help, const char* group);
    /// --scene-axes, too, of commands that make files.
    void add_axes(CLI::App& command, const char* group);
    /// What the caller must do with directions, and with a scene in the renderer's frame of whose axes nothing was
    /// said.
    void note_axes(const CLI::App& command, const builder::Renderer& renderer, builder::Projection projection,
                   const Note& note) const;
    /// Throws CLI::ValidationError where there is an option of the scene, but no scene.
    void check(const CLI::App& command) const;
    /// The option in one spelling, with the SHA-256 of each file. Throws input::Error.
    std::string text() const;
    /// Empty where no scene was given; reading is noted.
    std::vector<builder::SceneNormal> read(const Note& note) const;
    const input::SceneOptions& input() const { return input_; }
    /// What is left to turn after reading.
    const SceneAxes& axes() const { return axes_; }

private:
    input::SceneOptions input_;
    SceneAxes axes_;
};

} // namespace acdf::tools
