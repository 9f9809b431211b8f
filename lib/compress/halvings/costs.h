// What leaves of a tree of halvings cost.
#pragma once

#include "compress/halvings/table.h"

#include <cmath>

namespace acdf::compress {

/// Costs of boxes of a grid, of which growth makes the sum small (PAPER.md §5).
class HalvedCosts {
public:
    explicit HalvedCosts(const HalvedAxes& axes) : axes_(axes) {}
    HalvedCosts(const HalvedCosts&) = delete;
    HalvedCosts& operator=(const HalvedCosts&) = delete;
    virtual ~HalvedCosts() = default;

    const HalvedAxes& axes() const { return axes_; }
    /// What a box costs as a leaf.
    virtual float cost(HalvedBox box) const = 0;
    /// The share of samples that it should get, in proportion.
    virtual double weight(HalvedBox box) const { return double{cost(box)}; }
    /// Root of a box's measure times the integral of the square of f: positive where f is.
    virtual double alone(HalvedBox box) const { return double{cost(box)}; }
    /// The largest f in a box times its measure, over its integral; 0 where nobody asks.
    virtual double peak(HalvedBox) const { return 0.0; }
    /// Where the cost of a box is the root of its measure times an integral: the table of those.
    virtual const HalvedTable* squares() const { return nullptr; }
    /// Square of the least that all leaves together can cost.
    virtual double least_square() const = 0;

    /// Relative variance of one sample where leaves together cost so much and have shares in proportion.
    double variance(double total) const { return total * (total / least_square()) - 1.0; }

protected:
    float of_square(HalvedBox box, float square) const {
        return axes_.rows.root(box.rows) * axes_.columns.root(box.columns) * std::sqrt(square);
    }

private:
    const HalvedAxes& axes_;
};

} // namespace acdf::compress
