#include "compress/local/halved/mixtures.h"

#include "compress/local/light.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kAloneShare = 0.2; // of what normals count, bins themselves

double length_of(const Direction& d) { return std::sqrt(dot(d, d)); }

/// A corner of the lattice of bins on the faces of an octahedron: |x| + |y| + |z| is the number of subdivisions.
using OctahedronCorner = std::array<std::int32_t, 3>;

/// Calls `visit` with the three corners of each triangle.
template <class Visit>
void for_each_triangle(std::int32_t subdivisions, const Visit& visit) {
    // One that points down has its corners two steps from `base`, others one.
    const auto in_all_octants = [&](const OctahedronCorner& base, bool down) {
        for (int octant = 0; octant < 8; ++octant) {
            std::array<OctahedronCorner, 3> corners;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    corners[i][k] = (base[k] + ((k == i) != down)) * (octant >> k & 1 ? -1 : 1);
            visit(corners);
        }
    };
    for (std::int32_t x = 0; x < subdivisions; ++x)
        for (std::int32_t y = 0; x + y < subdivisions; ++y) {
            in_all_octants({x, y, subdivisions - 1 - x - y}, false);
            if (x + y < subdivisions - 1) in_all_octants({x, y, subdivisions - 2 - x - y}, true);
        }
}

} // namespace

Mixtures::Mixtures(const NormalBins& bins) : near(bins.normals.size()) {
    const auto add = [&](const Mixture& mixture, const Direction& unit) {
        if (!(mixture.frequency > 0.0)) return;
        for (std::size_t i = 0; i < 3; ++i)
            if (mixture.weight[i] > 0.0f) near[mixture.bin[i]].push_back(static_cast<std::uint32_t>(of.size()));
        normals.add(unit);
        of.push_back(mixture);
    };
    for_each_triangle(static_cast<std::int32_t>(bins.subdivisions), [&](const auto& corners) {
        Mixture mixture;
        mixture.frequency = 1.0;
        Direction place{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Direction corner = {double(corners[i][0]), double(corners[i][1]), double(corners[i][2])};
            mixture.bin[i] = acdf_octahedral_corner(bins.subdivisions, corners[i][0], corners[i][1], corners[i][2]);
            mixture.weight[i] = static_cast<float>(length_of(corner) / 3.0);
            mixture.frequency = std::min(mixture.frequency, bins.weight[mixture.bin[i]]);
            for (std::size_t k = 0; k < 3; ++k) place[k] += corner[k] / 3.0;
        }
        mixture.frequency *= 0.5 * (1.0 - kAloneShare); // there are two triangles a bin
        const double length = length_of(place);
        mixture.length = static_cast<float>(length);
        add(mixture, {place[0] / length, place[1] / length, place[2] / length});
    });
    for (std::uint32_t b = 0; b < bins.normals.size(); ++b) {
        Mixture alone;
        alone.bin = {b, b, b};
        alone.weight = {1.0f, 0.0f, 0.0f};
        alone.frequency = kAloneShare * bins.weight[b];
        add(alone, bins.normals[b]);
    }
}

} // namespace acdf::compress
