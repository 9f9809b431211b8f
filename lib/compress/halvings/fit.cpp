#include "compress/halvings/fit.h"

#include "compress/fit/refusals.h"
#include "compress/halvings/code_bits.h"
#include "compress/halvings/coder.h"
#include "compress/halvings/sums.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace acdf::compress {
namespace {

constexpr float kAlike = 0.99f; // of a round: the tree is nearly the one that halves one leaf after the other

class HalvingsFit {
public:
    HalvingsFit(const Target& target, const HalvingsOptions& options)
        : options_(options), sums_(grid_of(target)),
          coder_({target.row_axis, target.column_axis}, is_bounded() ? 1 : kStepsOfFloats),
          heaviest_(options.max_weight), texels_(std::size_t{target.rows} * target.columns) {
        const double integral = compress::integral(target);
        const double mean_square = target.mean_square > 0.0 ? target.mean_square : integral * integral;
        sums_.set_mean_square(mean_square);
        if (is_bounded()) sums_.set_mean(std::sqrt(mean_square));
    }

    Halvings run() {
        Halvings best = search();
        for (int tries = 0; is_bounded() && coder_.max_weight() > options_.max_weight; ++tries) {
            const double weight = coder_.max_weight();
            if (tries == 16) throw out_of_reach("a largest weight", options_.max_weight, weight);
            heaviest_ *= 0.95 * std::min(1.0, options_.max_weight / weight);
            best = search();
        }
        return best;
    }

private:
    Halvings search() {
        switch (options_.goal.kind) {
        case Goal::Kind::cells:
            return of_cells();
        case Goal::Kind::budget:
            return of_bytes();
        default:
            return of_variance();
        }
    }

    /// A bound on weights needs the smallest shares as they are: all 31 bits of random numbers.
    bool is_bounded() const { return options_.max_weight > 0.0; }

    HalvedGrowth grown(TreeSize size, const Progress& progress, double enough = 0.0) const {
        size.leaves = std::min(size.leaves, texels_);
        HalvedGrowth out({size}, {kAlike, enough, heaviest_});
        out.run(sums_, Loop(false), progress);
        return out;
    }

    /// Relative variance of ideal shares: noise that is relative to the square of the mean of f.
    double ideal_variance(const HalvedGrowth& tree, std::size_t leaves) const {
        return sums_.variance(tree.cost(leaves));
    }

    /// Codes of few bits round small shares by a tenth, which a bound on weights does not allow.
    std::vector<std::uint32_t> code_bits_tried() const {
        if (is_bounded()) return {kMostCodeBits};
        return {std::begin(kCodeBits), std::end(kCodeBits)};
    }

    Halvings of_cells() {
        const HalvedGrowth tree = grown({kUsualCodeBits, options_.goal.cells}, options_.progress);
        const std::uint32_t code_bits =
            is_bounded() ? kMostCodeBits : enough_code_bits(tree.leaves(), ideal_variance(tree, tree.leaves()));
        return coder_.code(sums_, tree, tree.leaves(), code_bits);
    }

    Halvings of_bytes() {
        const std::vector<TreeSize> sizes = sizes_within(options_.chunk_bytes, code_bits_tried());
        if (sizes.empty()) throw std::runtime_error("no tree fits into the budget");
        const HalvedGrowth tree = grown(sizes.back(), options_.progress);
        TreeSize best = sizes.front();
        double least = std::numeric_limits<double>::infinity();
        for (TreeSize size : sizes) {
            size.leaves = std::min(size.leaves, tree.leaves());
            const double variance = ideal_variance(tree, size.leaves) + predicted_loss(size.leaves, size.code_bits);
            if (variance >= least) continue;
            least = variance;
            best = size;
        }
        return coder_.code(sums_, tree, best.leaves, best.code_bits);
    }

    /// Grows until the variance is reached, then looks for the smallest tree of each kind of codes.
    Halvings of_variance() {
        const double wanted = options_.goal.variance;
        const double enough = std::sqrt((1.0 + 0.98 * wanted) * sums_.least_square());
        const HalvedGrowth tree =
            grown({kUsualCodeBits, leaves_within(options_.most_bytes, kFewestCodeBits)}, {}, enough);
        Halvings best;
        std::size_t least = std::numeric_limits<std::size_t>::max();
        for (const std::uint32_t code_bits : code_bits_tried()) {
            coder_.code(sums_, tree, tree.leaves(), code_bits);
            if (coder_.relative_variance() > wanted) continue;
            const std::size_t leaves = fewest_of_variance(tree, code_bits);
            const std::size_t bytes = halvings_bytes(leaves, kAxisBits, code_bits);
            if (bytes >= least) continue;
            least = bytes;
            best = coder_.code(sums_, tree, leaves, code_bits);
        }
        if (best.axes.empty()) refuse_variance(tree);
        return best;
    }

    std::size_t fewest_of_variance(const HalvedGrowth& tree, std::uint32_t code_bits) {
        std::size_t enough = tree.leaves(), few = 0;
        while (enough > few + 1) {
            const std::size_t middle = few + (enough - few) / 2;
            (reaches_goals(tree, middle, code_bits) ? enough : few) = middle;
        }
        return enough;
    }

    /// The first halvings alone may leave boxes heavy that the whole tree halves.
    bool reaches_goals(const HalvedGrowth& tree, std::size_t leaves, std::uint32_t code_bits) {
        if (ideal_variance(tree, leaves) > options_.goal.variance) return false;
        coder_.code(sums_, tree, leaves, code_bits);
        return coder_.relative_variance() <= options_.goal.variance &&
               (!is_bounded() || coder_.max_weight() <= options_.max_weight);
    }

    [[noreturn]] void refuse_variance(const HalvedGrowth& tree) const {
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
    TreeCoder coder_;
    double heaviest_;
    std::size_t texels_;
};

} // namespace

Halvings fit_halvings(const Target& target, const HalvingsOptions& options) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (options.goal.kind == Goal::Kind::cells && options.goal.cells == 0)
        throw std::invalid_argument("a goal of 0 cells");
    return HalvingsFit(target, options).run();
}

} // namespace acdf::compress
