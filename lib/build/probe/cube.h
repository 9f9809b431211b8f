// The cube layouts of projection.h. `map.layout` must be one of the three.
#pragma once

#include "build/probe/projection.h"

namespace acdf::build {

ImagePoint cube_point(const Map& map, const Direction& d);
bool cube_direction(const Map& map, double u, double v, Direction& d);
double cube_solid_angle(const Map& map, int column, int row);

/// The direction at (s, t) of the plane of the face in column and row `face` of the layout, whose own part of the
/// plane is where both are in [0, 1].
Direction cube_direction_beside(const Map& map, int face_column, int face_row, double s, double t);

/// Whether texel (column, row) belongs to one of the six faces.
bool on_cube_face(const Map& map, int column, int row);

} // namespace acdf::build
