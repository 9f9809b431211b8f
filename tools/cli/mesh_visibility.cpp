#include "tools/cli/mesh_visibility.h"

#include "measure/sequences.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace acdf::tools {
namespace {

/// Points all over a box, with normals all over the sphere.
class AirPoints {
public:
    explicit AirPoints(const input::Triangles& triangles) {
        for (const input::Triangles::Corner& corner : triangles.corners)
            for (std::size_t k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], double{corner.position[k]});
                high_[k] = std::max(high_[k], double{corner.position[k]});
            }
    }

    builder::VisibilityPoint at(std::uint64_t index) const {
        // Kronecker's sequence in five dimensions, of the root of x^6 = x + 1 (Roberts 2018).
        constexpr double root = 1.13472413840152;
        double step = 1.0, u[5];
        for (double& x : u) {
            step /= root;
            x = std::fmod((static_cast<double>(index & 0xFFFFFFFFu) + 0.5) * step, 1.0);
        }
        builder::VisibilityPoint out{};
        for (std::size_t k = 0; k < 3; ++k)
            out.position[k] = static_cast<float>(low_[k] + u[k] * (high_[k] - low_[k]));
        double sine, cosine;
        acdf_sincospi(2.0 * u[3] - 1.0, &sine, &cosine);
        const double z = 2.0 * u[4] - 1.0, r = std::sqrt((1.0 - z) * (1.0 + z));
        const double n[3] = {r * cosine, r * sine, z};
        for (std::size_t k = 0; k < 3; ++k) out.normal[k] = static_cast<float>(n[k]);
        return out;
    }

private:
    static constexpr double infinite_ = std::numeric_limits<double>::infinity();
    std::array<double, 3> low_{infinite_, infinite_, infinite_}, high_{-infinite_, -infinite_, -infinite_};
};

} // namespace

std::vector<builder::SceneNormal> both_sides(std::vector<builder::SceneNormal> normals) {
    for (std::size_t i = 0, count = normals.size(); i < count; ++i) {
        const builder::SceneNormal n = normals[i];
        normals.push_back({{-n.normal[0], -n.normal[1], -n.normal[2]}, n.weight});
    }
    return normals;
}

std::shared_ptr<const input::MeshSurface> read_surface(const SceneOption& scene, const Note& note) {
    input::Triangles triangles;
    for (const std::string& path : scene.paths) {
        const input::Triangles own = input::read_triangles(path, scene.input().up);
        note(path + ": visibility on " + std::to_string(own.count()) + " triangles");
        triangles.corners.insert(triangles.corners.end(), own.corners.begin(), own.corners.end());
    }
    scene.axes().turn(triangles);
    return std::make_shared<const input::MeshSurface>(std::move(triangles));
}

builder::Visibility visibility_on(std::shared_ptr<const input::MeshSurface> surface, input::UpAxis up,
                                  bool volume) {
    builder::Visibility out;
    const double lift =
        1e-5 * surface->tree().size(); // positions are given as floats: above what they were rounded to
    std::optional<AirPoints> air;
    if (volume) air.emplace(surface->triangles());
    out.point = [surface, lift, air](std::uint64_t index, builder::VisibilityPoint& point) {
        if (air) {
            if (index % 2 == 1) {
                point = air->at(index / 2);
                return true;
            }
            index /= 2;
        }
        const auto u = measure::sobol_point(static_cast<std::uint32_t>(index + 1));
        const input::MeshSurface::Point at = surface->at(u[0] * 0x1p-32, u[1] * 0x1p-32, input::is_front(index));
        for (std::size_t k = 0; k < 3; ++k) {
            point.position[k] = static_cast<float>(at.position[k] + lift * at.normal[k]);
            point.normal[k] = static_cast<float>(at.normal[k]);
        }
        return true;
    };
    out.occluded = [surface](const builder::VisibilityPoint& point, const float direction[3]) {
        const std::array<double, 3> from{double{point.position[0]}, double{point.position[1]},
                                         double{point.position[2]}};
        return surface->tree().any(from, {double{direction[0]}, double{direction[1]}, double{direction[2]}}, 0.0);
    };
    if (up == input::UpAxis::y) turn_from_y_up(out);
    return out;
}

} // namespace acdf::tools
