// acdf view: a file in the viewer, a page that needs neither a server nor a network.
#include "input/file_name.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/commands.h"
#include "tools/view/page.h"

#include <CLI/CLI.hpp>
#include <acdf/curves/curves.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

extern char** environ;

namespace acdf::tools {
namespace {

struct ViewArguments {
    std::string file, output;
    bool force = false, quiet = false;
};

/// A new file for a page in the folder of temporary files. It stays: the browser reads it once this program has
/// ended.
std::string temporary_page() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error)
        throw Failure("there is no folder for temporary files: " + error.message() + "; write the page with -o");
    std::string path = (folder / "acdf-view-XXXXXX.html").string();
    const int descriptor = mkstemps(path.data(), 5);
    if (descriptor < 0)
        throw Failure(path + ": cannot be made: " + std::strerror(errno) + "; write the page with -o");
    close(descriptor);
    return path;
}

/// Whether a program was found that opens pages: that of $BROWSER, or the desktop's.
bool open_in_browser(const std::string& path) {
    const char* const chosen = std::getenv("BROWSER");
    std::string program = chosen && *chosen ? chosen : "xdg-open", page = path;
    char* const arguments[] = {program.data(), page.data(), nullptr};
    posix_spawn_file_actions_t files;
    if (posix_spawn_file_actions_init(&files) != 0) return false;
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID); // it outlives this terminal
    pid_t child = 0;
    const int failed = posix_spawnp(&child, program.c_str(), &files, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return failed == 0;
}

void run(const ViewArguments& options) {
    const LoadedFile loaded = load_file(options.file);
    const std::string name = options.file == "-" ? "stdin" : input::file_name(options.file);
    std::uint32_t units;
    if (acdf_curves_tree(loaded.file.get(), &units))
        throw Failure(name + ": the viewer reads no curves; make the file with --fit variance");
    const std::string page = page_with(viewer_page(), name, loaded.bytes);
    const bool opens = options.output.empty();
    const std::string path = opens ? temporary_page() : options.output;
    write_output(path, {page.begin(), page.end()}, opens || options.force, {options.file});
    if (!opens) return;
    if (!open_in_browser(path)) say("acdf: no browser was found (xdg-open, or $BROWSER); open the page yourself");
    if (!options.quiet) put(path + "\n");
}

} // namespace

void add_view(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<ViewArguments>();
    CLI::App& command = *program.add_subcommand("view", "Show a file in the browser: pdf, cells, samples, figures");
    command.add_option("FILE", options->file, "An .acdf file (- is stdin)")
        ->required()
        ->type_name("")
        ->group("Input");
    add_output(command, options->output, options->force, "Write the page to this file, and open nothing");
    add_quiet(command, options->quiet);
    command.footer(
        help_footer("The page holds the file and the reader, and asks for nothing else: it can be kept and sent. "
                    "It is opened by $BROWSER, or by the desktop's program (xdg-open), from the folder of "
                    "temporary files, whose name is printed.",
                    "acdf view sky.acdf\n"
                    "acdf view nickel.acdf -o nickel.html"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
