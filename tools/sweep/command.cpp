// acdf sweep: size against noise and time, on a user's own probe or BRDF: a table and a page.
#include "build/text/format_names.h"
#include "input/brdf/brdf.h"
#include "input/file_name.h"
#include "tools/cli/comma_list.h"
#include "tools/cli/help.h"
#include "tools/cli/map_options.h"
#include "tools/cli/mesh_visibility.h"
#include "tools/cli/messages.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/progress.h"
#include "tools/cli/scene_option.h"
#include "tools/cli/sizes.h"
#include "tools/cli/target_options.h"
#include "tools/commands.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/build.h"
#include "tools/sweep/files.h"
#include "tools/sweep/maps.h"
#include "tools/sweep/page.h"
#include "tools/sweep/renderers.h"
#include "tools/sweep/sweep.h"
#include "tools/sweep/text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
    std::vector<std::string> sources; ///< several: maps for one file
    std::string source, folder;       ///< the only source, or the first map
    std::vector<std::string> budgets;
    MapOptions maps;
    input::ProbeOptions input;
    SweepOptions sweep;
    SceneOption scene; ///< of visibility
    const CLI::App* command = nullptr;
    int threads = 0;
    bool no_timing = false, json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

/// By its name: files of BRDFs, and what is no file but a model's name, are BRDFs.
SweepKind kind_of(const std::string& source) {
    const std::string extension = input::lower_extension(source);
    for (const char* brdf : {".binary", ".bsdf", ".pbsdf", ".npy"})
        if (extension == brdf) return SweepKind::brdf;
    std::error_code ignored;
    const std::string model = source.substr(0, source.find(':'));
    for (const char* name : {"lambert", "ggx", "cook-torrance", "blinn"})
        if (model == name && !fs::exists(source, ignored)) return SweepKind::brdf;
    return SweepKind::probe;
}

/// What every sweep takes.
void take_common_options(SweepArguments& options) {
    for (const std::string& text : options.budgets) {
        const auto bytes = parse_size(text);
        if (!bytes || *bytes == 0) throw CLI::ValidationError("--budgets", "needs sizes such as 16KiB,64KiB,1MB");
        options.sweep.budgets.push_back(*bytes);
    }
    std::sort(options.sweep.budgets.begin(), options.sweep.budgets.end());
    options.sweep.timing = !options.no_timing;
    options.sweep.visible.threshold /= 100.0; // it is given in per cent
}

void check_options(SweepArguments& options, SweepKind kind) {
    std::vector<std::string> names = brdf_files();
    if (kind == SweepKind::probe) {
        names.clear();
        for (const FileKind& each : file_kinds())
            if (options.scene.given() || each.needs != Given::position) names.push_back(each.name);
    }
    for (const std::string& file : options.sweep.files)
        if (std::find(names.begin(), names.end(), file) == names.end()) {
            std::string all;
            for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
            throw CLI::ValidationError("--files", "'" + file + "' is none of " + all);
        }
    if (kind == SweepKind::brdf)
        for (const char* option :
             {"--projection", "--domain", "--filter", "--bad-pixels", "--on-black", "--scene", "--heuristic"})
            if (options.given(option)) throw CLI::ValidationError(option, "is for environment maps");
    if (options.scene.given() && options.input.domain == input::Domain::octahedral)
        throw CLI::ValidationError("--domain", "is latlong with --scene: points of a mesh see lat-long texels");
    options.scene.check(*options.command);
    const builder::TargetOptions& target = options.sweep.target;
    if (kind != SweepKind::brdf && target.channels.mode == ACDF_CHANNELS_SEPARATE)
        throw CLI::ValidationError("--channel",
                                   "is one channel in a sweep of probes: the baselines are defined for one");
}

/// `source`, and whether there are several maps for one file.
bool take_sources(SweepArguments& options) {
    if (options.maps.given(options.sources)) {
        options.maps.take(options.sources);
        options.source = options.maps.files()[0];
        for (const char* option :
             {"--files", "--scene", "--faces", "--heuristic", "--sequence", "--shadow-ray-ns", "--scene-up"})
            if (options.given(option)) throw CLI::ValidationError(option, "is for a sweep of one map");
        return true;
    }
    for (const char* option : {"--sun", "--no-sun"})
        if (options.given(option)) throw CLI::ValidationError(option, "is for several maps (--axis)");
    if (options.sources.size() > 1)
        throw CLI::ValidationError("SOURCE", "is given once; several maps for one file need --axis");
    options.source = options.sources[0];
    return false;
}

/// What has to be repeated to the subcommand that makes a file; `on_latlong_grid`: that grid, which the probe has
/// not.
std::string input_text(const SweepArguments& options, bool on_latlong_grid) {
    std::string text;
    for (const std::string& source : options.sources) text += (text.empty() ? "" : " ") + shell_word(source);
    const auto add = [&](const char* option, const std::string& value) {
        if (options.given(option)) text += std::string(" ") + option + " " + value;
    };
    add("--projection", options.input.projection == input::Projection::automatic
                            ? "auto"
                            : input::to_string(options.input.projection));
    if (on_latlong_grid) text += " --domain latlong";
    else
        add("--domain", options.input.domain == input::Domain::latlong      ? "latlong"
                        : options.input.domain == input::Domain::octahedral ? "octahedral"
                                                                            : "source");
    add("--bad-pixels", options.input.bad_pixels == build::BadPixels::clamp   ? "clamp"
                        : options.input.bad_pixels == build::BadPixels::error ? "error"
                                                                              : "zero");
    add("--on-black", options.input.uniform_if_black ? "uniform" : "error");
    add("--filter", build::filter_name(options.sweep.target.filter));
    if (options.given("--channel")) add("--channel", options.command->get_option("--channel")->as<std::string>());
    for (const char* option : {"--axis", "--sun"})
        for (const std::string& value : options.command->get_option(option)->results())
            text += std::string(" ") + option + " " + shell_word(value);
    if (options.given("--no-sun")) text += " --no-sun";
    return text;
}

std::string output_of(const std::string& source) {
    std::error_code ignored;
    return fs::exists(source, ignored) ? fs::path(source).stem().string() : source.substr(0, source.find(':'));
}

/// The map's own texels, where a lookup blends them: what estimates find.
builder::Target own_texels(const SweepArguments& options, const ProbeTarget& swept) {
    builder::TargetOptions target = options.sweep.target;
    if (target.filter == ACDF_FILTER_NEAREST || swept.resampled) return {};
    target.filter = ACDF_FILTER_NEAREST;
    return load_target(options.source, options.input, target, notes_of(options.source, true)).target;
}

/// What files are made of, as the subcommand does that makes one; points of meshes see lat-long texels.
ProbeTarget sweep_target(const SweepArguments& options) {
    input::ProbeOptions input = options.input;
    if (options.scene.given()) input.domain = input::Domain::latlong;
    return load_target(options.source, input, options.sweep.target, notes_of(options.source, options.quiet));
}

SweptMesh swept_mesh(const SweepArguments& options) {
    SweptMesh out;
    const input::UpAxis up = options.scene.input().up;
    const Note note = [&](const std::string& text) {
        if (!options.quiet) say(text);
    };
    out.normals = both_sides(options.scene.read(note));
    out.surface = read_surface(options.scene, note);
    out.turned = up == input::UpAxis::y;
    out.visibility = visibility_on(out.surface, up);
    out.text = options.scene.text() + " --visibility";
    for (const std::string& path : options.scene.paths)
        out.options += (out.options.empty() ? "--scene " : " --scene ") + shell_word(path);
    if (out.turned) out.options += " --scene-up y";
    return out;
}

Sweep sweep_light(SweepArguments& options, const build::Progress& progress) {
    const ProbeTarget swept = sweep_target(options);
    const input::Probe& probe = swept.probe;
    const builder::Target& target = swept.target;
    options.sweep.texels = own_texels(options, swept);
    const bool square = builder::grid_of(target).parameterization == ACDF_PARAM_OCTAHEDRAL;
    std::optional<SweptMesh> mesh;
    if (options.scene.given()) mesh = swept_mesh(options);
    Sweep sweep =
        sweep_probe(target, source_of(probe, options.input), mesh ? &*mesh : nullptr, options.sweep, progress);
    sweep.input = input_text(options, options.scene.given() && swept.resampled);
    sweep.description =
        std::to_string(probe.width) + " x " + std::to_string(probe.height) + (square ? " octahedral" : " lat-long");
    if (!swept.resampled) return sweep;
    sweep.description += ", resampled from " + std::to_string(probe.source_width) + " x " +
                         std::to_string(probe.source_height) + " " + input::to_string(probe.projection);
    char least[240];
    std::snprintf(
        least, sizeof least,
        "the probe was resampled: no pdf that is constant on %d x %d texels has less than %.3g, of the light "
        "itself; points and baselines take these texels for what is looked up",
        probe.width, probe.height, compress::least_second_moment(builder::grid_of(target)) - 1.0);
    sweep.notes.push_back(least);
    return sweep;
}

Sweep sweep_reflection(SweepArguments& options, const build::Progress& progress) {
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(options.source);
    Sweep sweep = sweep_brdf(*brdf, options.sweep, progress);
    sweep.input = input_text(options, false);
    sweep.description = brdf->isotropic ? "isotropic BRDF" : "anisotropic BRDF";
    sweep.notes.insert(sweep.notes.end(), brdf->notes.begin(), brdf->notes.end());
    return sweep;
}

Sweep make_sweep(SweepArguments& options, SweepKind kind) {
    ProgressBar bar(options.quiet);
    try {
        Sweep sweep = kind == SweepKind::brdf ? sweep_reflection(options, bar.callback())
                                              : sweep_light(options, bar.callback());
        sweep.source = options.source;
        sweep.output = output_of(options.source);
        return sweep;
    } catch (const std::invalid_argument& error) {
        throw Failure(options.source + ": " + error.what());
    }
}

/// A line of advice, and the command, of each kind of renderer.
std::string advice_text(const Sweep& sweep) {
    const Advice advice = advise(sweep);
    if (sweep.kind == SweepKind::brdf) return advice.sentence + "\n  " + advice.command + "\n";
    std::string out;
    for (const RendererAdvice& one : advice.renderers)
        out += renderer_text(one.renderer) + ": " + one.sentence + "\n  " + one.command + "\n";
    return out;
}

MapSweep make_map_sweep(SweepArguments& options) {
    constexpr double kReading = 0.2; // of the time, about
    ProgressBar bar(options.quiet);
    const build::Progress progress = bar.callback();
    const LoadedMaps loaded =
        options.maps.load(options.input, options.sweep.target, notes_of(options.source, options.quiet),
                          part_of(progress, 0.0, kReading));
    builder::EnvironmentOptions each;
    each.target = options.sweep.target;
    builder::IndexedOptions one = options.maps.options(options.input, each);
    one.source = loaded.source;
    MapSweep sweep;
    sweep.sources = options.sources;
    sweep.input = input_text(options, false);
    sweep.output = "maps";
    sweep.maps = loaded.maps.size();
    sweep.visible = options.sweep.visible;
    sweep.timed = options.sweep.timing;
    try {
        sweep_maps(loaded.maps, one, options.sweep, part_of(progress, kReading, 1.0 - kReading), sweep);
    } catch (const std::invalid_argument& error) {
        throw Failure(options.source + ": " + error.what());
    }
    return sweep;
}

void run_maps(SweepArguments& options) {
    const auto limit = limit_threads(options.threads);
    const OutputFolder folder(options.folder);
    const auto path = [&](const char* name) { return (fs::path(options.folder) / name).string(); };
    // All refuse early, before the work.
    Output csv(path("sweep.csv"), options.force, options.maps.files());
    Output json(path("sweep.json"), options.force, options.maps.files());

    const MapSweep sweep = make_map_sweep(options);
    const std::string text = maps_json(sweep);
    csv.write(maps_csv(sweep));
    json.write(text);
    csv.commit();
    json.commit();

    const MapAdvice advice = advise(sweep);
    if (options.json) std::fputs(text.c_str(), stdout);
    else if (!options.quiet)
        put(advice.sentence + "\n  " + advice.command + "\nThe figures are in " + path("sweep.csv") + " and " +
            path("sweep.json") + "\n");
}

void run(SweepArguments& options) {
    take_common_options(options);
    if (take_sources(options)) return run_maps(options);
    const SweepKind kind = kind_of(options.source);
    check_options(options, kind);
    const auto limit = limit_threads(options.threads);
    const OutputFolder folder(options.folder);
    const auto path = [&](const char* name) { return (fs::path(options.folder) / name).string(); };
    // All refuse early, before the work.
    Output csv(path("sweep.csv"), options.force, {options.source});
    Output json(path("sweep.json"), options.force, {options.source});
    Output html(path("report.html"), options.force, {options.source});

    const Sweep sweep = make_sweep(options, kind);
    const std::string text = sweep_json(sweep);
    csv.write(sweep_csv(sweep));
    json.write(text);
    html.write(sweep_html(sweep));
    csv.commit();
    json.commit();
    html.commit();

    if (options.json) {
        std::fputs(text.c_str(), stdout);
    } else if (!options.quiet) {
        put(advice_text(sweep) + path("report.html") + " has plots; the figures are in " + path("sweep.csv") +
            " and " + path("sweep.json") + "\n");
    }
}

void add_sweep_options(CLI::App& command, SweepArguments& options) {
    options.scene.add(
        command,
        "A mesh of your scene (.obj, .ply, .instances): files are compared at points all over it, and "
        "those of acdf local --visibility take part",
        "Sweep");
    comma_separated(
        command.add_option("--files", options.sweep.files,
                           "Kinds of files to try, separated by commas. Probes: env, env-mis (--mis mean), "
                           "local, local-mis (--mis cosine), visibility (with --scene), "
                           "local-cdf, env-cdf, env-pdf, env-uniform; BRDFs: variance, "
                           "cdf, uniform"))
        ->option_text("NAMES [env,env-mis,local,local-mis; BRDFs: all]")
        ->group("Sweep");
    comma_separated(command.add_option("--budgets", options.budgets, "Sizes of each kind, separated by commas"))
        ->option_text("SIZES [16KiB,64KiB,256KiB for env; 64KiB,256KiB,1MiB for local]")
        ->group("Sweep");
    const std::map<std::string, AcdfHeuristic> heuristics{{"balance", ACDF_HEURISTIC_BALANCE},
                                                          {"power", ACDF_HEURISTIC_POWER}};
    command
        .add_option_function<std::string>(
            "--heuristic",
            [&options, heuristics](const std::string& name) { options.sweep.heuristic = heuristics.at(name); },
            "How your renderer weighs samples of the light and of the BSDF: balance, or power (squares)")
        ->check(CLI::IsMember({"balance", "power"}))
        ->type_name("")
        ->option_text("NAME [balance]")
        ->group("Sweep");
    command
        .add_option("--spp", options.sweep.visible.spp,
                    "Samples per pixel of your renderings: the more, the smaller a file is enough")
        ->check(CLI::Range(1u, 1u << 24))
        ->option_text("N [64]")
        ->group("Sweep");
    options.sweep.visible.threshold = 1.0;
    command
        .add_option(
            "--visible", options.sweep.visible.threshold,
            "Noise in per cent of a pixel's value that is still too small to see: 1 is about half a step of "
            "8-bit sRGB at middle grey")
        ->check(number_range(0.001, 100.0))
        ->option_text("X [1]")
        ->group("Sweep");
    const std::map<std::string, measure::Numbers> sequences{{"independent", measure::Numbers::independent},
                                                            {"sobol", measure::Numbers::sobol}};
    command
        .add_option_function<std::string>(
            "--sequence",
            [&options, sequences](const std::string& name) { options.sweep.numbers = sequences.at(name); },
            "Random numbers of your renderer, by which the advice goes: independent ones, or "
            "sobol, a scrambled Sobol' sequence in each pixel; both are reported")
        ->check(CLI::IsMember({"independent", "sobol"}))
        ->type_name("")
        ->option_text("NAME [independent]")
        ->group("Sweep");
    command
        .add_option("--shadow-ray-ns", options.sweep.shadow_ray_ns,
                    "Nanoseconds that a sample costs in your renderer besides its sampling: a shadow ray, a BRDF")
        ->check(number_range(0.0, 1e9))
        ->option_text("X [500]")
        ->group("Sweep");
    command
        .add_flag("--no-timing", options.no_timing,
                  "Leave out all times: the outputs are then the same, byte for byte, in every run")
        ->group("Sweep");
}

} // namespace

void add_sweep(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<SweepArguments>();
    CLI::App& command = *program.add_subcommand(
        "sweep",
        "Which file to make for which renderer: noise, time and baselines on your probe or BRDF, on a page");
    options->command = &command;
    command
        .add_option(
            "SOURCE", options->sources,
            "An environment map, or a BRDF: MERL .binary, RGL .bsdf, .npy, or a model such as ggx:alpha=0.1. With "
            "--axis all maps for one file; a sequence is sky.####.exr")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection);
    add_faces(command, options->input.faces);
    add_domain(command, options->input.domain);
    add_repairs(command, options->input);
    add_sweep_options(command, *options);
    options->maps.add(command);
    add_target_options(command, options->sweep.target);
    CLI::Option& channel = *command.get_option("--channel");
    channel.description(channel.get_description() + ". Baselines of probes are defined for one channel: not rgb");
    command.add_option("-o,--output", options->folder, "The folder to write to; made where it does not exist")
        ->required()
        ->type_name("DIR")
        ->group("Output");
    command
        .add_flag("-f,--force", options->force, "Replace sweep.csv, sweep.json and report.html of an earlier run")
        ->group("Output");
    add_threads(command, options->threads)
        ->description("Threads to build with; times of samples are always of one thread");
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help_footer(
        "Writes report.html, one page without network or scripts: which file to make for each kind of renderer, "
        "plots, "
        "pictures, and where a baseline is better. sweep.csv and sweep.json have the figures. All files that are "
        "compared are made in memory. Of several maps there are only figures: of one file at several sizes, and of "
        "a file for each map with as many bytes in all.",
        "acdf sweep probe.exr -o out\n"
        "acdf sweep probe.exr -o out --scene room.obj\n"
        "acdf sweep probe.exr -o out --files local,local-mis --budgets 64KiB,256KiB,1MB\n"
        "acdf sweep 'day.####.exr' -o out --budgets 16KiB,64KiB\n"
        "acdf sweep nickel.binary -o out --spp 16\n"
        "acdf sweep ggx:alpha=0.1 -o out --files variance,cdf --no-timing"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
