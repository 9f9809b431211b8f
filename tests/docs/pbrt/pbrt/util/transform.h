// Stands in for pbrt's header: a rotation about z by 90 degrees and a translation, so that a space that is mixed up
// shows.
#pragma once

#include <pbrt/util/vecmath.h>

namespace pbrt {

struct Transform {
    Vector3f offset;
    Vector3f operator()(Vector3f v) const { return {-v.y, v.x, v.z}; }
    Vector3f ApplyInverse(Vector3f v) const { return {v.y, -v.x, v.z}; }
    Normal3f ApplyInverse(Normal3f n) const { return {n.y, -n.x, n.z}; }
    Point3f ApplyInverse(Point3f p) const { return {p.y - offset.y, offset.x - p.x, p.z - offset.z}; }
};

} // namespace pbrt
