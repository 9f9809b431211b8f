// What a file was made from, as a small picture.
#pragma once

#include "images/picture.h"
#include "input/probe/probe.h"

#include <string>

namespace acdf::tools {

/// A probe as a lat-long map `width` wide and half as high, as a photograph of it would be exposed: RGB as
/// displayed. A lat-long probe is read in bands of rows. Throws input::Error.
images::Picture probe_picture(const std::string& path, const input::ProbeOptions& options, int width);

/// A BRDF times the cosine for a view at 45 degrees, over the hemisphere, in false colours of a range of their own.
/// Throws input::Error.
images::Picture brdf_picture(const std::string& source, int width);

} // namespace acdf::tools
