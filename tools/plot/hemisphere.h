// The axes of a picture of the hemisphere above a surface, as BRDFs are shown.
#pragma once

#include "images/picture.h"
#include "tools/plot/pdf_image.h"

#include <string>

namespace acdf::tools {

/// A picture of hemisphere_map() with a margin around it: rings at 30 and 60 degrees from the normal, and the names
/// of the axes. `font` as find_font gives it; without one there is no text. A cross marks where a mirror would
/// reflect `view` to, a ring the view itself.
images::Picture label_hemisphere(const images::Picture& disc, const float view[3], const std::string& font);

} // namespace acdf::tools
