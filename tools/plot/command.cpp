// acdf plot: a density in false colours, as in Lawrence et al. 2005, Fig. 5 and 9.
#include "build/format_names.h"
#include "tools/cli/choice.h"
#include "tools/cli/file_input.h"
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/progress.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"
#include "tools/plot/brdf.h"
#include "tools/plot/colour.h"
#include "tools/plot/image.h"
#include "tools/plot/knots.h"
#include "tools/plot/legend.h"
#include "tools/plot/local.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

struct PlotArguments {
    std::string file, output, range, view;
    std::vector<float> normal;
    input::ProbeOptions input;
    build::Layout layout = build::Layout::latlong;
    int width = 0; // 0: by the resolution
    bool knots = true, legend = true, quiet = false, force = false;
};

constexpr int smallest_width = 16, largest_width = 8192;

/// What is plotted, and what its title says.
struct Plotted {
    LoadedFile stored;      // of an .acdf file, else empty
    builder::Target target; // of a probe, else empty
    Density density;
    std::uint32_t columns = 0, rows = 0;
    std::optional<PlottedView> brdf;    // of a BRDF file
    std::optional<PlottedNormal> local; // of a local environment file
    std::vector<std::string> title;
};

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
    source.density = density_of(*source.brdf);
    source.columns = 1024;
    source.rows = 512;
    source.title = {shown_name(options.file), "view " + to_string(*view),
                    build::fit_name(file.description().fit) + " fit", to_readable_size(file.size())};
}

/// The accuracy that a file tells of itself, for a title.
void add_variance(const File& file, std::vector<std::string>& title) {
    const Text variance = file.metadata("accuracy.relative_variance");
    const std::string text(variance.data ? variance.data : "", variance.size);
    if (double value = 0.0; std::sscanf(text.c_str(), "%lf", &value) == 1) {
        char rounded[64];
        std::snprintf(rounded, sizeof rounded, "relative variance %.3g", value);
        title.emplace_back(rounded);
    }
}

void load_local(const PlotArguments& options, Plotted& source) {
    const File& file = source.stored.file;
    source.local.emplace(PlottedNormal{file.local(), chosen_normal(options.file, options.normal)});
    source.density = density_of(*source.local);
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    const Normal& n = source.local->normal;
    char normal[64];
    std::snprintf(normal, sizeof normal, "normal %.3g, %.3g, %.3g", double{n[0]}, double{n[1]}, double{n[2]});
    source.title = {shown_name(options.file), normal, to_readable_size(file.size())};
    add_variance(file, source.title);
}

void load_stored(const PlotArguments& options, Plotted& source) {
    source.stored = load_file(options.file);
    if (source.stored.file.kind() == ACDF_KIND_BRDF) return load_brdf(options, source);
    if (!options.view.empty()) throw CLI::ValidationError("--view", "is for BRDF files");
    if (source.stored.file.kind() == ACDF_KIND_LOCAL) return load_local(options, source);
    refuse_normal(options.file, options.normal);
    if (source.stored.file.kind() != ACDF_KIND_ENVIRONMENT)
        fail_kind(options.file, source.stored.file, "plot",
                  "environments and BRDFs, as `acdf env` and `acdf brdf` make them");
    const File& file = source.stored.file;
    source.density = density_of(file.environment());
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    std::unordered_map<std::uint32_t, std::uint64_t> known;
    const std::uint64_t cells = count_cells(file.tree(), file.bin(0).root, known);
    source.title = {shown_name(options.file), build::fit_name(file.description().fit) + " fit",
                    std::to_string(cells) + (cells == 1 ? " cell" : " cells"), to_readable_size(file.size())};
    add_variance(file, source.title);
}

void load_image(const PlotArguments& options, Plotted& source) {
    const input::Probe probe = load_probe(options.file, options.input, options.quiet);
    source.target = probe_target(options.file, probe);
    source.density = density_of(builder::grid_of(source.target));
    source.columns = source.target.columns();
    source.rows = source.target.rows();
    source.title = {shown_name(options.file), "full resolution",
                    std::to_string(source.columns) + " x " + std::to_string(source.rows)};
}

build::Map picture_map(const PlotArguments& options, const Plotted& source) {
    if (options.width > 0) return plot_map(options.layout, options.width);
    // A pixel a grid step where that is neither tiny nor huge.
    const bool latlong = options.layout == build::Layout::latlong;
    const int steps = static_cast<int>(std::min<std::uint32_t>(latlong ? source.columns : source.rows, 1u << 20));
    return plot_map(options.layout, latlong ? std::clamp(steps, 512, 2048) : std::clamp(steps, 512, 1024));
}

DensityRange chosen_range(const PlotArguments& options, const DensityImage& image) {
    if (!options.range.empty()) return *parse_range(options.range);
    const DensityRange range = automatic_range(image);
    if (!options.quiet)
        say(options.output + ": colours span " + to_string(range) +
            " sr^-1; --range sets them, for pictures to compare");
    return range;
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    return text;
}

/// The numbers of a plot, before they become a picture.
struct Drawing {
    DensityImage image;
    std::vector<float> knots;   // opacity; empty where none are drawn
    std::vector<float> horizon; // the same
};

Drawing draw(const PlotArguments& options, const Plotted& source, bool with_knots) {
    ProgressBar bar(options.quiet);
    const double share = with_knots ? 0.2 : 1.0; // of the work: tracing takes about four times as long
    const auto part = [report = bar.callback()](double begin, double width) {
        return [=](double done, const char* what) { report(begin + width * done, what); };
    };
    Drawing drawing;
    drawing.image = draw_density(picture_map(options, source), source.density, part(0.0, share));
    if (source.local) drawing.horizon = horizon_opacity(source.local->normal, drawing.image.map);
    if (with_knots && source.brdf) drawing.knots = knot_opacity(*source.brdf, drawing.image.map);
    else if (with_knots && source.local)
        drawing.knots = knot_opacity(*source.local, drawing.image.map, part(share, 1.0 - share));
    else if (with_knots)
        drawing.knots = knot_opacity(source.stored.file.environment(), drawing.image.map, part(share, 1.0 - share));
    return drawing;
}

std::string checked_font(const PlotArguments& options) {
    const std::string font = find_font();
    if (font.empty() && !options.quiet)
        say(options.output + ": no font was found, so the legend has no text; installing DejaVu Sans "
                             "(fonts-dejavu-core) would help");
    return font;
}

std::vector<std::uint8_t> make_png(const PlotArguments& options, const Plotted& source) {
    const Drawing drawing = draw(options, source, options.knots && !source.stored.file.empty());
    const std::vector<float>& density = drawing.image.density;
    const DensityRange range = chosen_range(options, drawing.image);
    images::Picture picture = false_colour(drawing.image, range);
    if (!drawing.knots.empty()) draw_knots(picture, drawing.knots);
    if (!drawing.horizon.empty()) draw_horizon(picture, drawing.horizon);
    if (options.legend) {
        const bool zero = std::find(density.begin(), density.end(), 0.0f) != density.end();
        picture = add_legend(picture, {source.title, range, zero}, checked_font(options));
    }
    return encode_png(picture, {"acdf " ACDF_VERSION, "Density of " + joined(source.title) + "; colours span " +
                                                          to_string(range) + " sr^-1, logarithmic"});
}

std::vector<std::uint8_t> make_exr(const PlotArguments& options, const Plotted& source) {
    return encode_exr(draw(options, source, false).image,
                      {"acdf " ACDF_VERSION, "Density of " + joined(source.title) + ", sr^-1"});
}

bool is_exr(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".exr" && extension != ".png" && path != "-")
        throw CLI::ValidationError("--output", "needs a name that ends in .png (picture) or .exr (numbers)");
    return extension == ".exr";
}

void run(const PlotArguments& options) {
    const bool exr = is_exr(options.output);
    if (!options.range.empty() && !parse_range(options.range))
        throw CLI::ValidationError("--range", "needs two densities such as 1e-3:100, 0 < MIN < MAX");
    Output output(options.output, options.force, {options.file}); // refuses early, before the work

    Plotted source;
    if (is_stored(options.file)) load_stored(options, source);
    else load_image(options, source);
    const std::vector<std::uint8_t> bytes = exr ? make_exr(options, source) : make_png(options, source);
    output.write(bytes.data(), bytes.size());
    output.commit();
}

void add_picture_options(CLI::App& command, PlotArguments& options) {
    const std::map<std::string, build::Layout> layouts{{"latlong", build::Layout::latlong},
                                                       {"angular", build::Layout::angular}};
    command
        .add_option(
            "--projection", options.layout,
            "How the picture lays out directions: latlong (a 2:1 map: all cells at a glance) or angular (the "
            "unit disc of Debevec's light probes and of Lawrence et al. 2005, Fig. 5: less distorted around "
            "the middle, which is +x as in the lat-long map; sides as in a probe of that projection)")
        ->transform(one_of(layouts))
        ->option_text("NAME [latlong]")
        ->group("Picture");
    command
        .add_option(
            "--width", options.width,
            "Pixels across the density, without the legend. By default a pixel for each grid step, within 512 "
            "and 2048 (angular: 1024)")
        ->check(CLI::Range(smallest_width, largest_width).description(""))
        ->option_text("N")
        ->group("Picture");
    command
        .add_option(
            "--range", options.range,
            "Densities in sr^-1 of the first and the last colour, such as 1e-3:100. Give it where pictures are "
            "to be compared; by default it fits this picture, leaving out outliers")
        ->option_text("MIN:MAX")
        ->group("Picture");
    command
        .add_flag_callback(
            "--no-knots", [&options] { options.knots = false; },
            "Leave out the borders of cells (drawn by default; they fade where cells are too small to see)")
        ->group("Picture");
    command
        .add_flag_callback(
            "--no-legend", [&options] { options.legend = false; },
            "Leave out title and colour bar (drawn by default): exactly the density's pixels, to place in a figure")
        ->group("Picture");
}

} // namespace

void add_plot(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<PlotArguments>();
    CLI::App& command =
        *program.add_subcommand("plot", "Show a density in false colours, and the cells that hold it");
    command
        .add_option(
            "FILE", options->file,
            "An .acdf file of an environment, local or not, or of a BRDF (- is stdin), or a probe, whose own "
            "density is then shown at full resolution")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection, "--probe-projection");
    command
        .add_option(
            "--view", options->view,
            "For a BRDF file, the direction of view in degrees: theta from the normal, phi from the tangent")
        ->option_text("THETA[,PHI] [45]")
        ->group("Input");
    add_normal(command, options->normal, "Input", "; the white line is its horizon");
    add_picture_options(command, *options);
    add_output(command, options->output, options->force,
               "The picture to write: .png, or .exr for the densities themselves as floats, for other programs")
        ->required();
    add_quiet(command, options->quiet);
    command.footer(
        help_footer("Colours follow the logarithm of the density per steradian, from violet over green to red; "
                    "dark grey is density "
                    "0, where no sample ever falls. Each pixel shows the density of the direction at its centre.",
                    "acdf plot sky.acdf -o sky.png\n"
                    "acdf plot sky.exr -o full.png --projection angular --range 1e-3:100\n"
                    "acdf plot local.acdf -o up.png --normal 0,0,1 --range 1e-3:100\n"
                    "acdf plot sky.acdf -o sky.exr --width 4096"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
