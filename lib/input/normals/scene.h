// The normals that occur in a scene, and how often: what a local environment map has to serve.
#pragma once

#include "input/error.h"
#include "input/up_axis.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::input {

struct WeightedNormal {
    float n[3];          ///< unit, in the frame of docs/conventions.md: z up
    double weight = 0.0; ///< > 0: how often it occurs: area of a mesh, pixels of an image, as a list says
};

struct SceneNormals {
    std::vector<WeightedNormal> normals; ///< at least one, at most about a million; in a fixed order
    std::string kind;                    ///< "mesh", "normal pass", "list"
    std::uint64_t skipped = 0;           ///< normals that are zero or NaN, polygons without area
};

struct SceneOptions {
    UpAxis up = UpAxis::z;
    bool rgb_is_normal = false; ///< take R, G and B of an image in which no channel is named as a normal
};

/// Reads, by the file's extension:
///
/// - a mesh, .obj or .ply: normals of the vertices, interpolated over each polygon; else of the face, as it is
/// wound;
///   weighted by area. .instances: meshes and where they stand (mesh/instances.h);
/// - a list, .txt or .csv: one a line, `x y z [weight]`, blanks or commas between; # starts a comment;
/// - any other: an image of a normal in each pixel, floating-point components from -1 to 1: channels N.X, N.Y, N.Z
/// of any
///   layer, also Nx, normal.X, normal.R, ...; weighted by pixels.
///
/// Normals need not be unit; antialiased pixels are not. Those that agree to about 0.1 degree are merged into their
/// weighted mean, so that memory does not grow with the scene (but for meshes). Throws Error (a
/// std::runtime_error): one line, also where no normal is left.
SceneNormals read_scene_normals(const std::string& path, const SceneOptions& options = {});

} // namespace acdf::input
