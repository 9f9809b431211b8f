// acdf local: an environment map to an .acdf file that knows the surface: for every normal what shines on it.
#include "build/text/format_names.h"
#include "input/mesh/instances.h"
#include "input/mesh/surface.h"
#include "tools/cli/built.h"
#include "tools/cli/choice.h"
#include "tools/cli/conversion.h"
#include "tools/cli/goal_options.h"
#include "tools/cli/help.h"
#include "tools/cli/json.h"
#include "tools/cli/mesh_visibility.h"
#include "tools/cli/mis_options.h"
#include "tools/cli/number_range.h"
#include "tools/cli/options.h"
#include "tools/cli/portal_check.h"
#include "tools/cli/portal_option.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/renderer.h"
#include "tools/cli/scene_option.h"
#include "tools/cli/sizes.h"
#include "tools/cli/target_memory.h"
#include "tools/cli/target_options.h"
#include "tools/commands.h"
#include "visibility/visible_view.h"

#include <CLI/CLI.hpp>
#include <acdf/curves/curves.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace acdf::tools {
namespace {

// Peaks beside the program itself (tools/cli/target_memory.h has those of targets), measured on probes of 2^15 to
// 2^23 pixels with budgets up to 8 MiB: light as points and coarse maps; of each texel what tiles are found by; of
// each byte of the file the cells that it is chosen from, of which there are no more than texels suffice for.
constexpr std::uint64_t kLocalMemory = 16 << 20, kLocalMemoryOfTexel = 16, kLocalPartnerOfTexel = 20;
constexpr std::uint64_t kLocalMemoryOfByte = 170, kLocalPartnerOfByte = 170, kLocalCellsOfTexel = 1200;
// Of bins with trees of their own.
constexpr std::uint64_t kSeparateOfTexel = 32, kSeparateOfKnot = 32;
constexpr std::uint64_t kLocalBytesOfCell = 5; // of a file
/// Bytes of a file of a variance, about, times it.
constexpr double kLocalBytesOfVariance = 16384.0;

// Visibility of meshes of up to 120,000 triangles, with budgets up to 4 MB: what their rays have met, and the mesh.
constexpr std::uint64_t kVisibilityMemory = 64 << 20, kVisibilityMemoryOfByte = 200, kMeshMemoryOfByte = 32;

class LocalConversion : public Conversion {
public:
    void add_options(CLI::App& command) override;
    void check() override;
    std::vector<std::string*> files() override;
    std::string option_text() const override;
    std::uint64_t memory() const override;
    const input::ProbeOptions* reading() const override { return &input_; }
    Converted convert(const Listener& listener) override;

private:
    bool given(const char* option) const { return command_->get_option(option)->count() > 0; }
    void set_normals();
    void set_separate();
    void set_cells_beside_cosine();
    builder::LocalOptions read_scene(const Note& note) const;
    void add_bins(CLI::App& command);
    void add_size(CLI::App& command);
    void add_separate(CLI::App& command);
    nlohmann::ordered_json report(const ProbeTarget& loaded, const builder::Local& result) const;
    std::string scene_text() const;
    std::uint64_t most_bins() const;
    std::uint64_t bytes_of_cells() const;
    std::uint64_t memory_of_separate(const TargetMemory& of) const;
    std::uint64_t memory_of_shared(const TargetMemory& of) const;

    std::string normals_, budget_, knots_;
    SceneOption scene_;
    PortalOption portals_;
    input::ProbeOptions input_;
    const builder::Renderer* renderer_ = nullptr;
    bool for_partner_ = false; ///< as the renderer's preset has it
    builder::LocalOptions local_;
    const CLI::App* command_ = nullptr;
    bool no_sharing_ = false, visibility_ = false, volume_ = false;
    bool cells_beside_cosine_ = false; // --visibility --mis cosine
};

constexpr double kWorthwhile = 1.5; ///< gain below which a file without normals would do as well

void LocalConversion::set_normals() {
    if (!given("--normals")) return;
    builder::LocalOptions& local = local_;
    unsigned n = 0;
    int end = 0;
    if (std::sscanf(normals_.c_str(), "%4u%n", &n, &end) == 1 && static_cast<std::size_t>(end) == normals_.size() &&
        n >= 1 && n <= 256) {
        local.subdivisions = n;
        return;
    }
    if (!parse_pair(normals_, 1024, local.columns, local.rows))
        throw CLI::ValidationError("--normals", "needs a number from 1 to 256, or two such as 25x10 (phi x theta)");
}

void LocalConversion::set_separate() {
    builder::LocalOptions& local = local_;
    builder::FitOptions& fit = local.fit;
    local.sharing = !no_sharing_;
    if (local.sharing) {
        if (local.columns > 0)
            throw CLI::ValidationError("--normals",
                                       "AxB is for --no-sharing: bins that share tiles are interpolated");
        for (const char* option : {"--fit", "--knots", "--eps", "--order", "--bin-target"})
            if (given(option)) throw CLI::ValidationError(option, "is for --no-sharing");
        return;
    }
    if (visibility_) throw CLI::ValidationError("--visibility", "goes without --no-sharing");
    for (const char* option : {"--tiles", "--max-weight", "--cells", "--budget", "--target-variance"})
        if (given(option)) throw CLI::ValidationError(option, "is for files whose bins share tiles");
    if (!given("--fit")) fit.fit = ACDF_FIT_CDF;
    if (fit.fit == ACDF_FIT_VARIANCE)
        throw CLI::ValidationError("--fit", "is cdf, pdf or uniform with --no-sharing");
    if (!given("--order")) fit.order = builder::Order::z;
    local.goal.kind = builder::Goal::Kind::automatic;
    if (given("--knots")) {
        if (!parse_pair(knots_, ACDF_MAX_SEGMENTS, fit.phi_segments, fit.theta_segments))
            throw CLI::ValidationError("--knots", "needs two counts such as 30x30 (phi x theta)");
    } else if (given("--eps")) {
        fit.phi_segments = fit.theta_segments = ACDF_MAX_SEGMENTS; // the threshold alone decides
    }
}

/// Rows of normals stay those of all light, so that the file is valid alone.
void LocalConversion::set_cells_beside_cosine() {
    if (!visibility_ || local_.mis.kind == ACDF_PARTNER_NONE) return;
    for (const char* option : {"--shares", "--heuristic", "--cosine-share"})
        if (given(option)) throw CLI::ValidationError("--visibility --mis", std::string("goes without ") + option);
    cells_beside_cosine_ = true;
    local_.mis = {};
}

void LocalConversion::check() {
    use_renderer(*command_, renderer_, input_, local_.target);
    scene_.check(*command_);
    set_normals();
    local_.goal.budget = visibility_ ? builder::DefaultBudget::visibility : builder::DefaultBudget::local;
    local_.goal.kind = builder::Goal::Kind::budget;
    read_goal(*command_, budget_, local_.goal);
    set_separate();
    if (renderer_ && !visibility_) for_partner_ = use_partner(*command_, renderer_->partner(local_), local_.mis);
    set_cells_beside_cosine();
    const bool alone = local_.mis.kind == ACDF_PARTNER_NONE;
    for (const char* option : {"--shares", "--heuristic"})
        if (alone && given(option)) throw CLI::ValidationError(option, "is for files with an MIS partner (--mis)");
    for (const char* option : {"--no-sharing", "--cosine-share", "--max-weight"})
        if (!alone && given(option))
            throw CLI::ValidationError(option, "is for files without an MIS partner (--mis)");
    if (portals_.given() && !visibility_) throw CLI::ValidationError("--portal", "is for --visibility");
    if (volume_ && !visibility_) throw CLI::ValidationError("--volume", "is for --visibility");
    if (!visibility_) return;
    if (!scene_.given()) throw CLI::ValidationError("--visibility", "needs --scene MESH");
    for (const char* option : {"--cells", "--target-variance", "--max-weight"})
        if (given(option)) throw CLI::ValidationError("--visibility", std::string("goes without ") + option);
}

std::vector<std::string*> LocalConversion::files() {
    std::vector<std::string*> out = scene_.files(source);
    if (!portals_.path.empty()) out.push_back(&portals_.path);
    return out;
}

std::string LocalConversion::scene_text() const {
    return scene_.text() + (visibility_ ? " --visibility" : "") + (cells_beside_cosine_ ? " --mis cosine" : "") +
           (volume_ ? " --volume" : "") + portals_.text();
}

std::string LocalConversion::option_text() const {
    builder::LocalOptions written = local_;
    if (scene_.given()) {
        written.normals = {{}}; // any number: the text names the scene alone
        written.normals_text = scene_text();
    }
    written.source.reading = reading_text(input_);
    return builder::option_text(written);
}

/// The options with the normals of the scene.
builder::LocalOptions LocalConversion::read_scene(const Note& note) const {
    builder::LocalOptions local = local_;
    if (!scene_.given()) return local;
    local.normals = scene_.read(note);
    local.normals_text = scene_text();
    if (visibility_) {
        local.normals = both_sides(std::move(local.normals));
        if (volume_) local.normals.clear(); // what hangs in the air has any
        const std::shared_ptr<const input::MeshSurface> surface = read_surface(scene_, note);
        local.visibility = visibility_on(surface, scene_.input().up, volume_);
        if (!scene_.axes().ours()) scene_.axes().tell(local.visibility);
        local.visibility.beside_cosine = cells_beside_cosine_;
        portals_.tell(local.visibility);
        note_portals(local.visibility, *surface, note);
    }
    return local;
}

double gain(const builder::Local& result) {
    return result.accuracy.relative_variance_full_cdf / result.accuracy.relative_variance;
}

nlohmann::ordered_json LocalConversion::report(const ProbeTarget& loaded, const builder::Local& result) const {
    const builder::LocalAccuracy& a = result.accuracy;
    File file;
    File::from_memory(result.bytes.data(), result.bytes.size(), file, with_curves());
    const AcdfNormalRows* const rows = file.local().data().rows_of_normals;
    const AcdfVisibility* const cells = visible_view(file).data().cells.header;
    nlohmann::ordered_json out = {
        {"source", source},
        {"domain", build::parameterization_name(builder::grid_of(loaded.target).parameterization)},
        {"resolution", {loaded.probe.width, loaded.probe.height}},
        {"bytes", result.bytes.size()},
        {"bins", file.description().bin_count},
        {"tiles", rows ? rows->splits + 1 : 0},
        {"visibility", cells ? cells->row_count : 0},
        {"normals", result.normals},
        {"relative_variance", a.relative_variance},
        {"relative_variance_full_cdf", a.relative_variance_full_cdf},
        {"gain", gain(result)},
        {"max_weight", a.max_weight},
        {"share_above_horizon", a.share_above_horizon},
        {"least_share_above_horizon", a.least_share_above_horizon},
        {"support_violations", a.support_violations}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    return out;
}

std::string summary_of(const builder::Local& result) {
    const builder::LocalAccuracy& a = result.accuracy;
    char text[320];
    if (a.combined) {
        std::snprintf(
            text, sizeof text,
            "with its MIS partner, relative variance %.4g a sample over %u normals: %.3g times less than the "
            "probe's own CDF with it (%.4g); not to be used alone",
            a.relative_variance, a.lit_normals, gain(result), a.relative_variance_full_cdf);
        return text;
    }
    std::snprintf(text, sizeof text,
                  "relative variance %.4g over %u normals: %.3g times less than the probe's own CDF (%.4g); "
                  "%.1f %% of samples above the horizon",
                  a.relative_variance, a.lit_normals, gain(result), a.relative_variance_full_cdf,
                  100.0 * a.share_above_horizon);
    return text;
}

/// Bins of a file whose bins have trees of their own.
std::uint64_t LocalConversion::most_bins() const {
    if (local_.columns > 0) return std::uint64_t{local_.columns} * local_.rows;
    const std::uint64_t n = local_.subdivisions > 0 ? local_.subdivisions : 6;
    return 4 * n * n + 2;
}

/// What of the file cells take, at most.
std::uint64_t LocalConversion::bytes_of_cells() const {
    switch (local_.goal.kind) {
    case builder::Goal::Kind::budget:
        return local_.goal.budget;
    case builder::Goal::Kind::variance:
        return static_cast<std::uint64_t>(std::min(kLocalBytesOfVariance / local_.goal.variance, 0x1p26));
    default:
        return kLocalBytesOfCell * local_.goal.cells;
    }
}

std::uint64_t LocalConversion::memory_of_separate(const TargetMemory& of) const {
    const builder::FitOptions& fit = local_.fit;
    const std::uint64_t knots = std::uint64_t{fit.phi_segments} * fit.theta_segments;
    return of.target + of.texels * kSeparateOfTexel + most_bins() * kSeparateOfKnot * std::min(knots, of.texels);
}

std::uint64_t LocalConversion::memory_of_shared(const TargetMemory& of) const {
    const bool partner = local_.mis.kind != ACDF_PARTNER_NONE;
    const std::uint64_t of_byte = partner ? kLocalPartnerOfByte : kLocalMemoryOfByte;
    return of.target + of.texels * (kLocalMemoryOfTexel + (partner ? kLocalPartnerOfTexel : 0)) +
           std::min(bytes_of_cells() * of_byte, of.texels * kLocalCellsOfTexel);
}

std::uint64_t LocalConversion::memory() const {
    const TargetMemory of = target_memory(source, input_, local_.target);
    if (of.texels == 0) return 0;
    std::uint64_t fit = local_.sharing ? memory_of_shared(of) : memory_of_separate(of);
    if (visibility_) {
        fit += kVisibilityMemory + kVisibilityMemoryOfByte * local_.goal.budget;
        for (const std::string& path : scene_.paths) fit += kMeshMemoryOfByte * input::scene_bytes(path);
    }
    return kLocalMemory + std::max(of.reading, fit);
}

Converted LocalConversion::convert(const Listener& listener) {
    builder::LocalOptions local = read_scene(listener.note);
    const ProbeTarget loaded = load_target(source, input_, local.target, listener.note);
    if (renderer_) scene_.note_axes(*command_, *renderer_, loaded.probe.source_map.layout, listener.note);
    if (for_partner_) listener.note(partner_text(*renderer_, local_.mis));
    local.source = source_of(loaded.probe, input_);
    builder::Local result;
    require_built(source, builder::local(loaded.target, local, result, told(listener.progress)));
    if (!result.accuracy.combined && gain(result) < kWorthwhile) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "a pdf for each normal lowers the variance by a factor of only %.2f; `acdf env` does about "
                      "as well, in a smaller file",
                      gain(result));
        listener.note(text);
    }
    std::string json = json_text(report(loaded, result)), summary = summary_of(result);
    return {std::move(result.bytes), result.accuracy.relative_variance, std::move(json), std::move(summary)};
}

void LocalConversion::add_bins(CLI::App& command) {
    builder::LocalOptions& local = local_;
    command
        .add_option(
            "--normals", normals_,
            "Bins of normals: N divides each edge of an octahedron, 4 N^2 + 2 bins that are interpolated; AxB is "
            "a lat-long grid (phi x theta) whose nearest bin serves, as in the paper, with --no-sharing")
        ->option_text("N|AxB [as suits the size]")
        ->group("Normals");
    scene_.add(command,
               "Only the normals of a scene: a mesh (.obj, .ply, .instances), a normal pass (.exr) or a list of "
               "normals (.txt, x y z [weight] a line). Bins that do not occur are not stored: a normal outside is "
               "served by the whole environment, unbiased but noisier",
               "Normals");
    scene_.add_axes(command, "Normals");
    command
        .add_flag(
            "--visibility", visibility_,
            "Store what the scene (a mesh) hides from each of its positions, in visibility cells: hidden light is "
            "not sampled. Positions are in the mesh's own coordinates; more than half of the budget, by default "
            "4 MiB, is for the cells. With --mis cosine they are for renderers with MIS, and valid alone, too")
        ->group("Normals");
    command
        .add_flag(
            "--volume", volume_,
            "With --visibility: also in the air, in the box around the scene, and for all normals. For what has no "
            "surface there, such as smoke, hair or things that move")
        ->group("Normals");
    portals_.add(command, "Normals");
    command
        .add_option(
            "--cosine-share", local.cosine_share,
            "This share of samples follows the cosine around the normal instead, with pdf cos/pi; sample and pdf "
            "apply the mixture. For scenes in which the brightest light is often hidden; 0.2 is a good value")
        ->check(number_range(0.0, 0.99))
        ->option_text("X [0]")
        ->group("Normals");
}

void LocalConversion::add_size(CLI::App& command) {
    builder::LocalOptions& local = local_;
    add_goal(command, local.goal.cells, budget_, local.goal.variance,
             {"Cells of what bins share, about", "N", "SIZE [1MiB]", ", in the mean over normals", 16});
    add_max_weight(command, local.max_weight, ". It is measured over the normals whose variance is printed");
    command
        .add_option(
            "--tiles", local.tiles,
            "Tiles whose probability each bin stores: more of them and the cosine is followed more closely, at the "
            "price of cells within them")
        ->check(CLI::Range(1u, builder::max_tiles))
        ->option_text("N [as suits the size]")
        ->group("Size and accuracy");
}

void LocalConversion::add_separate(CLI::App& command) {
    builder::FitOptions& fit = local_.fit;
    const char* group = "Trees of their own";
    command
        .add_flag("--no-sharing", no_sharing_,
                  "A tree of its own for each bin, as in the paper, to compare with: larger and noisier. --fit cdf "
                  "is then "
                  "the default, beside pdf and uniform")
        ->group(group);
    add_fit(command, fit.fit, "How knots are chosen: as in acdf env")->group(group);
    command.add_option("--knots", knots_, "Segments of a curve over phi and over theta: as in acdf env")
        ->option_text("AxB [64x64]")
        ->group(group);
    command.add_option("--eps", fit.epsilon, "Deviation at which a curve has knots enough: as in acdf env")
        ->check(number_range(0.0, 1.0))
        ->option_text("E")
        ->group(group);
    constexpr Named<builder::Order> orders[] = {{"phi", builder::Order::phi}, {"z", builder::Order::z}};
    add_choice(
        command, "--order", [&fit](builder::Order order) { fit.order = order; }, orders,
        "Which axis is split first")
        ->option_text("phi|z [z]")
        ->group(group);
    constexpr Named<builder::BinTarget> targets[] = {{"mean", builder::BinTarget::mean},
                                                     {"centre", builder::BinTarget::centre}};
    add_choice(command, "--bin-target", local_.bin_target, targets,
               "What a bin's tree is fitted to: mean (right for all of its normals) or centre (the paper's: biased "
               "for the others)")
        ->option_text("NAME [mean]")
        ->group(group);
}

void LocalConversion::add_options(CLI::App& command) {
    command_ = &command;
    add_projection(command, input_.projection);
    add_faces(command, input_.faces);
    add_domain(command, input_.domain);
    add_renderer(command, renderer_);
    add_repairs(command, input_);
    add_bins(command);
    add_size(command);
    add_partner(command, local_.mis, ACDF_KIND_LOCAL);
    add_separate(command);
    add_target_options(command, local_.target);
    add_codec(command, local_.codec);
}

} // namespace

std::unique_ptr<Conversion> local_conversion() { return std::make_unique<LocalConversion>(); }

void add_local(CLI::App& program, int& exit_code) {
    CLI::App& command = *program.add_subcommand(
        "local", "Compress an environment map for every normal: clipped at its horizon, times the cosine");
    add_conversion(
        command, local_conversion(),
        {"PROBE", ".local.acdf",
         "The environment map: any image OpenImageIO reads, or the six faces of a cube (--faces). Several become a "
         "file each",
         help_footer("Prints the exact relative variance of irradiance estimates, mean over 256 random normals (or "
                     "those of the scene), beside that of the probe's full-resolution CDF.",
                     "acdf local probe.exr\n"
                     "acdf local probe.exr -o small.acdf --budget 128KiB\n"
                     "acdf local probe.exr -o car.acdf --scene car.obj --scene-up y --cosine-share 0.2\n"
                     "acdf local probe.exr -o room.acdf --scene walls.obj --scene things.ply --visibility\n"
                     "acdf local probe.exr -o paper.acdf --no-sharing --normals 25x10 --fit cdf --knots 64x64")},
        exit_code);
}

} // namespace acdf::tools
