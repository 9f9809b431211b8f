// The cube layouts of projection.h. `map.layout` must be one of the three.
#pragma once

#include "build/projection.h"

namespace acdf::build {

ImagePoint cube_point(const Map& map, const Direction& d);
bool cube_direction(const Map& map, double u, double v, Direction& d);
double cube_solid_angle(const Map& map, int column, int row);

/// Whether texel (column, row) belongs to one of the six faces.
bool on_cube_face(const Map& map, int column, int row);

} // namespace acdf::build
