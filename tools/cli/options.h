// Options that several subcommands share, so that they read and behave the same everywhere.
#pragma once

#include "tools/cli/choice.h"

#include <acdf/layout.h>

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <memory>
#include <string>

namespace acdf::tools {

inline CLI::Option* add_json(CLI::App& command, bool& json) {
    return command.add_flag("--json", json, "Report as JSON, for scripts: keys are stable, numbers are exact")
        ->group("Output");
}

inline CLI::Option* add_quiet(CLI::App& command, bool& quiet) {
    return command
        .add_flag("-q,--quiet", quiet,
                  "No progress bar, no remarks, no summary of what was made: only errors, and what was asked for")
        ->group("Output");
}

/// -o and --force. `what` says what the file holds, for example "The .acdf file to write".
inline CLI::Option* add_output(CLI::App& command, std::string& path, bool& force, const std::string& what) {
    command
        .add_flag("-f,--force", force,
                  "Replace an existing output. Without it nothing is ever overwritten, so that a slip of the "
                  "shell's history costs no data")
        ->group("Output");
    return command.add_option("-o,--output", path, what + " (- is stdout)")->type_name("FILE")->group("Output");
}

inline CLI::Option* add_codec(CLI::App& command, AcdfCodec& codec) {
    constexpr Named<AcdfCodec> codecs[] = {{"none", ACDF_CODEC_NONE}, {"zlib", ACDF_CODEC_ZLIB}};
    return add_choice(
               command, "--compress", codec, codecs,
               "none: usable in place, mapped or linked into a program; zlib: smaller to ship, inflated at load")
        ->option_text("NAME [none]")
        ->group("Output");
}

/// --fit. `help`: what each is for.
inline CLI::Option* add_fit(CLI::App& command, AcdfFit& fit, const std::string& help) {
    constexpr Named<AcdfFit> fits[] = {{"uniform", ACDF_FIT_UNIFORM},
                                       {"cdf", ACDF_FIT_CDF},
                                       {"pdf", ACDF_FIT_PDF},
                                       {"variance", ACDF_FIT_VARIANCE}};
    return add_choice(command, "--fit", fit, fits, help)->option_text("NAME [variance]");
}

/// Holds as long as it lives; 0: all cores.
inline std::unique_ptr<tbb::global_control> limit_threads(int threads) {
    if (threads == 0) return nullptr;
    return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                 static_cast<std::size_t>(threads));
}

inline CLI::Option* add_threads(CLI::App& command, int& threads) {
    return command.add_option("--threads", threads, "Threads to use; the file is the same for any number of them")
        ->check(CLI::Range(1, 4096))
        ->option_text("N [all cores]")
        ->group("Output");
}

} // namespace acdf::tools
