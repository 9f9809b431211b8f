#include "tools/plot/pdf_image.h"
#include "compress/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace acdf::tools {

PdfFunction pdf_of(const EnvironmentView& view) {
    return [view](const float direction[3]) { return view.pdf(direction); };
}

PdfFunction pdf_of(const MixedEnvironment& view) {
    return [view](const float direction[3]) { return view.pdf(direction); };
}

PdfFunction pdf_of(const compress::Target& target) {
    const double scale = 1.0 / compress::integral(target);
    const bool square = target.parameterization == ACDF_PARAM_OCTAHEDRAL;
    const build::Map grid{square ? build::Layout::octahedral : build::Layout::latlong,
                          static_cast<int>(target.columns), static_cast<int>(target.rows)};
    return [&target, scale, grid](const float d[3]) {
        const build::ImagePoint p = build::to_image(grid, {d[0], d[1], d[2]});
        const auto column = static_cast<std::uint32_t>(p.u * grid.width);
        const auto row = static_cast<std::uint32_t>(p.v * grid.height);
        return static_cast<float>(static_cast<double>(target.row(row)[column]) * scale);
    };
}

PlotMap plot_map(build::Layout layout, int width) {
    return {layout, width, layout == build::Layout::latlong ? std::max(width / 2, 1) : width};
}

PlotMap hemisphere_map(int width) {
    PlotMap map(build::Layout::angular, width, width);
    map.hemisphere = true;
    return map;
}

bool pixel_direction(const PlotMap& map, double x, double y, float direction[3]) {
    if (map.hemisphere) {
        const double a = 2.0 * x / map.width - 1.0, b = 1.0 - 2.0 * y / map.height, square = a * a + b * b;
        if (!(square < 1.0)) return false;
        const double scale = std::sqrt(2.0 - square); // sin theta over sqrt(1 - cos theta)
        direction[0] = static_cast<float>(scale * a);
        direction[1] = static_cast<float>(scale * b);
        direction[2] = static_cast<float>(1.0 - square);
        return true;
    }
    build::Direction d;
    if (!build::to_direction(map, x / map.width, y / map.height, d)) return false;
    direction[0] = static_cast<float>(d.x);
    direction[1] = static_cast<float>(d.y);
    direction[2] = static_cast<float>(d.z);
    return true;
}

double pixel_solid_angle(const PlotMap& map, int x, int y) {
    if (!map.hemisphere) return build::texel_solid_angle(map, x, y);
    float direction[3];
    if (!pixel_direction(map, x + 0.5, y + 0.5, direction)) return 0.0;
    return 8.0 / (double(map.width) * map.height); // of 2 pi on a disc of pi, in a square of 4
}

PdfImage pdf_image(const PlotMap& map, const PdfFunction& pdf, const build::Progress& progress) {
    PdfImage image{map, {}};
    const auto width = static_cast<std::size_t>(map.width);
    image.pdf.assign(width * static_cast<std::size_t>(map.height), shows_nothing);
    std::atomic<int> rows{0};
    compress::parallel_for(0, map.height, [&](int y) {
        float* row = image.pdf.data() + static_cast<std::size_t>(y) * width;
        for (int x = 0; x < map.width; ++x)
            if (float direction[3]; pixel_direction(map, x + 0.5, y + 0.5, direction)) row[x] = pdf(direction);
        if (progress) progress(++rows / static_cast<double>(map.height), "evaluating");
    });
    return image;
}

} // namespace acdf::tools
