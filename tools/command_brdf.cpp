// acdf brdf: a BRDF to an .acdf file.
#include "brdf.h"
#include "commands.h"
#include "file_input.h"
#include "format_names.h"
#include "goal_options.h"
#include "help.h"
#include "options.h"
#include "output.h"
#include "sizes.h"
#include "target_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace acdf::tools {
namespace {

struct Options {
    std::string source, output;
    BrdfFileOptions file;
    std::string views, knots, budget;
    const CLI::App* command = nullptr;
    int threads = 0;
    bool separate = false;
    bool json = false, quiet = false, force = false;

    bool given(const char* option) const { return command->get_option(option)->count() > 0; }
};

/// "32" or "32x16".
bool parse_views(const std::string& text, std::uint32_t& theta, std::uint32_t& phi) {
    unsigned a = 0, b = 1;
    int end = 0;
    if (std::sscanf(text.c_str(), "%5ux%5u%n", &a, &b, &end) != 2) {
        b = 1;
        if (std::sscanf(text.c_str(), "%5u%n", &a, &end) != 1) return false;
    }
    theta = a;
    phi = b;
    return static_cast<std::size_t>(end) == text.size() && a >= 2 && a <= 1024 && b >= 1 && b <= 1024 && b != 2 &&
           b != 3;
}

void check_options(Options& options) {
    compress::BrdfOptions& fit = options.file.fit;
    const bool variance = fit.fit == ACDF_FIT_VARIANCE;
    for (const char* option : {"--cells", "--budget", "--target-variance", "--no-sharing"})
        if (!variance && options.given(option))
            throw CLI::ValidationError(option, "is for --fit variance; use --knots or --eps with the other fits");
    for (const char* option : {"--knots", "--eps"})
        if (variance && options.given(option))
            throw CLI::ValidationError(option, "is for --fit uniform, cdf and pdf; use --budget or --cells");
    if (options.given("--eps") && fit.fit == ACDF_FIT_UNIFORM)
        throw CLI::ValidationError("--eps", "is for --fit cdf and pdf");
    if (options.given("--views") && !parse_views(options.views, fit.theta_views, fit.phi_views))
        throw CLI::ValidationError("--views",
                                   "needs a count such as 32, or two such as 16x8 (theta_o x phi_o, at least 4)");
    if (options.given("--knots") && !parse_views(options.knots, fit.phi_segments, fit.theta_segments))
        throw CLI::ValidationError("--knots", "needs two counts such as 10x30 (phi_h x theta_h)");
    if (options.given("--eps") && !options.given("--knots"))
        fit.phi_segments = fit.theta_segments = ACDF_MAX_SEGMENTS;
    fit.sharing = !options.separate;
    if (!variance) return;
    fit.goal = {compress::Goal::Kind::budget, fit.goal.cells, std::uint64_t{64} << 10, fit.goal.variance};
    read_goal(*options.command, options.budget, fit.goal);
}

nlohmann::ordered_json report(const Options& options, const BrdfFile& result) {
    const measure::BrdfAccuracy& a = result.accuracy;
    return {{"file", options.output},
            {"source", options.source},
            {"fit", fit_name(options.file.fit.fit)},
            {"views", {result.theta_views, result.phi_views}},
            {"bytes", result.bytes.size()},
            {"bins", result.theta_views * result.phi_views},
            {"cells", a.cells},
            {"relative_variance", a.relative_variance}, // JSON has no infinity: null with a support violation
            {"relative_variance_median", a.median},
            {"relative_variance_worst", a.worst},
            {"rms_pdf_error", a.rms_pdf_error},
            {"kl_divergence", a.kl_divergence},
            {"max_weight", a.max_weight},
            {"share_above_horizon", a.share_above_horizon},
            {"support_violations", a.support_violations}};
}

BrdfFile build(const Options& options, const input::Brdf& brdf) {
    ProgressBar bar(options.quiet);
    try {
        return build_brdf(brdf, options.file, bar.callback());
    } catch (const std::invalid_argument& error) {
        throw Failure(options.source + ": " + error.what());
    } catch (const std::runtime_error& error) { // the goal is out of reach
        throw Failure(options.source + ": " + error.what());
    }
}

void run(Options& options) {
    check_options(options);
    const auto limit = limit_threads(options.threads);
    std::vector<std::string> inputs;
    if (std::filesystem::exists(options.source)) inputs.push_back(options.source);
    Output output(options.output, options.force, inputs); // refuses early, before the work
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(options.source);
    if (!options.quiet)
        for (const std::string& note : brdf->notes)
            std::fprintf(stderr, "%s: %s\n", options.source.c_str(), note.c_str());
    const BrdfFile result = build(options, *brdf);
    output.write(result.bytes.data(), result.bytes.size());
    output.commit(check_reads_back);

    std::FILE* out = options.output == "-" ? stderr : stdout;
    const measure::BrdfAccuracy& a = result.accuracy;
    if (options.json) std::fprintf(out, "%s\n", report(options, result).dump(2).c_str());
    else if (!options.quiet)
        std::fprintf(out, "%s: %s, %u views, %llu cells, relative variance %.4g (mean; worst %.4g)\n",
                     options.output.c_str(), to_readable_size(result.bytes.size()).c_str(),
                     result.theta_views * result.phi_views, static_cast<unsigned long long>(a.cells),
                     a.relative_variance, a.worst);
}

void add_fit_options(CLI::App& command, Options& options) {
    compress::BrdfOptions& fit = options.file.fit;
    const std::map<std::string, AcdfFit> fits{{"uniform", ACDF_FIT_UNIFORM},
                                              {"cdf", ACDF_FIT_CDF},
                                              {"pdf", ACDF_FIT_PDF},
                                              {"variance", ACDF_FIT_VARIANCE}};
    command
        .add_option(
            "--fit", fit.fit,
            "How knots are chosen: variance (least noise for its size; views share cells and are interpolated), "
            "or, to compare with, cdf, pdf and uniform (Lawrence et al. 2005: curves of its own for each bin of "
            "views, the nearest bin serves)")
        ->transform(CLI::CheckedTransformer(fits).description(""))
        ->option_text("NAME [variance]")
        ->group("Fit");
    command
        .add_option(
            "--views", options.views,
            "Stored views in theta_o and phi_o, such as 32 or 16x8; two counts treat the BRDF as anisotropic")
        ->option_text("N|NxM [as suits the size]")
        ->group("Fit");
    command
        .add_flag("--no-sharing", options.separate,
                  "Give each bin of views a tree of its own, of which the nearest serves: to compare with")
        ->group("Fit");
    std::vector<std::string> names;
    for (const ChannelName& channel : channel_names) names.push_back(channel.name);
    command
        .add_option_function<std::string>(
            "--channel",
            [&options](const std::string& name) {
                for (const ChannelName& channel : channel_names)
                    if (name == channel.name) {
                        options.file.channels = channel.channels;
                        options.file.weights = channel.weights;
                    }
            },
            "Whose noise is minimised: luminance (Rec. 709), rgb (all three channels), max (the largest), red, "
            "green or "
            "blue alone")
        ->check(CLI::IsMember(names).description(""))
        ->option_text("NAME [luminance]")
        ->group("Fit");
    command
        .add_option(
            "--diffuse-floor", options.file.diffuse_share,
            "Share of samples that follow the cosine instead. Not needed for what the fit has seen, which it "
            "covers; it bounds weights where a renderer's BRDF differs from the one fitted")
        ->check(CLI::Range(0.0f, 0.99f))
        ->option_text("X [0]")
        ->group("Fit");
}

void add_size_options(CLI::App& command, Options& options) {
    compress::BrdfOptions& fit = options.file.fit;
    add_goal(command, fit.goal.cells, options.budget, fit.goal.variance,
             {"Cells that all views share; without sharing: of each, on average", "N", "SIZE [64KiB]",
              ", about, as mean over views", 1, ACDF_MAX_TILES});
    command
        .add_option("--knots", options.knots,
                    "Segments of curves over phi_h and theta_h, for --fit uniform, cdf and pdf")
        ->option_text("AxB [10x30]")
        ->group("Size and accuracy");
    command
        .add_option("--eps", fit.epsilon, "Stop adding knots once no curve deviates by more, for --fit cdf and pdf")
        ->check(CLI::Range(0.0, 1.0))
        ->option_text("E")
        ->group("Size and accuracy");
}

} // namespace

void add_brdf(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App& command =
        *program.add_subcommand("brdf", "Compress a BRDF: directions of light by what they reflect");
    options->command = &command;
    command
        .add_option("BRDF", options->source,
                    "MERL .binary, RGL .bsdf, an .npy over (theta_o, phi_o, theta_h, phi_h), or a model: lambert, "
                    "ggx:alpha=0.1[,0.3], cook-torrance:m=0.2,n=1.5,k=0, blinn:e=100")
        ->required()
        ->type_name("")
        ->group("Input");
    add_output(command, options->output, options->force, "The .acdf file to write")->required();
    add_fit_options(command, *options);
    add_size_options(command, *options);
    add_codec(command, options->file.codec);
    add_threads(command, options->threads);
    add_json(command, options->json);
    add_quiet(command, options->quiet);
    command.footer(help_footer("Prints the size and the relative variance of the stored densities over random "
                               "views, cos(theta_o) uniform in "
                               "[0.1, 1]: n samples have that over n.",
                               "acdf brdf nickel.binary -o nickel.acdf\n"
                               "acdf brdf cc_ibiza_sunset_rgb.bsdf -o ibiza.acdf --budget 200KiB\n"
                               "acdf brdf ggx:alpha=0.1,0.3 -o brushed.acdf --target-variance 0.01\n"
                               "acdf brdf nickel.binary -o paper.acdf --fit cdf --knots 10x30 --views 32x16"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
