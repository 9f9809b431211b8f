#include "compress/halvings/sums.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace acdf::compress {
namespace {

constexpr double kLargestTotal = 0x1p100; // of all squares: far from overflow, and as far as can be from underflow
constexpr float kLeast = std::numeric_limits<float>::min();

float largest_value(const Grid& grid) {
    const std::size_t columns = grid.shape[1];
    std::vector<float> of_row(grid.shape[0]);
    parallel_for(std::uint32_t{0}, grid.shape[0], [&](std::uint32_t row) {
        const float* values = grid.values + row * columns;
        float largest = 0.0f;
        for (std::size_t c = 0; c < columns; ++c) largest = values[c] > largest ? values[c] : largest;
        of_row[row] = largest;
    });
    return *std::max_element(of_row.begin(), of_row.end());
}

double total(const std::vector<double>& measure) { return std::accumulate(measure.begin(), measure.end(), 0.0); }

double unit_of(const Grid& grid) {
    const double largest = double{largest_value(grid)};
    return largest > 0.0 ? std::sqrt(kLargestTotal / (total(grid.measure[0]) * total(grid.measure[1]))) / largest
                         : 0.0;
}

/// f is multiplied with the root of the measure before it is squared, so that no square overflows.
std::vector<float> roots(const std::vector<double>& measure, double scale) {
    std::vector<float> out;
    for (const double m : measure) out.push_back(static_cast<float>(scale * std::sqrt(m)));
    return out;
}

} // namespace

// ---- tables ----

void HalvedTables::choose_kept(std::size_t most_values) {
    for (std::size_t axis = 0; axis < 2; ++axis) kept_[axis] = axes_[axis].levels();
    while (std::size_t{axes_[0].count(kept_[0])} * axes_[1].count(kept_[1]) > most_values / 4)
        --kept_[kept_[0] >= kept_[1] ? 0 : 1];
    tables_.resize((kept_[0] + 1) * (kept_[1] + 1));
}

double HalvedTables::added(const HalvedBox& box) const {
    const std::uint32_t begin = axes_[1].low(box.level[1], box.index[1]),
                        end = axes_[1].high(box.level[1], box.index[1]);
    std::vector<float> line(end - begin);
    double sum = 0.0;
    for (std::uint32_t r = axes_[0].low(box.level[0], box.index[0]); r < axes_[0].high(box.level[0], box.index[0]);
         ++r) {
        read_(value_, r, begin, end, line.data());
        for (const float value : line) sum += double{value};
    }
    return sum;
}

void HalvedTables::fill_finest() {
    const std::uint32_t rows = axes_[0].count(kept_[0]), columns = axes_[1].count(kept_[1]);
    const std::uint32_t steps = axes_[1].count(axes_[1].levels());
    std::vector<float>& finest = of(kept_[0], kept_[1]);
    finest.resize(std::size_t{rows} * columns);
    if (kept_[0] == axes_[0].levels() && kept_[1] == axes_[1].levels()) {
        parallel_for(std::uint32_t{0}, rows, [&](std::uint32_t r) {
            read_(value_, r, 0, columns, finest.data() + std::size_t{r} * columns);
        });
        return;
    }
    parallel_for(std::uint32_t{0}, rows, [&](std::uint32_t r) {
        std::vector<float> line(steps);
        std::vector<double> sums(columns, 0.0);
        for (std::uint32_t step = axes_[0].low(kept_[0], r); step < axes_[0].high(kept_[0], r); ++step) {
            read_(value_, step, 0, steps, line.data());
            for (std::uint32_t c = 0; c < columns; ++c)
                for (std::uint32_t k = axes_[1].low(kept_[1], c); k < axes_[1].high(kept_[1], c); ++k)
                    sums[c] += double{line[k]};
        }
        for (std::uint32_t c = 0; c < columns; ++c)
            finest[std::size_t{r} * columns + c] = static_cast<float>(sums[c]);
    });
}

void HalvedTables::add_up() {
    for (std::uint32_t level0 = kept_[0]; level0-- > 0;) add_rows(level0);
    parallel_for(std::uint32_t{0}, kept_[0] + 1, [&](std::uint32_t level0) {
        for (std::uint32_t level1 = kept_[1]; level1-- > 0;) add_columns(level0, level1);
    });
}

void HalvedTables::add_rows(std::uint32_t level0) {
    const std::uint32_t rows = axes_[0].count(level0), columns = axes_[1].count(kept_[1]);
    const std::vector<float>& below = of(level0 + 1, kept_[1]);
    std::vector<float>& sums = of(level0, kept_[1]);
    sums.resize(std::size_t{rows} * columns);
    parallel_for(std::uint32_t{0}, rows, [&](std::uint32_t row) {
        const float* lower = below.data() + std::size_t{axes_[0].lower(level0, row)} * columns;
        float* out = sums.data() + std::size_t{row} * columns;
        if (!axes_[0].can_halve(level0, row)) {
            std::copy(lower, lower + columns, out);
            return;
        }
        for (std::uint32_t c = 0; c < columns; ++c) out[c] = lower[c] + lower[c + columns];
    });
}

void HalvedTables::add_columns(std::uint32_t level0, std::uint32_t level1) {
    const std::uint32_t rows = axes_[0].count(level0), columns = axes_[1].count(level1);
    const std::uint32_t columns_below = axes_[1].count(level1 + 1);
    const float* below = of(level0, level1 + 1).data();
    std::vector<float>& sums = of(level0, level1);
    sums.resize(std::size_t{rows} * columns);
    float* out = sums.data();
    if (columns_below == 2 * columns) {
        for (std::size_t i = 0; i < sums.size(); ++i) out[i] = below[2 * i] + below[2 * i + 1];
        return;
    }
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const float* lower = below + std::size_t{row} * columns_below + axes_[1].lower(level1, c);
            *out++ = axes_[1].can_halve(level1, c) ? lower[0] + lower[1] : lower[0];
        }
}

// ---- costs ----

float HalvedSums::Square::operator()(std::uint32_t row, std::uint32_t column) const {
    const float value = grid->values[std::size_t{row} * grid->shape[1] + column];
    const float root = value * row_scale[row] * column_scale[column], square = root * root;
    const float least = value > 0.0f ? kLeast : 0.0f;
    return square > least ? square : least;
}

float HalvedSums::LeftOver::operator()(std::uint32_t row, std::uint32_t column) const {
    const double measure = grid->measure[0][row] * grid->measure[1][column];
    const double left = double{grid->left[std::size_t{row} * grid->shape[1] + column]} * measure * unit;
    return static_cast<float>(std::min(left, double{std::numeric_limits<float>::max()}));
}

HalvedSums::HalvedSums(const Grid& grid, std::size_t most_values)
    : grid_(grid), axes_{HalvedAxis(grid.measure[0]), HalvedAxis(grid.measure[1])},
      unit_(unit_of(grid)), square_{&grid_, roots(grid.measure[0], unit_), roots(grid.measure[1], 1.0)},
      left_over_{&grid_, unit_}, squares_(axes_, most_values, square_) {
    if (grid_.left) left_.emplace_back(axes_, most_values, left_over_);
}

double HalvedSums::peak(const HalvedBox& box) const {
    const float* peaks = grid_.peaks ? grid_.peaks : grid_.values;
    float largest = 0.0f;
    for (std::size_t r = axes_[0].low(box.level[0], box.index[0]); r < axes_[0].high(box.level[0], box.index[0]);
         ++r) {
        const float* row = peaks + r * grid_.shape[1];
        const std::uint32_t end = axes_[1].high(box.level[1], box.index[1]);
        for (std::uint32_t c = axes_[1].low(box.level[1], box.index[1]); c < end; ++c)
            largest = row[c] > largest ? row[c] : largest;
    }
    return double{largest};
}

} // namespace acdf::compress
