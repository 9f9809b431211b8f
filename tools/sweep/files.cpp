#include "tools/sweep/files.h"

#include "build/own_terms.h"
#include "tools/cli/built.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::tools {
namespace {

constexpr std::uint64_t kKi = 1024, kMi = 1024 * kKi;

/// The paper's bins of normals (Lawrence et al. 2005, §7.1).
constexpr std::uint32_t kPaperColumns = 25, kPaperRows = 10;

AcdfFit fit_of(const std::string& name) {
    return name == "env-cdf" || name == "local-cdf" ? ACDF_FIT_CDF
           : name == "env-pdf"                      ? ACDF_FIT_PDF
           : name == "env-uniform"                  ? ACDF_FIT_UNIFORM
                                                    : ACDF_FIT_VARIANCE;
}

/// The size of a file: of other fits as knots that take about as many bytes. In the words of the command line.
std::string set_size(const Step& step, builder::FitOptions& fit, builder::Goal& goal, std::uint32_t most_phi,
                     std::uint32_t most_theta, double bins) {
    fit.fit = fit_of(step.file);
    if (fit.fit == ACDF_FIT_VARIANCE) {
        goal = builder::Goal::of_budget(step.budget);
        return "--budget " + budget_text(step.budget);
    }
    const auto side = static_cast<std::uint32_t>(std::max(2.0, std::sqrt(cells_in(step.budget) / bins)));
    fit.phi_segments = std::min(side, most_phi);
    fit.theta_segments = std::min(side, most_theta);
    return knots_text(fit.phi_segments, fit.theta_segments);
}

Candidate make_environment(const Step& step, const builder::Target& target, const builder::Source& source,
                           const builder::Partner& partner) {
    builder::EnvironmentOptions options;
    options.source = source;
    options.mis = partner;
    const std::string size = set_size(step, options.fit, options.goal, target.columns(), target.rows(), 1.0);
    builder::Environment made;
    throw_unless_built(builder::environment(target, options, made));
    const builder::EnvironmentAccuracy& accuracy = made.accuracy;
    Candidate out = file_candidate(std::move(made.bytes));
    out.row.options = size;
    out.row.cells = accuracy.cells;
    if (accuracy.combined) return out;
    out.row.relative_variance = accuracy.support_violations > 0 ? HUGE_VAL : accuracy.relative_variance;
    out.row.max_weight = accuracy.max_weight;
    out.row.rms = accuracy.rms_pdf_error;
    return out;
}

Candidate make_local(const Step& step, const builder::Target& target, const builder::Source& source,
                     const SweptMesh* mesh, const builder::Partner& partner) {
    builder::LocalOptions options;
    options.source = source;
    options.mis = partner;
    options.sharing = step.file != "local-cdf";
    double bins = 1.0;
    if (step.file == "local-cdf") {
        options.columns = kPaperColumns, options.rows = kPaperRows;
        options.fit.order = builder::Order::z;
        bins = kPaperColumns * kPaperRows;
    }
    if (step.file == "visibility") {
        options.visibility = mesh->visibility;
        options.normals = mesh->normals;
        options.normals_text = mesh->text;
    }
    const std::string size = set_size(step, options.fit, options.goal, ACDF_MAX_SEGMENTS, ACDF_MAX_SEGMENTS, bins);
    builder::Local made;
    throw_unless_built(builder::local(target, options, made));
    const builder::LocalAccuracy& accuracy = made.accuracy;
    Candidate out = file_candidate(std::move(made.bytes));
    out.row.options = size;
    if (accuracy.combined || step.file == "visibility") return out;
    out.row.relative_variance = accuracy.support_violations > 0 ? HUGE_VAL : accuracy.relative_variance;
    out.row.worst = accuracy.support_violations > 0 ? HUGE_VAL : accuracy.worst;
    out.row.median = accuracy.median;
    out.row.max_weight = accuracy.max_weight;
    return out;
}

} // namespace

const std::vector<FileKind>& file_kinds() {
    static const std::vector<std::uint64_t> small{16 * kKi, 64 * kKi, 256 * kKi}, medium{64 * kKi, 256 * kKi, kMi},
        large{kMi, 4 * kMi};
    static const std::vector<FileKind> kinds{
        {"env", "env", "", Given::nothing, false, small},
        {"env-mis", "env", "--mis mean", Given::nothing, true, small},
        {"local", "local", "", Given::normal, false, medium},
        {"local-mis", "local", "--mis cosine", Given::normal, true, medium},
        {"visibility", "local", "--visibility", Given::position, false, large},
        {"local-cdf", "local", "--no-sharing --normals 25x10 --fit cdf", Given::normal, false, medium},
        {"env-cdf", "env", "--fit cdf", Given::nothing, false, small},
        {"env-pdf", "env", "--fit pdf", Given::nothing, false, small},
        {"env-uniform", "env", "--fit uniform", Given::nothing, false, small}};
    return kinds;
}

const FileKind& file_kind(const std::string& name) {
    for (const FileKind& kind : file_kinds())
        if (name == kind.name) return kind;
    throw std::logic_error("no kind of file is called " + name);
}

std::vector<std::string> default_files(bool mesh) {
    std::vector<std::string> out{"env", "env-mis", "local", "local-mis"};
    if (mesh) out.push_back("visibility");
    return out;
}

Candidate make_file(const Step& step, const builder::Target& target, const builder::Source& source,
                    const SweptMesh* mesh, AcdfHeuristic heuristic) {
    const FileKind& kind = file_kind(step.file);
    const bool local = kind.needs != Given::nothing;
    builder::Partner partner;
    if (kind.needs_mis) {
        partner.kind = local ? ACDF_PARTNER_COSINE : ACDF_PARTNER_MEAN;
        partner.heuristic = heuristic;
    }
    Candidate out =
        local ? make_local(step, target, source, mesh, partner) : make_environment(step, target, source, partner);
    std::string options = kind.options;
    if (kind.needs == Given::position) options = mesh->options + " " + options;
    if (kind.needs_mis && heuristic == ACDF_HEURISTIC_POWER) options += " --heuristic power";
    out.row.label = std::string("acdf ") + kind.command + (*kind.options ? " " : "") + kind.options;
    out.row.command = kind.command;
    out.row.options = options + (options.empty() ? "" : " ") + out.row.options;
    out.row.needs = kind.needs;
    out.row.needs_mis = kind.needs_mis;
    return out;
}

} // namespace acdf::tools
