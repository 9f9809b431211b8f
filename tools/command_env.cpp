// acdf env: an environment map to an .acdf file.
#include "commands.h"
#include "environment.h"
#include "file_input.h"
#include "format_names.h"
#include "goal_options.h"
#include "help.h"
#include "options.h"
#include "output.h"
#include "probe_options.h"
#include "sizes.h"
#include "target_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <memory>

namespace acdf::tools {
namespace {

struct Options {
    std::string probe, output;
    input::ProbeOptions input;
    EnvironmentOptions environment;
    std::string knots, budget;
    const CLI::App* command = nullptr;
    int threads = 0;
    bool json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

/// Which fits an option belongs to: with another it is a mistake, not something to ignore.
struct OnlyFor {
    const char* option;
    bool uniform, cdf, pdf, variance;
    const char* message;
};
constexpr OnlyFor only_for[] = {
    {"--cells", false, false, false, true, "is for --fit variance; use --knots with the other fits"},
    {"--budget", false, false, false, true, "is for --fit variance; use --knots with the other fits"},
    {"--target-variance", false, false, false, true,
     "is for --fit variance; use --eps or --knots with the other fits"},
    {"--max-weight", false, false, false, true, "is for --fit variance"},
    {"--shape", false, false, false, true, "is for --fit variance; the other fits have two levels"},
    {"--knots", true, true, true, false, "is for --fit uniform, cdf and pdf; use --cells or --budget"},
    {"--conditional", true, true, true, false, "is for --fit uniform, cdf and pdf"},
    {"--eps", false, true, true, false, "is for --fit cdf and pdf; use --target-variance with --fit variance"},
    {"--gradient", false, true, true, false, "is for --fit cdf and pdf; --fit variance needs no such help"},
};

bool allows(const OnlyFor& rule, AcdfFit fit) {
    switch (fit) {
    case ACDF_FIT_UNIFORM:
        return rule.uniform;
    case ACDF_FIT_CDF:
        return rule.cdf;
    case ACDF_FIT_PDF:
        return rule.pdf;
    default:
        return rule.variance;
    }
}

void set_goal(const Options& options, compress::FitOptions& fit) {
    const int goals = read_goal(*options.command, options.budget, fit.goal);
    const bool only_cells = fit.shape == compress::Shape::cascade;
    if (only_cells && goals > 0 && !options.given("--cells"))
        throw CLI::ValidationError("--shape cascade", "is sized by --cells");
    if (only_cells && options.given("--max-weight"))
        throw CLI::ValidationError("--max-weight", "is for --shape tree");
}

void set_knots(const Options& options, compress::FitOptions& fit) {
    if (options.given("--knots")) {
        if (!parse_pair(options.knots, ACDF_MAX_SEGMENTS, fit.column_segments, fit.row_segments))
            throw CLI::ValidationError("--knots", "needs two counts such as 64x64 (phi x theta)");
    } else if (options.given("--eps")) {
        fit.column_segments = fit.row_segments = ACDF_MAX_SEGMENTS; // the threshold alone decides
    }
}

void check_options(Options& options) {
    compress::FitOptions& fit = options.environment.fit;
    for (const OnlyFor& rule : only_for)
        if (options.given(rule.option) && !allows(rule, fit.fit))
            throw CLI::ValidationError(rule.option, rule.message);
    if (fit.fit == ACDF_FIT_VARIANCE) set_goal(options, fit);
    else set_knots(options, fit);
}

nlohmann::ordered_json report(const Options& options, const input::Probe& probe, const Environment& result) {
    const measure::Accuracy& a = result.accuracy;
    return {{"file", options.output},
            {"source", options.probe},
            {"projection", input::to_string(probe.projection)},
            {"projection_reason", probe.projection_reason},
            {"resolution", {probe.width, probe.height}},
            {"bad_texels",
             {{"nan", probe.bad.nan}, {"infinite", probe.bad.infinite}, {"negative", probe.bad.negative}}},
            {"fit", fit_name(options.environment.fit.fit)},
            {"order", result.order ? to_string(*result.order) : "free"},
            {"bytes", result.bytes.size()},
            {"cells", a.cells},
            {"total", a.total},
            {"relative_variance", a.relative_variance},
            {"least_variance", a.least_variance},
            {"rms_pdf_error", a.rms_pdf_error},
            {"kl_divergence", a.kl_divergence},
            {"max_weight", a.max_weight},
            {"support_violations", a.support_violations}};
}

void run(Options& options) {
    check_options(options);
    const auto limit = limit_threads(options.threads);
    Output output(options.output, options.force, {options.probe}); // refuses early, before the work

    input::Probe probe = load_probe(options.probe, options.input, options.quiet);
    const compress::Target target = probe_target(options.probe, probe, options.environment.target);
    probe.rgb = {}; // the target is all that is needed from here
    Environment result;
    {
        ProgressBar bar(options.quiet);
        const Source source{probe.source_name, probe.source_sha256, input::to_string(probe.projection)};
        try {
            result = build_environment(target, source, options.environment, bar.callback());
        } catch (const std::runtime_error& error) { // the goal is out of reach
            throw Failure(options.probe + ": " + error.what());
        }
    }
    output.write(result.bytes.data(), result.bytes.size());
    output.commit(check_reads_back);

    std::FILE* out = options.output == "-" ? stderr : stdout;
    if (options.json) std::fprintf(out, "%s\n", report(options, probe, result).dump(2).c_str());
    else if (!options.quiet)
        std::fprintf(out, "%s: %s, %llu cells, relative variance %.4g (%s fit%s)\n", options.output.c_str(),
                     to_readable_size(result.bytes.size()).c_str(),
                     static_cast<unsigned long long>(result.accuracy.cells), result.accuracy.relative_variance,
                     fit_name(options.environment.fit.fit).c_str(),
                     result.order ? (std::string(", ") + to_string(*result.order) + " first").c_str() : "");
}

void add_fit_options(CLI::App& command, Options& options) {
    compress::FitOptions& fit = options.environment.fit;
    const std::map<std::string, AcdfFit> fits{{"uniform", ACDF_FIT_UNIFORM},
                                              {"cdf", ACDF_FIT_CDF},
                                              {"pdf", ACDF_FIT_PDF},
                                              {"variance", ACDF_FIT_VARIANCE}};
    command
        .add_option(
            "--fit", fit.fit,
            "How knots are chosen: variance (least noise for its size), cdf (Lawrence et al. 2005, "
            "Douglas-Peucker on the CDF), pdf (the same on the density, piecewise linear: for smooth skies), "
            "uniform (equal steps, to compare with)")
        ->transform(CLI::CheckedTransformer(fits).description(""))
        ->option_text("NAME [variance]")
        ->group("Fit");
    const std::map<std::string, compress::Shape> shapes{{"tree", compress::Shape::tree},
                                                        {"cascade", compress::Shape::cascade}};
    command
        .add_option(
            "--shape", fit.shape,
            "What --fit variance makes: tree (refines any segment along any axis: less noise for its size) or "
            "cascade (two levels, as in the paper: a sample takes less time)")
        ->transform(CLI::CheckedTransformer(shapes).description(""))
        ->option_text("NAME [tree]")
        ->group("Fit");
    const std::map<std::string, int> orders{{"auto", 0}, {"phi", 1}, {"z", 2}};
    command
        .add_option_function<int>(
            "--order",
            [&fit](int order) {
                if (order != 0) fit.order = order == 1 ? compress::Order::phi : compress::Order::z;
            },
            "Which axis is split first: phi, z, or auto (two levels are fitted both ways and the more accurate "
            "file is "
            "kept, in twice the time; a tree takes the axis that gains more)")
        ->transform(CLI::CheckedTransformer(orders).description(""))
        ->option_text("NAME [auto]")
        ->group("Fit");
    add_goal(command, fit.goal.cells, options.budget, fit.goal.variance,
             {"Cells in all: about 4 bytes each", "N [4096]", "SIZE",
              ": 0.01 is a tenth of the mean as standard deviation of one sample"});
    command
        .add_option("--max-weight", fit.max_weight,
                    "No sample weighs more than W times the mean (largest f/p): no fireflies, at the price of some "
                    "cells. It holds for whatever size is asked for, and fails where that is too small")
        ->check(CLI::Range(1.01, 1e9))
        ->option_text("W")
        ->group("Size and accuracy");
    command
        .add_option(
            "--knots", options.knots,
            "Segments of a curve over phi and over theta, for --fit uniform, cdf and pdf (at most this many "
            "with --eps)")
        ->option_text("AxB [64x64]")
        ->group("Size and accuracy");
    command
        .add_option(
            "--eps", fit.epsilon,
            "Stop adding knots once no curve deviates by more: from the CDF for --fit cdf, from the density "
            "relative to its peak for --fit pdf")
        ->check(CLI::Range(0.0, 1.0))
        ->option_text("E")
        ->group("Size and accuracy");
    command
        .add_option("--gradient", fit.gradient_knots,
                    "Extra knots of the first curve where the map changes across it, for --fit cdf and pdf: helps "
                    "where lights at different heights share a region (ibid., eq. 5)")
        ->check(CLI::Range(0u, 1u << 20))
        ->option_text("N [0]")
        ->group("Fit");
    const std::map<std::string, compress::Conditional> conditionals{{"energy", compress::Conditional::energy},
                                                                    {"mean", compress::Conditional::mean}};
    command
        .add_option("--conditional", fit.conditional,
                    "How the lines of a region are averaged: energy (by what they emit, less noise) or mean "
                    "(all alike, as ibid., eq. 4, is printed)")
        ->transform(CLI::CheckedTransformer(conditionals).description(""))
        ->option_text("NAME [energy]")
        ->group("Fit");
}

} // namespace

void add_env(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App& command = *program.add_subcommand("env", "Compress an environment map: directions by what they emit");
    options->command = &command;
    command.add_option("PROBE", options->probe, "The environment map: any image OpenImageIO reads")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection);
    add_repairs(command, options->input);
    add_output(command, options->output, options->force, "The .acdf file to write")->required();
    add_fit_options(command, *options);
    add_target_options(command, options->environment.target);
    add_codec(command, options->environment.codec);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(
        help_footer("Prints the size and the exact relative variance of the stored density: n samples have "
                    "that over n. The default is the least noise for 4096 cells (about 18 KiB).",
                    "acdf env probe.exr -o probe.acdf\n"
                    "acdf env probe.hdr -o probe.acdf --budget 64KiB\n"
                    "acdf env probe.hdr -o probe.acdf --target-variance 0.01 --compress zlib\n"
                    "acdf env grace_probe.hdr --projection angular -o grace.acdf\n"
                    "acdf env probe.exr -o paper.acdf --fit cdf --knots 64x64 --order z --gradient 16"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
