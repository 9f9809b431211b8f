// What `acdf plot` shows: a stored pdf, or that of a probe, and the words of its title.
#pragma once

#include "input/normals/scene.h"
#include "tools/cli/file_input.h"
#include "tools/cli/probe_options.h"
#include "tools/plot/brdf.h"
#include "tools/plot/local.h"
#include "tools/plot/pdf_image.h"

#include <acdf/builder.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

enum class PlotProjection { automatic, latlong, angular, hemisphere };

struct PlotArguments {
    std::string file, output, range, view;
    std::vector<float> normal, position;
    std::string mesh;            // the cells over it are shown, not a pdf
    std::vector<std::string> at; // where among several maps
    input::UpAxis up = input::UpAxis::z;
    std::vector<double> from, to; // the camera
    input::ProbeOptions input;
    PlotProjection projection = PlotProjection::automatic;
    int width = 0; // 0: by the resolution
    bool knots = true, legend = true, quiet = false, force = false;
};

/// What is plotted, and what its title says.
struct Plotted {
    LoadedFile stored;      // of an .acdf file, else empty
    builder::Target target; // of a probe, else empty
    PdfFunction pdf;
    std::uint32_t columns = 0, rows = 0;
    std::optional<PlottedView> brdf;    // of a BRDF file
    std::optional<PlottedNormal> local; // of a local environment file
    bool indexed = false;               // of several maps: without borders of cells
    bool panels = false;                // of a local environment file for several normals
    std::vector<std::string> title;
};

/// Whether the picture is one of numbers. Throws CLI::ValidationError where the name shows neither.
bool is_exr(const std::string& path);

/// Reads what `options` name. Throws Failure, and CLI::ValidationError where an option is for another kind of file.
Plotted load_plotted(const PlotArguments& options);

} // namespace acdf::tools
