// acdf measure: how accurate a file is, by summation over its source.
#include "build/accuracy/environment.h"
#include "build/brdf.h"
#include "build/indexed/accuracy.h"
#include "measure/samplers/full_cdf.h"
#include "tools/cli/comma_list.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/noise.h"
#include "tools/cli/options.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/scene_option.h"
#include "tools/cli/source_check.h"
#include "tools/cli/target_options.h"
#include "tools/commands.h"
#include "tools/measure/brdf.h"
#include "tools/measure/local.h"
#include "tools/measure/memory.h"
#include "tools/measure/table.h"
#include "visibility/visible_view.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <optional>

namespace acdf::tools {
namespace {

struct MeasureArguments {
    std::string file, source, other;
    input::ProbeOptions input;
    std::uint32_t normals = 256, views = build::kMeasuredViews, points = 64;
    std::string mesh;
    std::vector<std::string> at;
    input::UpAxis up = input::UpAxis::z;
    const CLI::App* command = nullptr;
    std::optional<AcdfFilter> filter;
    bool baselines = false, json = false, quiet = false;
};

struct Measured {
    build::Accuracy accuracy;
    double full_cdf = 0.0; ///< relative variance of the source's own CDF on the grid of the file
    double error = 0.0;    ///< build::SourceTarget
};

nlohmann::ordered_json report(const MeasureArguments& options, const File& file, const Measured& measured) {
    const build::Accuracy& a = measured.accuracy;
    nlohmann::ordered_json out = {
        {"file", options.file},
        {"source", options.source},
        {"relative_variance", a.relative_variance}, // JSON has no infinity: null with a support violation
        {"noise_percent", noise_json(a.relative_variance)},
        {"relative_variance_full_cdf", known_json(!a.combined, measured.full_cdf)},
        {"least_variance", known_json(!a.combined, a.least_variance)},
        {"rms_pdf_error", known_json(!a.combined, a.rms_pdf_error)},
        {"kl_divergence", known_json(!a.combined, a.kl_divergence)},
        {"max_weight", a.max_weight},
        {"resampling_error", measured.error},
        {"support_violations", a.support_violations},
        {"bytes", file.size()},
        {"memory_bytes", measure::memory_of(file)},
        {"cells", a.cells},
        {"bins", file.description().bin_count},
        {"total", a.total}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    return out;
}

void print_text(const MeasureArguments& options, const File& file, const Measured& measured) {
    const build::Accuracy& a = measured.accuracy;
    std::printf("%s against %s\n", printable(options.file).c_str(), printable(options.source).c_str());
    if (a.combined) {
        std::printf("  relative variance      %.6g   a sample, with its MIS partner: not to be used alone\n",
                    a.relative_variance);
        std::printf("    noise                %s   at 16, 64, 256 samples, without occluders\n",
                    noise_texts(a.relative_variance).c_str());
        std::printf("  largest weight         %.6g   f over the combined pdf, over its mean\n", a.max_weight);
        std::printf("  support violations     %" PRIu64 "   of both together\n", a.support_violations);
        std::printf("  cells                  %" PRIu64 "\n", a.cells);
        print_bytes(file);
        return;
    }
    std::printf("  relative variance      %.6g   of one sample; the mean of n samples has 1/n of it\n",
                a.relative_variance);
    std::printf("    noise                %s   at 16, 64, 256 samples; of the light's sum, not of a surface\n",
                noise_texts(a.relative_variance).c_str());
    std::printf("    full-resolution CDF  %.6g\n", measured.full_cdf);
    if (a.least_variance > 0.0)
        std::printf("    any texel table      %.6g   at least: several channels, a filter, or resampling\n",
                    a.least_variance);
    if (measured.error > 0.0)
        std::printf(
            "    error                %.2g   relative, of 1 + the variance: texels cut by the grid of the file\n",
            measured.error);
    std::printf("  largest weight         %.6g   f/p over its mean\n", a.max_weight);
    std::printf("  RMS error of the pdf   %.6g   sr^-1\n", a.rms_pdf_error);
    std::printf("  KL divergence          %.6g   nats\n", a.kl_divergence);
    std::printf("  support violations     %" PRIu64 "\n", a.support_violations);
    std::printf("  cells                  %" PRIu64 "\n", a.cells);
    print_bytes(file);
}

/// An option that has no say for a kind is a mistake of whoever gave it.
void refuse_options_of_other_kinds(const MeasureArguments& options, AcdfKind kind) {
    const auto refuse = [&](std::initializer_list<const char*> names, const char* of) {
        for (const char* option : names)
            if (options.command->get_option(option)->count() > 0)
                throw CLI::ValidationError(option, std::string("is for files of ") + of);
    };
    if (kind != ACDF_KIND_LOCAL) refuse({"--baselines", "--normals", "--scene"}, "local environments");
    if (kind != ACDF_KIND_TABLE) refuse({"--mis"}, "tables");
    if (kind != ACDF_KIND_BRDF) refuse({"--views"}, "BRDFs");
    if (kind != ACDF_KIND_INDEXED) refuse({"--at"}, "several maps");
    if (kind == ACDF_KIND_TABLE || kind == ACDF_KIND_BRDF)
        refuse({"--projection", "--bad-pixels", "--on-black", "--filter"}, "environments");
}

/// The map is looked up by its filter, and texel by texel where the sun is.
void measure_indexed(const MeasureArguments& options, const LoadedFile& loaded) {
    const File& file = loaded.file;
    const MixedEnvironment sky = chosen_environment(options.file, loaded, options.at);
    builder::Target texels;
    const ProbeTarget source = source_map(file, options.source, options.input, options.filter, texels);
    const AcdfFilter filter = options.filter.value_or(static_cast<AcdfFilter>(file.description().filter));
    const builder::MapAccuracy a =
        build::measure_mixed(sky, {&builder::grid_of(source.target), &builder::grid_of(texels), filter});
    if (options.json) {
        const nlohmann::ordered_json out = {{"file", options.file},
                                            {"source", options.source},
                                            {"relative_variance", a.relative_variance},
                                            {"noise_percent", noise_json(a.relative_variance)},
                                            {"max_weight", a.max_weight},
                                            {"support_violations", a.support_violations},
                                            {"sun_share", sky.sun_share()},
                                            {"bytes", file.size()},
                                            {"memory_bytes", measure::memory_of(file) + loaded.maps.table_bytes()},
                                            {"bins", file.description().bin_count},
                                            {"total", a.total},
                                            {"total_stored", sky.total()}};
        std::fputs(json_text(out).c_str(), stdout);
        return;
    }
    std::printf("%s against %s\n", printable(options.file).c_str(), printable(options.source).c_str());
    std::printf("  relative variance      %.6g   of one sample; the mean of n samples has 1/n of it\n",
                a.relative_variance);
    std::printf("    noise                %s   at 16, 64, 256 samples; of the light's sum, not of a surface\n",
                noise_texts(a.relative_variance).c_str());
    std::printf("  largest weight         %.6g   f/p over its mean\n", a.max_weight);
    std::printf("  support violations     %" PRIu64 "\n", a.support_violations);
    std::printf("  share of the sun       %.6g   of samples\n", sky.sun_share());
    print_bytes(file);
}

void run(const MeasureArguments& options) {
    for (const char* option : {"--scene-up", "--points"})
        if (options.mesh.empty() && options.command->get_option(option)->count() > 0)
            throw CLI::ValidationError(option, "is of the mesh given by --scene");
    const LoadedFile loaded = load_file(options.file);
    refuse_options_of_other_kinds(options, loaded.file.kind());
    switch (loaded.file.kind()) {
    case ACDF_KIND_TABLE:
        return measure_table(options.file, loaded.file, options.source, options.other, options.json, options.quiet);
    case ACDF_KIND_BRDF:
        return measure_brdf(options.file, loaded.file, options.source, options.views, options.json, options.quiet);
    case ACDF_KIND_LOCAL:
        if (!visible_view(loaded.file).has_cells() && options.command->get_option("--points")->count() > 0)
            throw CLI::ValidationError("--points", "is for files that store visibility cells");
        return measure_local(loaded.file, {options.file, options.source, options.input, options.normals,
                                           options.mesh, options.up, options.points, options.baselines,
                                           options.json, options.quiet, options.filter});
    case ACDF_KIND_INDEXED:
        return measure_indexed(options, loaded);
    default:
        break;
    }
    if (loaded.file.kind() != ACDF_KIND_ENVIRONMENT)
        fail_kind(options.file, loaded.file, "measure", "files of every other kind");
    const ProbeTarget source =
        source_target(options.file, loaded.file, options.source, options.input, options.quiet, options.filter);
    const compress::Target& target = builder::grid_of(source.target);
    const Measured measured{build::measure_environment(loaded.file, target),
                            measure::full_cdf_relative_variance(target), source.error};
    const std::string warning =
        resampling_warning(source, measured.accuracy.least_variance, measured.accuracy.relative_variance);
    if (!warning.empty() && !options.quiet) say(options.file + ": " + warning);
    if (options.json) std::fputs(json_text(report(options, loaded.file, measured)).c_str(), stdout);
    else print_text(options, loaded.file, measured);
    require_support(options.file, loaded.file, options.source, source.probe.source_sha256,
                    measured.accuracy.support_violations);
    if (measured.accuracy.support_violations > 0)
        throw Failure(
            options.file + ": its pdf is 0 where " + options.source +
            ", as it is read here, has light; measure with the options that it was made with, which `acdf "
            "info` prints");
}

} // namespace

void add_measure(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<MeasureArguments>();
    CLI::App& command =
        *program.add_subcommand("measure", "How noisy a file's samples are, exactly, by summation over its source");
    options->command = &command;
    command.add_option("FILE", options->file, "The .acdf file (- is stdin)")
        ->required()
        ->type_name("")
        ->group("Input");
    command
        .add_option(
            "--against", options->source,
            "The probe, the .npy of a table or the BRDF that it stands for: usually the one it was made from")
        ->required()
        ->type_name("SOURCE")
        ->group("Input");
    command
        .add_option("--mis", options->other,
                    "Of a table that was made to be combined with another one: the .npy of that one")
        ->type_name("")
        ->option_text("OTHER.npy")
        ->group("Input");
    add_projection(command, options->input.projection);
    add_faces(command, options->input.faces);
    add_repairs(command, options->input);
    add_filter(
        command, [options](AcdfFilter filter) { options->filter = filter; },
        "Another lookup than the file was made for: how noisy it is for a renderer that looks the probe up so. A "
        "file for nearest lookups may be biased under a bilinear one, which is an error")
        ->option_text("NAME [as the file was made]")
        ->group("Input");
    comma_separated(command.add_option("--at", options->at,
                                       "Of several maps in one file: where among them, at a map or between"))
        ->option_text("NAME=V,...")
        ->group("Input");
    command
        .add_option("--normals", options->normals, "Of a local environment: random normals to take the mean over")
        ->check(CLI::Range(1u, 1u << 20))
        ->option_text("N [256]")
        ->group("Input");
    command
        .add_option(
            "--scene", options->mesh,
            "Of a file that stores visibility cells: the mesh (.obj, .ply, .instances) to look from, usually "
            "the one it was made for; its variance there is printed beside that of its normals alone. Of "
            "other local files: what acdf local takes, to measure by the normals of a scene alone")
        ->type_name("FILE")
        ->group("Input");
    add_scene_up(command, options->up, "Which axis of the scene points up, as in acdf local")->group("Input");
    command.add_option("--points", options->points, "Points on both sides of the mesh to take the mean over")
        ->check(CLI::Range(1u, 1u << 20))
        ->option_text("N [64]")
        ->group("Input");
    command.add_option("--views", options->views, "Of a BRDF: random views to take the mean over")
        ->check(CLI::Range(1u, 1u << 20))
        ->option_text("N [64]")
        ->group("Input");
    command
        .add_flag(
            "--baselines", options->baselines,
            "Of a local environment: beside it what a renderer can do without one: resampling 32 candidates, tiles "
            "weighted on the fly, cosine sampling")
        ->group("Output");
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(
        help_footer("The figures are exact sums over the source, so they carry no noise of their own. A source "
                    "other than the file's own is reported on stderr, and is an error where it has light and the "
                    "pdf is 0. The file's own source is read with the --projection that the file was made with.",
                    "acdf measure probe.acdf --against probe.exr\n"
                    "acdf measure day.acdf --against noon.exr --at time=12\n"
                    "acdf measure probe.acdf --against probe.exr --json | jq .relative_variance"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
