#include "tools/cli/scene_option.h"

#include "tools/cli/choice.h"
#include "tools/cli/renderer.h"

#include "input/mesh/instances.h"

#include <CLI/CLI.hpp>

namespace acdf::tools {

CLI::Option* add_scene_up(CLI::App& command, input::UpAxis& up, const std::string& help) {
    constexpr Named<input::UpAxis> axes[] = {{"y", input::UpAxis::y}, {"z", input::UpAxis::z}};
    return add_choice(command, "--scene-up", up, axes, help)->option_text("y|z [z]");
}

void SceneOption::add(CLI::App& command, const std::string& help, const char* group) {
    command.add_option("--scene", paths, help + ". May be given several times: all files together")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->group(group);
    add_scene_up(
        command, input_.up,
        "Which axis of the scene points up; y turns (x, y, z) into (z, x, y), as docs/conventions.md has it")
        ->group(group);
    command
        .add_flag("--scene-rgb", input_.rgb_is_normal,
                  "Take R, G and B of the scene's image as a normal where no channel is named as one")
        ->group(group);
}

void SceneOption::add_axes(CLI::App& command, const char* group) {
    command
        .add_option_function<std::string>(
            "--scene-axes", [this](const std::string& text) { axes_ = SceneAxes::of(text); },
            "Which of the scene's axes are our x, y and z, any of them negated: (-x,y,z) where it is in the "
            "frame of pbrt. What --for says of its (X, Y, Z) can be given as it stands")
        ->option_text("AXES [(x,y,z)]")
        ->excludes("--scene-up")
        ->group(group);
}

std::vector<std::string*> SceneOption::files(std::string& source) {
    std::vector<std::string*> out{&source};
    for (std::string& path : paths) out.push_back(&path);
    return out;
}

void SceneOption::note_axes(const CLI::App& command, const builder::Renderer& renderer,
                            builder::Projection projection, const Note& note) const {
    note(axes_text(renderer, projection));
    const builder::Axes* axes = renderer.axes_of(projection);
    const std::string back = (axes ? *axes : renderer.axes).inverse().text("XYZ");
    if (!given() || SceneAxes::of(back).ours()) return;
    for (const char* option : {"--scene-up", "--scene-axes"})
        if (command.get_option(option)->count() > 0) return;
    note(std::string("the scene's coordinates are taken as acdf's own; if they are those of ") + renderer.name +
         ", add --scene-axes \"" + back + "\"");
}

void SceneOption::check(const CLI::App& command) const {
    for (const char* option : {"--scene-up", "--scene-axes", "--scene-rgb"})
        if (const CLI::Option* found = command.get_option_no_throw(option); found && !given() && found->count() > 0)
            throw CLI::ValidationError(option, "is of the file given by --scene");
}

std::string SceneOption::text() const {
    std::string out;
    for (const std::string& path : paths)
        out += (out.empty() ? "--scene " : " --scene ") + input::scene_sha256(path);
    return out + (input_.up == input::UpAxis::y ? " --scene-up y" : "") +
           (axes_.ours() ? "" : " --scene-axes " + axes_.text()) + (input_.rgb_is_normal ? " --scene-rgb" : "");
}

std::vector<builder::SceneNormal> SceneOption::read(const Note& note) const {
    std::vector<builder::SceneNormal> out;
    for (const std::string& path : paths) {
        const input::SceneNormals scene = input::read_scene_normals(path, input_);
        for (const input::WeightedNormal& given : scene.normals) {
            const std::array<float, 3> n = axes_.turned(given.n);
            out.push_back({{n[0], n[1], n[2]}, given.weight});
        }
        note(path + ": a " + scene.kind + " with " + std::to_string(scene.normals.size()) + " different normals, " +
             std::to_string(scene.skipped) + " skipped");
    }
    return out;
}

} // namespace acdf::tools
