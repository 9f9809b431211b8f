// The axes of a scene's coordinates: --scene-axes.
#pragma once

#include "input/mesh/triangles.h"

#include <acdf/builder.h>

#include <array>
#include <cstddef>
#include <string>

namespace acdf::tools {

/// Ours of docs/conventions.md are sign[k] times the scene's from[k]: one of 48 ways.
struct SceneAxes {
    std::array<std::size_t, 3> from{0, 1, 2};
    std::array<float, 3> sign{1, 1, 1};

    /// Of "(-X, Y, Z)" or "-x,y,z". Throws CLI::ValidationError.
    static SceneAxes of(const std::string& text);
    /// "(-x,y,z)"
    std::string text() const;

    bool ours() const { return from[0] == 0 && from[1] == 1 && sign == std::array<float, 3>{1, 1, 1}; }
    /// Whether left and right are swapped, as in pbrt.
    bool mirrored() const;
    /// A position or direction of the scene in our frame.
    std::array<float, 3> turned(const float v[3]) const {
        return {sign[0] * v[from[0]], sign[1] * v[from[1]], sign[2] * v[from[2]]};
    }
    /// All corners; triangles stay wound as their normals are.
    void turn(input::Triangles& triangles) const;
    /// Positions are given in the scene's axes.
    void tell(builder::Visibility& visibility) const;
};

} // namespace acdf::tools
