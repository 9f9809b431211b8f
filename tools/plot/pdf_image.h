// Pdfs over the sphere as images: what `acdf plot` turns into colours.
#pragma once

#include "build/probe/projection.h"
#include "compress/target.h"
#include "tools/cli/progress.h"

#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <functional>
#include <vector>

namespace acdf::tools {

/// The pdf in sr^-1 of a unit direction. Called from several threads.
using PdfFunction = std::function<float(const float direction[3])>;

/// The stored pdf, exactly. The view's File must outlive the result.
PdfFunction pdf_of(const EnvironmentView& view);
PdfFunction pdf_of(const MixedEnvironment& view);

/// The pdf proportional to `target` at full resolution (nearest lookup). `target` must outlive the result and
/// have energy.
PdfFunction pdf_of(const compress::Target& target);

/// What pixels outside of the disc of an angular map hold.
constexpr float shows_nothing = -1.0f;

/// How a picture lays out directions: as a probe does, or the hemisphere around +z on a disc.
struct PlotMap : build::Map {
    bool hemisphere = false;

    PlotMap() = default;
    PlotMap(const build::Map& map) : build::Map(map) {}
    PlotMap(build::Layout layout, int width, int height) : build::Map{layout, width, height} {}
};

/// A pdf at the centres of the pixels of `map`.
struct PdfImage {
    PlotMap map;
    std::vector<float> pdf; ///< height x width, sr^-1, or shows_nothing

    float at(int x, int y) const {
        return pdf[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x)];
    }
};

/// A map of that width: lat-long (half as high) or angular (square).
PlotMap plot_map(build::Layout layout, int width);

/// The hemisphere above a surface on a disc, seen from its normal: x to the right, y up, areas as they are
/// (Lambert's azimuthal projection: the distance from the middle is sqrt(1 - cos theta)).
PlotMap hemisphere_map(int width);

/// The direction at image position (x, y) in pixels; pixel centres are at halves. False outside of the disc.
bool pixel_direction(const PlotMap& map, double x, double y, float direction[3]);

/// Solid angle in sr of a pixel; 0 where its centre shows nothing.
double pixel_solid_angle(const PlotMap& map, int x, int y);

PdfImage pdf_image(const PlotMap& map, const PdfFunction& pdf, const build::Progress& progress = {});

} // namespace acdf::tools
