// The borders of cells, drawn over a plot.
#pragma once

#include "input/projection.h"
#include "progress.h"

#include <OpenImageIO/imagebuf.h>
#include <acdf/reader.h>

#include <vector>

namespace acdf::tools {

/// How opaque the line is at each pixel of `map`, in [0, 1]: lines one pixel wide along the borders of the cells.
/// Where cells are narrower than about three pixels lines would hide what they delimit, and fade out. Borders that
/// pass between pixels belong to the pixel on their right or below.
std::vector<float> knot_opacity(const EnvironmentView& view, const input::Map& map, const Progress& progress = {});

/// Blends the lines into `picture` (RGB floats as displayed, as large as `map`): black over light colours, white
/// over dark ones.
void draw_knots(OIIO::ImageBuf& picture, const std::vector<float>& opacity);

} // namespace acdf::tools
