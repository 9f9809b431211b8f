// Radiance pictures, as most programs write them.
#pragma once

#include "images/module.h"

namespace acdf::images {

/// Of regular files. Takes pictures in RGBE or XYZE, from any corner on, in rows or in columns ("Orientation" says
/// which). Each row may be encoded by components, by whole pixels as before 1991, or not at all. Exposure and gamma
/// are ignored, as renderers ignore them; XYZE and PRIMARIES are given as chromaticities. Opening any other file
/// returns null, and reading fails where rows are damaged: OpenImageIO says what that is. After G. Ward, "Real
/// Pixels", Graphics Gems II, 1991, II.5, and the file format of Radiance.
const ImageReader& radiance_reader();

} // namespace acdf::images
