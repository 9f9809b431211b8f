#include "tools/plot/knots.h"

#include "compress/parallel.h"
#include "tools/plot/pdf_image.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace acdf::tools {
namespace {

constexpr float invisible_thickness = 2.5f, full_thickness = 12.0f; // of a cell, in pixels
constexpr float line_opacity = 0.55f;

/// The cell under a pixel, seen along one axis, in pixels.
struct Extent {
    float line = 0.0f;      ///< how much of the pixel the lines at the cell's two ends cover
    float thickness = 0.0f; ///< distance between those ends
};
using Extents = std::array<Extent, 2>;

/// Position on the grid, in columns and rows.
struct GridPoint {
    bool shown = false;
    std::array<double, 2> at = {0.0, 0.0};
};

class Tracer {
public:
    Tracer(const FindCell& find, const AcdfGrid& grid, const PlotMap& map)
        : find_(find), columns_(grid.columns), rows_(grid.rows),
          map_(map), grid_{acdf_grid_is_octahedral(&grid) ? build::Layout::octahedral : build::Layout::latlong, 1,
                           1} {} // of any size: it is scaled below

    Extents extents(int x, int y) const {
        float direction[3];
        if (!pixel_direction(map_, x + 0.5, y + 0.5, direction)) return {};
        AcdfRange range[2];
        find_(direction, range);
        const GridPoint here = grid_point(x + 0.5, y + 0.5);
        Extents out;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double step = gradient(x, y, here, axis);
            out[axis].thickness = static_cast<float>((range[axis].high - range[axis].low) / step);
            out[axis].line = static_cast<float>(coverage(axis, range[axis], here.at[axis], step));
        }
        return out;
    }

private:
    const FindCell& find_;
    std::uint32_t columns_, rows_;
    PlotMap map_;
    build::Map grid_;

    std::uint32_t resolution(std::size_t axis) const { return axis == ACDF_AXIS_PHI ? columns_ : rows_; }

    GridPoint grid_point(double x, double y) const {
        if (map_.layout == build::Layout::latlong &&
            !is_square()) // the same map: no detour, which would lose columns at the poles
            return {true, {x / map_.width * columns_, y / map_.height * rows_}};
        build::Direction d;
        if (!build::to_direction(map_, x / map_.width, y / map_.height, d)) return {};
        const build::ImagePoint p = build::to_image(grid_, d);
        return {true, {p.u * columns_, p.v * rows_}};
    }

    bool is_square() const { return grid_.layout == build::Layout::octahedral; }

    // Change of the position on `axis` between two points; columns of lat-long grids are periodic. Across a side of
    // the square the position jumps to the other half: no pixel there shows how far it moves.
    double difference(const GridPoint& a, const GridPoint& b, std::size_t axis) const {
        const double d = b.at[axis] - a.at[axis];
        if (is_square()) return std::abs(d) < 0.25 * resolution(axis) ? d : 0.0;
        if (axis != ACDF_AXIS_PHI) return d;
        return d - columns_ * std::round(d / columns_);
    }

    // How far the position on `axis` moves per pixel, in the direction in which it moves fastest.
    double gradient(int x, int y, const GridPoint& here, std::size_t axis) const {
        double square = 0.0;
        for (int i = 0; i < 2; ++i) {
            const double dx = i == 0 ? 0.5 : 0.0, dy = 0.5 - dx;
            const GridPoint before = grid_point(x + 0.5 - dx, y + 0.5 - dy);
            const GridPoint after = grid_point(x + 0.5 + dx, y + 0.5 + dy);
            double d = 0.0;
            if (before.shown && after.shown) d = difference(before, after, axis);
            else if (before.shown) d = 2.0 * difference(before, here, axis); // at the rim of the disc
            else if (after.shown) d = 2.0 * difference(here, after, axis);
            square += d * d;
        }
        return std::max(std::sqrt(square), 1e-9);
    }

    // A line runs half a pixel beyond its border, so that it fills one row or column of pixels where borders lie
    // between pixels, and is antialiased where they do not.
    double coverage(std::size_t axis, const AcdfRange& range, double at, double step) const {
        if (range.high - range.low == resolution(axis) && !is_square()) return 0.0; // all around: no seam either
        double covered = 0.0;
        if (is_border(axis, range.low)) covered += std::max(0.0, 1.0 - std::abs((at - range.low) / step - 0.5));
        if (is_border(axis, range.high)) covered += std::max(0.0, 0.5 - (range.high - at) / step);
        return std::min(covered, 1.0);
    }

    // The poles are no borders, and the seam at phi = pi is the edge of a lat-long picture. Cells end at the sides
    // of the square.
    bool is_border(std::size_t axis, std::uint32_t position) const {
        if (position > 0 && position < resolution(axis)) return true;
        return is_square() || (axis == ACDF_AXIS_PHI && map_.layout != build::Layout::latlong);
    }
};

float opacity_at(const std::vector<Extents>& extents, const PlotMap& map, int x, int y) {
    const auto at = [&](int i, int j) -> const Extents& {
        return extents[static_cast<std::size_t>(std::clamp(j, 0, map.height - 1)) *
                           static_cast<std::size_t>(map.width) +
                       static_cast<std::size_t>(std::clamp(i, 0, map.width - 1))];
    };
    float opacity = 0.0f;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float line = at(x, y)[axis].line;
        if (!(line > 0.0f)) continue;
        float thickness = 0.0f; // a large cell keeps its outline beside small ones
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) thickness = std::max(thickness, at(x + i, y + j)[axis].thickness);
        const float visible = (thickness - invisible_thickness) / (full_thickness - invisible_thickness);
        opacity = std::max(opacity, line * std::clamp(visible, 0.0f, 1.0f));
    }
    return opacity;
}

} // namespace

std::vector<float> knot_opacity(const EnvironmentView& view, const PlotMap& map, const build::Progress& progress) {
    const AcdfEnvironment& env = view.data();
    const FindCell find = [&env](const float direction[3], AcdfRange range[2]) {
        double t[2];
        AcdfStratum strata[2];
        acdf_environment_find(&env, direction, range, t, strata);
    };
    return knot_opacity(find, acdf_environment_grid(&env), map, progress);
}

std::vector<float> knot_opacity(const FindCell& find, const AcdfGrid& grid, const PlotMap& map,
                                const build::Progress& progress) {
    const Tracer tracer(find, grid, map);
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<Extents> extents(width * static_cast<std::size_t>(map.height));
    std::atomic<int> finished{0};
    compress::parallel_for(0, map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x)
            extents[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = tracer.extents(x, y);
        if (progress) progress(++finished / static_cast<double>(map.height), "tracing cells");
    });
    std::vector<float> opacity(extents.size());
    compress::parallel_for(0, map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x)
            opacity[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                opacity_at(extents, map, x, y);
    });
    return opacity;
}

void draw_knots(images::Picture& picture, const std::vector<float>& opacity) {
    float* rgb = picture.values.data();
    compress::parallel_for(std::size_t{0}, opacity.size(), [&](std::size_t i) {
        float* p = rgb + 3 * i;
        const float luma = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2];
        const float ink = luma > 0.45f ? 0.0f : 1.0f;
        for (int c = 0; c < 3; ++c) p[c] += line_opacity * opacity[i] * (ink - p[c]);
    });
}

} // namespace acdf::tools
