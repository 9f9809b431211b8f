// acdf plot: a pdf in false colours, as in Lawrence et al. 2005, Fig. 5 and 9.
#include "tools/cli/choice.h"
#include "tools/cli/comma_list.h"
#include "tools/cli/help.h"
#include "tools/cli/messages.h"
#include "tools/cli/normal_option.h"
#include "tools/cli/options.h"
#include "tools/cli/output.h"
#include "tools/cli/output_names.h"
#include "tools/cli/probe_options.h"
#include "tools/cli/progress.h"
#include "tools/cli/scene_option.h"
#include "tools/commands.h"
#include "tools/plot/brdf.h"
#include "tools/plot/cells.h"
#include "tools/plot/colour.h"
#include "tools/plot/hemisphere.h"
#include "tools/plot/image.h"
#include "tools/plot/knots.h"
#include "tools/plot/legend.h"
#include "tools/plot/local.h"
#include "tools/plot/panels.h"
#include "tools/plot/source.h"
#include "visibility/visible_view.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <tuple>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

constexpr int smallest_width = 16, largest_width = 8192;

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

PdfRange chosen_range(const PlotArguments& options, const std::vector<PdfImage>& images) {
    if (!options.range.empty()) return *parse_range(options.range);
    PdfRange range = automatic_range(images.front());
    for (const PdfImage& image : images) { // one for all of them
        const PdfRange other = automatic_range(image);
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
    PdfImage image;
    std::vector<float> knots;   // opacity; empty where none are shown
    std::vector<float> horizon; // the same
};

Drawing draw(const PlotArguments& options, const Plotted& source, bool with_knots) {
    ProgressBar bar(options.quiet);
    const double share = with_knots ? 0.2 : 1.0; // of the work: tracing takes about four times as long
    const auto part = [report = bar.callback()](double begin, double width) {
        return [=](double done, const char* what) { report(begin + width * done, what); };
    };
    Drawing drawing;
    drawing.image = pdf_image(picture_map(options, source), source.pdf, part(0.0, share));
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

images::Picture coloured(const Drawing& drawing, const PdfRange& range) {
    images::Picture picture = false_colour(drawing.image, range);
    if (!drawing.knots.empty()) draw_knots(picture, drawing.knots);
    if (!drawing.horizon.empty()) draw_horizon(picture, drawing.horizon);
    return picture;
}

/// One picture, or one for each of panel_normals.
std::vector<Drawing> draw_all(const PlotArguments& options, const Plotted& source) {
    const bool with_knots = options.knots && !source.stored.file.empty() && !source.indexed;
    std::vector<Drawing> out;
    if (!source.panels) {
        out.push_back(draw(options, source, with_knots));
        return out;
    }
    for (const NamedNormal& named : panel_normals) {
        Plotted panel;
        panel.local.emplace(PlottedNormal{source.local->local, named.normal, source.local->position});
        panel.pdf = pdf_of(*panel.local);
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
    std::vector<PdfImage> pdfs;
    for (const Drawing& drawing : drawings) pdfs.push_back(drawing.image);
    const PdfRange range = chosen_range(options, pdfs);
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
        if (source.brdf && pdfs.front().map.hemisphere) {
            float wo[3];
            source.brdf->direction(wo);
            picture = label_hemisphere(picture, wo, font);
        }
        const bool zero = std::any_of(pdfs.begin(), pdfs.end(), [](const PdfImage& image) {
            return std::find(image.pdf.begin(), image.pdf.end(), 0.0f) != image.pdf.end();
        });
        picture = add_legend(picture, {source.title, range, zero}, font);
    }
    return encode_png(picture, {"acdf " ACDF_VERSION, "Pdf of " + joined(source.title) + "; colours span " +
                                                          to_string(range) + " sr^-1, logarithmic"});
}

std::vector<std::uint8_t> make_exr(const PlotArguments& options, const Plotted& source) {
    return encode_exr(draw(options, source, false).image,
                      {"acdf " ACDF_VERSION, "Pdf of " + joined(source.title) + ", sr^-1"});
}

/// The options that only a picture of cells has, and those that it has not.
void check_mesh(const CLI::App& command, const PlotArguments& options) {
    const auto given = [&](const char* option) { return command.get_option(option)->count() > 0; };
    if (options.mesh.empty())
        for (const char* option : {"--scene-up", "--from", "--to"})
            if (given(option)) throw CLI::ValidationError(option, "is of the mesh given by --scene");
    if (!options.mesh.empty())
        for (const char* option : {"--position", "--normal", "--view", "--projection", "--range", "--no-knots",
                                   "--no-legend", "--probe-projection"})
            if (given(option)) throw CLI::ValidationError(option, "is for a pdf, not for cells over a mesh");
}

std::vector<std::uint8_t> make_cells(const PlotArguments& options) {
    const LoadedFile stored = load_file(options.file);
    if (stored.file.kind() != ACDF_KIND_LOCAL || !visible_view(stored.file).has_cells())
        throw Failure(options.file + ": stores no visibility cells; leave out --scene");
    CellsOptions cells;
    cells.mesh = options.mesh;
    cells.up = options.up;
    if (!options.from.empty()) cells.from = {options.from[0], options.from[1], options.from[2]};
    if (!options.to.empty()) cells.to = {options.to[0], options.to[1], options.to[2]};
    if (options.width > 0) cells.width = options.width;
    cells.height = cells.width * 3 / 4;
    return encode_png(cells_picture(visible_view(stored.file), cells),
                      {"acdf " ACDF_VERSION, "Visibility cells, a colour each"});
}

void run(const PlotArguments& options) {
    const bool exr = is_exr(options.output);
    if (!options.mesh.empty()) {
        if (exr) throw CLI::ValidationError("--scene", "shows cells, not a pdf: give a .png to write to");
        Output output(options.output, options.force, {options.file, options.mesh});
        const std::vector<std::uint8_t> bytes = make_cells(options);
        output.write(bytes.data(), bytes.size());
        return output.commit();
    }
    if (!options.range.empty() && !parse_range(options.range))
        throw CLI::ValidationError("--range", "needs two pdfs such as 1e-3:100, 0 < MIN < MAX");
    Output output(options.output, options.force, {options.file}); // refuses early, before the work

    const Plotted source = load_plotted(options);
    if (options.projection == PlotProjection::hemisphere && !source.brdf)
        throw CLI::ValidationError("--projection", "hemisphere is for BRDF files");
    const std::vector<std::uint8_t> bytes = exr ? make_exr(options, source) : make_png(options, source);
    output.write(bytes.data(), bytes.size());
    output.commit();
}

void add_picture_options(CLI::App& command, PlotArguments& options) {
    constexpr Named<PlotProjection> layouts[] = {{"latlong", PlotProjection::latlong},
                                                 {"angular", PlotProjection::angular},
                                                 {"hemisphere", PlotProjection::hemisphere}};
    add_choice(command, "--projection", options.projection, layouts,
               "How the picture lays out directions: latlong (a 2:1 map: all cells at a glance), angular (the "
               "unit disc of Debevec's light probes and of Lawrence et al. 2005, Fig. 5: less distorted around "
               "the middle, which is +x as in the lat-long map; sides as in a probe of that projection) or, for "
               "BRDFs, hemisphere (seen from the normal, x to the right; a cross marks the mirror direction)")
        ->option_text("NAME [latlong; BRDFs: hemisphere]")
        ->group("Picture");
    command
        .add_option("--width", options.width,
                    "Width of the pdf's map in pixels, without the legend. By default a pixel for each grid step, "
                    "within 512 and 2048 (angular: 1024)")
        ->check(CLI::Range(smallest_width, largest_width).description(""))
        ->option_text("N")
        ->group("Picture");
    command
        .add_option("--range", options.range,
                    "The pdfs of the first and the last colour in sr^-1, such as 1e-3:100. Give it where pictures "
                    "are to be compared; by default it fits this picture, leaving out outliers")
        ->option_text("MIN:MAX")
        ->group("Picture");
    command
        .add_flag_callback(
            "--no-knots", [&options] { options.knots = false; },
            "Leave out the borders of cells (shown by default; they fade where cells are too small to see)")
        ->group("Picture");
    command
        .add_flag_callback(
            "--no-legend", [&options] { options.legend = false; },
            "Leave out title and colour bar (shown by default): exactly the pixels of the pdf, for a figure")
        ->group("Picture");
}

void add_mesh_options(CLI::App& command, PlotArguments& options) {
    command
        .add_option("--scene", options.mesh,
                    "The mesh (.obj, .ply, .instances) of a file that stores visibility cells: the picture shows "
                    "these cells over the mesh, instead of a pdf")
        ->type_name("FILE")
        ->group("Cells over a mesh");
    add_scene_up(command, options.up, "Which axis of the scene points up, as in acdf local")
        ->group("Cells over a mesh");
    for (const auto& [name, target, help] :
         {std::tuple{"--from", &options.from, "Where the camera is, in the coordinates of the mesh"},
          std::tuple{"--to", &options.to, "Where it looks at"}})
        comma_separated(command.add_option(name, *target, help), 3)
            ->option_text("X,Y,Z [all of the mesh is seen]")
            ->group("Cells over a mesh");
}

} // namespace

void add_plot(CLI::App& program, int& exit_code) {
    auto options = std::make_shared<PlotArguments>();
    CLI::App& command = *program.add_subcommand("plot", "Show a pdf in false colours, and the cells that store it");
    command
        .add_option("FILE", options->file,
                    "An .acdf file of an environment, local or not, or of a BRDF (- is stdin), or a probe, whose "
                    "own pdf is then shown at full resolution")
        ->required()
        ->type_name("")
        ->group("Input");
    add_projection(command, options->input.projection, "--probe-projection");
    add_faces(command, options->input.faces);
    command
        .add_option(
            "--view", options->view,
            "For a BRDF file, the direction of view in degrees: theta from the normal, phi from the tangent")
        ->option_text("THETA[,PHI] [45]")
        ->group("Input");
    add_normal(command, options->normal, "Input",
               "; the white line is its horizon. Without it the six axes are shown");
    comma_separated(command.add_option("--at", options->at,
                                       "Of several maps in one file: where among them, at a map or between"))
        ->option_text("NAME=V,...")
        ->group("Input");
    comma_separated(
        command.add_option("--position", options->position,
                           "For a file that stores visibility cells (acdf local --visibility), the position in its "
                           "scene; without it the picture shows the pdf without occlusion"),
        3)
        ->option_text("X,Y,Z")
        ->group("Input");
    add_mesh_options(command, *options);
    add_picture_options(command, *options);
    add_output(command, options->output, options->force,
               "The picture to write: .png, or .exr for the pdfs themselves as floats, for other programs; without "
               "it NAME.png beside the input");
    add_quiet(command, options->quiet);
    command.footer(help_footer(
        "Colours follow the logarithm of the pdf per steradian, from violet over green to red; dark grey is a pdf "
        "of 0, where no sample ever falls. Each pixel shows the pdf of the direction at its centre.",
        "acdf plot sky.acdf\n"
        "acdf plot sky.exr -o full.png --projection angular --range 1e-3:100\n"
        "acdf plot local.acdf -o six.png\n"
        "acdf plot local.acdf -o up.png --normal 0,0,1 --range 1e-3:100\n"
        "acdf plot room.acdf -o floor.png --position 0.5,1,0 --normal 0,0,1\n"
        "acdf plot room.acdf -o cells.png --scene room.obj --from 4,-6,3 --to 0,0,1\n"
        "acdf plot nickel.acdf -o lobe.png --view 60\n"
        "acdf plot day.acdf -o morning.png --at time=9.5\n"
        "acdf plot sky.acdf -o pdf.exr --width 4096"));
    command.callback([options, &command, &exit_code] {
        if (options->output.empty()) options->output = output_names({options->file}, "", ".png")[0];
        check_mesh(command, *options);
        run(*options);
        exit_code = exit_done;
    });
}

} // namespace acdf::tools
