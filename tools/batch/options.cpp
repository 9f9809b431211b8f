#include "tools/batch/options.h"

#include "tools/cli/comma_list.h"
#include "tools/cli/options.h"

#include <CLI/CLI.hpp>

namespace acdf::tools {
namespace {

void add_what(CLI::App& command, BatchArguments& options) {
    command
        .add_option("INPUT", options.inputs,
                    "Folders (all probes and BRDFs in them and below), files, quoted globs, manifests of one JSON "
                    "object a line (*.jsonl; - is stdin); with --merge-reports: reports")
        ->type_name("")
        ->group("Input");
    comma_separated(command.add_option("--kind", options.kinds,
                                       "What probes become where no manifest says it: env, local, or both"))
        ->check(CLI::IsMember({"env", "local"}).description(""))
        ->option_text("NAME,... [env]")
        ->group("Input");
    command
        .add_option(
            "--set", options.set,
            "An option of `acdf env`, `acdf local` or `acdf brdf` for all jobs of that kind, but those with "
            "options of their own in a manifest; before it there may be a pattern of sources, by their names "
            "below the folder: 'angular/*:env.projection=angular'")
        ->type_name("")
        ->option_text("[PATTERN:]KIND.OPTION[=VALUE]")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group("Input");
}

void add_how(CLI::App& command, BatchArguments& options) {
    command.add_option("-o,--output", options.output, "The folder to write to; made where it is missing")
        ->type_name("")
        ->option_text("DIR")
        ->group("Output");
    command
        .add_flag("-f,--force", options.force,
                  "Make all files again. Without it those are skipped that were made of the same source with the "
                  "same options")
        ->group("Output");
    command.add_flag("-n,--dry-run", options.dry_run, "Only print which files would be made or skipped, and why")
        ->group("Output");
    command
        .add_flag("--gallery", options.gallery,
                  "Write DIR/gallery.html too: thumbnails of each source and its pdf, size and noise, on one page "
                  "that needs no other file")
        ->group("Output");
    add_json(command, options.json);
    add_quiet(command, options.quiet);
    command
        .add_option(
            "--memory", options.memory,
            "Bound on the memory of all jobs at once; what a job needs is estimated from its source's header")
        ->type_name("")
        ->option_text("SIZE [3/4 of what is free]")
        ->group("Resources");
    command
        .add_option("--threads", options.threads, "Threads in all; the files are the same for any number of them")
        ->check(CLI::Range(1, 4096))
        ->option_text("N [all cores]")
        ->group("Resources");
    command.add_option("--jobs", options.jobs, "Jobs at once; threads that are left over help those that run")
        ->check(CLI::Range(1, 4096))
        ->option_text("N [as many as threads]")
        ->group("Resources");
    command
        .add_option("--shard", options.shard,
                    "Only a part of the jobs, such as 3/8, balanced by size; slurm: that of this task of a Slurm "
                    "array")
        ->type_name("")
        ->option_text("I/N|slurm")
        ->group("Farm");
    command
        .add_flag("--merge-reports", options.merge,
                  "Merge the --json reports of all shards, and name missing shards")
        ->group("Farm");
    command.add_option("--emit", options.emit, "ninja: write DIR/build.ninja instead of running")
        ->check(CLI::IsMember({"ninja"}).description(""))
        ->type_name("")
        ->option_text("ninja")
        ->group("Farm");
}

} // namespace

void add_batch_options(CLI::App& command, BatchArguments& options) {
    add_what(command, options);
    add_how(command, options);
}

} // namespace acdf::tools
