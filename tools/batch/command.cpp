// acdf batch: many sources to many files.
#include "input/sha256.h"
#include "tools/batch/gallery.h"
#include "tools/batch/job_conversion.h"
#include "tools/batch/jobs.h"
#include "tools/batch/memory.h"
#include "tools/batch/ninja.h"
#include "tools/batch/options.h"
#include "tools/batch/plan.h"
#include "tools/batch/report.h"
#include "tools/batch/run.h"
#include "tools/batch/shard.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/sizes.h"
#include "tools/cli/temporary.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <tbb/info.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <string_view>

#include <unistd.h>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kErrorsShown = 50;

/// Prints errors, a line for each kind of them, and throws where there are any.
void refuse(const std::vector<std::string>& errors) {
    if (errors.empty()) return;
    const std::vector<std::string> lines = grouped(errors);
    for (std::size_t i = 0; i + 1 < std::min(lines.size(), kErrorsShown); ++i) say("acdf: " + lines[i]);
    if (lines.size() > kErrorsShown)
        throw Failure(std::to_string(lines.size() - kErrorsShown + 1) + " more errors; nothing was started");
    throw Failure(lines.back() + "; nothing was started");
}

// ---- what is asked for -----------------------------------------------------------------------------------

/// With all that go with it wherever it counts: some options need others.
void check_setting(const BatchSetting& setting, const std::vector<BatchSetting>& all) {
    BatchDefaults together;
    for (const BatchSetting& other : all)
        if (other.kind == setting.kind && (other.pattern.empty() || other.pattern == setting.pattern))
            together.settings.push_back({"", other.kind, other.option});
    BatchJob job;
    job.kind = setting.kind;
    job.options = together.options(*setting.kind, "");
    try {
        make_conversion(job);
    } catch (const OptionError& error) {
        throw CLI::ValidationError(std::string("--set ") + setting.kind->name, error.what());
    }
}

BatchDefaults defaults_of(const BatchArguments& options) {
    BatchDefaults defaults;
    if (!options.kinds.empty()) defaults.probe_kinds.clear();
    for (const std::string& name : options.kinds) {
        const JobKind* kind = find_kind(name);
        if (std::count(defaults.probe_kinds.begin(), defaults.probe_kinds.end(), kind) == 0)
            defaults.probe_kinds.push_back(kind);
    }
    for (const std::string& text : options.set) {
        try {
            defaults.settings.push_back(parse_setting(text));
        } catch (const std::invalid_argument& error) {
            throw CLI::ValidationError("--set", error.what());
        }
    }
    for (const BatchSetting& setting : defaults.settings) check_setting(setting, defaults.settings);
    return defaults;
}

BatchLimits limits_of(const BatchArguments& options) {
    BatchLimits limits;
    limits.threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
    limits.workers = options.jobs > 0 ? options.jobs : limits.threads;
    if (!options.memory.empty()) {
        const auto bytes = parse_size(options.memory);
        if (!bytes) throw CLI::ValidationError("--memory", "needs a size such as 8GiB");
        limits.memory = *bytes;
    } else {
        const std::uint64_t available = available_memory();
        limits.memory = available > 0 ? available / 4 * 3 : std::numeric_limits<std::uint64_t>::max();
    }
    keep_within_address_space(limits);
    return limits;
}

Shard shard_of(const BatchArguments& options) {
    if (options.shard.empty()) return {};
    try {
        return parse_shard(options.shard);
    } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError("--shard", error.what());
    }
}

void check_usage(const BatchArguments& options) {
    if (options.inputs.empty())
        throw CLI::ValidationError("INPUT is missing: folders, globs, files or a manifest (*.jsonl)");
    if (options.gallery && (options.merge || options.dry_run || !options.emit.empty()))
        throw CLI::ValidationError("--gallery", "is for runs: not for --dry-run, --merge-reports and --emit");
    if (options.merge) return;
    if (options.output.empty()) throw CLI::ValidationError("--output is missing: the folder to write to");
    if (!options.emit.empty() && (options.dry_run || !options.shard.empty() || options.json))
        throw CLI::ValidationError("--emit", "is not for --dry-run, --shard and --json: Ninja decides what to run");
    std::error_code error;
    if (fs::exists(options.output, error) && !fs::is_directory(options.output, error))
        throw Failure(options.output + ": is not a folder; give one to write to");
}

/// All jobs, checked.
BatchJobs all_jobs(const BatchArguments& options) {
    BatchJobs jobs = collect_jobs(options.inputs, defaults_of(options));
    check_jobs(options.output, jobs);
    check_options(jobs, make_conversion);
    refuse(jobs.errors);
    return jobs;
}

/// What a run writes beside its jobs' outputs. Throws Failure where another's file is in the way.
std::string own_file(const BatchArguments& options, const char* name, const char* mark) {
    const std::string path = (fs::path(options.output) / name).string();
    std::error_code error;
    if (fs::is_directory(path, error)) throw Failure(path + ": is a folder, but a file must be written there");
    if (options.force || !fs::exists(path, error)) return path;
    const std::vector<std::uint8_t> old = read_bytes(path);
    const std::string_view start(mark);
    if (old.size() < start.size() || !std::equal(start.begin(), start.end(), old.begin()))
        throw Failure(path + ": exists and was not made by acdf; use --force to replace it");
    return path;
}

// ---- the ways to go on -----------------------------------------------------------------------------------

void sweep(const BatchArguments& options, const std::vector<BatchJob>& jobs) {
    std::set<std::string> folders;
    for (const BatchJob& job : jobs) folders.insert((fs::path(options.output) / job.output).parent_path().string());
    std::size_t removed = 0;
    for (const std::string& folder : folders) removed += remove_stale_temporaries(folder);
    if (removed > 0 && !options.quiet)
        say(options.output + ": removed " + std::to_string(removed) + " temporary file" +
            (removed == 1 ? "" : "s") + " of a run that was killed");
}

void show_plan(const BatchArguments& options, const std::vector<PlannedJob>& plan) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const PlannedJob& planned : plan) {
        const BatchJob& job = planned.job;
        if (options.json)
            list.push_back({{"input", job.source},
                            {"output", job.output},
                            {"kind", job.kind->name},
                            {"due", planned.due},
                            {"reason", planned.reason},
                            {"memory", planned.due ? nlohmann::ordered_json(planned.memory) : nullptr}});
        else if (!options.quiet)
            std::printf("%s %s %s -> %s: %s\n", planned.due ? "make" : "skip", job.kind->name,
                        printable(job.source).c_str(), printable(job.output).c_str(),
                        printable(planned.reason).c_str());
    }
    if (options.json) std::fputs(json_text(list).c_str(), stdout);
}

std::vector<JobResult> run_with_progress(const BatchArguments& options, const std::vector<PlannedJob>& plan,
                                         const BatchLimits& limits) {
    ProgressBar bar(options.quiet);
    const build::Progress show = bar.callback();
    const bool terminal = isatty(STDERR_FILENO) != 0;
    std::size_t ended = 0, failed = 0;
    const auto due = static_cast<std::size_t>(
        std::count_if(plan.begin(), plan.end(), [](const PlannedJob& planned) { return planned.due; }));
    return run_jobs(plan, options.output, limits, make_conversion, [&](double share, const JobResult* result) {
        if (result) ++ended;
        if (result && result->status == JobResult::Status::failed) {
            ++failed;
            std::fprintf(to_person(), "%sacdf: %s\n", terminal ? "\r\033[K" : "",
                         on_one_line(told_in_batch(*result)).c_str());
        }
        const std::string text = std::to_string(ended) + " of " + std::to_string(due) + " jobs" +
                                 (failed > 0 ? ", " + std::to_string(failed) + " failed" : "");
        show(share, text.c_str());
    });
}

int tell(const BatchArguments& options, const BatchReport& report) {
    if (options.json) std::fputs(to_json(report).c_str(), stdout);
    else if (!options.quiet) put(summary_table(report));
    return report.count(JobResult::Status::failed) > 0 ? exit_failed : exit_done;
}

std::vector<PlannedJob> checked_plan(const BatchArguments& options, const std::vector<BatchJob>& jobs,
                                     const PlanOptions& planning, const BatchLimits& limits) {
    const auto limit = limit_threads(limits.threads);
    std::vector<std::string> errors;
    std::vector<PlannedJob> plan = plan_jobs(jobs, options.output, planning, make_conversion, errors);
    refuse(errors);
    return plan;
}

int run_batch(const BatchArguments& options, const BatchJobs& all, const BatchLimits& limits) {
    const Shard shard = shard_of(options);
    const std::vector<BatchJob> jobs = jobs_of_shard(all.jobs, shard);
    if (!options.dry_run) sweep(options, all.jobs);
    const PlanOptions planning{options.force, !options.dry_run || options.json};
    const std::vector<PlannedJob> plan = checked_plan(options, jobs, planning, limits);
    if (options.dry_run) {
        show_plan(options, plan);
        return exit_done;
    }
    const std::string gallery = options.gallery ? own_file(options, "gallery.html", gallery_mark) : "";
    make_folder(options.output);
    const BatchReport report{batch_id(all.jobs), shard, run_with_progress(options, plan, limits)};
    const int code = tell(options, report); // also where the page cannot be written
    if (!gallery.empty()) {
        const std::string page = gallery_page(report, options.output, plan, make_conversion);
        write_output(gallery, {page.begin(), page.end()}, true);
    }
    return code;
}

/// The arguments that make the same build file once more.
std::vector<std::string> same_command(const BatchArguments& options) {
    std::vector<std::string> words = {"batch", "--emit", "ninja", "--quiet", "--output=" + options.output};
    for (const std::string& kind : options.kinds) words.push_back("--kind=" + kind);
    for (const std::string& setting : options.set) words.push_back("--set=" + setting);
    if (!options.memory.empty()) words.push_back("--memory=" + options.memory);
    if (options.threads > 0) words.push_back("--threads=" + std::to_string(options.threads));
    if (options.jobs > 0) words.push_back("--jobs=" + std::to_string(options.jobs));
    words.push_back("--");
    words.insert(words.end(), options.inputs.begin(), options.inputs.end());
    return words;
}

bool is_within(const fs::path& path, const fs::path& folder) {
    const fs::path relative = path.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

int emit_ninja(const BatchArguments& options, const BatchJobs& all, const BatchLimits& limits) {
    if (std::count(options.inputs.begin(), options.inputs.end(), "-") > 0)
        throw CLI::ValidationError("--emit", "needs a manifest that Ninja can read again, not stdin");
    std::vector<std::string> errors;
    const std::vector<PlannedJob> plan = checked_plan(options, all.jobs, {true, true}, limits);
    for (const PlannedJob& planned : plan)
        if (planned.memory > limits.memory)
            errors.push_back(planned.job.origin + ": needs about " + to_readable_size(planned.memory) +
                             " of memory; raise --memory");
    refuse(errors);
    const std::string path = own_file(options, "build.ninja", ninja_mark);
    make_folder(options.output);
    NinjaBuild build;
    build.program = fs::read_symlink("/proc/self/exe").string();
    build.output = options.output;
    build.folder = fs::current_path().string();
    build.command = same_command(options);
    build.memory = limits.memory;
    build.threads = limits.workers;
    const fs::path output = fs::canonical(options.output);
    for (const std::vector<std::string>* list : {&all.files, &all.folders})
        for (const std::string& path : *list) {
            const fs::path real = fs::canonical(path);
            if (!is_within(real, output)) build.dependencies.push_back(real.string());
        }
    const std::string text = ninja_text(plan, build, make_conversion);
    write_output(path, {text.begin(), text.end()}, true);
    if (!options.quiet)
        put(path + ": " + std::to_string(plan.size()) + " jobs; run `ninja -C " + options.output + " -k 0`\n");
    return exit_done;
}

int merge(const BatchArguments& options) {
    std::vector<BatchReport> reports;
    for (const std::string& path : options.inputs) {
        const std::vector<std::uint8_t> bytes = read_bytes(path);
        try {
            reports.push_back(parse_report({bytes.begin(), bytes.end()}));
        } catch (const std::invalid_argument& error) {
            throw Failure(path + ": " + error.what());
        }
    }
    MergedReport merged;
    try {
        merged = merge_reports(reports);
    } catch (const std::invalid_argument& error) {
        throw Failure(error.what());
    }
    for (const std::string& problem : merged.problems) say("acdf: " + problem);
    for (const JobResult& job : merged.report.jobs)
        if (!job.error.empty()) say("acdf: " + told_in_batch(job));
    const int code = tell(options, merged.report);
    return merged.problems.empty() ? code : exit_failed;
}

int run(const BatchArguments& options) {
    check_usage(options);
    if (options.merge) return merge(options);
    const BatchLimits limits = limits_of(options);
    shard_of(options); // wrong usage is reported before files are looked at
    input::text_sha256(
        "", "OpenSSL"); // sets itself up at the first call, and crashes if that is a thread without memory
    const BatchJobs jobs = all_jobs(options);
    return options.emit.empty() ? run_batch(options, jobs, limits) : emit_ninja(options, jobs, limits);
}

} // namespace

void add_batch(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<BatchArguments>();
    CLI::App& command = *program.add_subcommand("batch", "Compress a library of probes and BRDFs; resumes where it "
                                                         "was ended");
    add_batch_options(command, *options);
    command.footer(help_footer(
        "Outputs are named after sources: sky.exr becomes sky.acdf, or sky.local.acdf. A line of a manifest: "
        "{\"source\": \"sky.exr\", \"kind\": \"local\", \"options\": {\"budget\": \"256KiB\"}, \"output\": "
        "\"skies/noon.acdf\"}; all but source may be left out. A job that fails stops no other.",
        "acdf batch probes brdfs -o library\n"
        "acdf batch probes -o library --kind env,local --set env.budget=64KiB --set local.filter=bilinear\n"
        "acdf batch library.jsonl -o library --dry-run\n"
        "acdf batch library.jsonl -o library --shard 3/8 --json > report.3.json\n"
        "acdf batch --merge-reports report.*.json\n"
        "acdf batch library.jsonl -o library --emit ninja && ninja -C library -k 0"));
    command.callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace acdf::tools
