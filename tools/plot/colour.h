// False colours for pdfs.
#pragma once

#include "images/picture.h"
#include "tools/plot/pdf_image.h"
#include "tools/plot/range.h"

#include <array>

namespace acdf::tools {

/// sRGB, in [0, 1] as it is displayed.
using Colour = std::array<float, 3>;

/// Pdf 0: no sample ever falls there. A neutral grey that the colour map does not contain.
constexpr Colour zero_colour = {0.25f, 0.25f, 0.25f};
/// Outside of the disc, and around the picture.
constexpr Colour background = {1.0f, 1.0f, 1.0f};

enum class ColourMap {
    rainbow,  ///< violet (low) over green to red (high)
    diverging ///< blue over a light grey, in the middle of the range, to red: for ratios
};

/// RGB floats as displayed: the logarithm of the pdf from range.low to range.high, zero_colour where it is 0,
/// background where nothing is shown.
images::Picture false_colour(const PdfImage& image, const PdfRange& range, ColourMap map = ColourMap::rainbow);

/// IEC 61966-2-1, of one channel.
float linear_to_srgb(float linear);

} // namespace acdf::tools
