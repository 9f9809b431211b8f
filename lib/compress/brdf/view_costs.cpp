#include "compress/brdf/view_costs.h"

#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kAround = 8; // squares of each axis

/// Squares around one, as a box.
HalvedBox around(const SharedGrid& grid, std::uint32_t row, std::uint32_t column) {
    return {std::max((grid.rows() + row) / kAround, 1u), std::max((grid.columns() + column) / kAround, 1u)};
}

} // namespace

ViewCosts::ViewCosts(const HalvedAxes& axes, const SharedGrid& grid, const std::vector<SharedTarget>& targets)
    : HalvedCosts(axes), stride_(std::size_t{2} * grid.columns()),
      sums_(std::size_t{2} * grid.rows() * stride_ * targets.size()) {
    for (const SharedTarget& target : targets) weights_.push_back(static_cast<float>(target.weight));
    add_up(grid, targets);
    std::vector<double> least(grid.rows(), 0.0);
    parallel_for(std::size_t{0}, least.size(), [&](std::size_t r) {
        for (std::uint32_t c = 0; c < grid.columns(); ++c)
            least[r] += double{cost({grid.rows() + static_cast<std::uint32_t>(r), grid.columns() + c})};
    });
    least_ = std::accumulate(least.begin(), least.end(), 0.0);
}

void ViewCosts::add_up(const SharedGrid& grid, const std::vector<SharedTarget>& targets) {
    const std::uint32_t rows = grid.rows(), columns = grid.columns();
    const std::size_t count = targets.size();
    parallel_for(std::size_t{0}, std::size_t{rows}, [&](std::size_t row) {
        const auto r = static_cast<std::uint32_t>(row);
        for (std::uint32_t c = 0; c < columns; ++c) {
            float* out = squares(rows + r, columns + c);
            const auto measure = static_cast<float>(grid.row_measure[r] * grid.column_measure[c]);
            for (std::size_t t = 0; t < count; ++t) out[t] = targets[t].square[row * columns + c] * measure;
        }
        for (std::uint32_t c = columns; c-- > 1;) {
            float* out = squares(rows + r, c);
            const float *lower = squares(rows + r, 2 * c), *upper = lower + count;
            for (std::size_t t = 0; t < count; ++t) out[t] = lower[t] + upper[t];
        }
    });
    const std::size_t whole = stride_ * count;
    for (std::uint32_t r = rows; r-- > 1;) {
        float* out = squares(r, 0);
        const float *lower = squares(2 * r, 0), *upper = lower + whole;
        for (std::size_t i = 0; i < whole; ++i) out[i] = lower[i] + upper[i];
    }
}

float ViewCosts::cost(HalvedBox box) const {
    const float* of = squares(box);
    float sum = 0.0f;
    for (std::size_t t = 0; t < weights_.size(); ++t) sum += weights_[t] * std::sqrt(of[t]);
    return sum * axes().rows.root(box.rows) * axes().columns.root(box.columns);
}

SharedTarget shared_target(const SharedGrid& grid, const std::vector<SharedTarget>& targets,
                           const ViewCosts& costs) {
    SharedTarget out;
    out.square.assign(grid.size(), 0.0f);
    parallel_for(std::size_t{0}, std::size_t{grid.rows()}, [&](std::size_t row) {
        const auto r = static_cast<std::uint32_t>(row);
        for (std::uint32_t c = 0; c < grid.columns(); ++c) {
            const HalvedBox box = around(grid, r, c);
            const double measure = costs.axes().measure(box);
            const float* of = costs.squares(box);
            double sum = 0.0, square = 0.0;
            for (std::size_t t = 0; t < targets.size(); ++t) {
                const double mean = std::sqrt(double{of[t]} / measure);
                if (!(mean > 0.0)) continue;
                sum += targets[t].weight * mean;
                square += targets[t].weight * double{targets[t].square[row * grid.columns() + c]} / mean;
            }
            out.square[row * grid.columns() + c] = static_cast<float>(sum * square);
        }
    });
    return out;
}

} // namespace acdf::compress
