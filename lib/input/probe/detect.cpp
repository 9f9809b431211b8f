#include "input/probe/detect.h"

#include "input/error.h"
#include "input/probe/blank.h"
#include "input/probe/latlong_check.h"
#include "input/probe/seams.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {
namespace {

bool has_ratio(const Image& image, int across, int down) {
    return image.width % across == 0 && image.width / across * down == image.height;
}

bool is_square(const Image& image) { return has_ratio(image, 1, 1); }

[[noreturn]] void refuse(const std::string& path, const Image& image, const std::string& what) {
    throw input_error(path, shape(image) + " " + what);
}

build::Layout cube_layout(const std::string& path, const Image& image) {
    for (const build::Layout layout :
         {build::Layout::vertical_cross, build::Layout::horizontal_cross, build::Layout::stacked_cube})
        if (build::has_shape({layout, image.width, image.height})) return layout;
    refuse(
        path, image,
        "is neither a cube cross (3:4 or 4:3) nor a column of faces (1:6); give the six faces with --faces, or set "
        "another --projection");
}

Detected as_cross(const Image& image, build::Layout layout, const std::string& reason) {
    if (layout == build::Layout::vertical_cross && back_face_is_upright(Brightness(image)))
        return {layout, reason + "; the back face is upright, by its seams", true};
    return {layout, reason};
}

Detected as_asked(const std::string& path, const Image& image, Projection projection) {
    const std::string reason = std::string("--projection ") + to_string(projection);
    if (projection == Projection::latlong) return {build::Layout::latlong, reason};
    if (projection == Projection::cube_cross) return as_cross(image, cube_layout(path, image), reason);
    if (!is_square(image))
        refuse(path, image,
               std::string("is not square, as ") + to_string(projection) +
                   " is; cut off what lies beyond the disc or the square, or set another --projection");
    if (projection == Projection::angular) return {build::Layout::angular, reason};
    if (projection == Projection::mirrorball) return {build::Layout::mirrorball, reason};
    return {build::Layout::octahedral, reason};
}

Detected by_tag(const std::string& path, const Image& image) {
    if (image.tag == EnvironmentTag::latlong)
        return {build::Layout::latlong, "the file says so (OpenEXR envmap attribute or texture format)"};
    if (!has_ratio(image, 1, 6))
        refuse(path, image, "says it is a cube map, but is not 1:6 as OpenEXR's are; set --projection");
    return {build::Layout::stacked_cube, "the file says so (OpenEXR envmap attribute)"};
}

Detected by_square(const std::string& path, const Image& image, bool is_octahedral) {
    const Brightness brightness(image);
    if (is_disc(brightness))
        refuse(path, image,
               "with black corners is an angular map or a mirror ball, and nothing in the image shows "
               "which; set --projection angular (as Debevec's light probes) or --projection mirrorball");
    if (goes_on_across_folds(brightness))
        return {build::Layout::octahedral, "square, and it goes on across its folded borders"};
    if (is_octahedral) return {build::Layout::octahedral, "square, as the renderer reads octahedral maps alone"};
    refuse(
        path, image,
        "is square, but neither a disc with black corners nor a map that goes on across folded borders, as "
        "octahedral ones do (symmetry alone proves nothing); set --projection angular, mirrorball or octahedral");
}

/// What a map of a shape that is nearly a known one may be.
std::string advice_on_shape(const Image& image) {
    if (has_ratio(image, 6, 1) || has_ratio(image, 3, 2) || has_ratio(image, 2, 3))
        return "; if it is six faces of a cube, set --faces, else give a map of the whole sphere";
    const double ratio = static_cast<double>(image.width) / image.height;
    const auto nearly = [&](double known) { return std::abs(ratio / known - 1.0) < 0.05; };
    if (nearly(2.0))
        return "; it is nearly 2:1: if it shows the whole sphere, as a lat-long map that was scaled, set "
               "--projection latlong; if a part was cut off, give the map before that";
    for (const double cross : {3.0 / 4.0, 4.0 / 3.0, 1.0 / 6.0})
        if (nearly(cross))
            return "; it is nearly that of a cube: scale it so that all faces are squares of as many pixels, or "
                   "give "
                   "them as six files (--faces)";
    if (nearly(1.0))
        return "; it is nearly 1:1: if it is a disc or a square with a margin, cut that off, else scale it to a "
               "square, and set --projection";
    return "; give a map of the whole sphere, or set --projection latlong if it is one in unequal steps";
}

Detected by_shape(const std::string& path, const Image& image, bool squares_are_octahedral) {
    if (has_ratio(image, 2, 1)) return {build::Layout::latlong, "2:1 shape"};
    for (const build::Layout layout : {build::Layout::vertical_cross, build::Layout::horizontal_cross}) {
        const bool vertical = layout == build::Layout::vertical_cross;
        if (!has_ratio(image, vertical ? 3 : 4, vertical ? 4 : 3)) continue;
        if (is_cross(Brightness(image), layout))
            return as_cross(image, layout,
                            vertical ? "3:4 shape, black beside the cross" : "4:3 shape, black beside the cross");
        refuse(path, image,
               "has the shape of a cube cross but is not black beside it; "
               "if it is one, set --projection cube-cross");
    }
    if (has_ratio(image, 1, 6))
        refuse(path, image,
               "may be six cube faces, but no envmap attribute says so; set --projection cube-cross "
               "for OpenEXR's, or --faces directx or opengl for those of games (each +X -X +Y -Y +Z -Z)");
    if (is_square(image)) return by_square(path, image, squares_are_octahedral);
    refuse(path, image,
           "has the shape of no known projection (lat-long is 2:1, cubes 3:4 or 4:3, discs and octahedral 1:1)" +
               advice_on_shape(image));
}

} // namespace

Detected detect_layout(const std::string& path, const Image& image, const ProbeOptions& options) {
    if (options.projection != Projection::automatic) return as_asked(path, image, options.projection);
    return image.tag != EnvironmentTag::none ? by_tag(path, image)
                                             : by_shape(path, image, options.squares_are_octahedral);
}

void refuse_latlong(const std::string& path, const Image& image, const LatlongCheck& check) {
    const std::string objection = check.objection();
    if (!objection.empty()) refuse(path, image, objection);
}

bool is_latlong(const Image& image, Projection projection) {
    if (projection != Projection::automatic) return projection == Projection::latlong;
    return image.tag == EnvironmentTag::latlong || is_latlong_by_shape(image, projection);
}

bool is_latlong_by_shape(const Image& image, Projection projection) {
    return projection == Projection::automatic && image.tag == EnvironmentTag::none && has_ratio(image, 2, 1);
}

Projection projection_of(build::Layout layout) {
    switch (layout) {
    case build::Layout::latlong:
        return Projection::latlong;
    case build::Layout::angular:
        return Projection::angular;
    case build::Layout::mirrorball:
        return Projection::mirrorball;
    case build::Layout::octahedral:
        return Projection::octahedral;
    default:
        return Projection::cube_cross;
    }
}

} // namespace acdf::input
