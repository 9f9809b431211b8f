// The general tree that minimises the variance for its size: docs/method.md.
//
// A partition is grown far beyond what will be stored, then pruned: at a price per byte, each division stays only
// if it lowers the sum of costs by more than its bytes are worth (Breiman et al. 1984, ch. 3, with bytes for
// leaves). Since growing does not depend on the price, one partition holds the best tree for every size.
#include "compress/fit_tree.h"

#include "compress/partition.h"
#include "compress/polish.h"
#include "compress/prune.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace acdf::compress {
namespace {

constexpr double kNegligible = 1e-14; // of the sum of costs, which is at least 1: rounding, no gain

/// The trees at one price, stored, and what they come to.
struct Candidate {
    double price = 0.0; ///< in units of the sum of costs a byte
    Fitted fitted;
    std::size_t cells = 0;
    double variance = 0.0;   ///< relative variance of the stored density, mean over the bins
    double max_weight = 0.0; ///< the largest f/p over its mean
};

class Search {
public:
    Search(const std::vector<Grid>& bins, const FitOptions& options) : goal_(options.goal), options_(options) {
        dark_axis_ = bins.front().axes.front();
        for (const Grid& bin : bins) {
            const double total = integral(bin);
            if (!(total > 0.0)) { // nothing to sample: a curve that is never entered
                partitions_.emplace_back();
                continue;
            }
            partitions_.emplace_back(Partition(bin, total, first_split(options)));
            const Moments& whole = partitions_.back()->parts().front().moments;
            excess_ += whole.cost() - whole.flux;
            cost_ = std::max(cost_, whole.cost());
        }
        heaviest_ = options.max_weight > 0.0 ? options.max_weight : std::numeric_limits<double>::infinity();
    }

    /// The fit that meets the goal. Where a bound on the weight is broken, by the rounding of probabilities or
    /// because the sum of costs is above 1, it is tightened and the search begins again.
    Fitted run() {
        Candidate best = search();
        for (int tries = 0; options_.max_weight > 0.0 && best.max_weight > options_.max_weight; ++tries) {
            if (tries == 16)
                throw std::runtime_error(out_of_reach("a largest weight", options_.max_weight, best.max_weight));
            heaviest_ *= 0.95 * std::min(1.0, options_.max_weight / best.max_weight);
            best = search();
        }
        progress(1.0);
        return std::move(best.fitted);
    }

private:
    static std::int8_t first_split(const FitOptions& options) {
        if (!options.order) return Part::whole;
        return *options.order == Order::z ? 0 : 1;
    }

    /// Grows the partitions until the best trees for the price of their finest divisions are beyond the goal, or
    /// nothing is left to divide; then moves the price to where the goal is met.
    Candidate search() {
        Candidate candidate = grow();
        progress(0.6);
        if (beyond(candidate)) return bisect(std::move(candidate));
        if (goal_.kind == Goal::Kind::variance)
            throw std::runtime_error(out_of_reach("a relative variance", goal_.variance, candidate.variance));
        return candidate;
    }

    Candidate at(double price) const {
        Candidate out;
        out.price = price;
        std::vector<Pruned> pruned;
        for (const auto& partition : partitions_) {
            pruned.push_back(partition ? prune(partition->parts(), price, heaviest_) : Pruned{});
            out.cells += partition ? pruned.back().cells[0] : 1;
        }
        if (goal_.kind == Goal::Kind::cells && out.cells > goal_.cells) return out;
        store_trees(pruned, out);
        return out;
    }

    void store_trees(const std::vector<Pruned>& pruned, Candidate& out) const {
        Flattened flat;
        for (std::size_t bin = 0; bin < partitions_.size(); ++bin)
            if (partitions_[bin]) {
                flatten(*partitions_[bin], pruned[bin], flat);
                if (!std::isfinite(heaviest_))
                    polish(*partitions_[bin], bin, flat); // moved knots could break a bound
            } else {
                flatten_nothing(dark_axis_, flat);
            }
        // A bound on weights leaves no room for shares much below their probability.
        const double most_ratio = options_.max_weight > 0.0 ? 1.01 : std::numeric_limits<double>::infinity();
        // E[(f/p)^2] is about the square of the sum of costs: a byte is worth twice as much in it. `reach` in
        // encode_tree is a mean over the bins, the price here counts each of them.
        out.fitted.tree = encode_tree(flat.cascade, 2.0 * out.price / double(partitions_.size()), most_ratio);
        std::size_t lit = 0;
        for (std::size_t bin = 0; bin < partitions_.size(); ++bin) {
            if (!partitions_[bin]) continue;
            const StoredQuality quality = stored_quality(flat, bin, out.fitted.tree);
            out.variance += flat.cost[bin] * flat.cost[bin] * quality.excess - 1.0;
            out.max_weight = std::max(out.max_weight, quality.max_weight);
            ++lit;
        }
        if (lit > 0) out.variance /= double(lit);
        out.fitted.cascade = std::move(flat.cascade);
    }

    /// Whether a candidate is larger than the goal lets it be; for a variance, at least as large as needed.
    bool beyond(const Candidate& candidate) const {
        switch (goal_.kind) {
        case Goal::Kind::cells:
            return candidate.cells > goal_.cells;
        case Goal::Kind::budget:
            return size(candidate) > goal_.budget;
        default:
            return candidate.variance <= goal_.variance;
        }
    }

    std::uint64_t size(const Candidate& candidate) const {
        return options_.file_size ? options_.file_size(candidate.fitted.tree) : candidate.fitted.tree.bytes.size();
    }

    std::size_t parts() const {
        std::size_t sum = 0;
        for (const auto& partition : partitions_) sum += partition ? partition->parts().size() : 0;
        return sum;
    }

    Candidate grow() {
        double finest = excess_ / 1024.0;
        for (std::size_t before = 0;; finest *= 0.25) {
            for (auto& partition : partitions_)
                if (partition) partition->refine(finest, heaviest_);
            const bool last = finest < kNegligible;
            if (parts() == before && !last) continue; // nothing new at this price
            before = parts();
            Candidate candidate = at(finest / kLeastBytes);
            if (last || beyond(candidate)) return candidate;
        }
    }

    /// Halves the interval of prices, on a logarithmic scale, until the trees no longer change.
    Candidate bisect(Candidate inside) const {
        Candidate outside = at(std::max(cost_, inside.price)); // as few cells as there can be
        if (beyond(outside)) return goal_.kind == Goal::Kind::variance ? std::move(outside) : fail(outside);
        for (int step = 0; step < 40 && inside.cells > outside.cells + 1; ++step) {
            Candidate middle = at(std::sqrt(inside.price * outside.price));
            (beyond(middle) ? inside : outside) = std::move(middle);
            progress(0.6 + 0.4 * step / 40.0);
        }
        return goal_.kind == Goal::Kind::variance ? std::move(inside) : std::move(outside);
    }

    Candidate fail(const Candidate& smallest) const {
        if (goal_.kind == Goal::Kind::cells)
            throw std::runtime_error(out_of_reach("a number of cells", goal_.cells, double(smallest.cells)));
        throw std::runtime_error(out_of_reach("a size in bytes", double(goal_.budget), double(size(smallest))));
    }

    static std::string out_of_reach(const char* what, double wanted, double best) {
        char text[160];
        std::snprintf(text, sizeof text, "%s of %.9g is out of reach; the least that can be had is %.6g", what,
                      wanted, best);
        return text;
    }

    void progress(double share) const {
        if (options_.progress) options_.progress(share);
    }

    const Goal& goal_;
    const FitOptions& options_;
    std::vector<std::optional<Partition>> partitions_; ///< one a bin, empty where it has no energy
    std::uint32_t dark_axis_ = 0;                      ///< of the curve of a bin without energy
    double excess_ = 0.0, cost_ = 1.0, heaviest_ = 0.0;
};

} // namespace

Fitted fit_trees(const std::vector<Grid>& bins, const FitOptions& options) { return Search(bins, options).run(); }

} // namespace acdf::compress
