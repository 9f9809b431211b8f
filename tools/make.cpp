// acdf make: the file that suits a renderer. Chooses the kind, and leaves the rest to `acdf env` or `acdf local`.
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/renderer.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {
namespace {

const char* command_of(const builder::Renderer& renderer) {
    return renderer.kind() == ACDF_KIND_LOCAL ? "local" : "env";
}

/// Says what was chosen and why, and runs it.
int make(const builder::Renderer& renderer, const std::vector<std::string>& others) {
    std::vector<std::string> words{"acdf", command_of(renderer)};
    words.insert(words.end(), others.begin(), others.end());
    words.insert(words.end(), {"--for", renderer.name});
    const auto is_quiet = [](const std::string& word) { return word == "-q" || word == "--quiet"; };
    if (std::none_of(others.begin(), others.end(), is_quiet))
        say(std::string("acdf make: for ") + renderer.name + " runs `acdf " + command_of(renderer) +
            "`: " + renderer.why);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return run_program(static_cast<int>(words.size()), argv.data());
}

} // namespace

void add_make(CLI::App& program, int& exit_code) {
    CLI::App& command = *program.add_subcommand(
        "make", "The file that suits a renderer: `acdf env` or `acdf local`, with what --for sets");
    const auto chosen = std::make_shared<const builder::Renderer*>(nullptr);
    add_renderer(command, *chosen);
    command.get_option("--for")->required();
    command.allow_extras();
    command.footer(help_footer(
        "Makes a local file where the renderer's environment light is given the normal, else an environment file; "
        "for the "
        "MIS partner and the heuristic of the renderer's path integrator, where it has them. All else (PROBE, -o, "
        "--budget, --scene and so on) is given as to `acdf env` and `acdf local`.",
        "acdf make probe.exr -o probe.acdf --for pbrt-v4\n"
        "acdf make probe.exr -o probe.acdf --for cycles --budget 64KiB"));
    command.callback([&command, chosen, &exit_code] { exit_code = make(**chosen, command.remaining()); });
}

} // namespace acdf::tools
