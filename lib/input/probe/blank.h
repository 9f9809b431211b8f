// Layouts that are known by what they leave blank.
#pragma once

#include "build/probe/projection.h"
#include "input/probe/brightness.h"

namespace acdf::input {

/// Whether what lies beside the six faces of a cross is black, and the cross is not.
bool is_cross(const Brightness& image, build::Layout layout);

/// Whether a square has a disc that touches its sides, and nothing in its corners: black or another single value.
bool is_disc(const Brightness& image);

/// Whether an image of 2:1 has a disc in either half, and nothing around them.
bool is_pair_of_discs(const Brightness& image);

} // namespace acdf::input
