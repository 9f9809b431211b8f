// Boxes of texels: no direction in one is farther from its centre than it says.
#include "tests/inputs/synthetic.h"

#include "compress/boxes.h"
#include "compress/local/light.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace acdf::compress;

void expect_within(const Target& target, const Box& box) {
    const auto middle = centre(target, box);
    const double reach = radius(target, box);
    double most = 0.0;
    for (int y = 0; y <= 20; ++y)
        for (int x = 0; x <= 20; ++x) {
            const auto d = direction_at(target, box.begin[0] + y / 20.0 * box.length(0),
                                        box.begin[1] + x / 20.0 * box.length(1));
            most = std::max(most, std::hypot(d[0] - middle[0], d[1] - middle[1], d[2] - middle[2]));
        }
    ASSERT_LE(most, reach + 1e-9);
    ASSERT_LE(reach, most + 0.25); // it is about that of some direction in the box
}

TEST(Boxes, RadiusIsThatOfTheFarthestDirection) {
    std::mt19937_64 random(4);
    for (const bool square : {false, true}) {
        const Target target =
            empty_target(24, square ? 24 : 12, square ? ACDF_PARAM_OCTAHEDRAL : ACDF_PARAM_LATLONG);
        for (int i = 0; i < 1000; ++i) {
            Box box;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                const std::uint32_t size = axis == 0 ? target.rows : target.columns;
                box.begin[axis] = static_cast<std::uint32_t>(random() % size);
                box.end[axis] =
                    box.begin[axis] + 1 + static_cast<std::uint32_t>(random() % (size - box.begin[axis]));
            }
            expect_within(target, box);
        }
    }
}

} // namespace
