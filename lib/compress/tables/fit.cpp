#include "compress/tables/fit.h"

#include "compress/fit/refusals.h"
#include "compress/halvings/code_bits.h"
#include "compress/tables/coder.h"
#include "compress/tables/growth.h"
#include "compress/tables/order.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>

namespace acdf::compress {
namespace {

class TableFit {
public:
    TableFit(const std::vector<Grid>& bins, const TableFitOptions& options)
        : bins_(bins), options_(options), heaviest_(options.max_weight) {
        for (const std::uint32_t bits : kCodeBits)
            if (!is_bounded() || bits == kMostCodeBits) codes_.emplace_back(bits);
    }

    TableTrees run() {
        for (int tries = 0;; ++tries) {
            double weight = 0.0;
            TableTrees out = search(weight);
            if (!is_bounded() || weight <= options_.max_weight) return out;
            if (tries == 16) throw out_of_reach("a largest weight", options_.max_weight, weight);
            heaviest_ *= 0.95 * std::min(1.0, options_.max_weight / weight);
        }
    }

private:
    /// A bound on weights needs small shares as they are: all bits of random numbers, and codes that round little.
    bool is_bounded() const { return options_.max_weight > 0.0; }

    TableTrees search(double& weight) {
        const TableCosts costs(bins_, heaviest_);
        if (costs.trees() == 0) throw std::invalid_argument("a table without energy");
        const TableOrder order = grown(costs);
        TableCoder coder(costs, order);
        const Choice best = choose(costs, order, coder);
        TableTrees out;
        out.halvings = coder.code(best.leaves, *best.codes);
        out.roots.assign(bins_.size(), ACDF_NO_ROOT);
        for (std::size_t tree = 0; tree < costs.trees(); ++tree)
            out.roots[costs.bin_of(tree)] = coder.roots()[tree];
        weight = coder.max_weight();
        return out;
    }

    std::size_t leaves_in(const TableCosts& costs, std::uint64_t bytes, std::uint32_t code_bits) const {
        return leaves_within(bytes, code_bits, axis_bits_for(costs.axes()), costs.trees());
    }

    /// The most leaves that the goal lets trees have.
    std::size_t most_leaves(const TableCosts& costs) const {
        std::size_t most = options_.goal.cells;
        if (options_.goal.kind == Goal::Kind::variance)
            most = leaves_in(costs, options_.most_bytes, kFewestCodeBits);
        if (options_.goal.kind == Goal::Kind::budget) {
            most = 0;
            for (const HalvingCodes& codes : codes_)
                most = std::max(most, leaves_in(costs, options_.chunk_bytes, codes.bits()));
            if (most == 0) throw std::runtime_error("no tree fits into the budget");
        }
        return std::min(most, costs.numbers());
    }

    /// Trees with more leaves than there may be, so that those that hardly pay are left out.
    TableOrder grown(const TableCosts& costs) const {
        const bool of_variance = options_.goal.kind == Goal::Kind::variance;
        std::size_t most = most_leaves(costs);
        TableGrowth growth(costs);
        if (of_variance) {
            growth.run(most, options_.goal.variance, options_.progress);
            most = std::min(most, growth.leaves());
        }
        growth.run(most + most / 2, -1.0, of_variance ? Progress() : options_.progress);
        return TableOrder(growth, costs.trees());
    }

    /// Trees of so many leaves.
    struct Choice {
        const HalvingCodes* codes = nullptr;
        std::size_t leaves = 0;
    };

    Choice choose(const TableCosts& costs, const TableOrder& order, TableCoder& coder) const {
        if (options_.goal.kind == Goal::Kind::budget) return of_bytes(costs, order, coder);
        if (options_.goal.kind == Goal::Kind::variance) return of_variance(costs, order, coder);
        const std::size_t leaves =
            std::min<std::size_t>(std::max<std::size_t>(options_.goal.cells, costs.trees()), order.leaves());
        const std::uint32_t bits = enough_code_bits(leaves / costs.trees(), order.variance(leaves));
        return {is_bounded() ? &codes_.back() : codes_of(bits), leaves};
    }

    /// Beside an MIS partner, whose noise shares do not tell, what rounding to codes is known to add.
    static double variance_of(const TableCosts& costs, const TableOrder& order, TableCoder& coder,
                              const Choice& choice) {
        if (costs.has_partner())
            return order.variance(choice.leaves) +
                   predicted_loss(choice.leaves / costs.trees(), choice.codes->bits());
        coder.code(choice.leaves, *choice.codes);
        return coder.relative_variance();
    }

    Choice of_bytes(const TableCosts& costs, const TableOrder& order, TableCoder& coder) const {
        double least = std::numeric_limits<double>::infinity();
        Choice best;
        for (const HalvingCodes& codes : codes_) {
            const Choice choice = {&codes,
                                   std::min(leaves_in(costs, options_.chunk_bytes, codes.bits()), order.leaves())};
            if (choice.leaves == 0) continue;
            const double variance = variance_of(costs, order, coder, choice);
            if (variance >= least) continue;
            least = variance;
            best = choice;
        }
        return best;
    }

    /// The smallest of the smallest trees of each kind of codes.
    Choice of_variance(const TableCosts& costs, const TableOrder& order, TableCoder& coder) const {
        std::size_t least = options_.most_bytes + 1;
        Choice best;
        for (const HalvingCodes& codes : codes_) {
            if (!reaches_goals(order, coder, order.leaves(), codes)) continue;
            const std::size_t few = fewest_leaves(costs, order, coder, codes);
            const std::size_t bytes = halvings_bytes(few, axis_bits_for(costs.axes()), codes.bits(), costs.trees());
            if (bytes >= least) continue;
            least = bytes;
            best = {&codes, few};
        }
        if (!best.codes) refuse_variance(costs, order);
        return best;
    }

    /// The first halvings alone may leave boxes heavy that the whole trees halve.
    bool reaches_goals(const TableOrder& order, TableCoder& coder, std::size_t leaves,
                       const HalvingCodes& codes) const {
        if (order.variance(leaves) > options_.goal.variance) return false;
        coder.code(leaves, codes);
        return coder.relative_variance() <= options_.goal.variance &&
               (!is_bounded() || leaves == order.leaves() || coder.max_weight() <= options_.max_weight);
    }

    std::size_t fewest_leaves(const TableCosts& costs, const TableOrder& order, TableCoder& coder,
                              const HalvingCodes& codes) const {
        std::size_t enough = order.leaves(), few = costs.trees() - 1;
        while (enough > few + 1) {
            const std::size_t middle = few + (enough - few) / 2;
            (reaches_goals(order, coder, middle, codes) ? enough : few) = middle;
        }
        return enough;
    }

    [[noreturn]] void refuse_variance(const TableCosts& costs, const TableOrder& order) const {
        const double reached = order.variance(order.leaves());
        if (order.leaves() > leaves_in(costs, options_.most_bytes, kMostCodeBits))
            throw variance_beyond(options_.most_bytes, options_.goal.variance, reached);
        throw out_of_reach("a relative variance", options_.goal.variance, reached);
    }

    const HalvingCodes* codes_of(std::uint32_t bits) const {
        return &*std::find_if(codes_.begin(), codes_.end(),
                              [&](const HalvingCodes& codes) { return codes.bits() == bits; });
    }

    const std::vector<Grid>& bins_;
    const TableFitOptions& options_;
    std::vector<HalvingCodes> codes_;
    double heaviest_;
};

} // namespace

TableTrees fit_table(const std::vector<Grid>& bins, const TableFitOptions& options) {
    if (options.goal.kind == Goal::Kind::cells && options.goal.cells == 0)
        throw std::invalid_argument("a goal of 0 cells");
    return TableFit(bins, options).run();
}

TableTrees whole_cells(const std::vector<float>& shares) {
    TableTrees out;
    for (const float share : shares)
        if (share > 0.0f) out.halvings.axes.push_back(-1);
    out.roots.assign(shares.size(), ACDF_NO_ROOT);
    return out;
}

} // namespace acdf::compress
