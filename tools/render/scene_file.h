// Scenes as small JSON files: docs/scene.schema.json.
#pragma once

#include "input/probe/probe.h"
#include "measure/scenes/scene.h"
#include "tools/render/scene_error.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// No scene is longer: it has at most 1,000 objects, and what is much longer takes minutes to parse.
constexpr std::uint64_t kMostSceneBytes = std::uint64_t{1} << 24;

/// A BRDF by the name that input::open_brdf takes, files relative to the data folder.
struct SceneMaterial {
    std::string brdf;
    std::array<double, 3> tint{1.0, 1.0, 1.0};

    bool operator==(const SceneMaterial& other) const { return brdf == other.brdf && tint == other.tint; }
};

/// The file of an object that is a mesh.
struct SceneMesh {
    std::size_t object = 0; ///< of the geometry
    std::string file;       ///< relative to the data folder
    input::UpAxis up = input::UpAxis::z;
};

/// A scene as written: nothing is loaded.
struct SceneFile {
    std::string description;
    measure::Camera camera;
    measure::Geometry geometry; ///< its materials are indices into `materials`
    std::vector<SceneMaterial> materials;
    std::vector<SceneMesh> meshes;
    std::string
        probe; ///< a file, or six faces of a cube (lib/input/probe/source.h), relative to the data folder, or
    std::string built_in;                     ///< the name of one of demo_probes()
    input::ProbeOptions reading;              ///< of the probe
    AcdfFilter filter = ACDF_FILTER_BILINEAR; ///< how the light is looked up
    std::uint32_t width = 96, height = 72;
    std::uint32_t samples = 20; ///< of each estimate
    std::uint32_t seeds = 0;    ///< 0: the program's
    bool reference = true;      ///< exact, by summation; else the mean of all pictures
    std::vector<std::string> samplers;
};

/// Strict: unknown and repeated keys, wrong types and values out of range are errors. Throws SceneError.
SceneFile parse_scene(const std::string& text);

} // namespace acdf::tools
