// Stands in for pbrt's header: the few types that docs/examples/pbrt/acdf_light.h uses, with their names and calls.
#pragma once

namespace pbrt {

using Float = float;

struct Tuple3 {
    float x = 0, y = 0, z = 0;
    bool operator!=(const Tuple3& other) const { return x != other.x || y != other.y || z != other.z; }
};

struct Vector3f : Tuple3 {
    Vector3f() = default;
    Vector3f(float x, float y, float z) : Tuple3{x, y, z} {}
    Vector3f operator-() const { return {-x, -y, -z}; }
    Vector3f operator*(float s) const { return {x * s, y * s, z * s}; }
};

struct Normal3f : Tuple3 {
    Normal3f() = default;
    Normal3f(float x, float y, float z) : Tuple3{x, y, z} {}
};

struct Point3f : Tuple3 {
    Point3f() = default;
    Point3f(float x, float y, float z) : Tuple3{x, y, z} {}
    Point3f operator+(Vector3f v) const { return {x + v.x, y + v.y, z + v.z}; }
};

struct Point2f {
    float x = 0, y = 0;
    float operator[](int i) const { return i == 0 ? x : y; }
};

inline Normal3f FaceForward(Normal3f n, Vector3f v) {
    return n.x * v.x + n.y * v.y + n.z * v.z < 0 ? Normal3f(-n.x, -n.y, -n.z) : n;
}

} // namespace pbrt
