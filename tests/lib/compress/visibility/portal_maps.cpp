// Maps of the light that portals face: those that face the same way share one, however a wall stands.
#include "tests/inputs/synthetic.h"

#include "compress/visibility/portal_maps.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace {

using namespace acdf::compress;

using Vector = std::array<double, 3>;

Vector moved(const Vector& from, const Vector& along, double by) {
    return {from[0] + by * along[0], from[1] + by * along[1], from[2] + by * along[2]};
}

TEST(PortalMaps, AreSharedInWallsThatStandAskew) {
    const Target sky = acdf_test::texel_target(16, 8, [](std::uint32_t, std::uint32_t) { return 1.0; });
    for (int turn = 0; turn < 12; ++turn) {
        const double phi = 0.1 + 0.5 * turn, slope = 0.03 * turn;
        const Vector across{-std::sin(phi), std::cos(phi), 0.0};
        const Vector up{-std::sin(slope) * std::cos(phi), -std::sin(slope) * std::sin(phi), std::cos(slope)};
        const Vector corner{2.0 * std::cos(phi), 2.0 * std::sin(phi), 1.0};
        const PortalRectangle one{corner, across, up},
            other{moved(corner, across, 3.0), up, moved({}, across, -1.5)};
        const PortalSet made = make_portals(sky, {one, other, one}, 1 << 16);
        EXPECT_EQ(made.maps.size(), 1u) << turn;
        ASSERT_EQ(made.portals.size(), 3u);
        EXPECT_FLOAT_EQ(made.portals[1].sides[0], 1.5f);
    }
}

} // namespace
