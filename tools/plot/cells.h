// The cells of visibility over the mesh that they were made for.
#pragma once

#include "images/picture.h"
#include "input/normals/scene.h"

#include <acdf/reader.h>
#include <acdf/visibility/visibility.h>

#include <array>
#include <optional>
#include <string>

namespace acdf::tools {

struct CellsOptions {
    std::string mesh; ///< a path
    input::UpAxis up = input::UpAxis::z;
    /// The camera, in the coordinates of the mesh; none: from above and outside, all of it in the picture.
    std::optional<std::array<double, 3>> from, to;
    int width = 640, height = 480;
};

/// As displayed: the mesh seen by a camera, each cell with a colour of its own, darker where the surface is seen
/// askance; colours are mixed as the file mixes the cells. Where it stores no visibility cells, the surface is
/// grey. Throws input::Error.
images::Picture cells_picture(const VisibleLocalView& view, const CellsOptions& options);

} // namespace acdf::tools
