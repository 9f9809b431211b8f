#include "tools/cli/output_names.h"

#include "input/brdf/models.h"
#include "input/file_name.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <map>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

bool is_model(const std::string& input) {
    std::error_code ignored;
    return input::is_model(input) && !fs::exists(input, ignored);
}

bool is_folder(const std::string& output) {
    std::error_code ignored;
    return output.back() == '/' || fs::is_directory(output, ignored);
}

/// Pipes and devices have whatever name they have.
void check_extension(const std::string& output, const std::string& extension) {
    std::error_code ignored;
    const fs::file_status status = fs::status(output, ignored);
    const std::string own = input::lower_extension(output);
    if (own.empty() || own == extension || (fs::exists(status) && !fs::is_regular_file(status))) return;
    throw CLI::ValidationError("--output", "'" + output + "' ends in " + own + ", and " + extension +
                                               " is what is written; give a name such as " +
                                               fs::path(output).replace_extension(extension).string());
}

} // namespace

std::string output_beside(const std::string& input, const std::string& suffix) {
    return (is_model(input) ? input : fs::path(input).replace_extension().string()) + suffix;
}

std::vector<std::string> output_names(const std::vector<std::string>& inputs, const std::string& output,
                                      const std::string& suffix) {
    const std::string extension = fs::path("x" + suffix).extension().string();
    if (inputs.size() > 1 &&
        (output == "-" || (!output.empty() && !is_folder(output) && fs::path(output).has_extension())))
        throw CLI::ValidationError("--output", "'" + output + "' is one file, and there are " +
                                                   std::to_string(inputs.size()) +
                                                   " inputs; give a folder, such as library/, leave it out, or say "
                                                   "with --faces that they are those of a cube");
    if (inputs.size() == 1 && !output.empty() && (output == "-" || !is_folder(output))) {
        if (output != "-") check_extension(output, extension);
        return {output};
    }
    std::vector<std::string> names;
    std::map<std::string, std::string> made; // of which input
    for (const std::string& input : inputs) {
        if (output.empty() && input == "-") throw CLI::ValidationError("--output is missing: stdin has no name");
        if (output.empty() && input::lower_extension(input) == extension)
            throw Failure(input + ": ends in " + extension +
                          " as its output would; give the source, or a name with -o");
        std::string name = output_beside(input, suffix);
        if (!output.empty())
            name = (fs::path(output) / (is_model(input) ? name : fs::path(name).filename().string())).string();
        const auto [first, is_new] = made.emplace(fs::path(name).lexically_normal().string(), input);
        if (!is_new)
            throw CLI::ValidationError("'" + input + "' and '" + first->second + "' would both become " + name +
                                       "; give them one at a time, each with a name (-o)");
        names.push_back(name);
    }
    return names;
}

} // namespace acdf::tools
