// Title and colour bar around a plot.
#pragma once

#include "tools/plot/colour.h"
#include "tools/plot/range.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// A rectangle in pixels; y grows downwards.
struct Box {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Where everything lies in a plot with legend, by the size of the picture alone.
struct LegendLayout {
    int width = 0, height = 0; ///< of the whole
    int font_size = 0;
    Box picture, bar;
    Box zero;            ///< swatch of pdf 0, below the bar
    int tick_length = 0; ///< to the right of the bar

    /// The row of a pdf's tick.
    int row_of(double pdf, const PdfRange& range) const;
};

LegendLayout legend_layout(int picture_width, int picture_height);

struct Legend {
    std::vector<std::string> title; ///< parts by importance; those that do not fit are left out
    PdfRange range;
    bool shows_zero = false; ///< explain the colour of pdf 0
    bool per_steradian = true;
    ColourMap colours = ColourMap::rainbow;
};

/// The path of a font for the text; empty where the system has none.
std::string find_font();

/// `picture` (RGB floats as displayed) with a title and a colour bar: a tick at each power of ten, small ticks
/// between. `font` as find_font gives it; without one there is no text.
images::Picture add_legend(const images::Picture& picture, const Legend& legend, const std::string& font);

} // namespace acdf::tools
