// The `acdf` program: a table of subcommands, and the function where errors become exit codes.
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/usage.h"
#include "tools/cli/values.h"
#include "tools/commands.h"

#include <acdf/layout.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace acdf::tools;

// A new subcommand: a file NAME.cpp, its add_NAME in commands.h, a line here.
struct Command {
    const char* group; // heading in `acdf --help`
    std::string_view name;
    void (*add)(CLI::App& program, int& exit_code);
};

constexpr Command commands[] = {
    {"Start here", "demo", add_demo},
    {"Make", "make", add_make},
    {"Make", "env", add_env},
    {"Make", "local", add_local},
    {"Make", "brdf", add_brdf},
    {"Make", "table", add_table},
    {"Inspect", "info", add_info},
    {"Inspect", "validate", add_validate},
    {"Inspect", "measure", add_measure},
    {"Inspect", "plot", add_plot},
    {"Inspect", "scanline", add_scanline},
    {"Inspect", "render", add_render},
    {"Inspect", "sweep", add_sweep},
    {"Use", "sample", add_sample},
    {"Use", "pdf", add_pdf},
    {"Use", "export", add_export},
    {"Use", "completion", add_completion},
    {"Make", "batch", add_batch},
    {"Start here", "help", add_help},
    {"Inspect", "diff", add_diff},
    {"Inspect", "view", add_view},
};

constexpr const char* program_description =
    "Compact importance sampling of measured light and reflectance: turns probes into small adaptive CDFs (.acdf), "
    "measures them exactly, and takes and evaluates samples.";

constexpr const char* program_footer =
    "`acdf help COMMAND` explains a command, with examples.\n\n"
    "Results go to stdout, messages to stderr; - stands for stdin or stdout.\n"
    "Exit codes: 0 done, 1 input or I/O error (one line on stderr), 2 wrong usage, 3 `validate` found faults, "
    "or `diff` a difference";

// Of libraries: those that it was compiled with.
std::string version_text() {
    return "acdf " ACDF_VERSION "\nformat " + std::to_string(ACDF_VERSION_MAJOR) + "." +
           std::to_string(ACDF_VERSION_MINOR) + "\n" ACDF_LIBRARIES;
}

// The name with which the user called what failed: "acdf", or "acdf info".
std::string called(const CLI::App& program) {
    const auto parsed = program.get_subcommands();
    return parsed.empty() ? "acdf" : "acdf " + parsed.front()->get_name();
}

int usage_error(const CLI::App& program, const CLI::ParseError& error) {
    const std::string name = called(program);
    say(name + ": " + what_is_wrong(program, error) + "; see `" + name + " --help`");
    return exit_usage;
}

int failure(const std::string& what) {
    say("acdf: " + what);
    return exit_failed;
}

// The options of all commands together take longer to set up than short commands to run. So only the command that
// is called is added, if one is: `completion` and `help` write of all.
void add_commands(CLI::App& program, std::string_view called, int& exit_code) {
    const auto is_called = [&](const Command& command) { return command.name == called; };
    const bool of_all = called == "completion" || called == "help";
    const bool one = !of_all && std::any_of(std::begin(commands), std::end(commands), is_called);
    for (const Command& command : commands) {
        if (one && !is_called(command)) continue;
        command.add(program, exit_code);
        CLI::App& added = *program.get_subcommand(std::string(command.name));
        added.group(command.group);
        refuse_what_is_no_value(added);
    }
}

constexpr const char* unwritten = "stdout: cannot write all results";

/// Whether all went to stdout, by either way.
bool is_written(const std::ostream& out) { return out && std::fflush(stdout) == 0 && !std::ferror(stdout); }

int parse_and_run(CLI::App& program, int argc, char** argv, const int& exit_code) {
    try {
        program.parse(argc, argv);
        if (program.get_subcommands().empty()) {
            std::fputs(program.help().c_str(), stderr);
            return exit_usage;
        }
    } catch (const CLI::Success& help_or_version) {
        const int code = program.exit(help_or_version);
        return is_written(std::cout.flush()) ? code : failure(unwritten);
    } catch (const CLI::ParseError& error) {
        return usage_error(program, error);
    } catch (const std::bad_alloc&) {
        return failure("out of memory; a smaller input or fewer --threads would help");
    } catch (const std::exception& error) {
        return failure(error.what());
    }
    return is_written(std::cout) ? exit_code : failure(unwritten);
}

} // namespace

int acdf::tools::run_program(int argc, char** argv) {
    CLI::App program(program_description, "acdf");
    program.formatter(std::make_shared<HelpFormatter>());
    program.set_version_flag("--version", version_text,
                             "The versions of this program, of the format it writes, and of its libraries");
    program.set_help_flag("-h,--help", "Show this help");
    program.require_subcommand(0, 1);
    program.footer(program_footer);
    int exit_code = exit_done;
    add_commands(program, argc > 1 ? argv[1] : "", exit_code);
    return parse_and_run(program, argc, argv, exit_code);
}
