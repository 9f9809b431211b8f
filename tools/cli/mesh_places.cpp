#include "tools/cli/mesh_places.h"

#include "measure/sequences.h"

#include <algorithm>
#include <array>

namespace acdf::tools {

builder::Places places_on(std::shared_ptr<const input::MeshSurface> surface, input::UpAxis up) {
    builder::Places out;
    const double lift = 1e-5 * surface->tree().size(); // floats are told: above what they were rounded to
    out.point = [surface, lift](std::uint64_t index, builder::PlacePoint& point) {
        const auto u = measure::sobol_point(static_cast<std::uint32_t>(index + 1));
        const input::MeshSurface::Point at = surface->at(u[0] * 0x1p-32, u[1] * 0x1p-32, input::is_front(index));
        for (std::size_t k = 0; k < 3; ++k) {
            point.position[k] = static_cast<float>(at.position[k] + lift * at.normal[k]);
            point.normal[k] = static_cast<float>(at.normal[k]);
        }
        return true;
    };
    out.occluded = [surface](const builder::PlacePoint& point, const float direction[3]) {
        const std::array<double, 3> from{double{point.position[0]}, double{point.position[1]},
                                         double{point.position[2]}};
        return surface->tree().any(from, {double{direction[0]}, double{direction[1]}, double{direction[2]}}, 0.0);
    };
    if (up == input::UpAxis::y) turn_from_y_up(out);
    return out;
}

} // namespace acdf::tools
