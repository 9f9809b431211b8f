// Cubes whose faces are six images, or lie in a strip: put together to a layout that acdf has.
#pragma once

#include "build/probe/projection.h"
#include "input/probe/image.h"

#include <array>
#include <string>
#include <vector>

namespace acdf::input {

/// Which face of a cube each of six images is, and in whose frame.
struct Faces {
    /// +X -X +Y -Y +Z -Z of Direct3D (left-handed, y up: pictures are right as seen from inside), of OpenGL (the
    /// same texels in a right-handed frame: pictures are mirrored), and of OpenEXR (texel centres on the borders).
    enum class Frame { directx, opengl, openexr };
    Frame frame = Frame::directx;
    std::array<int, 6> order{0, 1, 2, 3, 4, 5}; ///< the number of each image's face among +X -X +Y -Y +Z -Z
    std::string name;                           ///< as on a command line
};

/// "directx", "opengl", "openexr", or six of "+x,-x,+y,-y,+z,-z" in any order, in Direct3D's frame; faces have
/// other names, too, such as px, posx and right. False where it is none.
bool parse_faces(const std::string& text, Faces& faces);

/// Six squares of as many pixels as one map. Throws Error, naming `paths` (six, or one for all), where they are
/// not.
Image assemble(const std::vector<std::string>& paths, std::vector<Image> images, const Faces& faces,
               build::Layout& layout);

/// The six squares that an image consists of, row by row: in a column, a row, or two or three rows. Throws Error,
/// naming `path`, where it has no such shape.
std::vector<Image> cut_strip(const std::string& path, const Image& strip);

/// Turns the face at the foot of a vertical cross upside down.
void hang_back_face(Image& cross);

} // namespace acdf::input
