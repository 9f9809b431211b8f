// Any bytes: reading them as a scene of `acdf render` gives one that is within its limits, or an error of one line.
#include "tests/fuzz/require.h"
#include "tools/render/scene_file.h"

#include <cmath>
#include <cstdint>

namespace {

using acdf::measure::Vec3;
using acdf_test::require;

bool is_text(const std::string& text) {
    for (const char c : text)
        if (static_cast<unsigned char>(c) < 0x20) return false;
    return true;
}

bool is_near(const Vec3& point) {
    for (const double x : point)
        if (!(std::abs(x) <= 1e6)) return false;
    return true;
}

void check_shape(const acdf::measure::Shape& shape) {
    if (const auto* sphere = std::get_if<acdf::measure::Sphere>(&shape))
        require(is_near(sphere->centre) && sphere->radius > 0.0 && sphere->radius <= 1e6);
    else if (const auto* plane = std::get_if<acdf::measure::Plane>(&shape))
        require(std::abs(plane->z) <= 1e6 && plane->extent > 0.0);
    else {
        const auto& box = std::get<acdf::measure::Box3>(shape);
        require(is_near(box.low) && is_near(box.high));
        for (std::size_t k = 0; k < 3; ++k) require(box.low[k] < box.high[k]);
    }
}

void check(const acdf::tools::SceneFile& scene) {
    require(scene.width >= 1 && scene.height >= 1 && scene.samples >= 1 && !scene.samplers.empty());
    require(scene.probe.empty() != scene.built_in.empty() && is_text(scene.probe) && is_text(scene.built_in));
    for (const acdf::measure::Object& object : scene.geometry.objects) {
        check_shape(object.shape);
        require(object.seen ? object.material < scene.materials.size() : object.material == 0);
    }
    for (const acdf::tools::SceneMaterial& material : scene.materials)
        require(!material.brdf.empty() && is_text(material.brdf));
    // Every pixel looks somewhere.
    for (const std::uint32_t x : {0u, scene.width - 1}) {
        const Vec3 d = scene.camera.ray(x, 0, scene.width, scene.height).direction;
        require(std::abs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1.0) < 1e-6);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        check(acdf::tools::parse_scene(text));
    } catch (const acdf::tools::SceneError& error) {
        require(error.what()[0] != '\0' && is_text(error.what()));
    }
    return 0;
}
