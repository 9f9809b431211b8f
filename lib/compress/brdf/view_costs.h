// What cells of half-vectors cost the stored views of a BRDF.
#pragma once

#include "compress/brdf/row_mixtures.h"
#include "compress/halvings/costs.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The cost of a cell: the weighted sum over targets of the root of its measure times the integral of their square,
/// as where each target has a row of its own.
class ViewCosts final : public HalvedCosts {
public:
    /// `axes` are those of `grid`, powers of two, and must outlive it.
    ViewCosts(const HalvedAxes& axes, const SharedGrid& grid, const std::vector<SharedTarget>& targets);

    float cost(HalvedBox box) const override;
    double least_square() const override { return least_ * least_; }

    /// The integral of each target's square over a box.
    const float* squares(HalvedBox box) const {
        return sums_.data() + (std::size_t{box.rows} * stride_ + box.columns) * weights_.size();
    }
    using HalvedCosts::squares;
    std::size_t targets() const { return weights_.size(); }
    double weight_of(std::size_t target) const { return double{weights_[target]}; }

private:
    float* squares(std::uint32_t rows, std::uint32_t columns) {
        return sums_.data() + (std::size_t{rows} * stride_ + columns) * weights_.size();
    }
    void add_up(const SharedGrid& grid, const std::vector<SharedTarget>& targets);

    std::size_t stride_;
    std::vector<float> weights_;
    std::vector<float> sums_; ///< of each box, side by side
    double least_ = 0.0;
};

/// The square of a light whose cells cost alone what they cost all targets where these share them: each target
/// counts by what it has around. `costs`: those of the targets.
SharedTarget shared_target(const SharedGrid& grid, const std::vector<SharedTarget>& targets,
                           const ViewCosts& costs);

} // namespace acdf::compress
