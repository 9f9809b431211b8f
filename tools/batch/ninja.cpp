#include "tools/batch/ninja.h"

#include "input/mesh/instances.h"
#include "input/probe/source.h"
#include "tools/cli/messages.h"
#include "tools/commands.h"

#include <algorithm>
#include <filesystem>

namespace acdf::tools {

const char ninja_mark[] = "# Made by `acdf batch --emit ninja`: changes here will be lost.";

namespace {

namespace fs = std::filesystem;

/// A word of a command line.
std::string shell_quoted(const std::string& word) {
    const auto plain = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("/._-=,:+%@").find(c) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

std::string shell_command(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_quoted(word);
    return text;
}

/// Ninja has no way to write the end of a line. Throws Failure.
void require_one_line(const std::string& text) {
    if (text.find_first_of("\r\n") != std::string::npos)
        throw Failure(on_one_line(text) +
                      ": has a line end in its name, which a build file of Ninja cannot hold; rename it, "
                      "or run acdf batch without --emit");
}

/// Text as the value of a variable.
std::string value(const std::string& text) {
    require_one_line(text);
    std::string out;
    for (const char c : text) out += c == '$' ? "$$" : std::string(1, c);
    return out;
}

/// A path in a list of paths. Ninja ends a path at a bar however it is escaped, but not at that of a variable.
std::string path_text(const std::string& path) {
    require_one_line(path);
    std::string out;
    for (const char c : path)
        if (c == '|') out += "${bar}";
        else out += c == '$' || c == ' ' || c == ':' ? std::string("$") + c : std::string(1, c);
    return out;
}

std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

/// `folder`: where the build file lies.
std::string edge(const PlannedJob& planned, bool large, const std::string& folder, const MakeConversion& make) {
    const BatchJob& job = planned.job;
    const std::shared_ptr<Conversion> conversion = make(job);
    std::string text = "build " + path_text(job.output) + ": convert";
    for (const std::string& file : job.files()) text += " " + path_text(absolute(file));
    // Paths among the options are relative to their manifest.
    const std::vector<std::string*> files = conversion->files();
    std::string output = job.output, at, between = " | ";
    for (std::size_t i = std::max<std::size_t>(job.maps.size(), 1); i < files.size(); ++i) {
        for (const std::string& file : input::scene_files(*files[i])) {
            text += between + path_text(absolute(file));
            between = " ";
        }
        output = absolute((fs::path(folder) / job.output).string());
        at = "  at = cd " + value(shell_quoted(absolute(job.base.empty() ? "." : job.base))) + " &&\n";
    }
    std::vector<std::string> command = {job.kind->name};
    for (const std::string& map : job.maps) command.push_back(absolute(map));
    if (job.maps.empty())
        command.push_back(job.files().empty() ? job.source : input::with_paths(job.source, absolute));
    command.insert(command.end(), {"--output=" + output, "--force", "--quiet"});
    if (!large) command.insert(command.end(), {"--threads", "1"});
    command.insert(command.end(), job.options.begin(), job.options.end());
    return text + "\n" + at + "  arguments = " + value(shell_command(command)) + "\n" +
           (large ? "  pool = large\n" : "");
}

} // namespace

std::string ninja_text(const std::vector<PlannedJob>& plan, const NinjaBuild& build, const MakeConversion& make) {
    const std::uint64_t each = build.memory / static_cast<std::uint64_t>(std::max(1, build.threads));
    std::uint64_t most = 1;
    for (const PlannedJob& job : plan) most = std::max(most, job.memory);
    std::string text =
        std::string(ninja_mark) +
        "\nninja_required_version = 1.5\nbar = |\nacdf = " + value(shell_quoted(build.program)) +
        "\n\npool large\n  depth = " + std::to_string(std::max<std::uint64_t>(1, build.memory / most)) +
        "\n\nrule convert\n  command = $at $acdf $arguments\n  description = $out\n\nrule plan\n"
        "  command = cd " +
        value(shell_quoted(build.folder)) + " && $acdf " + value(shell_command(build.command)) +
        "\n  description = build.ninja\n  generator = 1\n\nbuild build.ninja: plan |";
    for (const std::string& file : build.dependencies) text += " " + path_text(file);
    text += "\n\n";
    for (const PlannedJob& job : plan) text += edge(job, job.memory > each, build.output, make);
    return text;
}

} // namespace acdf::tools
