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
#include "tools/plot/hemisphere.h"
#include "tools/plot/image.h"
#include "tools/plot/knots.h"
#include "tools/plot/legend.h"
#include "tools/plot/local.h"
#include "tools/plot/panels.h"

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

enum class PlotProjection { automatic, latlong, angular, hemisphere };

struct PlotArguments {
    std::string file, output, range, view;
    std::vector<float> normal;
    input::ProbeOptions input;
    PlotProjection projection = PlotProjection::automatic;
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
    bool panels = false;                // of a local environment file for several normals
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

bool is_exr(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".exr" && extension != ".png" && path != "-")
        throw CLI::ValidationError("--output", "needs a name that ends in .png (picture) or .exr (numbers)");
    return extension == ".exr";
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
    source.panels = options.normal.empty() && !is_exr(options.output);
    const Normal chosen = source.panels ? panel_normals[0].normal : chosen_normal(options.file, options.normal);
    source.local.emplace(PlottedNormal{file.local(), chosen});
    source.density = density_of(*source.local);
    source.columns = file.axis(ACDF_AXIS_PHI).resolution;
    source.rows = file.axis(ACDF_AXIS_THETA).resolution;
    const Normal& n = source.local->normal;
    char normal[64];
    std::snprintf(normal, sizeof normal, "normal %.3g, %.3g, %.3g", double{n[0]}, double{n[1]}, double{n[2]});
    source.title = {shown_name(options.file)};
    if (!source.panels) source.title.emplace_back(normal);
    source.title.push_back(to_readable_size(file.size()));
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

PlotMap picture_map(const PlotArguments& options, const Plotted& source) {
    const bool automatic = options.projection == PlotProjection::automatic;
    if (options.projection == PlotProjection::hemisphere || (automatic && source.brdf))
        return hemisphere_map(options.width > 0 ? options.width : 640);
    const build::Layout layout =
        options.projection == PlotProjection::angular ? build::Layout::angular : build::Layout::latlong;
    if (options.width > 0) return plot_map(layout, options.width);
    // A pixel a grid step where that is neither tiny nor huge.
    const bool latlong = layout == build::Layout::latlong;
    const int steps = static_cast<int>(std::min<std::uint32_t>(latlong ? source.columns : source.rows, 1u << 20));
    if (source.panels) return plot_map(layout, latlong ? 512 : 384);
    return plot_map(layout, latlong ? std::clamp(steps, 512, 2048) : std::clamp(steps, 512, 1024));
}

DensityRange chosen_range(const PlotArguments& options, const std::vector<DensityImage>& images) {
    if (!options.range.empty()) return *parse_range(options.range);
    DensityRange range = automatic_range(images.front());
    for (const DensityImage& image : images) { // one for all of them
        const DensityRange other = automatic_range(image);
        range = {std::min(range.low, other.low), std::max(range.high, other.high)};
    }
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

images::Picture coloured(const Drawing& drawing, const DensityRange& range) {
    images::Picture picture = false_colour(drawing.image, range);
    if (!drawing.knots.empty()) draw_knots(picture, drawing.knots);
    if (!drawing.horizon.empty()) draw_horizon(picture, drawing.horizon);
    return picture;
}

/// One drawing, or one for each of panel_normals.
std::vector<Drawing> draw_all(const PlotArguments& options, const Plotted& source) {
    const bool with_knots = options.knots && !source.stored.file.empty();
    std::vector<Drawing> out;
    if (!source.panels) {
        out.push_back(draw(options, source, with_knots));
        return out;
    }
    for (const NamedNormal& named : panel_normals) {
        Plotted panel;
        panel.local.emplace(PlottedNormal{source.local->local, named.normal});
        panel.density = density_of(*panel.local);
        panel.columns = source.columns;
        panel.rows = source.rows;
        panel.panels = true;
        out.push_back(draw(options, panel, with_knots));
    }
    return out;
}

std::vector<std::uint8_t> make_png(const PlotArguments& options, const Plotted& source) {
    const std::vector<Drawing> drawings = draw_all(options, source);
    const std::string font = options.legend ? checked_font(options) : "";
    std::vector<DensityImage> densities;
    for (const Drawing& drawing : drawings) densities.push_back(drawing.image);
    const DensityRange range = chosen_range(options, densities);
    images::Picture picture;
    if (source.panels) {
        std::vector<Panel> panels;
        for (std::size_t i = 0; i < drawings.size(); ++i)
            panels.push_back({panel_normals[i].name, coloured(drawings[i], range)});
        picture = arranged(panels, 3, font);
    } else {
        picture = coloured(drawings.front(), range);
    }
    if (options.legend) {
        if (source.brdf && densities.front().map.hemisphere) {
            float wo[3];
            source.brdf->direction(wo);
            picture = label_hemisphere(picture, wo, font);
        }
        const bool zero = std::any_of(densities.begin(), densities.end(), [](const DensityImage& image) {
            return std::find(image.density.begin(), image.density.end(), 0.0f) != image.density.end();
        });
        picture = add_legend(picture, {source.title, range, zero}, font);
    }
    return encode_png(picture, {"acdf " ACDF_VERSION, "Density of " + joined(source.title) + "; colours span " +
                                                          to_string(range) + " sr^-1, logarithmic"});
}

std::vector<std::uint8_t> make_exr(const PlotArguments& options, const Plotted& source) {
    return encode_exr(draw(options, source, false).image,
                      {"acdf " ACDF_VERSION, "Density of " + joined(source.title) + ", sr^-1"});
}

void run(const PlotArguments& options) {
    const bool exr = is_exr(options.output);
    if (!options.range.empty() && !parse_range(options.range))
        throw CLI::ValidationError("--range", "needs two densities such as 1e-3:100, 0 < MIN < MAX");
    Output output(options.output, options.force, {options.file}); // refuses early, before the work

    Plotted source;
    if (is_stored(options.file)) load_stored(options, source);
    else load_image(options, source);
    if (options.projection == PlotProjection::hemisphere && !source.brdf)
        throw CLI::ValidationError("--projection", "hemisphere is for BRDF files");
    const std::vector<std::uint8_t> bytes = exr ? make_exr(options, source) : make_png(options, source);
    output.write(bytes.data(), bytes.size());
    output.commit();
}

void add_picture_options(CLI::App& command, PlotArguments& options) {
    const std::map<std::string, PlotProjection> layouts{{"latlong", PlotProjection::latlong},
                                                        {"angular", PlotProjection::angular},
                                                        {"hemisphere", PlotProjection::hemisphere}};
    command
        .add_option(
            "--projection", options.projection,
            "How the picture lays out directions: latlong (a 2:1 map: all cells at a glance), angular (the "
            "unit disc of Debevec's light probes and of Lawrence et al. 2005, Fig. 5: less distorted around "
            "the middle, which is +x as in the lat-long map; sides as in a probe of that projection) or, for "
            "BRDFs, hemisphere (seen from the normal, x to the right; a cross marks the mirror direction)")
        ->transform(one_of(layouts))
        ->option_text("NAME [latlong; BRDFs: hemisphere]")
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
    add_normal(command, options->normal, "Input",
               "; the white line is its horizon. Without it the six axes are shown");
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
                    "acdf plot local.acdf -o six.png\n"
                    "acdf plot local.acdf -o up.png --normal 0,0,1 --range 1e-3:100\n"
                    "acdf plot nickel.acdf -o lobe.png --view 60\n"
                    "acdf plot sky.acdf -o sky.exr --width 4096"));
    command.callback([options, &exit_code] {
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
