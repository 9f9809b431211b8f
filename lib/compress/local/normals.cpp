#include "compress/local/normals.h"

#include <acdf/curves/normals.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace acdf::compress {

NormalBins octahedral_bins(std::uint32_t subdivisions) {
    const auto n = static_cast<std::int32_t>(subdivisions);
    NormalBins bins;
    bins.subdivisions = subdivisions;
    bins.normals.resize(4 * std::size_t{subdivisions} * subdivisions + 2);
    bins.weight.resize(bins.normals.size());
    double sum = 0.0;
    for (std::int32_t x = -n; x <= n; ++x)
        for (std::int32_t y = -n + std::abs(x); y <= n - std::abs(x); ++y) {
            const std::int32_t height = n - std::abs(x) - std::abs(y);
            for (std::int32_t z = -height; z <= height; z += height > 0 ? 2 * height : 1) {
                const double length = std::sqrt(double(x * x + y * y + z * z));
                const std::uint32_t bin = acdf_octahedral_corner(subdivisions, x, y, z);
                bins.normals[bin] = {x / length, y / length, z / length};
                sum += bins.weight[bin] = 1.0 / (length * length * length); // of the face as seen from the centre
            }
        }
    for (double& weight : bins.weight) weight /= sum;
    return bins;
}

NormalBins latlong_bins(std::uint32_t columns, std::uint32_t rows) {
    NormalBins bins;
    bins.columns = columns;
    bins.rows = rows;
    for (std::uint32_t r = 0; r < rows; ++r) {
        const double upper = acdf_row_z(r, rows), lower = acdf_row_z(r + 1, rows);
        const double z = 0.5 * (upper + lower), radius = std::sqrt((1.0 - z) * (1.0 + z));
        for (std::uint32_t c = 0; c < columns; ++c) {
            double sine, cosine;
            acdf_sincospi(1.0 - (2.0 * c + 1.0) / columns, &sine, &cosine);
            bins.normals.push_back({radius * cosine, radius * sine, z});
            bins.weight.push_back(0.5 * (upper - lower) / columns);
        }
    }
    return bins;
}

bool NormalBins::find(const float normal[3], AcdfNormalBins& out) const {
    return subdivisions > 0 ? acdf_octahedral_bins(subdivisions, normal, &out) != 0
                            : acdf_latlong_bins(columns, rows, normal, &out) != 0;
}

std::size_t NormalBins::stored() const {
    return static_cast<std::size_t>(std::count_if(weight.begin(), weight.end(), [](double w) { return w > 0.0; }));
}

namespace {

/// Adds what a normal weighs to the bins around it.
bool add(NormalBins& bins, const float normal[3], double weight) {
    AcdfNormalBins found;
    if (!bins.find(normal, found)) return false;
    double all = 0.0;
    for (int i = 0; i < found.count; ++i) all += found.weight[i];
    for (int i = 0; i < found.count; ++i) bins.weight[found.bin[i]] += weight * found.weight[i] / all;
    return true;
}

/// The bins of normals nearly the same, with next to no weight: a renderer's normals are rounded, and one that is
/// off a corner or an edge of the octahedron by 1e-7 has bins that the normal itself has not.
void add_around(NormalBins& bins, const std::array<float, 3>& normal, double weight) {
    constexpr double tilt = 1e-3, of_weight = 1e-6;
    const std::uint32_t sides = std::max(8u, 2 * bins.columns); // at a pole of a lat-long grid all columns meet
    for (std::uint32_t side = 0; side < sides; ++side) {
        float tilted[3];
        acdf_cosine_direction(normal.data(), (side + 0.5) / sides, tilt * tilt, tilted);
        add(bins, tilted, of_weight * weight / sides);
    }
}

} // namespace

void weigh(NormalBins& bins, const std::vector<SceneNormal>& scene, Rounded rounded) {
    std::fill(bins.weight.begin(), bins.weight.end(), 0.0);
    double sum = 0.0;
    for (const SceneNormal& n : scene) {
        if (!add(bins, n.normal.data(), n.weight)) continue;
        if (rounded == Rounded::yes) add_around(bins, n.normal, n.weight);
        sum += n.weight;
    }
    if (!(sum > 0.0)) throw std::invalid_argument("no valid normal");
    for (double& weight : bins.weight) weight /= sum;
}

} // namespace acdf::compress
