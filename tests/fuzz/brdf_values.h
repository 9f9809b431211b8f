// What every BRDF that is read from a file must hold, whatever its bytes were.
#pragma once

#include "input/brdf/brdf.h"
#include "tests/fuzz/require.h"

#include <cmath>

namespace acdf_test {

/// Above, along and below the surface, values are finite and not negative.
inline void require_good(const acdf::input::Brdf& brdf) {
    const double directions[][3] = {
        {0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}, {-0.8, 0.0, 0.6}, {0.0, 1.0, 1e-9}, {0.0, 0.6, -0.8}};
    for (const auto& wo : directions)
        for (const auto& wi : directions) {
            double rgb[3];
            brdf.evaluate(wo, wi, rgb);
            for (const double v : rgb) require(std::isfinite(v) && v >= 0.0);
        }
}

} // namespace acdf_test
