#include "compress/halvings/fit.h"

#include "compress/fit/refusals.h"
#include "compress/halvings/code_bits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace acdf::compress {
namespace {

class HalvingsFit {
public:
    HalvingsFit(const Target& target, const HalvingsOptions& options)
        : options_(options), sums_(grid_of(target)), integral_(compress::integral(target)),
          mean_square_(target.mean_square > 0.0 ? target.mean_square : integral_ * integral_),
          heaviest_(options.max_weight * (std::sqrt(mean_square_) / integral_)) {}

    Halvings run() {
        Quantised best = search();
        for (int tries = 0; options_.max_weight > 0.0 && weight_of(best) > options_.max_weight; ++tries) {
            const double weight = weight_of(best);
            if (tries == 16) throw out_of_reach("a largest weight", options_.max_weight, weight);
            heaviest_ *= 0.95 * std::min(1.0, options_.max_weight / weight);
            best = search();
        }
        return std::move(best.halvings);
    }

private:
    Quantised search() {
        switch (options_.goal.kind) {
        case Goal::Kind::cells:
            return of_cells();
        case Goal::Kind::budget:
            return of_bytes();
        default:
            return of_variance();
        }
    }

    GrowthLimits limits(std::size_t leaves) const {
        GrowthLimits out;
        out.leaves = leaves;
        out.heaviest = heaviest_;
        out.done = options_.progress;
        return out;
    }

    /// One cell where the map is as even as sums in floats are exact.
    GrownTree grown(GrowthLimits limits) const {
        const double whole = sums_.cost(sums_.whole()) / sums_.unit();
        if (whole * (whole / mean_square_) - 1.0 < kEven) limits.leaves = 1;
        return grow(sums_, integral_, limits);
    }

    Quantised stored(const GrownTree& tree, std::size_t leaves, std::uint32_t code_bits) const {
        return quantise(sums_, tree, leaves, code_bits, options_.max_weight > 0.0 ? integral_ : 0.0);
    }

    /// Relative variance of ideal shares: noise that is relative to the square of the mean of f.
    double ideal_variance(const GrownTree& tree, std::size_t leaves) const {
        const double cost = tree.cost[leaves - 1] / sums_.unit();
        return cost * (cost / mean_square_) - 1.0;
    }
    double variance_of(const Quantised& stored) const {
        return stored.second_moment / sums_.unit() / sums_.unit() / mean_square_ - 1.0;
    }
    /// Over the mean of f / p that a renderer sees.
    double weight_of(const Quantised& stored) const {
        return stored.max_weight * (integral_ / std::sqrt(mean_square_));
    }

    /// Codes of few bits round small shares by a tenth, which a bound on weights does not allow.
    std::vector<std::uint32_t> code_bits_tried() const {
        if (options_.max_weight > 0.0) return {kMostCodeBits};
        return {std::begin(kCodeBits), std::end(kCodeBits)};
    }

    Quantised of_cells() const {
        const GrownTree tree = grown(limits(options_.goal.cells));
        std::uint32_t code_bits = options_.max_weight > 0.0 ? kMostCodeBits : kUsualCodeBits;
        while (code_bits < 10 &&
               ideal_variance(tree, tree.leaves()) < 4.0 * predicted_loss(tree.leaves(), code_bits))
            ++code_bits;
        return stored(tree, tree.leaves(), code_bits);
    }

    Quantised of_bytes() const {
        const std::size_t usual = leaves_within(options_.chunk_bytes, kUsualCodeBits);
        if (leaves_within(options_.chunk_bytes, kMostCodeBits) == 0)
            throw std::runtime_error("no tree fits into the budget");
        const GrownTree tree = grown(limits(std::max<std::size_t>(usual, 1)));
        std::uint32_t best = kMostCodeBits;
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t code_bits : code_bits_tried()) {
            const std::size_t leaves = std::min(leaves_within(options_.chunk_bytes, code_bits), tree.leaves());
            if (leaves == 0) continue;
            const double variance = ideal_variance(tree, leaves) + predicted_loss(leaves, code_bits);
            if (variance >= least) continue;
            least = variance;
            best = code_bits;
        }
        return stored(tree, std::min(leaves_within(options_.chunk_bytes, best), tree.leaves()), best);
    }

    /// Grows until the variance is reached, then looks for the smallest tree of each kind of codes.
    Quantised of_variance() const {
        const double wanted = options_.goal.variance;
        GrowthLimits until = limits(leaves_within(options_.most_bytes, kFewestCodeBits));
        until.cost = std::sqrt((1.0 + 0.98 * wanted) * mean_square_) * sums_.unit();
        until.done = {};
        const GrownTree tree = grown(until);
        Quantised best;
        std::size_t least = std::numeric_limits<std::size_t>::max();
        for (const std::uint32_t code_bits : code_bits_tried()) {
            if (variance_of(stored(tree, tree.leaves(), code_bits)) > wanted) continue;
            Quantised smallest = smallest_of_variance(tree, code_bits);
            const std::size_t bytes = halvings_bytes(smallest.halvings.leaves(), kAxisBits, code_bits);
            if (bytes >= least) continue;
            least = bytes;
            best = std::move(smallest);
        }
        if (best.halvings.axes.empty()) refuse_variance(tree);
        return best;
    }

    Quantised smallest_of_variance(const GrownTree& tree, std::uint32_t code_bits) const {
        std::size_t enough = tree.leaves(), few = 0;
        while (enough > few + 1) {
            const std::size_t middle = few + (enough - few) / 2;
            (reaches_goals(tree, middle, code_bits) ? enough : few) = middle;
        }
        return stored(tree, enough, code_bits);
    }

    /// The first halvings alone may leave boxes heavy that the whole tree halves.
    bool reaches_goals(const GrownTree& tree, std::size_t leaves, std::uint32_t code_bits) const {
        if (ideal_variance(tree, leaves) > options_.goal.variance) return false;
        const Quantised part = stored(tree, leaves, code_bits);
        return variance_of(part) <= options_.goal.variance &&
               (!(options_.max_weight > 0.0) || weight_of(part) <= options_.max_weight);
    }

    [[noreturn]] void refuse_variance(const GrownTree& tree) const {
        const double reached = ideal_variance(tree, tree.leaves());
        if (halvings_bytes(tree.leaves() + 64, kAxisBits, kFewestCodeBits) > options_.most_bytes)
            throw variance_beyond(options_.most_bytes, options_.goal.variance, reached);
        char text[120];
        std::snprintf(text, sizeof text, "a relative variance of %.9g is out of reach: texels alone have %.3g",
                      options_.goal.variance, reached);
        throw std::runtime_error(text);
    }

    const HalvingsOptions& options_;
    HalvedSums sums_;
    double integral_, mean_square_, heaviest_;
};

} // namespace

Halvings fit_halvings(const Target& target, const HalvingsOptions& options) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (options.goal.kind == Goal::Kind::cells && options.goal.cells == 0)
        throw std::invalid_argument("a goal of 0 cells");
    return HalvingsFit(target, options).run();
}

} // namespace acdf::compress
