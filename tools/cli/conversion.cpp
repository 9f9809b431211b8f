#include "tools/cli/conversion.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"

#include "tools/cli/file_input.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <cstdio>

namespace acdf::tools {
namespace {

struct RunOptions {
    std::string output;
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

void run(Conversion& conversion, const RunOptions& options) {
    conversion.check();
    const auto limit = limit_threads(options.threads);
    std::vector<std::string> inputs;
    for (const std::string* file : conversion.files()) inputs.push_back(*file);
    Output output(options.output, options.force, inputs); // refuses early, before the work
    std::vector<std::string> notes;
    const Converted made = convert(conversion, options.quiet, notes);
    output.write(made.bytes.data(), made.bytes.size());
    output.commit(check_reads_back);

    std::FILE* out = options.output == "-" ? stderr : stdout;
    if (options.json) {
        nlohmann::ordered_json report{{"file", options.output}};
        report.update(nlohmann::ordered_json::parse(made.report));
        report["notes"] = notes;
        std::fputs(json_text(report).c_str(), out);
    } else if (!options.quiet) {
        std::fprintf(out, "%s: %s, %s\n", printable(options.output).c_str(),
                     to_readable_size(made.bytes.size()).c_str(), made.summary.c_str());
    }
}

} // namespace

void add_conversion(CLI::App& command, std::shared_ptr<Conversion> conversion, const ConversionHelp& help,
                    int& exit_code) {
    auto options = std::make_shared<RunOptions>();
    command.add_option(help.source, conversion->source, help.source_text)
        ->required()
        ->type_name("")
        ->group("Input");
    add_output(command, options->output, options->force, "The .acdf file to write")->required();
    conversion->add_options(command);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help.footer);
    command.callback([conversion, options, &exit_code] {
        run(*conversion, *options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
