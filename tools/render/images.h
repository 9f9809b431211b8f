// What `acdf render` shows: pictures, and figures of each pixel in false colour.
#pragma once

#include "images/picture.h"
#include "measure/scenes/scene_points.h"
#include "tools/plot/colour.h"
#include "tools/plot/range.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// Linear RGB: a value a point, the probe where nothing is seen.
images::Picture scene_picture(const measure::Scene& scene, const measure::ScenePoints& points,
                              const std::vector<measure::Rgb>& values);

/// What luminance is divided by for display: a half more than what 98 % of points stay below.
double exposure(const std::vector<measure::Rgb>& values);

/// As displayed: exposed, clamped, sRGB.
images::Picture displayed(const images::Picture& linear, double exposure);

/// A positive figure a point in false colour with a legend, on a logarithmic scale.
struct FigureImage {
    std::string title;
    PdfRange range;
    ColourMap colours = ColourMap::rainbow;
    bool shows_zero = false;
};
images::Picture figure_picture(const measure::Scene& scene, const measure::ScenePoints& points,
                               const std::vector<double>& values, const FigureImage& figure);

/// Round ends that leave out 1 % of the positive values at each, at most eight decades.
PdfRange figure_range(std::vector<double> values);

} // namespace acdf::tools
