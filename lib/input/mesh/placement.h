// Where a mesh stands in a scene.
#pragma once

#include <array>

namespace acdf::input {

/// An affine map from the mesh's coordinates to those of the scene, a row a coordinate:
/// x' = t[0] x + t[1] y + t[2] z + t[3].
struct Placement {
    std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    /// Whether all is left as it is.
    bool stays() const { return rows == Placement{}.rows; }
    /// The factor of volumes; negative where the mesh is mirrored, which turns the winding of its triangles.
    double determinant() const;
    std::array<float, 3> position(const std::array<float, 3>& p) const;
    /// A normal of some length, that stays on its side of the surface: by the inverse transposed (times the
    /// determinant, but for its sign).
    std::array<float, 3> normal(const std::array<float, 3>& n) const;
};

} // namespace acdf::input
