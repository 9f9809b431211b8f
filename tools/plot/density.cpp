#include "tools/plot/density.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace acdf::tools {

Density density_of(const EnvironmentView& view) {
    return [view](const float direction[3]) { return view.pdf(direction); };
}

Density density_of(const compress::Target& target) {
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

build::Map plot_map(build::Layout layout, int width) {
    return {layout, width, layout == build::Layout::latlong ? std::max(width / 2, 1) : width};
}

bool pixel_direction(const build::Map& map, double x, double y, float direction[3]) {
    build::Direction d;
    if (!build::to_direction(map, x / map.width, y / map.height, d)) return false;
    direction[0] = static_cast<float>(d.x);
    direction[1] = static_cast<float>(d.y);
    direction[2] = static_cast<float>(d.z);
    return true;
}

DensityImage draw_density(const build::Map& map, const Density& density, const build::Progress& progress) {
    DensityImage image{map, {}};
    const auto width = static_cast<std::size_t>(map.width);
    image.density.assign(width * static_cast<std::size_t>(map.height), shows_nothing);
    std::atomic<int> rows{0};
    tbb::parallel_for(0, map.height, [&](int y) {
        float* row = image.density.data() + static_cast<std::size_t>(y) * width;
        for (int x = 0; x < map.width; ++x)
            if (float direction[3]; pixel_direction(map, x + 0.5, y + 0.5, direction)) row[x] = density(direction);
        if (progress) progress(++rows / static_cast<double>(map.height), "evaluating");
    });
    return image;
}

} // namespace acdf::tools
