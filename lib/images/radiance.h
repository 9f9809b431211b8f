// Radiance pictures, as most programs write them.
#pragma once

#include "images/module.h"

namespace acdf::images {

/// Of regular files. Takes pictures of 8 to 32767 columns in run-length encoded RGBE, from the top left corner on,
/// of gamma 1, whose header has no lines that are rare; also in the older encoding of whole pixels, which
/// OpenImageIO does not know. Opening any other file returns null, and reading fails where rows are damaged or
/// encoded otherwise: OpenImageIO tells what that is. After G. Ward, "Real Pixels", Graphics Gems II, 1991, II.5,
/// and the file format of Radiance.
const ImageReader& radiance_reader();

} // namespace acdf::images
