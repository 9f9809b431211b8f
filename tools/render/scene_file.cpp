#include "tools/render/scene_file.h"

#include "build/text/format_names.h"
#include "input/probe/faces.h"
#include "tools/render/scene_json.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace acdf::tools {
namespace {

using measure::cross;
using measure::dot;
using measure::operator-;

constexpr double kFar = 1e6; ///< where shadow rays still begin above their surface
constexpr std::uint32_t kMostPixels = 4096, kMostSamples = 65536, kMostSeeds = 4096;
constexpr std::size_t kMostObjects = 1000, kMostSamplers = 64, kMostPortals = 64, kFaces = 6;

measure::Vec3 point(const JsonValue& value) { return value.triple(-kFar, kFar); }

measure::Camera read_camera(const JsonValue& value) {
    JsonObject object(value);
    measure::Camera camera;
    camera.from = point(object.at("from"));
    camera.to = point(object.at("to"));
    camera.fov = object.at("fov").number(0.01, 170.0);
    object.if_has("up", [&](const JsonValue& up) { camera.up = point(up); });
    object.finish();
    constexpr double least = 1e-6; // of lengths, and of the angle to `up`
    const measure::Vec3 forward = camera.to - camera.from;
    const double distance = std::sqrt(dot(forward, forward)), length = std::sqrt(dot(camera.up, camera.up));
    const measure::Vec3 across = cross(forward, camera.up);
    if (!(distance > least && length > least && std::sqrt(dot(across, across)) > least * distance * length))
        value.fail("has no direction: 'from' equals 'to', or 'up' is parallel to the view");
    return camera;
}

measure::Shape read_sphere(const JsonValue& value) {
    JsonObject object(value);
    measure::Sphere sphere;
    sphere.centre = point(object.at("centre"));
    sphere.radius = object.at("radius").number(1e-3, kFar);
    object.finish();
    return sphere;
}

measure::Shape read_plane(const JsonValue& value) {
    JsonObject object(value);
    measure::Plane plane;
    plane.z = object.at("z").number(-kFar, kFar);
    object.if_has("extent", [&](const JsonValue& extent) { plane.extent = extent.number(1e-3, kFar); });
    object.finish();
    return plane;
}

measure::Shape read_box(const JsonValue& value) {
    JsonObject object(value);
    const measure::Box3 box{point(object.at("low")), point(object.at("high"))};
    object.finish();
    for (std::size_t k = 0; k < 3; ++k)
        if (!(box.low[k] < box.high[k])) value.fail("'low' is not below 'high' on every axis");
    return box;
}

measure::Shape read_shape(const JsonValue& value, JsonObject& object) {
    struct Kind {
        const char* key;
        measure::Shape (*read)(const JsonValue&);
    };
    constexpr Kind kinds[] = {{"sphere", read_sphere}, {"plane", read_plane}, {"box", read_box}};
    std::vector<measure::Shape> shapes;
    for (const Kind& kind : kinds)
        object.if_has(kind.key, [&](const JsonValue& shape) { shapes.push_back(kind.read(shape)); });
    if (shapes.size() != 1) value.fail("needs one of 'sphere', 'plane', 'box' and 'mesh'");
    return shapes.front();
}

/// The file of a mesh, if the object is one.
std::optional<SceneMesh> read_mesh(JsonObject& object) {
    std::optional<SceneMesh> out;
    object.if_has("mesh", [&](const JsonValue& value) {
        JsonObject mesh(value);
        out.emplace();
        out->file = mesh.at("file").text();
        mesh.if_has("up", [&](const JsonValue& up) {
            const std::string axis = up.text();
            if (axis != "y" && axis != "z") up.fail("is not y or z");
            if (axis == "y") out->up = input::UpAxis::y;
        });
        mesh.finish();
    });
    return out;
}

void read_object(const JsonValue& value, SceneFile& scene) {
    JsonObject object(value);
    measure::Object out;
    if (std::optional<SceneMesh> mesh = read_mesh(object)) {
        mesh->object = scene.geometry.objects.size();
        scene.meshes.push_back(*mesh);
        out.shape = measure::Mesh{};
        if (object.has("sphere") || object.has("plane") || object.has("box"))
            value.fail("needs one of 'sphere', 'plane', 'box' and 'mesh'");
    } else {
        out.shape = read_shape(value, object);
    }
    object.if_has("seen", [&](const JsonValue& seen) { out.seen = seen.truth(); });
    SceneMaterial material;
    object.if_has("brdf", [&](const JsonValue& brdf) { material.brdf = brdf.text(); });
    object.if_has("tint", [&](const JsonValue& tint) { material.tint = tint.triple(0.0, 1.0); });
    object.finish();
    if (!out.seen && material.brdf.empty()) material.brdf = "lambert";
    if (material.brdf.empty()) value.fail("lacks 'brdf', such as \"lambert\"");
    if (out.seen) {
        const auto same = std::find(scene.materials.begin(), scene.materials.end(), material);
        out.material = static_cast<std::uint32_t>(same - scene.materials.begin());
        if (same == scene.materials.end()) scene.materials.push_back(material);
    }
    scene.geometry.objects.push_back(out);
}

measure::Portal read_portal(const JsonValue& value) {
    JsonObject object(value);
    const measure::Portal portal{point(object.at("corner")), point(object.at("across")), point(object.at("up"))};
    object.finish();
    const double across = std::sqrt(dot(portal.across, portal.across)), up = std::sqrt(dot(portal.up, portal.up));
    if (!(across >= 1e-3 && up >= 1e-3)) value.fail("has no area");
    if (!(std::fabs(dot(portal.across, portal.up)) <= 1e-6 * across * up))
        value.fail("is not a rectangle: its sides are not at right angles");
    return portal;
}

input::Projection projection(const JsonValue& value) {
    using input::Projection;
    const std::string text = value.text();
    for (const Projection p : {Projection::automatic, Projection::latlong, Projection::angular,
                               Projection::mirrorball, Projection::cube_cross, Projection::octahedral})
        if (text == input::to_string(p)) return p;
    value.fail("is not a projection: auto, latlong, angular, mirrorball, cube-cross, octahedral");
}

input::Faces faces(const JsonValue& value) {
    input::Faces out;
    if (!input::parse_faces(value.text(), out))
        value.fail("is not an order of faces: directx, opengl, openexr, or a list such as +x,-x,+y,-y,+z,-z");
    return out;
}

build::BadPixels bad_pixels(const JsonValue& value) {
    const std::string text = value.text();
    if (text == "zero") return build::BadPixels::zero;
    if (text == "clamp") return build::BadPixels::clamp;
    if (text == "error") return build::BadPixels::error;
    value.fail("is none of zero, clamp, error");
}

/// A file, or six faces of a cube as one source.
std::string probe(const JsonValue& value) {
    if (!value.json().is_array()) return value.text();
    std::vector<std::string> files;
    value.each(kFaces, [&](const JsonValue& file) { files.push_back(file.text()); });
    if (files.size() != kFaces) value.fail("is not one file, or six: the faces of a cube");
    std::string joined;
    for (const std::string& file : files) {
        if (file.find(',') != std::string::npos) value.fail("has a face with a comma in its name");
        joined += (joined.empty() ? "" : ",") + file;
    }
    return joined;
}

AcdfFilter filter(const JsonValue& value) {
    const std::string text = value.text();
    for (const AcdfFilter f : {ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR})
        if (text == build::filter_name(f)) return f;
    value.fail("is not a filter: nearest, bilinear");
}

void read_light(const JsonValue& value, SceneFile& scene) {
    JsonObject object(value);
    object.if_has("probe", [&](const JsonValue& source) { scene.probe = probe(source); });
    object.if_has("built_in", [&](const JsonValue& name) { scene.built_in = name.text(); });
    object.if_has("projection", [&](const JsonValue& p) { scene.reading.projection = projection(p); });
    object.if_has("faces", [&](const JsonValue& f) { scene.reading.faces = faces(f); });
    object.if_has("bad_pixels", [&](const JsonValue& b) { scene.reading.bad_pixels = bad_pixels(b); });
    object.if_has("filter", [&](const JsonValue& f) { scene.filter = filter(f); });
    object.finish();
    if (scene.probe.empty() == scene.built_in.empty()) value.fail("needs one of 'probe' and 'built_in'");
}

void read_image(const JsonValue& value, SceneFile& scene) {
    JsonObject object(value);
    scene.width = object.at("width").count(kMostPixels);
    scene.height = object.at("height").count(kMostPixels);
    object.finish();
}

} // namespace

SceneFile parse_scene(const std::string& text) {
    const Json json = parse_strict(text);
    const JsonValue root(json, "");
    JsonObject object(root);
    SceneFile scene;
    object.has("$schema");
    object.if_has("description", [&](const JsonValue& value) { scene.description = value.text(); });
    scene.camera = read_camera(object.at("camera"));
    object.if_has("image", [&](const JsonValue& value) { read_image(value, scene); });
    read_light(object.at("light"), scene);
    const JsonValue objects = object.at("objects");
    objects.each(kMostObjects, [&](const JsonValue& value) { read_object(value, scene); });
    object.if_has("portals", [&](const JsonValue& portals) {
        portals.each(kMostPortals,
                     [&](const JsonValue& value) { scene.geometry.portals.push_back(read_portal(value)); });
    });
    scene.geometry.turned =
        !scene.meshes.empty() && std::all_of(scene.meshes.begin(), scene.meshes.end(),
                                             [](const SceneMesh& mesh) { return mesh.up == input::UpAxis::y; });
    if (scene.materials.empty()) objects.fail("has no object that the camera sees");
    scene.samples = object.at("samples").count(kMostSamples);
    object.if_has("seeds", [&](const JsonValue& value) {
        scene.seeds = value.count(kMostSeeds);
        if (scene.seeds < 3) value.fail("is below 3");
    });
    object.if_has("reference", [&](const JsonValue& value) { scene.reference = value.truth(); });
    object.at("samplers").each(kMostSamplers, [&](const JsonValue& value) {
        scene.samplers.push_back(value.text());
    });
    object.finish();
    return scene;
}

} // namespace acdf::tools
