// The general tree that minimises the variance for its size: docs/method.md.
//
// A partition is grown far beyond what will be stored, then pruned: at a price per byte, each division stays only
// if it lowers the sum of costs by more than its bytes are worth (Breiman et al. 1984, ch. 3, with bytes for
// leaves). Since growing does not depend on the price, one partition holds the best tree for every size.
#include "compress/fit/tree.h"

#include "compress/fit/partition.h"
#include "compress/fit/polish.h"
#include "compress/fit/prune.h"
#include "compress/fit/refusals.h"
#include "compress/fit/tree_size.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint64_t kCellBytes = 4;      // about
constexpr std::uint64_t kFewParts = 1 << 16; // of a hundred bytes
constexpr double kNegligible = 1e-14;        // of the sum of costs, which is at least 1: rounding, no gain

/// The trees at one price.
struct Trial {
    double price = 0.0;    ///< in units of the sum of costs a byte
    std::size_t cells = 0; ///< in all bins
    bool beyond = false;   ///< they are larger than the goal lets them be; for a variance, as large as needed
    SizedTree tree;        ///< where its size counts
};

/// The same, stored, and what they come to.
struct Candidate {
    Fitted fitted;
    double variance = 0.0;   ///< relative variance of the stored pdf, mean over the bins
    double max_weight = 0.0; ///< the largest f/p over its mean
};

class TreeSearch {
public:
    TreeSearch(const std::vector<Grid>& bins, const FitOptions& options)
        : goal_(options.goal), options_(options), sizer_(bins.size(), most_ratio(options)) {
        dark_axis_ = bins.front().axes.front();
        for (const Grid& bin : bins) {
            const double total = integral(bin);
            if (!(total > 0.0)) { // nothing to sample: a curve that is never entered
                partitions_.emplace_back();
                continue;
            }
            partitions_.emplace_back(Partition(bin, total, first_split(options)));
            const Moments& whole = partitions_.back()->parts().front().moments;
            ++lit_;
            excess_ += whole.cost() - whole.flux;
            cost_ = std::max(cost_, whole.cost());
        }
        heaviest_ = options.max_weight > 0.0 ? options.max_weight : std::numeric_limits<double>::infinity();
    }

    /// The fit that meets the goal. Where a bound on the weight is broken, by the rounding of probabilities or
    /// because the sum of costs is above 1, it is tightened and the search begins again.
    Fitted run() {
        Candidate best = store_trees(search());
        for (int tries = 0; options_.max_weight > 0.0 && best.max_weight > options_.max_weight; ++tries) {
            if (tries == 16) throw out_of_reach("a largest weight", options_.max_weight, best.max_weight);
            heaviest_ *= 0.95 * std::min(1.0, options_.max_weight / best.max_weight);
            best = store_trees(search());
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
    /// nothing is left to divide; then moves the price to where the goal is met, and returns it.
    double search() {
        Trial grown = grow();
        progress(0.6);
        if (grown.beyond) {
            forget(grown.price);
            grown.tree = {}; // of other partitions
            return bisect(std::move(grown));
        }
        if (goal_.kind == Goal::Kind::variance)
            throw out_of_reach("a relative variance", goal_.variance, store_trees(grown.price).variance);
        return grown.price;
    }

    /// What pruning looks at, of the partitions as they are.
    void look_at_partitions() {
        sizer_.forget();
        nodes_.clear();
        begins_.clear();
        for (const auto& partition : partitions_) {
            nodes_.push_back(partition ? prune_nodes(partition->parts(), heaviest_, partition->grid().filling)
                                       : PruneNodes{});
            begins_.push_back(partition ? begins_of(partition->parts()) : std::vector<std::uint32_t>{});
        }
    }

    std::vector<Pruned> pruned(double price) const {
        std::vector<Pruned> out;
        for (const PruneNodes& nodes : nodes_) out.push_back(prune(nodes, price));
        return out;
    }

    /// Trees that are not made here are those of one of `known`.
    Trial at(double price, const std::vector<const Trial*>& known = {}) {
        Trial out;
        out.price = price;
        const std::vector<Pruned> trees = pruned(price);
        for (const Pruned& tree : trees) out.cells += tree.cells.empty() ? 1 : tree.cells[0];
        if (goal_.kind == Goal::Kind::cells) out.beyond = out.cells > goal_.cells;
        else if (polished()) out.beyond = beyond(store_trees(trees, price)); // its knots are not the partition's
        else if (goal_.kind == Goal::Kind::variance && short_of_variance(trees)) out.beyond = false;
        else out.beyond = sized_beyond(trees, known, out);
        return out;
    }

    /// Whether the cells alone, whatever is stored, miss the variance: rounding can only raise it.
    bool short_of_variance(const std::vector<Pruned>& trees) const {
        double variance = 0.0;
        for (std::size_t bin = 0; bin < trees.size(); ++bin) {
            if (!partitions_[bin]) continue;
            const double cost = shares_below(nodes_[bin], trees[bin])[0];
            variance += cost * cost - 1.0;
        }
        return variance > (goal_.variance * (1.0 + 1e-9) + 1e-9) * double(lit_);
    }

    bool sized_beyond(const std::vector<Pruned>& trees, const std::vector<const Trial*>& known, Trial& out) {
        std::vector<PrunedBin> bins;
        for (std::size_t bin = 0; bin < trees.size(); ++bin)
            bins.push_back({&nodes_[bin], &begins_[bin], &trees[bin]});
        std::vector<const SizedTree*> known_trees;
        for (const Trial* trial : known) known_trees.push_back(&trial->tree);
        out.tree = sizer_.tree(bins, stored_price(out.price), known_trees);
        for (const Trial* trial : known)
            if (trial->tree == out.tree) return trial->beyond;
        if (goal_.kind == Goal::Kind::budget && !options_.cascade_size &&
            (!options_.file_size || options_.size_by_length))
            return file_size_of_length(sizer_.bytes(out.tree)) > goal_.budget;
        return beyond(store_trees(trees, out.price));
    }

    std::uint64_t file_size_of_length(std::uint64_t bytes) const {
        if (!options_.file_size) return bytes;
        EncodedTree tree;
        tree.bytes.resize(bytes);
        tree.roots.resize(partitions_.size());
        return options_.file_size(tree);
    }

    /// Knots of a line are moved to better positions, unless that could break a bound on weights.
    bool polished() const {
        return !std::isfinite(heaviest_) && !beside_partner() &&
               std::any_of(partitions_.begin(), partitions_.end(),
                           [](const auto& partition) { return partition && partition->grid().dimensions() == 1; });
    }

    bool beside_partner() const {
        return std::any_of(partitions_.begin(), partitions_.end(),
                           [](const auto& partition) { return partition && partition->grid().filling; });
    }

    /// E[(f/p)^2] is about the square of the sum of costs: a byte is worth twice as much in it. `reach` in
    /// encode_tree is a mean over the bins, the price of a trial counts each of them.
    double stored_price(double price) const { return 2.0 * price / double(partitions_.size()); }

    Candidate store_trees(double price) const { return store_trees(pruned(price), price); }

    Candidate store_trees(const std::vector<Pruned>& trees, double price) const {
        Flattened flat;
        Candidate out;
        for (std::size_t bin = 0; bin < partitions_.size(); ++bin)
            if (partitions_[bin]) {
                flatten(*partitions_[bin], trees[bin], flat);
                if (!std::isfinite(heaviest_) && !beside_partner()) polish(*partitions_[bin], bin, flat);
            } else {
                flatten_nothing(dark_axis_, flat);
            }
        out.fitted.tree = encode_tree(flat.cascade, stored_price(price), most_ratio(options_));
        for (std::size_t bin = 0; bin < partitions_.size(); ++bin) {
            if (!partitions_[bin]) continue;
            const StoredQuality quality = stored_quality(flat, bin, out.fitted.tree);
            out.variance += flat.cost[bin] * flat.cost[bin] * quality.excess - 1.0;
            out.max_weight = std::max(out.max_weight, quality.max_weight);
        }
        if (lit_ > 0) out.variance /= double(lit_);
        out.fitted.cascade = std::move(flat.cascade);
        return out;
    }

    /// A bound on weights leaves no room for shares much below their probability.
    static double most_ratio(const FitOptions& options) {
        return options.max_weight > 0.0 ? 1.01 : std::numeric_limits<double>::infinity();
    }

    bool beyond(const Candidate& candidate) const {
        if (goal_.kind == Goal::Kind::variance) return candidate.variance <= goal_.variance;
        return size(candidate) > goal_.budget;
    }

    std::uint64_t size(const Candidate& candidate) const {
        if (options_.cascade_size) return options_.cascade_size(candidate.fitted.cascade);
        return options_.file_size ? options_.file_size(candidate.fitted.tree) : candidate.fitted.tree.bytes.size();
    }

    void forget(double price) {
        for (auto& partition : partitions_)
            if (partition) partition->forget(price, heaviest_);
        look_at_partitions();
    }

    /// More parts than these are kept only where they may be needed: some for every step of the grid, and what the
    /// goal asks for.
    std::size_t most_parts(const Partition& partition) const {
        std::size_t steps = 1;
        for (const std::uint32_t length : partition.grid().shape) steps *= length;
        const std::uint64_t asked = goal_.kind == Goal::Kind::cells    ? goal_.cells
                                    : goal_.kind == Goal::Kind::budget ? goal_.budget / kCellBytes
                                                                       : 0;
        return steps / 16 + (kFewParts + 2 * asked) / partitions_.size();
    }

    /// Parts of the largest tree that a variance may take: cells, and as many again that are divided.
    std::size_t too_many_parts() const {
        const std::uint64_t cells = options_.most_bytes / kCellBytes;
        return goal_.kind == Goal::Kind::variance && cells < std::numeric_limits<std::uint64_t>::max() / kCellBytes
                   ? std::max<std::size_t>(2 * cells / partitions_.size(), kFewParts)
                   : std::numeric_limits<std::size_t>::max();
    }

    enum class News { none, some, too_many };

    /// Divides all partitions on; returns whether that is news to any.
    News refine(double finest) {
        bool any = false, full = false;
        for (auto& partition : partitions_) {
            if (!partition) continue;
            const Forgetting forgetting{finest / kLeastBytes, most_parts(*partition), too_many_parts()};
            any = partition->refine(finest, heaviest_, forgetting) || any;
            full = full || partition->full();
        }
        if (full) return News::too_many;
        look_at_partitions();
        return any ? News::some : News::none;
    }

    Trial grow() {
        double finest = excess_ / 1024.0;
        for (bool first = true;; finest *= 0.25, first = false) {
            const News news = refine(finest);
            if (news == News::too_many) return grow_between(4.0 * finest, finest);
            const bool last = finest < kNegligible;
            if (news == News::none && !first && !last) continue; // nothing new at this price
            Trial trial = at(finest / kLeastBytes);
            if (last || trial.beyond) return trial;
        }
    }

    /// Grows as far as there may be parts: to somewhere between `coarse`, which the goal is beyond, and `fine`.
    Trial grow_between(double coarse, double fine) {
        constexpr int kSteps = 4;
        for (int step = 0; step < kSteps; ++step) {
            forget(coarse / kLeastBytes);
            const double middle = std::sqrt(coarse * fine);
            if (refine(middle) == News::too_many) {
                fine = middle;
                continue;
            }
            Trial trial = at(middle / kLeastBytes);
            if (trial.beyond) return trial;
            coarse = middle;
        }
        forget(coarse / kLeastBytes);
        const double price = coarse / kLeastBytes;
        throw variance_beyond(options_.most_bytes, goal_.variance, store_trees(price).variance);
    }

    /// Halves the interval of prices, on a logarithmic scale, until the trees no longer change.
    double bisect(Trial inside) {
        Trial outside = at(std::max(cost_, inside.price)); // as few cells as there can be
        if (outside.beyond) return goal_.kind == Goal::Kind::variance ? outside.price : fail(outside);
        for (int step = 0; step < 40 && inside.cells > outside.cells + 1; ++step) {
            Trial middle = at(std::sqrt(inside.price * outside.price), {&inside, &outside});
            (middle.beyond ? inside : outside) = std::move(middle);
            progress(0.6 + 0.4 * step / 40.0);
        }
        return goal_.kind == Goal::Kind::variance ? inside.price : outside.price;
    }

    double fail(const Trial& smallest) const {
        const bool cells = goal_.kind == Goal::Kind::cells;
        const double wanted = cells ? double(goal_.cells) : double(goal_.budget);
        const double least = cells ? double(smallest.cells) : double(size(store_trees(smallest.price)));
        if (!(options_.max_weight > 0.0))
            throw out_of_reach(cells ? "a number of cells" : "a size in bytes", wanted, least);
        char text[160];
        std::snprintf(
            text, sizeof text,
            "so low a bound on weights needs about %.6g %s; %.9g are allowed: allow more, or raise the bound",
            least, cells ? "cells" : "bytes", wanted);
        throw std::runtime_error(text);
    }

    void progress(double share) const {
        if (options_.progress) options_.progress(share);
    }

    const Goal& goal_;
    const FitOptions& options_;
    std::vector<std::optional<Partition>> partitions_; ///< one a bin, empty where it has no energy
    std::uint32_t dark_axis_ = 0;                      ///< of the curve of a bin without energy
    std::size_t lit_ = 0;                              ///< bins that have energy
    double excess_ = 0.0, cost_ = 1.0, heaviest_ = 0.0;
    std::vector<PruneNodes> nodes_; ///< of the partitions
    std::vector<std::vector<std::uint32_t>> begins_;
    TreeSizer sizer_;
};

} // namespace

Fitted fit_trees(const std::vector<Grid>& bins, const FitOptions& options) {
    return TreeSearch(bins, options).run();
}

} // namespace acdf::compress
