#include "tools/cli/conversion.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"

#include "tools/cli/file_input.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/output_names.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <cstdio>
#include <new>
#include <optional>

namespace acdf::tools {
namespace {

struct RunOptions {
    std::vector<std::string> sources;
    std::string output; ///< as it was given: a file, a folder, or none
    int threads = 0;
    bool json = false, quiet = false, force = false;
};

/// Remarks are said, unless `quiet`, and kept in `notes`.
Converted convert(Conversion& conversion, bool quiet, std::vector<std::string>& notes) {
    ProgressBar bar(quiet);
    return conversion.convert({bar.callback(), [&](const std::string& text) {
                                   notes.push_back(on_one_line(text));
                                   if (!quiet) say(conversion.source + ": " + text);
                               }});
}

/// What --json prints.
nlohmann::ordered_json run_one(Conversion& conversion, const RunOptions& options, const std::string& path) {
    std::vector<std::string> notes;
    Output output(path, options.force, input_paths(conversion)); // refuses early, before the work
    const Converted made = convert(conversion, options.quiet, notes);
    output.write(made.bytes.data(), made.bytes.size());
    output.commit(check_reads_back);

    if (!options.json && !options.quiet)
        std::fprintf(path == "-" ? stderr : stdout, "%s: %s, %s\n", printable(path).c_str(),
                     to_readable_size(made.bytes.size()).c_str(), made.summary.c_str());
    nlohmann::ordered_json report{{"file", path}};
    report.update(nlohmann::ordered_json::parse(made.report));
    report["notes"] = notes;
    return report;
}

/// A source that fails stops no other. Whether all are made; a report of each that is, in `reports`.
bool run_several(Conversion& conversion, const RunOptions& options, const std::vector<std::string>& names,
                 nlohmann::ordered_json& reports) {
    bool all = true;
    for (std::size_t i = 0; i < names.size(); ++i) {
        conversion.source = options.sources[i];
        try {
            reports.push_back(run_one(conversion, options, names[i]));
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            say(std::string("acdf: ") + error.what());
            all = false;
        }
    }
    return all;
}

/// The six faces of a cube become one source (lib/input/probe/source.h).
void join_faces(RunOptions& options) {
    const std::vector<std::string> files = options.sources;
    if (files.size() == 1) return;
    if (files.size() != 6) throw CLI::ValidationError("--faces", "takes one file, or six: the faces of a cube");
    if (options.output.empty()) throw CLI::ValidationError("--output", "is needed where six faces are one map");
    std::string joined;
    for (const std::string& file : files) {
        if (file.find(',') != std::string::npos)
            throw CLI::ValidationError("PROBE", "may not have commas in the names of faces");
        joined += (joined.empty() ? "" : ",") + file;
    }
    options.sources = {joined};
}

int run(Conversion& conversion, const RunOptions& options, const std::string& suffix) {
    conversion.source = options.sources[0];
    conversion.check();
    const std::vector<std::string> names = output_names(options.sources, options.output, suffix);
    const auto limit = limit_threads(options.threads);
    const bool several = names.size() > 1;
    std::optional<OutputFolder> folder;
    if (!options.output.empty() && names[0] != options.output) folder.emplace(options.output);
    nlohmann::ordered_json reports = nlohmann::ordered_json::array();
    bool all = true;
    if (several) all = run_several(conversion, options, names, reports);
    else reports.push_back(run_one(conversion, options, names[0]));
    if (options.json)
        std::fputs(json_text(several ? reports : reports[0]).c_str(), names[0] == "-" ? stderr : stdout);
    return all ? exit_done : exit_failed;
}

} // namespace

void add_conversion(CLI::App& command, std::shared_ptr<Conversion> conversion, const ConversionHelp& help,
                    int& exit_code) {
    auto options = std::make_shared<RunOptions>();
    command.add_option(help.source, options->sources, help.source_text)->required()->type_name("")->group("Input");
    add_output(command, options->output, options->force,
               std::string("The .acdf file to write, or a folder for one of each input; without it NAME") +
                   help.suffix + " beside the input");
    conversion->add_options(command);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help.footer);
    command.callback([conversion, options, suffix = std::string(help.suffix), &exit_code] {
        if (const auto* reading = conversion->reading(); reading && reading->faces) join_faces(*options);
        if (conversion->takes_all(options->sources)) {
            if (options->output.empty())
                throw CLI::ValidationError("--output", "is needed where several maps become one file");
            options->sources = {conversion->source};
        }
        exit_code = run(*conversion, *options, suffix);
    });
}

} // namespace acdf::tools
