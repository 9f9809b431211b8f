// Which way is up in a scene.
#pragma once

namespace acdf::input {

/// Which axis of the scene points up. `y` turns (x, y, z) into (z, x, y), as docs/conventions.md maps the frames of
/// programs with y up (OpenEXR, USD, Mitsuba).
enum class UpAxis { z, y };

} // namespace acdf::input
