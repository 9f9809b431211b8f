// The cell of an environment that holds a grid square.
#pragma once

#include <acdf/sample.h>

#include <cstdint>

namespace acdf_test {

/// Returns the cell's probability, its box, and the random numbers that lead there.
inline double find_cell(const AcdfEnvironment& env, const std::uint32_t square[2], AcdfRange range[2],
                        AcdfStratum strata[2]) {
    for (int axis = 0; axis < 2; ++axis) strata[axis] = {0.0, 1.0};
    if (!env.halved) {
        acdf_sphere_ranges(env.columns, env.rows, range);
        return acdf_tree_find(env.tree, env.root, square, range, strata);
    }
    AcdfSpan steps[2];
    const double p = acdf_environment_halved_cell(&env, square, steps, range);
    for (int axis = 0; axis < 2; ++axis)
        strata[axis] = {steps[axis].end[0] * 0x1p-31, acdf_span_share(&steps[axis])};
    return p;
}

} // namespace acdf_test
