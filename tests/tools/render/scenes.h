// Scenes so small that every sampler can be tried on them.
#pragma once

#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"
#include "tools/render/run.h"
#include "tools/render/scene_file.h"

#include <memory>
#include <string>
#include <vector>

namespace acdf::test {

/// A probe of 32 x 16 texels without symmetry: a gradient, a dark band and a lamp.
inline std::vector<float> small_probe() {
    std::vector<float> rgb;
    for (int r = 0; r < 16; ++r)
        for (int c = 0; c < 32; ++c) {
            const bool lamp = c >= 20 && c < 22 && r >= 3 && r < 5, dark = r == 7 && c < 12;
            const double value = lamp ? 40.0 : dark ? 0.0 : 0.2 + 0.05 * ((c * 7 + r * 3) % 11) + 0.04 * (15 - r);
            for (const double tint : {1.0, 0.8, 0.6}) rgb.push_back(static_cast<float>(tint * value));
        }
    return rgb;
}

/// A sphere on a plane beside a wall that the camera does not see.
inline std::string small_scene(const std::string& samplers) {
    return R"({"camera": {"from": [4, -1, 2], "to": [0, 0, 0.7], "fov": 35},
 "image": {"width": 8, "height": 6},
 "light": {"probe": "probe.exr", "projection": "latlong"},
 "objects": [
  {"plane": {"z": 0, "extent": 4}, "brdf": "lambert:albedo=0.5"},
  {"sphere": {"centre": [0, 0, 1], "radius": 1}, "brdf": "ggx:alpha=0.4", "tint": [0.9, 0.7, 0.5]},
  {"box": {"low": [-4, 1.5, 0], "high": [4, 2, 4]}, "seen": false}],
 "samples": 8,
 "samplers": [)" +
           samplers + "]}";
}

/// The folder with the probe, and the scene as a file.
struct SceneFolder : Folder {
    explicit SceneFolder(const std::string& scene = small_scene("\"full-cdf\"")) {
        write_rgb(*this / "probe.exr", 32, 16, small_probe());
        write_text(*this / "scene.json", scene);
    }
    std::string data() const { return *this / ""; }
};

} // namespace acdf::test
