// Layouts that are known by their seams: where the borders of an image touch on the sphere, it goes on across them.
#pragma once

#include "build/probe/projection.h"
#include "input/probe/brightness.h"

namespace acdf::input {

/// Whether a square goes on across its borders as an octahedral map does, which folds each at its middle. A picture
/// that is only symmetric matches there, too, but comes back on the way that it went: it proves nothing.
bool goes_on_across_folds(const Brightness& image);

/// Whether the face at the foot of a vertical cross stands upright: it matches its neighbours so, and not upside
/// down, as it should hang there.
bool back_face_is_upright(const Brightness& image);

/// Whether the first and the last column of an image differ more than any others that touch, and as much as distant
/// ones: those of a lat-long map touch. `image` may have some of the rows alone.
bool sides_do_not_meet(const Brightness& image);

} // namespace acdf::input
