#include "build/probe/source_lookup.h"

#include "build/probe/cube.h"
#include "compress/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

namespace acdf::build {
namespace {

TexelPosition repeated(const Map& map, int column, int row) {
    return {(column + map.width) % map.width, (row + map.height) % map.height};
}

TexelPosition beside_on_latlong(const Map& map, int column, int row) {
    return {(column + map.width) % map.width, std::clamp(row, 0, map.height - 1)};
}

TexelPosition beside_on_square(const Map& map, int column, int row) {
    if (column < 0 || column >= map.width) {
        column = column < 0 ? -1 - column : 2 * map.width - 1 - column;
        row = map.height - 1 - row;
    }
    if (row < 0 || row >= map.height) {
        row = row < 0 ? -1 - row : 2 * map.height - 1 - row;
        column = map.width - 1 - column;
    }
    return {column, row};
}

/// Bilinear interpolation between four centres of texels, of which the first lies at (x, y).
struct Patch {
    double v[4];
    double x, y;

    double at(double column, double row) const { // in half texels
        const double s = 0.5 * column - x, t = 0.5 * row - y;
        return (1.0 - t) * ((1.0 - s) * v[0] + s * v[1]) + t * ((1.0 - s) * v[2] + s * v[3]);
    }

    void add_moments(const Polygon& p, std::size_t plane, LookupMoments& out) const {
        if (p.size < 3) {
            const double f = at(p.x[0], p.y[0]);
            out.mean[plane] += f;
            out.square += f * f;
            out.peak = std::max(out.peak, f);
            return;
        }
        double whole = 0.0, mean = 0.0, square = 0.0;
        for (int i = 1; i + 1 < p.size; ++i) {
            const double twice =
                std::abs((p.x[i] - p.x[0]) * (p.y[i + 1] - p.y[0]) - (p.y[i] - p.y[0]) * (p.x[i + 1] - p.x[0]));
            add_triangle(p, i, twice, mean, square);
            whole += twice;
        }
        for (int i = 0; i < p.size; ++i) {
            const int j = i + 1 < p.size ? i + 1 : 0;
            out.peak =
                std::max({out.peak, at(p.x[i], p.y[i]), at(0.5 * (p.x[i] + p.x[j]), 0.5 * (p.y[i] + p.y[j]))});
        }
        if (!(whole > 0.0)) return;
        out.mean[plane] += mean / whole;
        out.square += square / whole;
    }

    /// Corners 0, i and i + 1, by the rule of six points that is exact for f^2: of degree 4 (D. Dunavant, "High
    /// degree efficient symmetrical Gaussian quadrature rules for the triangle", 1985).
    void add_triangle(const Polygon& p, int i, double weight, double& mean, double& square) const {
        constexpr double a[2] = {0.445948490915965, 0.091576213509771},
                         w[2] = {0.223381589678011, 0.109951743655322};
        for (int set = 0; set < 2; ++set)
            for (int k = 0; k < 3; ++k) {
                double b[3] = {a[set], a[set], a[set]};
                b[k] = 1.0 - 2.0 * a[set];
                const double f = at(b[0] * p.x[0] + b[1] * p.x[i] + b[2] * p.x[i + 1],
                                    b[0] * p.y[0] + b[1] * p.y[i] + b[2] * p.y[i + 1]);
                mean += weight * w[set] * f;
                square += weight * w[set] * f * f;
            }
    }
};

/// Over an edge the plane of the face is prolonged: what lies there is on the face that it looks at.
TexelPosition beside_on_cube(const Map& map, int from_column, int from_row, int column, int row) {
    const int n = cube_face_size(map);
    if (column / n == from_column / n && row / n == from_row / n && column >= 0 && row >= 0) return {column, row};
    if (map.layout == Layout::stacked_cube) { // centres lie on the edges: nothing is looked up beyond
        const int left = from_column / n * n, top = from_row / n * n;
        return {std::clamp(column, left, left + n - 1), std::clamp(row, top, top + n - 1)};
    }
    const int face_column = from_column / n, face_row = from_row / n;
    if (!on_cube_face(map, from_column, from_row)) return {from_column, from_row};
    const Direction d = cube_direction_beside(map, face_column, face_row, (column - face_column * n + 0.5) / n,
                                              (row - face_row * n + 0.5) / n);
    const ImagePoint p = cube_point(map, d);
    return {std::min(static_cast<int>(p.u * map.width), map.width - 1),
            std::min(static_cast<int>(p.v * map.height), map.height - 1)};
}

} // namespace

TexelPosition texel_beside(const Map& map, int from_column, int from_row, int column, int row) {
    const bool flat =
        map.layout == Layout::latlong || map.layout == Layout::angular || map.layout == Layout::mirrorball;
    if (map.repeats && flat) return repeated(map, column, row);
    switch (map.layout) {
    case Layout::latlong:
        return beside_on_latlong(map, column, row);
    case Layout::octahedral:
        return beside_on_square(map, column, row);
    case Layout::angular:
    case Layout::mirrorball:
        return {std::clamp(column, 0, map.width - 1), std::clamp(row, 0, map.height - 1)};
    default:
        return beside_on_cube(map, from_column, from_row, column, row);
    }
}

SourceLookup::SourceLookup(const Map& map, const float* rgb, const compress::TargetOptions& options)
    : map_(map), bilinear_(options.filter == ACDF_FILTER_BILINEAR), planes_(compress::planes_of(options)),
      values_(std::size_t{planes_} * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height)) {
    const std::size_t width = static_cast<std::size_t>(map.width), texels = values_.size() / planes_;
    std::atomic<bool> finite{true};
    compress::parallel_for(std::size_t{0}, static_cast<std::size_t>(map.height), [&](std::size_t row) {
        if (!compress::take_texels(rgb + 3 * width * row, width, options, values_.data() + width * row, texels))
            finite = false;
    });
    if (!finite) throw std::invalid_argument("radiance that is not finite");
}

LookupMoments SourceLookup::moments(int column, int row, const Polygon& polygon) const {
    LookupMoments out;
    if (!bilinear_) {
        for (std::uint32_t plane = 0; plane < planes_; ++plane) {
            const double f = value(plane, {column, row});
            out.mean[plane] = f;
            out.square += f * f;
            out.peak = std::max(out.peak, f);
        }
        return out;
    }
    // The first half of a texel lies between the centre before it and its own, the second between that and the
    // next.
    const int x = column / 2, y = row / 2, x0 = x - 1 + column % 2, y0 = y - 1 + row % 2;
    const TexelPosition at[4] = {texel_beside(map_, x, y, x0, y0), texel_beside(map_, x, y, x0 + 1, y0),
                                 texel_beside(map_, x, y, x0, y0 + 1), texel_beside(map_, x, y, x0 + 1, y0 + 1)};
    for (std::uint32_t plane = 0; plane < planes_; ++plane) {
        const Patch patch{{value(plane, at[0]), value(plane, at[1]), value(plane, at[2]), value(plane, at[3])},
                          x0 + 0.5,
                          y0 + 0.5};
        patch.add_moments(polygon, plane, out);
    }
    return out;
}

} // namespace acdf::build
