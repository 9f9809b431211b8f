#include "compress/halvings/sums.h"

#include "compress/halvings/kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

float largest_of(const Grid& grid) {
    std::vector<float> of_row(grid.shape[0]);
    const std::size_t columns = grid.shape[1];
    Loop(false).run(of_row.size(), 16, [&](std::size_t first, std::size_t last, std::size_t) {
        for (std::size_t r = first; r < last; ++r)
            of_row[r] = stretch_of(grid.values + r * columns, columns).largest;
    });
    return *std::max_element(of_row.begin(), of_row.end());
}

} // namespace

float unit_for(float largest) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    const int step = 16 * ((exponent + 1024) / 16) - 1024;
    return std::ldexp(1.0f, std::clamp(31 - step, -126, 126));
}

double peak_of(const float* peaks, const HalvedAxes& axes, HalvedBox box) {
    const std::uint32_t begin = axes.columns.low(box.columns), end = axes.columns.high(box.columns);
    float largest = 0.0f;
    for (std::size_t r = axes.rows.low(box.rows); r < axes.rows.high(box.rows); ++r)
        largest = std::max(largest, stretch_of(peaks + r * axes.columns.steps() + begin, end - begin).largest);
    return double{largest} * axes.measure(box);
}

HalvedSums::SquareRows::SquareRows(const Grid& of)
    : grid(of), unit(unit_for(largest_of(of))), column_measure(of.measure[1].begin(), of.measure[1].end()) {}

const float* HalvedSums::SquareRows::read(std::uint32_t row, std::uint32_t begin, std::uint32_t end,
                                          float* scratch) const {
    squares_of(grid.values + std::size_t{row} * grid.shape[1] + begin, column_measure.data() + begin, end - begin,
               unit, static_cast<float>(grid.measure[0][row]), scratch);
    return scratch;
}

const float* HalvedSums::LeftRows::read(std::uint32_t row, std::uint32_t begin, std::uint32_t end,
                                        float* scratch) const {
    const float* left = grid.left + std::size_t{row} * grid.shape[1];
    for (std::uint32_t c = begin; c < end; ++c) {
        const double of_step = double{left[c]} * grid.measure[0][row] * grid.measure[1][c] * unit;
        scratch[c - begin] = static_cast<float>(std::min(of_step, double{std::numeric_limits<float>::max()}));
    }
    return scratch;
}

HalvedSums::HalvedSums(const Grid& grid, std::size_t most_values)
    : HalvedCosts(axes_), grid_(grid), axes_{HalvedAxis(grid.measure[0]), HalvedAxis(grid.measure[1])},
      square_rows_(grid_), left_rows_(grid_, square_rows_.unit), squares_(axes_, square_rows_, most_values) {
    squares_.mark(0, grid.shape[0]);
    squares_.make(Loop(false));
    if (!grid_.left) return;
    left_.emplace(axes_, left_rows_, most_values);
    left_->mark(0, grid.shape[0]);
    left_->make(Loop(false));
}

float HalvedSums::cost(HalvedBox box) const {
    const float cost = of_square(box, squares_.at(box));
    return left_ ? static_cast<float>(cell_cost(double{cost}, double{left_->at(box)})) : cost;
}

double HalvedSums::weight(HalvedBox box) const {
    return left_ ? grid_.filling->share(alone(box), double{left_->at(box)}) : alone(box);
}

double HalvedSums::peak(HalvedBox box) const {
    if (!(mean_ > 0.0)) return 0.0;
    return peak_of(grid_.peaks ? grid_.peaks : grid_.values, axes_, box) / mean_;
}

} // namespace acdf::compress
