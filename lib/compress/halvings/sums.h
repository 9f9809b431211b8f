// What cells of a grid of two axes cost.
#pragma once

#include "compress/grid.h"
#include "compress/halvings/costs.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace acdf::compress {

/// Makes the largest light lie in [2^30, 2^46): no square overflows, and few are lost. A power of two, in steps of
/// 2^16, so that a frame that is a little brighter has the same.
float unit_for(float largest);

/// The largest f of each texel, which `peaks` or else values have.
inline const float* peaks_of(const Target& target) {
    return (target.peaks.empty() ? target.values : target.peaks).data();
}
/// The largest of `peaks`, one a step, in a box, times its measure.
double peak_of(const float* peaks, const HalvedAxes& axes, HalvedBox box);

/// Costs of a grid (PAPER.md §5; beside an MIS partner compress/partner.h).
class HalvedSums final : public HalvedCosts {
public:
    /// Tables have at most about `most_values` numbers.
    explicit HalvedSums(const Grid& grid, std::size_t most_values = std::size_t{1} << 26);

    float cost(HalvedBox box) const override;
    double weight(HalvedBox box) const override;
    double alone(HalvedBox box) const override { return double{of_square(box, squares_.at(box))}; }
    double peak(HalvedBox box) const override;
    const HalvedTable* squares() const override { return left_ ? nullptr : &squares_; }
    double least_square() const override { return least_square_; }

    /// Of the integral that noise is relative to.
    void set_mean_square(double square) { least_square_ = square * unit() * unit(); }
    /// The integral that peak() is over; peaks are 0 without.
    void set_mean(double mean) { mean_ = mean; }
    /// What f was multiplied with.
    double unit() const { return double{square_rows_.unit}; }

private:
    struct SquareRows final : HalvedRows {
        explicit SquareRows(const Grid& grid);
        const float* read(std::uint32_t row, std::uint32_t begin, std::uint32_t end, float* scratch) const override;

        const Grid& grid;
        float unit;
        std::vector<float> column_measure;
    };
    struct LeftRows final : HalvedRows {
        LeftRows(const Grid& grid, float unit) : grid(grid), unit(double{unit}) {}
        const float* read(std::uint32_t row, std::uint32_t begin, std::uint32_t end, float* scratch) const override;

        const Grid& grid;
        double unit;
    };

    const Grid grid_;
    const HalvedAxes axes_;
    SquareRows square_rows_;
    LeftRows left_rows_;
    HalvedTable squares_;
    std::optional<HalvedTable> left_; ///< light that the partner leaves over
    double least_square_ = 0.0, mean_ = 0.0;
};

} // namespace acdf::compress
