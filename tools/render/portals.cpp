#include "tools/render/portals.h"

#include "build/own_terms.h"

#include <cstddef>

namespace acdf::tools {

builder::Portal portal_of(const builder::Visibility& visibility, const measure::Portal& portal) {
    builder::Portal out;
    const auto turn_back = [&visibility](const measure::Vec3& v, float(&told)[3]) { // the transform only turns
        for (std::size_t i = 0; i < 3; ++i) {
            double sum = 0.0;
            for (std::size_t k = 0; k < 3; ++k) sum += double{visibility.transform[k][i]} * v[k];
            told[i] = static_cast<float>(sum);
        }
    };
    const bool mirrored = builder::mirrors(visibility.transform);
    turn_back(portal.corner, out.corner);
    turn_back(portal.across, mirrored ? out.up : out.across);
    turn_back(portal.up, mirrored ? out.across : out.up);
    return out;
}

} // namespace acdf::tools
