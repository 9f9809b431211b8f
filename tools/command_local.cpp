// acdf local: an environment map to an .acdf file that knows the surface: for every normal what shines on it.
#include "commands.h"
#include "file_input.h"
#include "format_names.h"
#include "goal_options.h"
#include "help.h"
#include "input/scene_normals.h"
#include "local.h"
#include "options.h"
#include "output.h"
#include "probe_options.h"
#include "sizes.h"
#include "target_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace acdf::tools {
namespace {

struct Options {
    std::string probe, output, normals, budget, knots, scene;
    input::ProbeOptions input;
    input::SceneOptions scene_input;
    LocalOptions local;
    const CLI::App* command = nullptr;
    int threads = 0;
    bool no_sharing = false, json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

constexpr double kWorthwhile = 1.5; ///< gain below which a file without normals would do as well

void set_normals(Options& options) {
    if (!options.given("--normals")) return;
    LocalOptions& local = options.local;
    unsigned n = 0;
    int end = 0;
    if (std::sscanf(options.normals.c_str(), "%4u%n", &n, &end) == 1 &&
        static_cast<std::size_t>(end) == options.normals.size() && n >= 1 && n <= 256) {
        local.subdivisions = n;
        return;
    }
    if (!parse_pair(options.normals, 1024, local.columns, local.rows))
        throw CLI::ValidationError("--normals", "needs a number from 1 to 256, or two such as 25x10 (phi x theta)");
}

void set_separate(Options& options) {
    LocalOptions& local = options.local;
    compress::FitOptions& fit = local.fit;
    local.sharing = !options.no_sharing;
    if (local.sharing) {
        if (local.columns > 0)
            throw CLI::ValidationError("--normals",
                                       "AxB is for --no-sharing: bins that share tiles are interpolated");
        for (const char* option : {"--fit", "--knots", "--eps", "--order", "--bin-target"})
            if (options.given(option)) throw CLI::ValidationError(option, "is for --no-sharing");
        return;
    }
    if (options.given("--tiles")) throw CLI::ValidationError("--tiles", "is for files whose bins share tiles");
    if (options.given("--target-variance"))
        throw CLI::ValidationError("--target-variance",
                                   "is for files whose bins share tiles; use --budget or --cells");
    const bool variance = fit.fit == ACDF_FIT_VARIANCE;
    for (const char* option : {"--knots", "--eps"})
        if (variance && options.given(option))
            throw CLI::ValidationError(option, "is for --fit uniform, cdf and pdf");
    for (const char* option : {"--cells", "--budget"})
        if (!variance && options.given(option)) throw CLI::ValidationError(option, "is for --fit variance");
    if (!variance && !fit.order) fit.order = compress::Order::z;
    if (options.given("--knots")) {
        if (!parse_pair(options.knots, ACDF_MAX_SEGMENTS, fit.column_segments, fit.row_segments))
            throw CLI::ValidationError("--knots", "needs two counts such as 30x30 (phi x theta)");
    } else if (options.given("--eps")) {
        fit.column_segments = fit.row_segments = ACDF_MAX_SEGMENTS; // the threshold alone decides
    }
}

void read_scene(Options& options) {
    if (options.scene.empty()) return;
    const input::SceneNormals scene = input::read_scene_normals(options.scene, options.scene_input);
    for (const input::WeightedNormal& n : scene.normals)
        options.local.scene.push_back({{n.n[0], n.n[1], n.n[2]}, n.weight});
    if (!options.quiet)
        std::fprintf(stderr, "%s: a %s with %zu different normals, %llu skipped\n", options.scene.c_str(),
                     scene.kind.c_str(), scene.normals.size(), static_cast<unsigned long long>(scene.skipped));
}

double gain(const Local& result) {
    return result.accuracy.relative_variance_full_cdf / result.accuracy.relative_variance;
}

nlohmann::ordered_json report(const Options& options, const input::Probe& probe, const Local& result,
                              const File& file) {
    const measure::LocalAccuracy& a = result.accuracy;
    return {{"file", options.output},
            {"source", options.probe},
            {"resolution", {probe.width, probe.height}},
            {"bytes", result.bytes.size()},
            {"bins", file.description().bin_count},
            {"tiles", file.blend().tiles ? file.blend().tiles->tile_count : 0},
            {"normals_measured", result.normals},
            {"relative_variance", a.relative_variance},
            {"relative_variance_full_cdf", a.relative_variance_full_cdf},
            {"gain", gain(result)},
            {"share_above_horizon", a.share_above_horizon},
            {"least_share_above_horizon", a.least_share_above_horizon},
            {"support_violations", a.support_violations}};
}

void print_text(const Options& options, const Local& result, std::FILE* out) {
    const measure::LocalAccuracy& a = result.accuracy;
    std::fprintf(out,
                 "%s: %s, relative variance %.4g over %u normals: %.3g times less than the probe's own CDF (%.4g); "
                 "%.1f %% of samples above the horizon\n",
                 options.output.c_str(), to_readable_size(result.bytes.size()).c_str(), a.relative_variance,
                 a.lit_normals, gain(result), a.relative_variance_full_cdf, 100.0 * a.share_above_horizon);
}

void run(Options& options) {
    set_normals(options);
    read_goal(*options.command, options.budget, options.local.goal);
    set_separate(options);
    const auto limit = limit_threads(options.threads);
    Output output(options.output, options.force, {options.probe, options.scene}); // refuses early, before the work
    read_scene(options);
    input::Probe probe = load_probe(options.probe, options.input, options.quiet);
    const compress::Target target = probe_target(options.probe, probe, options.local.target);
    probe.rgb = {};
    Local result;
    {
        ProgressBar bar(options.quiet);
        const Source source{probe.source_name, probe.source_sha256, input::to_string(probe.projection)};
        try {
            result = build_local(target, source, options.local, bar.callback());
        } catch (const std::runtime_error& error) { // the goal is out of reach
            throw Failure(options.probe + ": " + error.what());
        }
    }
    output.write(result.bytes.data(), result.bytes.size());
    output.commit(check_reads_back);

    std::FILE* out = options.output == "-" ? stderr : stdout;
    File file;
    File::from_memory(result.bytes.data(), result.bytes.size(), file);
    if (options.json) std::fprintf(out, "%s\n", report(options, probe, result, file).dump(2).c_str());
    else if (!options.quiet) print_text(options, result, out);
    if (gain(result) < kWorthwhile && !options.quiet)
        std::fprintf(
            stderr,
            "%s: knowing the normal lowers the variance by a factor of %.2f only; `acdf env` would do about as "
            "well, in a smaller file\n",
            options.output.c_str(), gain(result));
}

void add_bins(CLI::App& command, Options& options) {
    LocalOptions& local = options.local;
    command
        .add_option(
            "--normals", options.normals,
            "Bins of normals: N divides each edge of an octahedron, 4 N^2 + 2 bins that are interpolated; AxB is "
            "a lat-long grid (phi x theta) whose nearest bin serves, as in the paper, for --no-sharing, with "
            "--no-sharing")
        ->option_text("N|AxB [as suits the size]")
        ->group("Normals");
    command
        .add_option(
            "--scene", options.scene,
            "Only what a scene requires: a mesh (.obj, .ply), a normal pass (.exr) or a list of normals (.txt, "
            "x y z [weight] a line). Bins that do not occur are not stored: a normal outside is served by the "
            "whole environment, unbiased but noisier")
        ->type_name("FILE")
        ->group("Normals");
    const std::map<std::string, input::UpAxis> axes{{"y", input::UpAxis::y}, {"z", input::UpAxis::z}};
    command
        .add_option(
            "--scene-up", options.scene_input.up,
            "Which axis of the scene points up; y turns (x, y, z) into (z, x, y), as docs/conventions.md has it")
        ->transform(CLI::CheckedTransformer(axes).description(""))
        ->option_text("y|z [z]")
        ->group("Normals");
    command
        .add_flag("--scene-rgb", options.scene_input.rgb_is_normal,
                  "Take R, G and B of the scene's image as a normal where no channel is named as one")
        ->group("Normals");
    command
        .add_option(
            "--cosine-share", local.cosine_share,
            "This share of samples is drawn around the normal instead, density cos/pi; sample and pdf apply "
            "the mixture. For scenes in which the brightest light is often hidden; 0.2 is a good value")
        ->check(CLI::Range(0.0, 0.99))
        ->option_text("X [0]")
        ->group("Normals");
}

void add_size(CLI::App& command, Options& options) {
    LocalOptions& local = options.local;
    add_goal(command, local.goal.cells, options.budget, local.goal.variance,
             {"Cells of the curves that bins share, about; with --no-sharing: of a bin, in the mean", "N",
              "SIZE [1MiB]", ", in the mean over normals", 16});
    command
        .add_option(
            "--tiles", local.tiles,
            "Tiles whose probability each bin stores, a byte each: more of them and the cosine is followed more "
            "closely, at the price of cells within them")
        ->check(CLI::Range(1u, ACDF_MAX_TILES))
        ->option_text("N [as suits the size]")
        ->group("Size and accuracy");
}

void add_separate(CLI::App& command, Options& options) {
    compress::FitOptions& fit = options.local.fit;
    const char* group = "Trees of their own";
    command
        .add_flag("--no-sharing", options.no_sharing,
                  "A tree of its own for each bin, as in the paper, to compare with: larger and noisier")
        ->group(group);
    const std::map<std::string, AcdfFit> fits{{"uniform", ACDF_FIT_UNIFORM},
                                              {"cdf", ACDF_FIT_CDF},
                                              {"pdf", ACDF_FIT_PDF},
                                              {"variance", ACDF_FIT_VARIANCE}};
    command.add_option("--fit", fit.fit, "How knots are chosen: as in acdf env")
        ->transform(CLI::CheckedTransformer(fits).description(""))
        ->option_text("NAME [variance]")
        ->group(group);
    command.add_option("--knots", options.knots, "Segments of a curve over phi and over theta: as in acdf env")
        ->option_text("AxB [64x64]")
        ->group(group);
    command.add_option("--eps", fit.epsilon, "Deviation at which a curve has knots enough: as in acdf env")
        ->check(CLI::Range(0.0, 1.0))
        ->option_text("E")
        ->group(group);
    const std::map<std::string, compress::Order> orders{{"phi", compress::Order::phi}, {"z", compress::Order::z}};
    command
        .add_option_function<compress::Order>(
            "--order", [&fit](compress::Order order) { fit.order = order; }, "Which axis is split first")
        ->transform(CLI::CheckedTransformer(orders).description(""))
        ->option_text("phi|z [z]")
        ->group(group);
    const std::map<std::string, compress::BinTarget> targets{{"mean", compress::BinTarget::mean},
                                                             {"centre", compress::BinTarget::centre}};
    command
        .add_option(
            "--bin-target", options.local.bin_target,
            "What a bin's tree is fitted to: mean (right for all of its normals) or centre (the paper's: biased "
            "for the others)")
        ->transform(CLI::CheckedTransformer(targets).description(""))
        ->option_text("NAME [mean]")
        ->group(group);
}

} // namespace

void add_local(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App& command = *program.add_subcommand(
        "local", "Compress an environment map for every normal: clipped at its horizon, times "
                 "the cosine");
    options->command = &command;
    command.add_option("PROBE", options->probe, "The environment map: any image OpenImageIO reads")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection);
    add_repairs(command, options->input);
    add_output(command, options->output, options->force, "The .acdf file to write")->required();
    add_bins(command, *options);
    add_size(command, *options);
    add_separate(command, *options);
    add_target_options(command, options->local.target);
    add_codec(command, options->local.codec);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help_footer(
        "Prints the exact relative variance of irradiance estimates, mean over 256 random normals (or those of the "
        "scene), beside that of the probe's full-resolution CDF.",
        "acdf local probe.exr -o probe.local.acdf\n"
        "acdf local probe.exr -o small.acdf --budget 128KiB\n"
        "acdf local probe.exr -o car.acdf --scene car.obj --scene-up y --cosine-share 0.2\n"
        "acdf local probe.exr -o paper.acdf --no-sharing --normals 25x10 --fit cdf --knots 64x64"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
