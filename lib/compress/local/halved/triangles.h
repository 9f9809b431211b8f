// The triangles between bins of normals: of the lattice on the faces of an octahedron.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace acdf::compress {

/// A corner of the lattice: |x| + |y| + |z| is the number of subdivisions.
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

} // namespace acdf::compress
