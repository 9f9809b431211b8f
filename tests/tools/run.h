// Runs the acdf program as a user would, and makes small files for it to work on.
#pragma once

#include "tests/inputs/folder.h"
#include "tests/inputs/paths.h"
#include "tests/inputs/sanitized.h"

#include "compress/store/store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace acdf::test {

struct Result {
    int code = -1; ///< exit code; 128 + signal where one ended it
    std::string out, err;
};

/// Leaks are looked for in tests that call libraries: at the end of a program that takes as long as to start it. So
/// does to remember where each piece of memory was asked for.
inline void start_sanitized_programs_fast() {
    static const bool done = [] {
        const char* const given = std::getenv("ASAN_OPTIONS");
        const std::string options = (given ? given : "") + std::string(":detect_leaks=0:malloc_context_size=1");
        return setenv("ASAN_OPTIONS", options.c_str(), 1) == 0;
    }();
    ASSERT_TRUE(done);
}

/// Starts `acdf arguments...` (or a copy of it that lies elsewhere) with the given files as stdin, stdout and
/// stderr.
inline pid_t start_acdf(std::vector<std::string> arguments, const std::string& in, const std::string& out,
                        const std::string& err, const std::string& program = acdf_test::kProgram) {
    if (acdf_test::kSanitized) start_sanitized_programs_fast();
    arguments.insert(arguments.begin(), "acdf");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawnattr_t attributes; // what tests send ends it, also where they run in the background of a script
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGQUIT}) sigaddset(&signals, signal);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t pid = -1;
    if (posix_spawn(&pid, program.c_str(), &files, &attributes, argv.data(), environ) != 0) pid = -1;
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return pid;
}

inline int wait_for(pid_t pid) {
    int status = 0;
    if (pid < 0 || waitpid(pid, &status, 0) != pid) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

inline Result run_acdf(const std::vector<std::string>& arguments, const std::string& input = "",
                       const std::string& program = acdf_test::kProgram) {
    const Folder folder;
    write_text(folder / "in", input);
    Result result;
    result.code = wait_for(start_acdf(arguments, folder / "in", folder / "out", folder / "err", program));
    result.out = read_text(folder / "out");
    result.err = read_text(folder / "err");
    return result;
}

inline compress::Description small_description() {
    compress::Description description = compress::environment_description(8, 4);
    description.total = 2.5;
    description.metadata = {{"accuracy.relative_variance", "0.125"},
                            {"fit.options", "--cells 3"},
                            {"source.name", "sky.exr"},
                            {"tool", "acdf test"}};
    return description;
}

/// 8 x 4 texels. theta: upper half 3/4 of the probability, cut at phi = 0 into 1/3 and 2/3; lower half even.
inline std::vector<std::uint8_t> small_environment() {
    compress::Cascade cascade;
    cascade.curves.push_back({1, {2}, {0.75, 0.25}, {1, -1}, {}});
    cascade.curves.push_back({0, {4}, {1.0 / 3, 2.0 / 3}, {}, {}});
    cascade.roots = {0};
    return compress::store(compress::encode_tree(cascade), small_description());
}

/// The same cells by halvings, with nearly these probabilities.
inline std::vector<std::uint8_t> small_halvings() {
    compress::Halvings tree;
    tree.axes = {1, 0, -1, -1, -1};
    tree.codes = {170, 100};
    return compress::store(tree, small_description());
}

inline void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

} // namespace acdf::test
