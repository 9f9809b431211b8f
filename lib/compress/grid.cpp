#include "compress/grid.h"

#include "compress/sum.h"

#include <cstddef>

namespace acdf::compress {
namespace {

/// Of line `line` along the last axis, of `lines`: its measure on the others.
double measure_across(const Grid& grid, std::size_t line, std::size_t lines) {
    double out = 1.0;
    for (std::size_t axis = 0; axis + 1 < grid.dimensions(); ++axis) {
        lines /= grid.shape[axis];
        out *= grid.measure[axis][line / lines % grid.shape[axis]];
    }
    return out;
}

} // namespace

double integral(const Grid& grid) {
    const std::vector<double>& along = grid.measure.back();
    std::size_t lines = 1;
    for (std::size_t axis = 0; axis + 1 < grid.dimensions(); ++axis) lines *= grid.shape[axis];
    Sum total;
    for (std::size_t line = 0; line < lines; ++line) {
        const float* values = grid.values + line * along.size();
        Sum sum;
        for (std::size_t i = 0; i < along.size(); ++i) sum.add(values[i] * along[i]);
        total.add(sum.value() * measure_across(grid, line, lines));
    }
    return total.value();
}

} // namespace acdf::compress
