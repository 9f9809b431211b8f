#include "tools/plot/cells.h"

#include "compress/parallel.h"
#include "measure/scenes/scene.h"
#include "tools/commands.h"
#include "tools/plot/colour.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

using measure::cross;
using measure::dot;
using measure::Vec3;
using measure::operator+;
using measure::operator-;
using measure::operator*;

/// The colour of a cell, by where its row lies: hues far apart for neighbours.
Colour cell_colour(const AcdfVisibilityTable& table, const std::uint8_t* row) {
    const auto number = static_cast<double>(row - table.rows);
    const double hue = 6.0 * std::fmod(number * 0.6180339887498949, 1.0),
                 light = 0.75 + 0.25 * std::fmod(number * 0.7548776662466927, 1.0);
    Colour out;
    for (int k = 0; k < 3; ++k) {
        const double away = std::fabs(std::fmod(hue + 4.0 - 2.0 * k + 6.0, 6.0) - 3.0);
        out[static_cast<std::size_t>(k)] =
            static_cast<float>(light * (0.25 + 0.75 * std::clamp(away - 1.0, 0.0, 1.0)));
    }
    return out;
}

Vec3 turned(const Vec3& p) { return {p[2], p[0], p[1]}; } // from y up

measure::Camera camera_of(const input::Triangles& triangles, const CellsOptions& options) {
    Vec3 low{1e300, 1e300, 1e300}, high = -1.0 * low;
    for (const auto& corner : triangles.corners)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], double{corner.position[k]});
            high[k] = std::max(high[k], double{corner.position[k]});
        }
    const bool turn = options.up == input::UpAxis::y;
    measure::Camera out;
    out.fov = 50.0;
    out.to = options.to ? turn ? turned(*options.to) : *options.to : 0.5 * (low + high);
    const double size = std::sqrt(dot(high - low, high - low));
    out.from = options.from ? turn ? turned(*options.from) : *options.from
                            : out.to + size * measure::normalized({1.0, -1.3, 1.0});
    const Vec3 forward = out.to - out.from, across = cross(forward, out.up);
    if (!(dot(forward, forward) > 0.0)) throw Failure("the camera has no direction: --from equals --to");
    if (!(dot(across, across) > 1e-12 * dot(forward, forward))) out.up = {1.0, 0.0, 0.0}; // straight down
    return out;
}

Colour shown(const VisibleLocalView& view, const measure::Hit& hit, double askance, bool turn) {
    const Vec3& p = hit.position;
    const Vec3 own = turn ? Vec3{p[1], p[2], p[0]} : p;
    float position[3], normal[3];
    for (std::size_t k = 0; k < 3; ++k) {
        position[k] = static_cast<float>(own[k]);
        normal[k] = static_cast<float>(hit.n[k]);
    }
    const AcdfVisiblePoint point = view.at(position, normal);
    const AcdfVisibilityTable& table = view.data().cells;
    Colour out = point.in_cell ? cell_colour(table, acdf_visibility_row(&table, point.cell)) : zero_colour;
    for (float& channel : out) channel *= static_cast<float>(0.45 + 0.55 * askance);
    return out;
}

} // namespace

images::Picture cells_picture(const VisibleLocalView& view, const CellsOptions& options) {
    const input::Triangles triangles = input::read_triangles(options.mesh, options.up);
    const measure::Camera camera = camera_of(triangles, options);
    measure::Geometry geometry;
    geometry.objects = {{measure::Mesh{std::make_shared<const input::MeshSurface>(triangles)}, 0, true}};
    images::Picture out(options.width, options.height);
    const auto width = static_cast<std::uint32_t>(options.width),
               height = static_cast<std::uint32_t>(options.height);
    compress::parallel_for(0u, height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const measure::Ray ray = camera.ray(x, y, width, height);
            const auto hit = geometry.trace(ray);
            const Colour colour =
                hit ? shown(view, *hit, std::fabs(dot(hit->n, ray.direction)), options.up == input::UpAxis::y)
                    : background;
            std::copy(colour.begin(), colour.end(), out.values.begin() + 3 * (std::ptrdiff_t{y} * width + x));
        }
    });
    return out;
}

} // namespace acdf::tools
