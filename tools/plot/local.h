// The pdf of a local environment for one normal, at a position or anywhere, and its horizon.
#pragma once

#include "images/picture.h"
#include "tools/plot/pdf_image.h"

#include <acdf/reader.h>
#include <acdf/visibility/visibility.h>

#include <array>
#include <optional>
#include <vector>

namespace acdf::tools {

using Normal = std::array<float, 3>;

struct PlottedNormal {
    VisibleLocalView local;
    Normal normal;
    std::optional<std::array<float, 3>> position = {}; ///< a position of the file's scene
};

/// The stored pdf, exactly. The view's File must outlive the result.
PdfFunction pdf_of(const PlottedNormal& plotted);

/// The borders of cells, as of environments.
std::vector<float> knot_opacity(const PlottedNormal& plotted, const PlotMap& map,
                                const build::Progress& progress = {});

/// How opaque the horizon is at each pixel of `map`, in [0, 1]: a line about two pixels wide.
std::vector<float> horizon_opacity(const Normal& normal, const PlotMap& map);

/// Blends it into `picture` (RGB floats as displayed, as large as `map`), white.
void draw_horizon(images::Picture& picture, const std::vector<float>& opacity);

} // namespace acdf::tools
