// The kinds of files that normals are read from: each adds its normals to a histogram, or throws Error.
#pragma once

#include "input/normals/histogram.h"

#include <string>

namespace acdf::input {

/// A mesh or a list of instances (mesh/file.h).
void add_mesh_normals(const std::string& path, NormalHistogram& histogram);

/// An image with a normal in each pixel; `rgb`: take R, G, B where no channel is named as a normal.
void add_pixel_normals(const std::string& path, bool rgb, NormalHistogram& histogram);

/// Lines of text: x y z [weight].
void add_listed_normals(const std::string& path, NormalHistogram& histogram);

} // namespace acdf::input
