// Environment maps written slowly and independently of the library: each projection as its publication defines
// it, in its own frame, and a sky to render into them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace acdf::test {

constexpr double pi = 3.14159265358979323846;

struct Vec {
    double x = 0.0, y = 0.0, z = 0.0;
};

inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec normalized(Vec a) { return (1.0 / length(a)) * a; }

// Rotation by `angle` about unit `axis` (Rodrigues).
inline Vec rotated(Vec v, Vec axis, double angle) {
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1.0 - std::cos(angle)) * dot(axis, v) * axis;
}

// Debevec's frame has x right, y up and -z ahead; ours has +x ahead, y left and z up.
inline Vec from_debevec(Vec d) { return {-d.z, -d.x, d.y}; }

// The direction a layout shows at (u, v), u right and v down in [0, 1]; false where it shows nothing.
using Reference = std::function<bool(double u, double v, Vec& d)>;

inline bool latlong_reference(double u, double v, Vec& d) {
    const double phi = pi - 2.0 * pi * u, theta = pi * v;
    d = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    return true;
}

// Light Probe Image Gallery, to the letter: (0, 0, -1), turned by phi = pi r about y (up), then by atan2(b, a)
// about -z (ahead), both counterclockwise about their axis.
inline bool angular_reference(double u, double v, Vec& d) {
    const double a = 2.0 * u - 1.0, b = 1.0 - 2.0 * v, r = std::sqrt(a * a + b * b);
    if (r > 1.0) return false;
    const Vec tilted = rotated({0, 0, -1}, {0, 1, 0}, pi * r);
    d = from_debevec(rotated(tilted, {0, 0, -1}, std::atan2(b, a)));
    return true;
}

// The same page's inverse, with +z in the centre: (a, b) = r (Dx, Dy), r = acos(Dz) / (pi sqrt(Dx^2 + Dy^2)). In a
// right-handed frame with y up, +x is then on the left of who looks at +z.
inline void angular_reference_point(Vec d, double& u, double& v) {
    const Vec debevec{d.y, d.z, d.x};
    const double r = std::acos(debevec.z) / (pi * std::hypot(debevec.x, debevec.y));
    u = 0.5 + 0.5 * r * debevec.x;
    v = 0.5 - 0.5 * r * debevec.y;
}

// A photographer at +x looks along -x at a mirror ball; up is z, so the picture's right is +y.
inline bool mirrorball_reference(double u, double v, Vec& d) {
    const double a = 2.0 * u - 1.0, b = 1.0 - 2.0 * v;
    if (a * a + b * b > 1.0) return false;
    const Vec view{-1, 0, 0}, up{0, 0, 1}, right = cross(view, up);
    const Vec normal = a * right + b * up - std::sqrt(1.0 - a * a - b * b) * view;
    d = view - 2.0 * dot(view, normal) * normal;
    return true;
}

// A face by the corners of the cube [-1, 1]^3 at its upper left, upper right and lower left, in Debevec's frame.
struct CubeFace {
    int column, row;
    Vec upper_left, upper_right, lower_left;
};

inline Reference cube_reference(int columns, int rows, std::vector<CubeFace> faces) {
    return [=](double u, double v, Vec& d) {
        for (const CubeFace& f : faces) {
            const double s = u * columns - f.column, t = v * rows - f.row;
            if (s < 0.0 || s >= 1.0 || t < 0.0 || t >= 1.0) continue;
            d = from_debevec(
                normalized(f.upper_left + s * (f.upper_right - f.upper_left) + t * (f.lower_left - f.upper_left)));
            return true;
        }
        return false;
    };
}

// The front face is z = -1. Cutting the cube open leaves neighbouring faces joined along an edge.
inline std::vector<CubeFace> cross_faces() {
    return {{1, 1, {-1, 1, -1}, {1, 1, -1}, {-1, -1, -1}},   // front
            {0, 1, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}},    // left
            {2, 1, {1, 1, -1}, {1, 1, 1}, {1, -1, -1}},      // right
            {1, 0, {-1, 1, 1}, {1, 1, 1}, {-1, 1, -1}},      // up
            {1, 2, {-1, -1, -1}, {1, -1, -1}, {-1, -1, 1}}}; // down
}

inline Reference vertical_cross_reference() {
    std::vector<CubeFace> faces = cross_faces();
    faces.push_back({1, 3, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}}); // back, its foot joined to down
    return cube_reference(3, 4, faces);
}

inline Reference horizontal_cross_reference() {
    std::vector<CubeFace> faces = cross_faces();
    faces.push_back({3, 1, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}}); // back, joined to right
    return cube_reference(4, 3, faces);
}

// Clarberg 2008: the diamond |a| + |b| <= 1 is the upper hemisphere, as the concentric map of Shirley and Chiu
// 1997 on the square turned by 45 degrees, lifted by z = 1 - r^2; the rest is mirrored at the diamond's edges.
// In pbrt's frame, which is ours with x reversed.
inline bool octahedral_reference(double u, double v, Vec& d) {
    double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
    const bool lower = std::abs(a) + std::abs(b) > 1.0;
    if (lower) {
        const double mirrored = std::copysign(1.0 - std::abs(b), a);
        b = std::copysign(1.0 - std::abs(a), b);
        a = mirrored;
    }
    const double p = a + b, q = b - a; // turned by 45 degrees: a square [-1, 1]^2
    double r = 0.0, angle = 0.0;
    if (p != 0.0 || q != 0.0) {
        const bool wide = std::abs(p) > std::abs(q);
        r = wide ? p : q;
        angle = wide ? pi / 4.0 * q / p : pi / 2.0 - pi / 4.0 * p / q;
    }
    const double sine = r * std::sqrt(2.0 - r * r);
    const double x = sine * std::cos(angle + pi / 4.0), y = sine * std::sin(angle + pi / 4.0);
    d = {-x, y, lower ? r * r - 1.0 : 1.0 - r * r};
    return true;
}

// A smooth sky without any symmetry, different in each channel.
inline std::array<double, 3> sky(Vec d) {
    const double warm = std::exp(2.5 * (dot(d, normalized({0.5, 0.7, 0.6})) - 1.0));
    const double cold = std::exp(4.0 * (dot(d, normalized({-0.8, 0.3, -0.4})) - 1.0));
    return {0.2 + 3.0 * warm, 0.3 + 0.1 * d.z + 2.0 * cold, 0.25 + 0.1 * d.x - 0.05 * d.y + warm + 0.5 * cold};
}

struct Pixels {
    int width = 0, height = 0;
    std::vector<float> rgb;
    float* at(int x, int y) {
        return rgb.data() +
               3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
    const float* at(int x, int y) const { return const_cast<Pixels*>(this)->at(x, y); }
};

// The sky seen through a layout: the mean over 4 x 4 points of a texel, those that show something; else black.
inline Pixels render_sky(const Reference& reference, int width, int height) {
    Pixels pixels{width, height,
                  std::vector<float>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0f)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::array<double, 3> sum{};
            int points = 0;
            for (int i = 0; i < 16; ++i) {
                Vec d;
                if (!reference((x + (i % 4 + 0.5) / 4) / width, (y + (i / 4 + 0.5) / 4) / height, d)) continue;
                for (std::size_t c = 0; c < 3; ++c) sum[c] += sky(d)[c];
                ++points;
            }
            for (std::size_t c = 0; c < 3 && points; ++c) pixels.at(x, y)[c] = static_cast<float>(sum[c] / points);
        }
    return pixels;
}

// Solid angle of a texel by summing |d(direction)/du x d(direction)/dv| over n x n points.
inline double solid_angle_by_differences(const Reference& reference, int width, int height, int x, int y, int n) {
    const double h = 1e-6;
    double sum = 0.0;
    for (int i = 0; i < n * n; ++i) {
        const double u = (x + (i % n + 0.5) / n) / width, v = (y + (i / n + 0.5) / n) / height;
        Vec left, right, above, below;
        if (!reference(u - h, v, left) || !reference(u + h, v, right)) continue;
        if (!reference(u, v - h, above) || !reference(u, v + h, below)) continue;
        sum += length(cross(right - left, below - above)) / (4.0 * h * h);
    }
    return sum / (n * n) / width / height;
}

// Integral of channel c over the sphere.
inline double latlong_integral(int width, int height, const std::vector<float>& rgb, int c) {
    double sum = 0.0;
    for (int y = 0; y < height; ++y) {
        double row = 0.0;
        for (int x = 0; x < width; ++x)
            row += static_cast<double>(rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                static_cast<std::size_t>(x)) +
                                           static_cast<std::size_t>(c)]);
        sum += row * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height)) * 2.0 * pi / width;
    }
    return sum;
}

// Where the light of a channel comes from, on average.
inline Vec mean_direction(int width, const std::vector<float>& rgb, int channel) {
    const int height = width / 2;
    Vec mean;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float v = rgb[3 * static_cast<std::size_t>(y * width + x) + static_cast<std::size_t>(channel)];
            if (v == 0.0f) continue;
            Vec d;
            latlong_reference((x + 0.5) / width, (y + 0.5) / height, d);
            mean = mean + static_cast<double>(v) * std::sin(pi * (y + 0.5) / height) * d;
        }
    return normalized(mean);
}

} // namespace acdf::test
