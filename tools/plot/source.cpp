#include "tools/plot/source.h"

#include "build/text/format_names.h"
#include "input/file_name.h"
#include "tools/cli/coordinates.h"
#include "tools/cli/file_input.h"
#include "tools/cli/normal_option.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/plot/panels.h"
#include "visibility/visible_view.h"

#include <CLI/CLI.hpp>
#include <acdf/curves/tree.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <unordered_map>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

/// By the name, or the first bytes where it is named otherwise.
bool is_stored(const std::string& path) {
    if (path == "-" || fs::path(path).extension() == ".acdf") return true;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::vector<std::uint8_t> start(ACDF_MAGIC_SIZE);
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(start.data()), ACDF_MAGIC_SIZE);
    return has_magic(start);
}

std::string shown_name(const std::string& path) {
    return path == "-" ? "stdin" : fs::path(path).filename().string();
}

/// As many as build::for_each_cell visits. Shared curves are counted once and remembered: a small file can hold
/// more cells than anyone can visit.
std::uint64_t count_cells(const std::uint8_t* tree, std::uint32_t at,
                          std::unordered_map<std::uint32_t, std::uint64_t>& known) {
    if (const auto found = known.find(at); found != known.end()) return found->second;
    const AcdfCurve curve = acdf_curve_at(tree, at);
    std::uint64_t cells = 0;
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t link = acdf_curve_link(&curve, i);
        const bool reached = acdf_curve_cumulative(&curve, i + 1) > acdf_curve_cumulative(&curve, i);
        const std::uint64_t more = link != 0 && reached ? count_cells(tree, at + link, known) : 1;
        cells += std::min(more, std::numeric_limits<std::uint64_t>::max() - cells);
    }
    known[at] = cells;
    return cells;
}

void load_brdf(const PlotArguments& options, Plotted& source) {
    const File& file = source.stored.file;
    const auto view = parse_view(options.view.empty() ? "45" : options.view);
    if (!view) throw CLI::ValidationError("--view", "needs angles in degrees such as 60 or 60,30; theta below 90");
    source.brdf.emplace(PlottedView{file.brdf(), *view});
    source.pdf = pdf_of(*source.brdf);
    source.columns = 1024;
    source.rows = 512;
    source.title = {shown_name(options.file), "view " + to_string(*view),
                    build::fit_name(file.description().fit) + " fit", to_readable_size(file.size())};
}

/// The accuracy that is stored in a file, for a title.
void add_variance(const File& file, std::vector<std::string>& title) {
    const Text variance = file.metadata("accuracy.relative_variance");
    const std::string text(variance.data ? variance.data : "", variance.size);
    if (double value = 0.0; std::sscanf(text.c_str(), "%lf", &value) == 1) {
        char rounded[64];
        std::snprintf(rounded, sizeof rounded, "relative variance %.3g", value);
        title.emplace_back(rounded);
    }
}

std::optional<std::array<float, 3>> chosen_position(const PlotArguments& options, const VisibleLocalView& view) {
    const std::vector<float>& x = options.position;
    if (x.empty()) return std::nullopt;
    if (!view.has_cells()) throw Failure(options.file + ": stores no visibility cells; leave out --position");
    const float up[3] = {0.0f, 0.0f, 1.0f};
    if (view.at(x.data(), up).in_cell == 0)
        throw Failure(options.file + ": the position of --position lies outside of its scene; see acdf info");
    return std::array<float, 3>{x[0], x[1], x[2]};
}

void load_local(const PlotArguments& options, Plotted& source) {
    const File& file = source.stored.file;
    source.panels = options.normal.empty() && !is_exr(options.output);
    const Normal chosen = source.panels ? panel_normals[0].normal : chosen_normal(options.file, options.normal);
    const VisibleLocalView view = visible_view(file);
    source.local.emplace(PlottedNormal{view, chosen, chosen_position(options, view)});
    source.pdf = pdf_of(*source.local);
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    const Normal& n = source.local->normal;
    char normal[64];
    std::snprintf(normal, sizeof normal, "normal %.3g, %.3g, %.3g", double{n[0]}, double{n[1]}, double{n[2]});
    source.title = {shown_name(options.file)};
    if (!source.panels) source.title.emplace_back(normal);
    if (const auto& x = source.local->position) {
        char position[96];
        std::snprintf(position, sizeof position, "position %.4g, %.4g, %.4g", double{(*x)[0]}, double{(*x)[1]},
                      double{(*x)[2]});
        source.title.emplace_back(position);
    }
    source.title.push_back(to_readable_size(file.size()));
    add_variance(file, source.title);
}

/// Options that have no say for a kind of file; ACDF_KIND_ENVIRONMENT: or for a probe.
void refuse_options_of_other_kinds(const PlotArguments& options, AcdfKind kind) {
    if (kind != ACDF_KIND_BRDF && !options.view.empty()) throw CLI::ValidationError("--view", "is for BRDF files");
    if (kind != ACDF_KIND_INDEXED && !options.at.empty())
        throw CLI::ValidationError("--at", "is for environments of several maps");
    if (kind == ACDF_KIND_LOCAL) return;
    if (!options.position.empty())
        throw CLI::ValidationError("--position", "is for local environments with visibility cells");
    refuse_normal(options.file, options.normal);
}

void load_indexed(const PlotArguments& options, Plotted& source) {
    const File& file = source.stored.file;
    source.pdf = pdf_of(chosen_environment(options.file, source.stored, options.at));
    source.indexed = true;
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    source.title = {shown_name(options.file)};
    source.title.insert(source.title.end(), options.at.begin(), options.at.end());
    source.title.push_back(to_readable_size(file.size()));
}

void load_stored(const PlotArguments& options, Plotted& source) {
    if (options.input.projection != input::Projection::automatic)
        throw CLI::ValidationError("--probe-projection", "is for probes, not for .acdf files");
    source.stored = load_file(options.file);
    refuse_options_of_other_kinds(options, source.stored.file.kind());
    if (source.stored.file.kind() == ACDF_KIND_BRDF) return load_brdf(options, source);
    if (source.stored.file.kind() == ACDF_KIND_LOCAL) return load_local(options, source);
    if (source.stored.file.kind() == ACDF_KIND_INDEXED) return load_indexed(options, source);
    if (source.stored.file.kind() != ACDF_KIND_ENVIRONMENT)
        fail_kind(options.file, source.stored.file, "plot",
                  "environments and BRDFs, as `acdf env` and `acdf brdf` make them");
    const File& file = source.stored.file;
    source.pdf = pdf_of(file.environment());
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    std::unordered_map<std::uint32_t, std::uint64_t> known;
    const AcdfEnvironment data = file.environment().data();
    const std::uint64_t cells = data.halved ? data.halved->count + 1 : count_cells(data.tree, data.root, known);
    source.title = {shown_name(options.file), build::fit_name(file.description().fit) + " fit",
                    std::to_string(cells) + (cells == 1 ? " cell" : " cells"), to_readable_size(file.size())};
    add_variance(file, source.title);
}

void load_image(const PlotArguments& options, Plotted& source) {
    const input::Probe probe = load_probe(options.file, options.input, options.quiet);
    source.target = probe_texels(options.file, probe);
    source.pdf = pdf_of(builder::grid_of(source.target));
    source.columns = source.target.columns();
    source.rows = source.target.rows();
    source.title = {shown_name(options.file), "full resolution",
                    std::to_string(source.columns) + " x " + std::to_string(source.rows)};
}

} // namespace

bool is_exr(const std::string& path) {
    const std::string extension = input::lower_extension(path);
    if (extension != ".exr" && extension != ".png" && path != "-")
        throw CLI::ValidationError("--output", "needs a name that ends in .png (picture) or .exr (numbers)");
    return extension == ".exr";
}

Plotted load_plotted(const PlotArguments& options) {
    Plotted source;
    if (is_stored(options.file)) {
        load_stored(options, source);
        return source;
    }
    refuse_options_of_other_kinds(options, ACDF_KIND_ENVIRONMENT);
    load_image(options, source);
    return source;
}

} // namespace acdf::tools
