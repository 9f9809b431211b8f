#include "tools/plot/local.h"

#include "compress/parallel.h"
#include "tools/plot/knots.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {

namespace {

AcdfVisiblePoint point_of(const PlottedNormal& plotted) {
    if (plotted.position) return plotted.local.at(plotted.position->data(), plotted.normal.data());
    return plotted.local.at(plotted.normal.data());
}

} // namespace

PdfFunction pdf_of(const PlottedNormal& plotted) {
    const AcdfVisiblePoint point = point_of(plotted);
    return [view = plotted.local, point](const float direction[3]) { return view.pdf(point, direction); };
}

std::vector<float> knot_opacity(const PlottedNormal& plotted, const PlotMap& map, const build::Progress& progress) {
    const AcdfVisibleLocal light = plotted.local.data();
    const AcdfVisiblePoint point = point_of(plotted);
    const AcdfEnvironment& env = light.local.environment;
    const AcdfGrid grid = acdf_environment_grid(&env);
    const FindCell find = [&](const float direction[3], AcdfRange range[2]) {
        std::uint32_t square[2];
        double position[2];
        acdf_sphere_ranges(env.columns, env.rows, range);
        if (acdf_grid_square(&grid, direction, square, position))
            acdf_visible_find_cell(&light, &point, square, range);
    };
    return knot_opacity(find, grid, map, progress);
}

std::vector<float> horizon_opacity(const Normal& normal, const PlotMap& map) {
    const double length = std::hypot(double{normal[0]}, double{normal[1]}, double{normal[2]});
    const auto cosine = [&](double x, double y, double& out) {
        float d[3];
        if (!pixel_direction(map, x, y, d)) return false;
        out = (double{normal[0]} * d[0] + double{normal[1]} * d[1] + double{normal[2]} * d[2]) / length;
        return true;
    };
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<float> out(width * static_cast<std::size_t>(map.height), 0.0f);
    compress::parallel_for(0, map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x) {
            double here, left, right, above, below; // the distance to the horizon by its gradient
            if (!cosine(x + 0.5, y + 0.5, here) || !cosine(x, y + 0.5, left) || !cosine(x + 1.0, y + 0.5, right) ||
                !cosine(x + 0.5, y, above) || !cosine(x + 0.5, y + 1.0, below))
                continue;
            const double gradient = std::max(std::hypot(right - left, below - above), 1e-9);
            out[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                static_cast<float>(std::clamp(1.5 - std::abs(here) / gradient, 0.0, 1.0));
        }
    });
    return out;
}

void draw_horizon(images::Picture& picture, const std::vector<float>& opacity) {
    float* rgb = picture.values.data();
    for (std::size_t i = 0; i < opacity.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] += opacity[i] * (1.0f - rgb[3 * i + c]);
}

} // namespace acdf::tools
