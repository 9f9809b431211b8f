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
 "light": {"probe": "probe.pfm", "projection": "latlong", "filter": "nearest"},
 "objects": [
  {"plane": {"z": 0, "extent": 4}, "brdf": "lambert:albedo=0.5"},
  {"sphere": {"centre": [0, 0, 1], "radius": 1}, "brdf": "ggx:alpha=0.4", "tint": [0.9, 0.7, 0.5]},
  {"box": {"low": [-4, 1.5, 0], "high": [4, 2, 4]}, "seen": false}],
 "samples": 8,
 "samplers": [)" +
           samplers + "]}";
}

/// A mesh (.obj): a room that is open above one half of its floor, and a box in it; with z up, or with y up.
inline std::string room(bool y_up = false) {
    const double points[][3] = {{-2, -2, 0},     {2, -2, 0},      {2, 2, 0},       {-2, 2, 0},     {-2, -2, 2},
                                {2, -2, 2},      {2, 2, 2},       {-2, 2, 2},      {2, 0, 2},      {-2, 0, 2},
                                {-0.5, 0.6, 0},  {0.5, 0.6, 0},   {0.5, 1.2, 0},   {-0.5, 1.2, 0}, {-0.5, 0.6, 0.7},
                                {0.5, 0.6, 0.7}, {0.5, 1.2, 0.7}, {-0.5, 1.2, 0.7}};
    std::string text;
    for (const auto& p : points) {
        text += "v";
        for (int k = 0; k < 3; ++k) text += " " + std::to_string(p[y_up ? (k + 1) % 3 : k]);
        text += "\n";
    }
    return text + "f 1 2 3 4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 9 10\n" // half a roof
                  "f 15 16 17 18\nf 11 12 16 15\nf 12 13 17 16\nf 13 14 18 17\nf 14 11 15 18\n";
}

/// A scene of a room; the opening of its roof is a portal. `more`: of the mesh.
inline std::string mesh_scene(const std::string& file, const std::string& more = "") {
    return R"({"camera": {"from": [-1.7, 1.7, 1.7], "to": [0.6, -0.6, 0.3], "fov": 60}, "image": {"width": 12, "height": 9},
 "light": {"probe": "probe.pfm", "projection": "latlong", "filter": "nearest"}, "portals": [{"corner": [-2, 0, 2], "across": [4, 0, 0], "up": [0, 2, 0]}],
 "objects": [{"mesh": {"file": ")" +
           file + "\"" + more + R"(}, "brdf": "lambert:albedo=0.5"}], "samples": 8, "samplers": ["local:64KiB"]})";
}

/// The folder with the probe, and the scene as a file.
struct SceneFolder : Folder {
    explicit SceneFolder(const std::string& scene = small_scene("\"full-cdf\"")) {
        write_rgb(*this / "probe.pfm", 32, 16, small_probe());
        write_text(*this / "scene.json", scene);
    }
    std::string data() const { return *this / ""; }
};

} // namespace acdf::test
