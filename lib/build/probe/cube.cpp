#include "build/probe/cube.h"

#include "compress/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {
namespace {

// A face: its tile in the layout, the direction of its centre, and where the image's right and down point.
// right x down = centre for all: seen from inside, nothing is mirrored.
struct Face {
    int column, row;
    Direction centre, right, down;
};

struct CubeLayout {
    int columns, rows;
    Face faces[6];
};

constexpr Direction px{1, 0, 0}, nx{-1, 0, 0}, py{0, 1, 0}, ny{0, -1, 0}, pz{0, 0, 1}, nz{0, 0, -1};

// Front +x, left +y, right -y; up and down are hinged to the front.
constexpr CubeLayout vertical{3,
                              4,
                              {{1, 1, px, ny, nz},
                               {0, 1, py, px, nz},
                               {2, 1, ny, nx, nz},
                               {1, 0, pz, ny, px},
                               {1, 2, nz, ny, nx},
                               {1, 3, nx, ny, pz}}}; // hinged to the foot of the down face: upside down

constexpr CubeLayout horizontal{4,
                                3,
                                {{1, 1, px, ny, nz},
                                 {0, 1, py, px, nz},
                                 {2, 1, ny, nx, nz},
                                 {1, 0, pz, ny, px},
                                 {1, 2, nz, ny, nx},
                                 {3, 1, nx, py, nz}}};

// ImfEnvmap.h: +X -X +Y -Y +Z -Z from the top, where OpenEXR's (X, Y, Z) is our (y, z, x).
constexpr CubeLayout stacked{1,
                             6,
                             {{0, 0, py, px, nz},
                              {0, 1, ny, nx, nz},
                              {0, 2, pz, py, nx},
                              {0, 3, nz, py, px},
                              {0, 4, px, ny, nz},
                              {0, 5, nx, py, nz}}};

const CubeLayout& layout_of(const Map& map) {
    switch (map.layout) {
    case Layout::vertical_cross:
        return vertical;
    case Layout::horizontal_cross:
        return horizontal;
    default:
        return stacked;
    }
}

double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Positions s in [0, 1] across a face map linearly to tangents t in [-1, 1]: t = (2 s - 1) * stretch. OpenEXR
// puts the centres of the outermost texels on the cube's edges, which stretches n - 1 texels over the face.
double stretch(const Map& map) {
    const int n = cube_face_size(map);
    return map.layout == Layout::stacked_cube && n > 1 ? static_cast<double>(n) / (n - 1) : 1.0;
}

const Face* face_at(const CubeLayout& layout, int column, int row) {
    for (const Face& face : layout.faces)
        if (face.column == column && face.row == row) return &face;
    return nullptr;
}

Direction direction_on(const Face& face, double s, double t) {
    const double scale = 1.0 / std::sqrt(1.0 + s * s + t * t);
    return {scale * (face.centre.x + s * face.right.x + t * face.down.x),
            scale * (face.centre.y + s * face.right.y + t * face.down.y),
            scale * (face.centre.z + s * face.right.z + t * face.down.z)};
}

// Solid angle of [0, s] x [0, t] on the plane at distance 1.
double corner_solid_angle(double s, double t) {
    return compress::pi * compress::half_turns(s * t, std::sqrt(1.0 + s * s + t * t));
}

double rectangle_solid_angle(double s0, double s1, double t0, double t1) {
    return corner_solid_angle(s1, t1) - corner_solid_angle(s0, t1) - corner_solid_angle(s1, t0) +
           corner_solid_angle(s0, t0);
}

} // namespace

int cube_face_size(const Map& map) {
    switch (map.layout) {
    case Layout::vertical_cross:
    case Layout::horizontal_cross:
    case Layout::stacked_cube:
        return map.width / layout_of(map).columns;
    default:
        return 0;
    }
}

bool on_cube_face(const Map& map, int column, int row) {
    const int n = cube_face_size(map);
    return face_at(layout_of(map), column / n, row / n) != nullptr;
}

ImagePoint cube_point(const Map& map, const Direction& d) {
    const CubeLayout& layout = layout_of(map);
    int chart = 0;
    double largest = 0.0;
    for (int i = 0; i < 6; ++i) {
        const double along = dot(layout.faces[i].centre, d);
        if (along > largest) {
            largest = along;
            chart = i;
        }
    }
    const Face& face = layout.faces[chart];
    const double scale = 0.5 / (largest * stretch(map));
    // Short of the border, so that rounding never leads into the tile beside it.
    const double s = std::clamp(0.5 + scale * dot(face.right, d), 0x1p-40, 1.0 - 0x1p-40);
    const double t = std::clamp(0.5 + scale * dot(face.down, d), 0x1p-40, 1.0 - 0x1p-40);
    return {(face.column + s) / layout.columns, (face.row + t) / layout.rows, chart};
}

Direction cube_direction_beside(const Map& map, int face_column, int face_row, double s, double t) {
    return direction_on(*face_at(layout_of(map), face_column, face_row), (2.0 * s - 1.0) * stretch(map),
                        (2.0 * t - 1.0) * stretch(map));
}

bool cube_direction(const Map& map, double u, double v, Direction& d) {
    const CubeLayout& layout = layout_of(map);
    const int column = std::clamp(static_cast<int>(u * layout.columns), 0, layout.columns - 1);
    const int row = std::clamp(static_cast<int>(v * layout.rows), 0, layout.rows - 1);
    const Face* face = face_at(layout, column, row);
    if (!face) return false;
    const double s = (2.0 * (u * layout.columns - column) - 1.0) * stretch(map);
    const double t = (2.0 * (v * layout.rows - row) - 1.0) * stretch(map);
    if (!(std::max(std::abs(s), std::abs(t)) <= 1.0 + 1e-12)) return false;
    d = direction_on(*face, s, t);
    return true;
}

double cube_solid_angle(const Map& map, int column, int row) {
    if (!on_cube_face(map, column, row)) return 0.0;
    const int n = cube_face_size(map);
    const auto edge = [&](int i) { return std::clamp((2.0 * i / n - 1.0) * stretch(map), -1.0, 1.0); };
    return rectangle_solid_angle(edge(column % n), edge(column % n + 1), edge(row % n), edge(row % n + 1));
}

} // namespace acdf::build
