// acdf brdf: a BRDF to an .acdf file.
#include "build/own_terms.h"
#include "build/text/format_names.h"
#include "input/brdf/models.h"
#include "tools/cli/built.h"
#include "tools/cli/conversion.h"
#include "tools/cli/goal_options.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/sizes.h"
#include "tools/cli/target_options.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace acdf::tools {
namespace {

// Peaks beside the program itself: models 97 MiB with the default budget, 210 MiB with 1 MiB; 135 MiB for the
// 33 MiB of MERL.
constexpr std::uint64_t kBrdfMemory = 80 << 20, kMemoryOfByte = 2, kBrdfMemoryOfBudget = 140;
constexpr std::uint64_t kBrdfBytesOfCell = 5;
/// Bytes of a file of a variance, about, times it.
constexpr double kBrdfBytesOfVariance = 2048.0;

class BrdfConversion : public Conversion {
public:
    void add_options(CLI::App& command) override;
    void check() override;
    std::string option_text() const override { return builder::option_text(brdf_); }
    std::uint64_t memory() const override;
    Converted convert(const Listener& listener) override;

private:
    bool given(const char* option) const { return command_->get_option(option)->count() > 0; }
    void check_fit() const;
    std::uint64_t bytes_of_cells() const;
    void add_fit_options(CLI::App& command);
    void add_size_options(CLI::App& command);
    nlohmann::ordered_json report(const builder::BrdfFile& result) const;

    builder::BrdfOptions brdf_;
    std::string views_, knots_, budget_;
    const CLI::App* command_ = nullptr;
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

void BrdfConversion::check_fit() const {
    const bool variance = brdf_.fit == ACDF_FIT_VARIANCE;
    for (const char* option : {"--cells", "--budget", "--target-variance", "--max-weight"})
        if (!variance && given(option))
            throw CLI::ValidationError(option, "is for --fit variance; use --knots or --eps with the other fits");
    for (const char* option : {"--knots", "--eps"})
        if (variance && given(option))
            throw CLI::ValidationError(option, "is for --fit uniform, cdf and pdf; use --budget or --cells");
    if (given("--eps") && brdf_.fit == ACDF_FIT_UNIFORM)
        throw CLI::ValidationError("--eps", "is for --fit cdf and pdf");
}

void BrdfConversion::check() {
    check_fit();
    if (given("--views") && !parse_views(views_, brdf_.theta_views, brdf_.phi_views))
        throw CLI::ValidationError("--views",
                                   "needs a count such as 32, or two such as 16x8 (theta_o x phi_o, at least 4)");
    if (given("--knots") && !parse_pair(knots_, ACDF_MAX_SEGMENTS, brdf_.phi_segments, brdf_.theta_segments))
        throw CLI::ValidationError("--knots", "needs two counts such as 10x30 (phi_h x theta_h)");
    if (given("--eps") && !given("--knots")) brdf_.phi_segments = brdf_.theta_segments = ACDF_MAX_SEGMENTS;
    if (brdf_.fit == ACDF_FIT_VARIANCE) read_goal(*command_, budget_, brdf_.goal);
}

nlohmann::ordered_json BrdfConversion::report(const builder::BrdfFile& result) const {
    const builder::BrdfAccuracy& a = result.accuracy;
    return {{"source", source},
            {"fit", build::fit_name(brdf_.fit)},
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

/// What of the file cells take, about.
std::uint64_t BrdfConversion::bytes_of_cells() const {
    switch (brdf_.goal.kind) {
    case builder::Goal::Kind::cells:
        return kBrdfBytesOfCell * brdf_.goal.cells;
    case builder::Goal::Kind::variance:
        return static_cast<std::uint64_t>(std::min(kBrdfBytesOfVariance / brdf_.goal.variance, 0x1p22));
    case builder::Goal::Kind::budget:
        return brdf_.goal.budget;
    default:
        return builder::DefaultBudget::brdf;
    }
}

std::uint64_t BrdfConversion::memory() const {
    const std::uint64_t fit = kBrdfMemory + bytes_of_cells() * kBrdfMemoryOfBudget;
    if (input::is_model(source)) return fit;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(source, error);
    return error ? 0 : fit + bytes * kMemoryOfByte;
}

Converted BrdfConversion::convert(const Listener& listener) {
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(source);
    for (const std::string& note : brdf->notes) listener.note(note);
    builder::BrdfOptions options = brdf_;
    options.source.name = brdf->name;
    options.source.sha256 = brdf->sha256;
    builder::BrdfFile result;
    require_built(source, builder::brdf(builder::described(*brdf), options, result, told(listener.progress)));
    const builder::BrdfAccuracy& a = result.accuracy;
    char summary[200];
    std::snprintf(summary, sizeof summary, "%u views, %llu cells, relative variance %.4g (mean; worst %.4g)",
                  result.theta_views * result.phi_views, static_cast<unsigned long long>(a.cells),
                  a.relative_variance, a.worst);
    std::string told = json_text(report(result));
    return {std::move(result.bytes), a.relative_variance, std::move(told), summary};
}

void BrdfConversion::add_fit_options(CLI::App& command) {
    add_fit(command, brdf_.fit,
            "How cells are chosen: variance (least noise for its size; views share a tree and are interpolated), "
            "or, to compare with, cdf, pdf and uniform (Lawrence et al. 2005: curves of its own for each bin of "
            "views, the nearest bin serves)")
        ->group("Fit");
    command
        .add_option(
            "--views", views_,
            "Stored views in theta_o and phi_o, such as 32 or 16x8; two counts treat the BRDF as anisotropic")
        ->option_text("N|NxM [as suits the size]")
        ->group("Fit");
    add_channels(
        command, brdf_.channels,
        "Whose noise is minimised: luminance (Rec. 709), rgb (all three channels), max (the largest), red, "
        "green or blue alone");
    command
        .add_option(
            "--diffuse-floor", brdf_.diffuse_share,
            "Share of samples that follow the cosine instead. Not needed for what the fit has seen, which it "
            "covers; it bounds weights where a renderer's BRDF differs from the one fitted")
        ->check(number_range(0.0, 0.99))
        ->option_text("X [0]")
        ->group("Fit");
}

void BrdfConversion::add_size_options(CLI::App& command) {
    add_goal(command, brdf_.goal.cells, budget_, brdf_.goal.variance,
             {"Cells of each view", "N", "SIZE [128KiB]", ", about, as mean over views", 1, builder::max_tiles});
    add_max_weight(
        command, brdf_.max_weight,
        ". It is measured over the views whose variance is printed; without it, weights are held to about "
        "20 where that costs next to nothing");
    command
        .add_option("--knots", knots_, "Segments of curves over phi_h and theta_h, for --fit uniform, cdf and pdf")
        ->option_text("AxB [10x30]")
        ->group("Size and accuracy");
    command
        .add_option("--eps", brdf_.epsilon,
                    "Stop adding knots once no curve deviates by more, for --fit cdf and pdf")
        ->check(number_range(0.0, 1.0))
        ->option_text("E")
        ->group("Size and accuracy");
}

void BrdfConversion::add_options(CLI::App& command) {
    command_ = &command;
    add_fit_options(command);
    add_size_options(command);
    add_codec(command, brdf_.codec);
}

} // namespace

std::unique_ptr<Conversion> brdf_conversion() { return std::make_unique<BrdfConversion>(); }

void add_brdf(CLI::App& program, int& exit_code) {
    CLI::App& command =
        *program.add_subcommand("brdf", "Compress a BRDF: directions of light by what they reflect");
    add_conversion(
        command, brdf_conversion(),
        {"BRDF", ".acdf",
         "MERL .binary, RGL .bsdf, an .npy over (theta_o, phi_o, theta_h, phi_h), or a model: lambert, "
         "ggx:0.1[,0.3] (or ggx:alpha=0.1), cook-torrance:m=0.2,n=1.5,k=0, blinn:100. Several become a file each",
         help_footer("Prints the size and the relative variance of the stored pdfs over random views, cos(theta_o) "
                     "uniform in [0.1, 1]. An estimate of n samples has 1/n of this variance.",
                     "acdf brdf nickel.binary\n"
                     "acdf brdf ggx:0.1 -o ggx.acdf\n"
                     "acdf brdf cc_ibiza_sunset_rgb.bsdf -o ibiza.acdf --budget 200KiB\n"
                     "acdf brdf ggx:alpha=0.1,0.3 -o brushed.acdf --target-variance 0.01\n"
                     "acdf brdf nickel.binary -o paper.acdf --fit cdf --knots 10x30 --views 32x16")},
        exit_code);
}

} // namespace acdf::tools
