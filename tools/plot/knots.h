// The borders of cells, shown over a plot.
#pragma once

#include "build/probe/projection.h"
#include "images/picture.h"
#include "tools/cli/progress.h"
#include "tools/plot/pdf_image.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::tools {

/// How opaque the line is at each pixel of `map`, in [0, 1]: lines one pixel wide along the borders of the cells.
/// Where cells are narrower than about three pixels lines would hide what they delimit, and fade out. Borders that
/// pass between pixels belong to the pixel on their right or below.
std::vector<float> knot_opacity(const EnvironmentView& view, const PlotMap& map,
                                const build::Progress& progress = {});

/// Finds the cell of a unit direction: its positions on the axes of a grid. Called from several
/// threads.
using FindCell = std::function<void(const float direction[3], AcdfRange range[2])>;
std::vector<float> knot_opacity(const FindCell& find, const AcdfGrid& grid, const PlotMap& map,
                                const build::Progress& progress = {});

/// Blends the lines into `picture` (RGB floats as displayed, as large as `map`): black over light colours, white
/// over dark ones.
void draw_knots(images::Picture& picture, const std::vector<float>& opacity);

} // namespace acdf::tools
