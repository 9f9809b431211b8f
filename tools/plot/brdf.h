// The pdf of a BRDF file for one view, over the sphere of directions of light.
#pragma once

#include "tools/plot/pdf_image.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// A direction of view, in degrees.
struct ViewAngles {
    double theta = 0.0, phi = 0.0;
};

/// "THETA" or "THETA,PHI"; theta in [0, 90).
std::optional<ViewAngles> parse_view(const std::string& text);
/// As parse_view reads it.
std::string to_string(const ViewAngles& angles);

struct PlottedView {
    BrdfView brdf;
    ViewAngles angles;

    void direction(float wo[3]) const;
};

/// The stored pdf, exactly: below the surface too, where a few samples fall. The view's File must
/// outlive the result.
PdfFunction pdf_of(const PlottedView& view);

/// As of environments: lines along the borders of cells, none where cells are narrower than two pixels.
std::vector<float> knot_opacity(const PlottedView& view, const PlotMap& map);

} // namespace acdf::tools
