#include "tools/cli/scene_option.h"

#include "tools/cli/choice.h"

#include "input/image.h"

#include <map>

namespace acdf::tools {

void SceneOption::add(CLI::App& command, const std::string& help, const char* group) {
    command.add_option("--scene", paths, help + ". May be given several times: all files together")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->group(group);
    const std::map<std::string, input::UpAxis> axes{{"y", input::UpAxis::y}, {"z", input::UpAxis::z}};
    command
        .add_option(
            "--scene-up", input_.up,
            "Which axis of the scene points up; y turns (x, y, z) into (z, x, y), as docs/conventions.md has it")
        ->transform(one_of(axes))
        ->option_text("y|z [z]")
        ->group(group);
    command
        .add_flag("--scene-rgb", input_.rgb_is_normal,
                  "Take R, G and B of the scene's image as a normal where no channel is named as one")
        ->group(group);
}

std::vector<std::string*> SceneOption::files(std::string& source) {
    std::vector<std::string*> out{&source};
    for (std::string& path : paths) out.push_back(&path);
    return out;
}

void SceneOption::check(const CLI::App& command) const {
    for (const char* option : {"--scene-up", "--scene-rgb"})
        if (!given() && command.get_option(option)->count() > 0)
            throw CLI::ValidationError(option, "is of the file given by --scene");
}

std::string SceneOption::text() const {
    std::string out;
    for (const std::string& path : paths)
        out += (out.empty() ? "--scene " : " --scene ") + input::file_sha256(path);
    return out + (input_.up == input::UpAxis::y ? " --scene-up y" : "") +
           (input_.rgb_is_normal ? " --scene-rgb" : "");
}

std::vector<builder::SceneNormal> SceneOption::read(const Note& note) const {
    std::vector<builder::SceneNormal> out;
    for (const std::string& path : paths) {
        const input::SceneNormals scene = input::read_scene_normals(path, input_);
        for (const input::WeightedNormal& n : scene.normals) out.push_back({{n.n[0], n.n[1], n.n[2]}, n.weight});
        note(path + ": a " + scene.kind + " with " + std::to_string(scene.normals.size()) + " different normals, " +
             std::to_string(scene.skipped) + " skipped");
    }
    return out;
}

} // namespace acdf::tools
