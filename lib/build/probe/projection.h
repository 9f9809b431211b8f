// Where a direction lies in an environment map of each layout, and back: pure functions.
//
// Image coordinates: u to the right and v down; the whole image is [0, 1] x [0, 1] and texel (column, row)
// covers [column, column + 1] / width x [row, row + 1] / height. Directions are unit vectors in the frame of
// docs/conventions.md: right-handed, z up. The middle of a layout shows +x, that of the octahedral map +z.
#pragma once

#include <acdf/builder.h>

#include <cstddef>

namespace acdf::build {

/// How an image is laid out.
using Layout = builder::Projection;

/// An image of `width` x `height` texels and its layout.
struct Map {
    Layout layout = Layout::latlong;
    int width = 0, height = 0;
    /// Beyond the rows of a lat-long map, and the sides of a disc, lookups go on at the opposite border.
    bool repeats = false;
};

struct Direction {
    double x = 0.0, y = 0.0, z = 0.0;
};

/// A point of an image. Within one `chart` (cube face, octant) neighbouring directions are neighbours in the
/// image, but for the rim of the two discs, which is a single direction.
struct ImagePoint {
    double u = 0.0, v = 0.0;
    int chart = 0;
};

/// The image point that shows unit direction `d`: u and v in [0, 1).
ImagePoint to_image(const Map& map, const Direction& d);

/// The unit direction shown at (u, v) in [0, 1]. False, and `d` unset, where the layout shows nothing: corners
/// of the discs, unused parts of crosses, doubled borders of OpenEXR's cube.
bool to_direction(const Map& map, double u, double v, Direction& d);

/// Solid angle in sr of what texel (column, row) shows; 0 where it shows nothing. Over the image it sums to
/// 4 pi. Exact but for texels cut by the rim of a disc (relative error below 1e-3 there).
double texel_solid_angle(const Map& map, int column, int row);

/// Width and height of a lat-long image of which no texel on the equator is larger than the typical texel of
/// `map`: the next power of two, and half of it.
int latlong_width(const Map& map);

/// Whether `map` has the shape that its layout needs: 3:4, 4:3, 1:6 or square; lat-long maps have any.
bool has_shape(const Map& map);
/// Side of an octahedral image of which no texel is larger than the typical texel of `map`: the next power of two.
int octahedral_side(const Map& map);

/// Faces of a cube layout in texels; 0 for other layouts.
int cube_face_size(const Map& map);

} // namespace acdf::build
