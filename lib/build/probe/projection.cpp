#include "build/probe/projection.h"

#include "build/probe/cube.h"
#include "compress/trigonometry.h"

#include <acdf/octahedral.h>

#include <algorithm>
#include <cmath>

namespace acdf::build {
namespace {

constexpr double below_one = 1.0 - 0x1p-53;

// u and v stay below 1, so that floor(u * width) is always a column.
double unit_interval(double t) { return std::clamp(t, 0.0, below_one); }

ImagePoint point(double u, double v, int chart = 0) { return {unit_interval(u), unit_interval(v), chart}; }

// ---- lat-long: u = 1/2 - phi / 2 pi, v = theta / pi --------------------------------------------------

ImagePoint latlong_point(const Direction& d) {
    return point(0.5 - 0.5 * compress::half_turns(d.y, d.x), compress::half_turns(compress::norm(d.x, d.y), d.z));
}

Direction latlong_direction(double u, double v) {
    const compress::SineCosine phi = compress::sine_cosine(1.0 - 2.0 * u), theta = compress::sine_cosine(v);
    return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
}

// ---- discs: a to the right and b up, in [-1, 1], r = |(a, b)| ----------------------------------------

// The whole rim shows -x; any of its points will do.
const ImagePoint rim{0.0, 0.5, 0};

// Angular map: the angle from +x is pi r. Made from photographs of a mirror ball, it is mirrored like them: the
// right shows +y. Debevec's (Dx, Dy, Dz), at (a, b) = acos(Dz) / (pi |(Dx, Dy)|) (Dx, Dy), is our (y, z, x).
ImagePoint angular_point(const Direction& d) {
    const double s = compress::norm(d.y, d.z);
    if (s == 0.0 && d.x < 0.0) return rim;
    const double scale = s > 0.0 ? compress::half_turns(s, d.x) / s : 0.0;
    return point(0.5 + 0.5 * scale * d.y, 0.5 - 0.5 * scale * d.z);
}

Direction angular_direction(double a, double b) {
    const double r = compress::norm(a, b);
    const compress::SineCosine angle = compress::sine_cosine(r);
    const double scale = r > 0.0 ? angle.sine / r : compress::pi;
    return {angle.cosine, scale * a, scale * b};
}

// Mirror ball: the normal is (sqrt(1 - r^2), a, b), the camera looks from +x, and what it sees is +x mirrored
// at the normal. A mirror swaps sides: the right shows +y.
ImagePoint mirrorball_point(const Direction& d) {
    const double s2 = d.y * d.y + d.z * d.z;
    const double one_plus_x = d.x > 0.0 ? 1.0 + d.x : s2 / (1.0 - d.x); // no cancellation near -x
    if (one_plus_x == 0.0) return rim;
    const double scale = 1.0 / std::sqrt(2.0 * one_plus_x);
    return point(0.5 + 0.5 * scale * d.y, 0.5 - 0.5 * scale * d.z);
}

Direction mirrorball_direction(double a, double b) {
    const double r2 = a * a + b * b, n = std::sqrt(std::max(0.0, 1.0 - r2));
    return {1.0 - 2.0 * r2, 2.0 * n * a, 2.0 * n * b};
}

// Solid angle per area of the (a, b) plane: that of the angular map is pi sin(pi r) / r; the mirror ball
// preserves areas.
double solid_angle_per_area(Layout layout, double a, double b) {
    if (layout == Layout::mirrorball) return 4.0;
    const double r = compress::norm(a, b);
    return r > 0.0 ? compress::pi * compress::sine_cosine(r).sine / r : compress::pi * compress::pi;
}

// Integral of the pdf over [b0, b1] at a, by Gauss-Legendre with four nodes.
double disc_slice(Layout layout, double a, double b0, double b1) {
    constexpr double node[2] = {0.33998104358485626, 0.86113631159405258};
    constexpr double weight[2] = {0.65214515486254614, 0.34785484513745386};
    const double middle = 0.5 * (b0 + b1), half = 0.5 * (b1 - b0);
    double sum = 0.0;
    for (int i = 0; i < 2; ++i)
        sum += weight[i] * (solid_angle_per_area(layout, a, middle + half * node[i]) +
                            solid_angle_per_area(layout, a, middle - half * node[i]));
    return half * sum;
}

double disc_solid_angle(const Map& map, int column, int row) {
    const double da = 2.0 / map.width, db = 2.0 / map.height;
    const double a0 = da * column - 1.0, b1 = 1.0 - db * row, b0 = b1 - db;
    const double far =
        compress::norm(std::max(std::abs(a0), std::abs(a0 + da)), std::max(std::abs(b0), std::abs(b1)));
    // Texels cut by the rim need many slices, for the chord's kink; the others are smooth.
    const int slices = far <= 1.0 ? (map.width < 64 ? 16 : 4) : 64;
    double sum = 0.0;
    for (int i = 0; i < slices; ++i) {
        const double a = a0 + da * (i + 0.5) / slices;
        const double chord = std::sqrt(std::max(0.0, 1.0 - a * a));
        const double low = std::max(b0, -chord), high = std::min(b1, chord);
        if (low < high) sum += disc_slice(map.layout, a, low, high) * da / slices;
    }
    return sum;
}

// ---- octahedral: the square of Clarberg 2008 in pbrt's frame, which is ours with x reversed ----------

ImagePoint octahedral_point(const Direction& d) {
    const double direction[3] = {d.x, d.y, d.z};
    double u, v;
    acdf_octahedral_point(direction, &u, &v);
    const int chart = (d.x > 0.0 ? 1 : 0) + (d.y < 0.0 ? 2 : 0) + (d.z < 0.0 ? 4 : 0);
    return point(u, v, chart);
}

Direction octahedral_direction(double u, double v) {
    double d[3];
    acdf_octahedral_direction(u, v, d);
    return {d[0], d[1], d[2]};
}

} // namespace

ImagePoint to_image(const Map& map, const Direction& d) {
    switch (map.layout) {
    case Layout::latlong:
        return latlong_point(d);
    case Layout::angular:
        return angular_point(d);
    case Layout::mirrorball:
        return mirrorball_point(d);
    case Layout::octahedral:
        return octahedral_point(d);
    default:
        return cube_point(map, d);
    }
}

bool to_direction(const Map& map, double u, double v, Direction& d) {
    const double a = 2.0 * u - 1.0, b = 1.0 - 2.0 * v;
    switch (map.layout) {
    case Layout::latlong:
        d = latlong_direction(u, v);
        return true;
    case Layout::octahedral:
        d = octahedral_direction(u, v);
        return true;
    case Layout::angular:
    case Layout::mirrorball:
        if (!(a * a + b * b <= 1.0)) return false;
        d = map.layout == Layout::angular ? angular_direction(a, b) : mirrorball_direction(a, b);
        return true;
    default:
        return cube_direction(map, u, v, d);
    }
}

double texel_solid_angle(const Map& map, int column, int row) {
    switch (map.layout) {
    case Layout::latlong: {
        // cos(t0) - cos(t1), written without cancellation.
        const double middle = (row + 0.5) / map.height, half = 0.5 / map.height;
        return 2.0 * compress::sine_cosine(middle).sine * compress::sine_cosine(half).sine *
               (2.0 * compress::pi / map.width);
    }
    case Layout::octahedral:
        return 4.0 * compress::pi / map.width / map.height;
    case Layout::angular:
    case Layout::mirrorball:
        return disc_solid_angle(map, column, row);
    default:
        return cube_solid_angle(map, column, row);
    }
}

bool has_shape(const Map& map) {
    const auto ratio = [&](int across, int down) {
        return map.width % across == 0 && map.width / across * down == map.height;
    };
    switch (map.layout) {
    case Layout::latlong:
        return true;
    case Layout::vertical_cross:
        return ratio(3, 4);
    case Layout::horizontal_cross:
        return ratio(4, 3);
    case Layout::stacked_cube:
        return ratio(1, 6);
    default:
        return ratio(1, 1);
    }
}

namespace {

/// Texels of the typical size of `map` around the equator: the angular map's are largest (radially) with 2 pi /
/// width, a cube has four faces around; the other two preserve area, and a texel is sqrt(4 pi / texels) wide.
double texels_around(const Map& map) {
    switch (map.layout) {
    case Layout::latlong:
    case Layout::angular:
        return map.width;
    case Layout::mirrorball:
        return 0.5 * compress::pi * map.width;
    case Layout::octahedral:
        return std::sqrt(compress::pi) * map.width;
    default:
        return 4.0 * cube_face_size(map);
    }
}

} // namespace

int latlong_width(const Map& map) {
    if (map.layout == Layout::latlong) return map.width;
    const double around = texels_around(map);
    int width = 4;
    while (width < around) width *= 2;
    return width;
}

int octahedral_side(const Map& map) {
    if (map.layout == Layout::octahedral) return map.width;
    // As many around, but not a square of thousands for a map of a few rows.
    const double texels = std::min(texels_around(map) / std::sqrt(compress::pi),
                                   4.0 * std::sqrt(double(map.width) * double(map.height)));
    int side = 4;
    while (side < texels) side *= 2;
    return side;
}

} // namespace acdf::build
