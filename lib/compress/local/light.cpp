#include "compress/local/light.h"

#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/sample.h>

namespace acdf::compress {
namespace {

/// Light near the horizon of a normal is that within this sine: as far as its bins are apart.
double horizon_band(const NormalBins& bins) { return 2.0 / bins.subdivisions; }

/// The radius of tiles at the horizon.
constexpr double kTileRadius = 0.1;

/// A tile whose directions differ by r adds r^2 sin^2 / cos to the sum of costs, and about r where it crosses the
/// horizon.
double spread_worth(double cosine) {
    if (cosine <= -kTileRadius) return 0.0;
    if (cosine <= 0.0) return (1.0 + cosine / kTileRadius) / kTileRadius;
    return (1.0 - cosine * cosine) / std::max(cosine, kTileRadius);
}

Box whole(const Target& target) {
    Box all;
    all.end = {target.rows, target.columns};
    return all;
}

} // namespace

Direction direction_at(const Target& target, double row, double column) {
    if (is_octahedral(target)) return octahedral_direction(target, column, row);
    double s, c, z, r;
    acdf_sincospi(1.0 - 2.0 * column / target.columns, &s, &c);
    acdf_sincospi(row / target.rows, &r, &z);
    return {r * c, r * s, z};
}

double solid_angle(const Target& target, const Box& box) {
    if (is_octahedral(target))
        return 4.0 * ACDF_PI * (double(box.length(0)) / target.rows) * (double(box.length(1)) / target.columns);
    return 2.0 * ACDF_PI / target.columns * box.length(1) *
           (acdf_row_z(box.begin[0], target.rows) - acdf_row_z(box.end[0], target.rows));
}

std::array<double, 2> texel_radians(const Target& target, const Box& box) {
    if (is_octahedral(target)) {
        const double side = 2.0 * std::sqrt(ACDF_PI);
        return {side / target.rows, side / target.columns};
    }
    const double z = centre(target, box)[2];
    return {ACDF_PI / target.rows, 2.0 * ACDF_PI / target.columns * std::sqrt(std::max(0.0, 1.0 - z * z))};
}

DividedGrid::DividedGrid(const Target& target) {
    const auto largest = texel_radians(target, whole(target)); // on a lat-long map those of the equator
    for (std::size_t axis = 0; axis < 2; ++axis)
        parts[axis] = static_cast<std::uint32_t>(std::ceil(largest[axis] / kTexelStep));
    grid.parameterization = target.parameterization;
    grid.rows = target.rows * parts[0], grid.columns = target.columns * parts[1];
}

std::vector<LightPoint> light_points(const Target& target) {
    std::vector<Box> blocks;
    for_each_block(target, whole(target), kPointStep, [&](const Box& block, double) { blocks.push_back(block); });
    std::vector<LightPoint> points(blocks.size());
    parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        Sum sum;
        for (std::uint32_t r = blocks[i].begin[0]; r < blocks[i].end[0]; ++r)
            for (std::uint32_t c = blocks[i].begin[1]; c < blocks[i].end[1]; ++c)
                sum.add(target.row(r)[c] * target.row_measure[r] * target.column_measure[c]);
        points[i] = {centre(target, blocks[i]), sum.value(), solid_angle(target, blocks[i]),
                     radius(target, blocks[i])};
    });
    return points;
}

std::vector<double> irradiance(const std::vector<LightPoint>& points, const NormalBins& bins) {
    std::vector<double> out(bins.normals.size());
    parallel_for(std::size_t{0}, out.size(), [&](std::size_t b) {
        for (const LightPoint& p : points) out[b] += p.amount * std::max(0.0, dot(p.direction, bins.normals[b]));
    });
    return out;
}

Worth worth(const Target& target, const NormalBins& bins, const std::vector<double>& irradiance) {
    Worth out;
    Target grid;
    grid.columns = CoarseMap::columns;
    grid.rows = CoarseMap::rows;
    grid.parameterization = target.parameterization;
    const double band = out.band = horizon_band(bins);
    struct Lit {
        Direction normal;
        double weight, irradiance;
    };
    std::vector<Lit> lit;
    for (std::size_t b = 0; b < bins.normals.size(); ++b)
        if (irradiance[b] > 0.0) lit.push_back({bins.normals[b], bins.weight[b], irradiance[b]});
    parallel_for(std::size_t{0}, out.mean.values.size(), [&](std::size_t i) {
        const Direction d = direction_at(grid, double(i / grid.columns) + 0.5, double(i % grid.columns) + 0.5);
        double mean = 0.0, spread = 0.0, alarm = 0.0;
        for (const Lit& bin : lit) {
            const double cosine = dot(d, bin.normal);
            if (cosine <= -std::max(band, kTileRadius)) continue; // it sees nothing of it
            mean += bin.weight * std::max(0.0, cosine) / bin.irradiance;
            spread += bin.weight * spread_worth(cosine) / bin.irradiance;
            // Between bins the weight of light at the horizon is too large by up to a quarter of their distance.
            if (std::abs(cosine) < band) alarm = std::max(alarm, 0.25 * band / bin.irradiance);
        }
        out.mean.values[i] = mean;
        out.spread.values[i] = spread;
        out.alarm.values[i] = alarm;
    });
    return out;
}

BinLight::BinLight(const Target& target, const NormalBins& bins)
    : points(light_points(target)), irradiance(compress::irradiance(points, bins)),
      worth(compress::worth(target, bins, irradiance)) {}

} // namespace acdf::compress
