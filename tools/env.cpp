// acdf env: an environment map to an .acdf file.
#include "build/environment.h"
#include "build/text/format_names.h"
#include "tools/cli/built.h"
#include "tools/cli/choice.h"
#include "tools/cli/conversion.h"
#include "tools/cli/goal_options.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/map_options.h"
#include "tools/cli/mis_options.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/renderer.h"
#include "tools/cli/scene_option.h"
#include "tools/cli/sizes.h"
#include "tools/cli/target_memory.h"
#include "tools/cli/target_options.h"
#include "tools/commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace acdf::tools {
namespace {

// Peaks beside the program itself (tools/cli/target_memory.h has those of targets), measured on probes of 2^15 to
// 2^23 pixels. Of each texel the sums of all halvings, twice beside a partner, or what curves need.
constexpr std::uint64_t kEnvironmentMemory = 16 << 20, kPartnerMemory = 24 << 20;
constexpr std::uint64_t kSumsOfTexel = 16, kPartnerOfTexel = 28, kCurvesOfTexel = 8;
// A tree while it is grown. A cell takes 9 bits of a file at least.
constexpr std::uint64_t kMemoryOfCell = 110, kBitsOfCell = 9;
// Bytes of several maps: a texel of the map and of the map without its sun, and the most that sums of all take.
constexpr std::uint64_t kMapOfTexel = 8, kSumsOfMaps = 256 << 20;
/// Cells that a variance takes of nearly all maps, times it.
constexpr double kCellsOfVariance = 4000.0;

class EnvConversion : public Conversion {
public:
    void add_options(CLI::App& command) override;
    void check() override;
    std::vector<std::string*> files() override;
    std::string option_text() const override {
        return maps_.any() ? builder::option_text(maps_.options(input_, environment_))
                           : builder::option_text(with_source());
    }
    std::uint64_t memory() const override;
    const input::ProbeOptions* reading() const override { return &input_; }
    bool takes_all(const std::vector<std::string>& sources) override;
    Converted convert(const Listener& listener) override;

private:
    bool given(const char* option) const { return command_->get_option(option)->count() > 0; }
    builder::EnvironmentOptions with_source() const;
    void use_renderers_partner();
    void check_partner() const;
    void set_knots();
    void add_fit_options(CLI::App& command);
    std::uint64_t most_cells(std::uint64_t texels) const;
    nlohmann::ordered_json report(const ProbeTarget& loaded, const builder::Environment& result) const;

    input::ProbeOptions input_;
    const builder::Renderer* renderer_ = nullptr;
    bool for_partner_ = false; ///< as the renderer's preset has it
    builder::EnvironmentOptions environment_;
    std::string knots_, budget_;
    SceneOption scene_;
    MapOptions maps_;
    const CLI::App* command_ = nullptr;
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
    {"--order", true, true, true, false, "is for --fit uniform, cdf and pdf"},
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

void EnvConversion::set_knots() {
    builder::FitOptions& fit = environment_.fit;
    if (given("--knots")) {
        if (!parse_pair(knots_, ACDF_MAX_SEGMENTS, fit.phi_segments, fit.theta_segments))
            throw CLI::ValidationError("--knots", "needs two counts such as 64x64 (phi x theta)");
    } else if (given("--eps")) {
        fit.phi_segments = fit.theta_segments = ACDF_MAX_SEGMENTS; // the threshold alone decides
    }
}

std::vector<std::string*> EnvConversion::files() {
    std::vector<std::string*> out = scene_.files(source);
    for (std::size_t i = 1; i < maps_.files().size(); ++i) out.push_back(&maps_.files()[i]);
    return out;
}

bool EnvConversion::takes_all(const std::vector<std::string>& sources) {
    if (!maps_.given(sources)) return false;
    for (const char* option :
         {"--cells", "--target-variance", "--max-weight", "--fit", "--mis", "--scene", "--faces"})
        if (given(option)) throw CLI::ValidationError(option, "is for a file of one map, without --axis");
    maps_.take(sources);
    source = maps_.files()[0];
    return true;
}

void EnvConversion::use_renderers_partner() {
    if (!renderer_) return;
    builder::EnvironmentOptions options = environment_;
    if (scene_.given()) options.normals = {{}}; // any
    for_partner_ = use_partner(*command_, renderer_->partner(options), environment_.mis);
}

void EnvConversion::check_partner() const {
    const bool alone = environment_.mis.kind == ACDF_PARTNER_NONE;
    for (const char* option : {"--shares", "--heuristic", "--scene"})
        if (alone && given(option)) throw CLI::ValidationError(option, "is for files with an MIS partner (--mis)");
    for (const char* option : {"--target-variance", "--max-weight"})
        if (!alone && given(option))
            throw CLI::ValidationError(option, "is for files without an MIS partner (--mis)");
    if (!alone && environment_.fit.fit != ACDF_FIT_VARIANCE)
        throw CLI::ValidationError("--mis", "is for --fit variance");
}

void EnvConversion::check() {
    for (const char* option : {"--axis", "--sun", "--no-sun"})
        if (!maps_.any() && given(option))
            throw CLI::ValidationError(option,
                                       "is for several maps in one file: acdf env A B -o FILE --axis time=6,9");
    use_renderer(*command_, renderer_, input_, environment_.target);
    scene_.check(*command_);
    const AcdfFit fit = environment_.fit.fit;
    for (const OnlyFor& rule : only_for)
        if (given(rule.option) && !allows(rule, fit)) throw CLI::ValidationError(rule.option, rule.message);
    environment_.goal.budget = builder::DefaultBudget::environment;
    environment_.goal.kind = builder::Goal::Kind::budget;
    if (fit == ACDF_FIT_VARIANCE) read_goal(*command_, budget_, environment_.goal);
    else set_knots();
    use_renderers_partner();
    check_partner();
}

/// The options as they will be, but for what only the probe's file holds.
builder::EnvironmentOptions EnvConversion::with_source() const {
    builder::EnvironmentOptions options = environment_;
    options.source.reading = reading_text(input_);
    if (scene_.given()) {
        options.normals = {{}}; // any: only the text names them
        options.normals_text = scene_.text();
    }
    return options;
}

const char* order_name(builder::Order order) {
    return order == builder::Order::best ? "free" : order == builder::Order::phi ? "phi" : "z";
}

nlohmann::ordered_json EnvConversion::report(const ProbeTarget& loaded, const builder::Environment& result) const {
    const input::Probe& probe = loaded.probe;
    const builder::EnvironmentAccuracy& a = result.accuracy;
    nlohmann::ordered_json out = {
        {"source", source},
        {"projection", input::to_string(probe.projection)},
        {"projection_reason", probe.projection_reason},
        {"domain", build::parameterization_name(builder::grid_of(loaded.target).parameterization)},
        {"resolution", {probe.width, probe.height}},
        {"resampling_error", loaded.error},
        {"bad_texels",
         {{"nan", probe.bad.nan}, {"infinite", probe.bad.infinite}, {"negative", probe.bad.negative}}},
        {"fit", build::fit_name(environment_.fit.fit)},
        {"order", order_name(result.order)},
        {"bytes", result.bytes.size()},
        {"cells", a.cells},
        {"total", a.total},
        {"relative_variance", a.relative_variance},
        {"least_variance", known_json(!a.combined, a.least_variance)},
        {"rms_pdf_error", known_json(!a.combined, a.rms_pdf_error)},
        {"kl_divergence", known_json(!a.combined, a.kl_divergence)},
        {"max_weight", a.max_weight},
        {"support_violations", a.support_violations}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    return out;
}

/// The cells of the largest tree that is grown.
std::uint64_t EnvConversion::most_cells(std::uint64_t texels) const {
    const builder::Goal& goal = environment_.goal;
    std::uint64_t cells = goal.cells;
    if (goal.kind == builder::Goal::Kind::budget) cells = goal.budget * 8 / kBitsOfCell;
    if (goal.kind == builder::Goal::Kind::variance) {
        cells = build::kMostBytesForVariance * 8 / kBitsOfCell;
        if (environment_.fit.max_weight == 0.0)
            cells = static_cast<std::uint64_t>(std::min(double(cells), kCellsOfVariance / goal.variance));
    }
    return std::min(cells, texels);
}

std::uint64_t EnvConversion::memory() const {
    const TargetMemory of = target_memory(source, input_, environment_.target);
    if (of.texels == 0) return 0;
    if (maps_.any()) {
        const std::uint64_t maps = maps_.count();
        return kEnvironmentMemory + of.reading + (maps - 1) * of.target + maps * of.texels * kMapOfTexel +
               std::min(maps * of.texels * kSumsOfTexel, kSumsOfMaps);
    }
    const bool partner = environment_.mis.kind != ACDF_PARTNER_NONE;
    if (environment_.fit.fit != ACDF_FIT_VARIANCE)
        return kEnvironmentMemory + std::max(of.reading, of.target + of.texels * kCurvesOfTexel);
    const std::uint64_t fit = of.texels * (kSumsOfTexel + (partner ? kPartnerOfTexel : 0));
    return kEnvironmentMemory + (partner ? kPartnerMemory : 0) +
           std::max(of.reading, of.target + fit + most_cells(of.texels) * kMemoryOfCell);
}

Converted EnvConversion::convert(const Listener& listener) {
    if (maps_.any()) return maps_.convert(input_, environment_, listener);
    const ProbeTarget loaded = load_target(source, input_, environment_.target, listener.note);
    if (renderer_) scene_.note_axes(*command_, *renderer_, loaded.probe.source_map.layout, listener.note);
    if (for_partner_) listener.note(partner_text(*renderer_, environment_.mis));
    builder::EnvironmentOptions options = environment_;
    options.source = source_of(loaded.probe, input_);
    options.normals = scene_.read(listener.note);
    const auto partner = options.mis.kind;
    if (!scene_.given() && (partner == ACDF_PARTNER_COSINE || partner == ACDF_PARTNER_BRDF))
        listener.note("made for all normals alike; if most visible surfaces face the sky, --scene with their "
                      "normals, or else --mis mean, has less noise");
    if (scene_.given()) options.normals_text = scene_.text();
    builder::Environment result;
    require_built(source, builder::environment(loaded.target, options, result, told(listener.progress)));
    const std::string warning =
        resampling_warning(loaded, result.accuracy.least_variance, result.accuracy.relative_variance);
    if (!warning.empty()) listener.note(warning);
    char summary[240];
    std::snprintf(summary, sizeof summary, "%llu cells, %srelative variance %.4g%s (%s fit%s)",
                  static_cast<unsigned long long>(result.accuracy.cells),
                  result.accuracy.combined ? "with its MIS partner " : "", result.accuracy.relative_variance,
                  result.accuracy.combined ? " a sample, mean over normals; not to be used alone" : "",
                  build::fit_name(environment_.fit.fit).c_str(),
                  result.order != builder::Order::best
                      ? (std::string(", ") + order_name(result.order) + " first").c_str()
                      : "");
    std::string told = json_text(report(loaded, result));
    return {std::move(result.bytes), result.accuracy.relative_variance, std::move(told), summary};
}

void EnvConversion::add_fit_options(CLI::App& command) {
    builder::FitOptions& fit = environment_.fit;
    add_fit(command, fit.fit,
            "How knots are chosen: variance (least noise for its size), cdf (Lawrence et al. 2005, Douglas-Peucker "
            "on the CDF), pdf (the same on the pdf, piecewise linear: for smooth skies), uniform (equal steps, to "
            "compare with)")
        ->group("Fit");
    enum class First { either, phi, z };
    constexpr Named<First> orders[] = {{"auto", First::either}, {"phi", First::phi}, {"z", First::z}};
    add_choice(
        command, "--order",
        [&fit](First first) {
            if (first != First::either) fit.order = first == First::phi ? builder::Order::phi : builder::Order::z;
        },
        orders,
        "Which axis --fit uniform, cdf and pdf split first: phi, z, or auto (both files are made, and the more "
        "accurate one is kept, in twice the time)")
        ->option_text("NAME [auto]")
        ->group("Fit");
    add_goal(
        command, environment_.goal.cells, budget_, environment_.goal.variance,
        {"Cells in all, instead of a size: about 4 bytes each", "N", "SIZE [64KiB]",
         ": 0.01 is a tenth of the mean as standard deviation of one sample. Files of up to 16 MiB are tried"});
    add_max_weight(command, fit.max_weight);
    command
        .add_option(
            "--knots", knots_,
            "Segments of a curve over phi and over theta, for --fit uniform, cdf and pdf (at most this many "
            "with --eps)")
        ->option_text("AxB [64x64]")
        ->group("Size and accuracy");
    command
        .add_option("--eps", fit.epsilon,
                    "Stop adding knots once no curve deviates by more: from the CDF for --fit cdf, from the pdf "
                    "relative to its peak for --fit pdf")
        ->check(number_range(0.0, 1.0))
        ->option_text("E")
        ->group("Size and accuracy");
    command
        .add_option("--gradient", fit.gradient_knots,
                    "Extra knots of the first curve where the map changes across it, for --fit cdf and pdf: helps "
                    "where lights at different heights share a region (ibid., eq. 5)")
        ->check(CLI::Range(0u, 1u << 20))
        ->option_text("N [0]")
        ->group("Fit");
    constexpr Named<builder::Conditional> conditionals[] = {{"energy", builder::Conditional::energy},
                                                            {"mean", builder::Conditional::mean}};
    add_choice(command, "--conditional", fit.conditional, conditionals,
               "How the lines of a region are averaged: energy (by what they emit, less noise) or mean "
               "(all alike, as ibid., eq. 4, is printed)")
        ->option_text("NAME [energy]")
        ->group("Fit");
}

void EnvConversion::add_options(CLI::App& command) {
    command_ = &command;
    add_projection(command, input_.projection);
    add_faces(command, input_.faces);
    add_domain(command, input_.domain);
    add_renderer(command, renderer_);
    add_repairs(command, input_);
    add_fit_options(command);
    add_partner(command, environment_.mis, ACDF_KIND_ENVIRONMENT);
    scene_.add(command,
               "The normals that the partner lights: a mesh (.obj, .ply, .instances), a normal pass (.exr) or a "
               "list of normals "
               "(.txt, x y z [weight] a line)",
               "MIS partner");
    scene_.add_axes(command, "MIS partner");
    maps_.add(command);
    add_target_options(command, environment_.target);
    add_codec(command, environment_.codec);
}

} // namespace

std::unique_ptr<Conversion> env_conversion() { return std::make_unique<EnvConversion>(); }

void add_env(CLI::App& program, int& exit_code) {
    CLI::App& command = *program.add_subcommand("env", "Compress an environment map: directions by what they emit");
    add_conversion(
        command, env_conversion(),
        {"PROBE", ".acdf",
         "The environment map: any image OpenImageIO reads, or the six faces of a cube (--faces). Several become a "
         "file each, or one together (--axis; sky.####.exr)",
         help_footer("Prints the size and the exact relative variance of the stored pdf: an estimate of n samples "
                     "has 1/n of this variance. By default the file has the least noise in 64 KiB.",
                     "acdf env probe.exr\n"
                     "acdf env probe.hdr -o probe.acdf --budget 16KiB\n"
                     "acdf env noon.exr dusk.exr -o skies/\n"
                     "acdf env day.####.exr -o day.acdf\n"
                     "acdf env morning.exr noon.exr evening.exr -o day.acdf --axis time=8,12,18\n"
                     "acdf env probe.hdr -o probe.acdf --target-variance 0.01 --compress zlib\n"
                     "acdf env grace_probe.hdr --projection angular -o grace.acdf\n"
                     "acdf env sky_{px,nx,py,ny,pz,nz}.hdr --faces directx -o sky.acdf\n"
                     "acdf env probe.exr -o paper.acdf --fit cdf --knots 64x64 --order z --gradient 16")},
        exit_code);
}

} // namespace acdf::tools
