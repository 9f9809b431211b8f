#include "input/source_lookup.h"

#include "input/cube.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

namespace acdf::input {
namespace {

TexelPlace beside_on_latlong(const Map& map, int column, int row) {
    return {(column + map.width) % map.width, std::clamp(row, 0, map.height - 1)};
}

TexelPlace beside_on_square(const Map& map, int column, int row) {
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

/// Over an edge the plane of the face is prolonged: what lies there is on the face that it looks at.
TexelPlace beside_on_cube(const Map& map, int from_column, int from_row, int column, int row) {
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

TexelPlace texel_beside(const Map& map, int from_column, int from_row, int column, int row) {
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
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(map.height), [&](std::size_t row) {
        if (!compress::take_texels(rgb + 3 * width * row, width, options, values_.data() + width * row, texels))
            finite = false;
    });
    if (!finite) throw std::invalid_argument("radiance that is not finite");
}

LookupMoments SourceLookup::moments(int column, int row) const {
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
    // Quarters 0 and 1 of a texel lie between the centre before it and its own, 2 and 3 between that and the next.
    const int x = column / 4, y = row / 4, i = column % 4, k = row % 4;
    const int x0 = i < 2 ? x - 1 : x, y0 = k < 2 ? y - 1 : y;
    const double s = i < 2 ? 0.5 + 0.25 * i : 0.25 * i - 0.5, t = k < 2 ? 0.5 + 0.25 * k : 0.25 * k - 0.5;
    const TexelPlace at[4] = {texel_beside(map_, x, y, x0, y0), texel_beside(map_, x, y, x0 + 1, y0),
                              texel_beside(map_, x, y, x0, y0 + 1), texel_beside(map_, x, y, x0 + 1, y0 + 1)};
    for (std::uint32_t plane = 0; plane < planes_; ++plane) {
        const double v[4] = {value(plane, at[0]), value(plane, at[1]), value(plane, at[2]), value(plane, at[3])};
        const auto blend = [&](double u, double w) {
            return (1.0 - w) * ((1.0 - u) * v[0] + u * v[1]) + w * ((1.0 - u) * v[2] + u * v[3]);
        };
        const double a = blend(s, t), b = blend(s + 0.25, t), c = blend(s, t + 0.25), d = blend(s + 0.25, t + 0.25);
        out.mean[plane] = 0.25 * (a + b + c + d);
        out.square += (a * a + b * b + c * c + d * d + a * b + c * d + a * c + b * d + 0.5 * (a * d + b * c)) / 9.0;
        out.peak = std::max({out.peak, a, b, c, d});
    }
    return out;
}

} // namespace acdf::input
