// The subcommands of `acdf`: a file or a folder each, registered by the table in program.cpp.
#pragma once

#include <stdexcept>

namespace CLI {
class App;
}

namespace acdf::tools {

enum ExitCode {
    exit_done = 0,
    exit_failed = 1, ///< input or I/O error
    exit_usage = 2,
    exit_faults = 3, ///< `validate` found faults
    exit_differ = 3, ///< `diff` found a difference
};

/// An input or output error that ends the program with exit_failed. The text is one line without "acdf: ":
/// "FILE: what is wrong; what would help".
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Each adds one subcommand, which sets `exit_code` when it has run. A subcommand ends early by throwing Failure
// (or any std::exception: exit_failed) or CLI::ValidationError (exit_usage).
void add_demo(CLI::App& program, int& exit_code);
void add_env(CLI::App& program, int& exit_code);
void add_make(CLI::App& program, int& exit_code);
void add_brdf(CLI::App& program, int& exit_code);
void add_local(CLI::App& program, int& exit_code);
void add_table(CLI::App& program, int& exit_code);
void add_batch(CLI::App& program, int& exit_code);
void add_measure(CLI::App& program, int& exit_code);
void add_info(CLI::App& program, int& exit_code);
void add_validate(CLI::App& program, int& exit_code);
void add_sample(CLI::App& program, int& exit_code);
void add_pdf(CLI::App& program, int& exit_code);
void add_plot(CLI::App& program, int& exit_code);
void add_export(CLI::App& program, int& exit_code);
void add_scanline(CLI::App& program, int& exit_code);
void add_sweep(CLI::App& program, int& exit_code);
void add_completion(CLI::App& program, int& exit_code);
void add_help(CLI::App& program, int& exit_code);
void add_diff(CLI::App& program, int& exit_code);
void add_view(CLI::App& program, int& exit_code);
void add_render(CLI::App& program, int& exit_code);

/// The whole program, as main calls it and `demo` calls it in turn.
int run_program(int argc, char** argv);

} // namespace acdf::tools
