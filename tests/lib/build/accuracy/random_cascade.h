// Random cascades of any shape, for comparing sums with quadratures.
#pragma once

#include "tests/inputs/synthetic.h"

#include "compress/cascade.h"

#include <algorithm>

namespace acdf_test {

class RandomCascade {
public:
    RandomCascade(std::uint64_t seed, double tilt, int depth) : random_(seed), tilt_(tilt), depth_(depth) {}

    acdf::compress::Cascade make(std::uint32_t columns, std::uint32_t rows) {
        grow({{0, 0}, {columns, rows}, {true, true}}, 0);
        cascade_.roots = {0};
        return cascade_;
    }

private:
    /// A rectangle, and which axes may still be split: below a tilt none of the same axis.
    struct Part {
        std::uint32_t low[2], high[2];
        bool splits[2];
    };

    /// Adds a curve over `part` and, at random, curves below its segments. Returns its index.
    std::int32_t grow(const Part& part, int depth) {
        const std::size_t index = cascade_.curves.size();
        cascade_.curves.emplace_back();
        acdf::compress::Curve curve;
        curve.axis = static_cast<std::uint32_t>(random_() % 2);
        if (!part.splits[curve.axis]) curve.axis = 1 - curve.axis;
        for (std::uint32_t x = part.low[curve.axis] + 1; x < part.high[curve.axis]; ++x)
            if (uniform(random_) < 0.4) curve.knots.push_back(x);
        double sum = 0.0;
        for (std::size_t s = 0; s < curve.segments(); ++s) {
            curve.probability.push_back(0.05 + uniform(random_));
            sum += curve.probability.back();
        }
        for (double& p : curve.probability) p /= sum;
        for (std::size_t s = 0; tilt_ > 0.0 && s < curve.segments(); ++s)
            curve.tilts.push_back(tilt_ * (2.0 * uniform(random_) - 1.0));
        for (std::size_t s = 0; s < curve.segments(); ++s) {
            Part child = part;
            if (s > 0) child.low[curve.axis] = curve.knots[s - 1];
            if (s < curve.knots.size()) child.high[curve.axis] = curve.knots[s];
            if (tilt_ > 0.0) child.splits[curve.axis] = false;
            const bool ends =
                depth + 1 >= depth_ || (!child.splits[0] && !child.splits[1]) || uniform(random_) < 0.3;
            curve.children.push_back(ends ? -1 : grow(child, depth + 1));
        }
        cascade_.curves[index] = std::move(curve);
        return static_cast<std::int32_t>(index);
    }

    std::mt19937_64 random_;
    double tilt_;
    int depth_;
    acdf::compress::Cascade cascade_;
};

} // namespace acdf_test
