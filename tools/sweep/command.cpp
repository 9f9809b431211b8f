// acdf sweep: size against noise and time, on a user's own probe or BRDF: a table and a page.
#include "build/text/format_names.h"
#include "input/brdf/brdf.h"
#include "input/file_name.h"
#include "tools/cli/choice.h"
#include "tools/cli/comma_list.h"
#include "tools/cli/help.h"
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
#include "tools/sweep/page.h"
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
    std::string source, folder;
    std::optional<SweepKind> kind;
    std::vector<std::string> budgets;
    input::ProbeOptions input;
    SweepOptions sweep;
    SceneOption scene; ///< of visibility
    const CLI::App* command = nullptr;
    int threads = 0;
    bool no_timing = false, json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

/// What --kind is where it is not given: files of BRDFs and what is no file but a model's name.
SweepKind kind_of(const std::string& source) {
    const std::string extension = input::lower_extension(source);
    for (const char* brdf : {".binary", ".bsdf", ".pbsdf", ".npy"})
        if (extension == brdf) return SweepKind::brdf;
    std::error_code ignored;
    const std::string model = source.substr(0, source.find(':'));
    for (const char* name : {"lambert", "ggx", "cook-torrance", "blinn"})
        if (model == name && !fs::exists(source, ignored)) return SweepKind::brdf;
    return SweepKind::environment;
}

void check_options(SweepArguments& options, SweepKind kind) {
    for (const std::string& text : options.budgets) {
        const auto bytes = parse_size(text);
        if (!bytes || *bytes == 0) throw CLI::ValidationError("--budgets", "needs sizes such as 16KiB,64KiB,1MB");
        options.sweep.budgets.push_back(*bytes);
    }
    std::sort(options.sweep.budgets.begin(), options.sweep.budgets.end());
    const std::vector<std::string>& fits = fits_of(kind);
    for (const std::string& fit : options.sweep.fits)
        if (std::find(fits.begin(), fits.end(), fit) == fits.end()) {
            std::string names;
            for (const std::string& name : fits) names += (names.empty() ? "" : ", ") + name;
            throw CLI::ValidationError("--fits", std::string("for --kind ") + to_string(kind) + " are " + names);
        }
    if (kind == SweepKind::brdf)
        for (const char* option : {"--projection", "--domain", "--filter", "--bad-pixels", "--on-black"})
            if (options.given(option)) throw CLI::ValidationError(option, "is for environment maps");
    if ((kind == SweepKind::visibility) != options.scene.given())
        throw CLI::ValidationError("--scene", "is for --kind visibility, and that needs one");
    if (kind == SweepKind::visibility && options.input.domain == input::Domain::octahedral)
        throw CLI::ValidationError("--domain",
                                   "is latlong with --kind visibility: points of a mesh see lat-long texels");
    options.scene.check(*options.command);
    const builder::TargetOptions& target = options.sweep.target;
    if (kind != SweepKind::brdf && target.channels.mode == ACDF_CHANNELS_SEPARATE)
        throw CLI::ValidationError("--channel",
                                   "is one channel in a sweep of probes: the baselines are defined for one");
    options.sweep.timing = !options.no_timing;
    options.sweep.visible.threshold /= 100.0; // it is given in per cent
}

/// What has to be said again to the subcommand that makes a file; `on_latlong_grid`: that grid, which the probe has
/// not.
std::string command_of(const SweepArguments& options, SweepKind kind, bool on_latlong_grid) {
    const char* subcommand = kind == SweepKind::visibility ? "local" : to_string(kind);
    std::string text = std::string("acdf ") + subcommand + " " + shell_word(options.source);
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
    return text;
}

std::string output_of(const std::string& source, SweepKind kind) {
    std::error_code ignored;
    const std::string stem =
        fs::exists(source, ignored) ? fs::path(source).stem().string() : source.substr(0, source.find(':'));
    return stem + (kind == SweepKind::local        ? ".local.acdf"
                   : kind == SweepKind::visibility ? ".visibility.acdf"
                                                   : ".acdf");
}

/// The map's own texels, where a lookup blends them: what estimates find.
builder::Target own_texels(const SweepArguments& options, const ProbeTarget& swept) {
    builder::TargetOptions target = options.sweep.target;
    if (target.filter == ACDF_FILTER_NEAREST || swept.resampled) return {};
    target.filter = ACDF_FILTER_NEAREST;
    return load_target(options.source, options.input, target, notes_of(options.source, true)).target;
}

/// What files are made of, as the subcommand does that makes one; points of meshes see lat-long texels.
ProbeTarget sweep_target(const SweepArguments& options, SweepKind kind) {
    input::ProbeOptions input = options.input;
    if (kind == SweepKind::visibility) input.domain = input::Domain::latlong;
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

Sweep sweep_probe(SweepArguments& options, SweepKind kind, const build::Progress& progress) {
    const ProbeTarget swept = sweep_target(options, kind);
    const input::Probe& probe = swept.probe;
    const builder::Target& target = swept.target;
    const builder::Source source = source_of(probe, options.input);
    if (kind != SweepKind::visibility) options.sweep.texels = own_texels(options, swept);
    const bool square = builder::grid_of(target).parameterization == ACDF_PARAM_OCTAHEDRAL;
    Sweep sweep = kind == SweepKind::visibility
                      ? sweep_visibility(target, source, swept_mesh(options), options.sweep, progress)
                  : kind == SweepKind::local ? sweep_local(target, source, options.sweep, progress)
                                             : sweep_environment(target, source, options.sweep, progress);
    sweep.command = command_of(options, kind, kind == SweepKind::visibility && swept.resampled);
    sweep.description =
        std::to_string(probe.width) + " x " + std::to_string(probe.height) + (square ? " octahedral" : " lat-long");
    if (!swept.resampled) return sweep;
    sweep.description += ", resampled from " + std::to_string(probe.source_width) + " x " +
                         std::to_string(probe.source_height) + " " + input::to_string(probe.projection);
    char least[240];
    std::snprintf(least, sizeof least,
                  "the probe was resampled: a pdf that is constant on %d x %d texels has a relative variance of at "
                  "least %.3g of the light itself; points and baselines use these texels as the light",
                  probe.width, probe.height, compress::least_second_moment(builder::grid_of(target)) - 1.0);
    sweep.notes.push_back(least);
    return sweep;
}

Sweep sweep_reflection(SweepArguments& options, const build::Progress& progress) {
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(options.source);
    Sweep sweep = sweep_brdf(*brdf, options.sweep, progress);
    sweep.command = command_of(options, SweepKind::brdf, false);
    sweep.description = brdf->isotropic ? "isotropic BRDF" : "anisotropic BRDF";
    sweep.notes.insert(sweep.notes.end(), brdf->notes.begin(), brdf->notes.end());
    return sweep;
}

Sweep make_sweep(SweepArguments& options, SweepKind kind) {
    ProgressBar bar(options.quiet);
    try {
        Sweep sweep = kind == SweepKind::brdf ? sweep_reflection(options, bar.callback())
                                              : sweep_probe(options, kind, bar.callback());
        sweep.source = options.source;
        sweep.output = output_of(options.source, kind);
        return sweep;
    } catch (const std::invalid_argument& error) {
        throw Failure(options.source + ": " + error.what());
    }
}

void run(SweepArguments& options) {
    const SweepKind kind = options.kind ? *options.kind : kind_of(options.source);
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
        const Advice advice = advise(sweep);
        put(advice.sentence + "\n  " + advice.command + "\n" + path("report.html") +
            " compares them; the numbers are in " + path("sweep.csv") + " and " + path("sweep.json") + "\n");
    }
}

void add_sweep_options(CLI::App& command, SweepArguments& options) {
    constexpr Named<SweepKind> kinds[] = {{"env", SweepKind::environment},
                                          {"local", SweepKind::local},
                                          {"visibility", SweepKind::visibility},
                                          {"brdf", SweepKind::brdf}};
    add_choice(
        command, "--kind", [&options](SweepKind kind) { options.kind = kind; }, kinds,
        "Which files are compared: env, local (for every normal), visibility (of a scene: acdf local --visibility) "
        "or "
        "brdf")
        ->option_text("NAME [by the source: env or brdf]")
        ->group("Sweep");
    options.scene.add(command,
                      "For --kind visibility: the mesh (.obj, .ply, .instances) that the visibility cells are for",
                      "Sweep");
    comma_separated(command.add_option("--budgets", options.budgets, "Sizes to try, separated by commas"))
        ->option_text("SIZES [4KiB,16KiB,64KiB,256KiB,1MB for env]")
        ->group("Sweep");
    comma_separated(command.add_option(
                        "--fits", options.sweep.fits,
                        "Fits to try, separated by commas. env: variance, cdf, pdf, uniform; local: variance, fast "
                        "(--shape fast), separate (a tree for each normal), cdf (the paper's); visibility: "
                        "visibility, variance (by "
                        "normals "
                        "alone); brdf: variance, separate, cdf, uniform"))
        ->option_text("NAMES [all of the kind; local: variance,fast,cdf]")
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
        "sweep", "Which size and fit: noise, time and baselines on your probe or BRDF, as a table and a page");
    options->command = &command;
    command
        .add_option(
            "SOURCE", options->source,
            "An environment map, or a BRDF: MERL .binary, RGL .bsdf, .npy, or a model such as ggx:alpha=0.1")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection);
    add_faces(command, options->input.faces);
    add_domain(command, options->input.domain);
    add_repairs(command, options->input);
    add_sweep_options(command, *options);
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
        "Writes report.html, one page without network or scripts: plots, pictures, what to choose and the command "
        "that makes it, and where a baseline is better. sweep.csv and sweep.json have the same numbers. All files "
        "that "
        "are compared are made in memory.",
        "acdf sweep probe.exr -o out\n"
        "acdf sweep probe.exr -o out --kind local --budgets 64KiB,256KiB,1MB\n"
        "acdf sweep probe.exr -o out --kind visibility --scene room.obj --budgets 1MB,4MB\n"
        "acdf sweep nickel.binary -o out --spp 16\n"
        "acdf sweep ggx:alpha=0.1 -o out --fits variance,cdf --no-timing"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
