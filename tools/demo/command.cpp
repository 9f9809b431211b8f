// acdf demo: the other subcommands, one after the other, on built-in probes or on those given.
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/commands.h"
#include "tools/demo/probes.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

struct DemoArguments {
    std::vector<std::string> probes;
    std::string folder;
    bool force = false;
};

/// Prints a command as one would type it, and runs it.
void run_command(const std::vector<std::string>& words) {
    std::printf("\n$ acdf");
    for (const std::string& word : words) {
        const bool plain = word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                                  "._-/+:=,@%") == std::string::npos;
        put(plain ? " " + word : " '" + word + "'");
    }
    std::printf("\n");
    std::fflush(stdout);
    std::vector<std::string> copy{"acdf"};
    copy.insert(copy.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& word : copy) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (run_program(static_cast<int>(copy.size()), argv.data()) != exit_done)
        throw Failure("demo stopped: the command above failed");
}

/// Everything the program does with one probe.
void show_probe(const DemoArguments& options, const std::string& probe, const std::string& name) {
    const std::string stem = (fs::path(options.folder) / name).string();
    const auto with_force = [&](std::vector<std::string> words) {
        if (options.force) words.push_back("--force");
        run_command(words);
    };
    for (const char* fit : {"uniform", "cdf", "pdf"})
        with_force({"env", probe, "-o", stem + "." + fit + ".acdf", "--fit", fit, "--knots", "64x64"});
    with_force({"env", probe, "-o", stem + ".acdf"});
    run_command({"info", stem + ".acdf"});
    run_command({"validate", stem + ".acdf"});
    run_command({"measure", stem + ".acdf", "--against", probe});
    with_force({"sample", stem + ".acdf", "-n", "1000", "--sequence", "sobol", "-o", stem + ".samples.csv"});
    with_force({"pdf", stem + ".acdf", stem + ".samples.csv", "-o", stem + ".pdf.txt"});
    with_force({"plot", stem + ".acdf", "-o", stem + ".png"});
    const std::string local = stem + ".local.acdf";
    with_force({"local", probe, "-o", local, "--budget", "256KiB"});
    run_command({"measure", local, "--against", probe, "--baselines"});
    with_force({"plot", local, "-o", stem + ".local.png", "--normal", "1,0,1"});
}

/// The same with a BRDF.
void show_brdf(const DemoArguments& options, const std::string& brdf, const std::string& name) {
    const std::string stem = (fs::path(options.folder) / name).string();
    const auto with_force = [&](std::vector<std::string> words) {
        if (options.force) words.push_back("--force");
        run_command(words);
    };
    put("\n== " + brdf + "\n");
    with_force({"brdf", brdf, "-o", stem + ".acdf", "--budget", "32KiB"});
    run_command({"info", stem + ".acdf"});
    with_force({"plot", stem + ".acdf", "-o", stem + ".png", "--view", "60"});
}

void run(const DemoArguments& options) {
    const OutputFolder folder(options.folder);
    if (options.probes.empty()) {
        for (const DemoProbe& probe : demo_probes()) {
            const std::string path = (fs::path(options.folder) / (probe.name + ".exr")).string();
            write_probe(probe, path, options.force);
            put("\n== " + path + ": " + probe.what + "\n");
            show_probe(options, path, probe.name);
        }
        show_brdf(options, "ggx:alpha=0.1", "ggx");
    } else {
        std::set<std::string> names;
        for (const std::string& probe : options.probes)
            if (!names.insert(fs::path(probe).stem().string()).second)
                throw Failure(probe + ": two probes of this name would write the same files; give them one by one");
        for (const std::string& probe : options.probes) {
            put("\n== " + probe + "\n");
            show_probe(options, probe, fs::path(probe).stem().string());
        }
    }
    put("\nThe files are in " + options.folder +
        ": NAME.png shows the pdf, NAME.acdf is the file for a renderer.\n");
}

} // namespace

void add_demo(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<DemoArguments>();
    CLI::App& command =
        *program.add_subcommand("demo", "Make, show and measure files of built-in probes, or of yours");
    command.add_option("PROBE", options->probes, "Environment maps to use in place of the built-in ones")
        ->type_name("")
        ->group("Input");
    command.add_option("-o,--output", options->folder, "The folder to write to; made where it does not exist")
        ->required()
        ->type_name("DIR")
        ->group("Output");
    command.add_flag("-f,--force", options->force, "Replace the files of an earlier run")->group("Output");
    command.footer(help_footer("Each command is printed before it runs, so that it can be tried again by hand.",
                               "acdf demo -o demo\n"
                               "acdf demo -o demo --force probe.exr other.hdr"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
