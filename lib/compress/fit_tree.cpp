// The general tree that minimises the variance for its size: docs/method.md.
//
// A partition is grown far beyond what will be stored, then pruned: at a price
// per byte, each division stays only if it lowers the sum of costs by more than
// its bytes are worth (Breiman et al. 1984, ch. 3, with bytes for leaves).
// Since growing does not depend on the price, one partition holds the best tree
// for every size.
#include "compress/fit.h"
#include "compress/partition.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace acdf::compress {
namespace {

// What a division is charged, in bytes: about what encode_tree makes of it.
constexpr double kKnotBytes = 3.0;
constexpr double kCurveBytes = 2.0;   // header, and the link that leads to it
constexpr double kLeastBytes = 2.5;   // of any division: what could gain less at a price need not be grown for it
constexpr double kNegligible = 1e-14; // of the sum of costs, which is at least 1: rounding, no gain

/// A partition pruned at one price.
struct Pruned {
    std::vector<bool> divided;        ///< one a part: whether its division stays
    std::vector<std::uint32_t> cells; ///< below each part
};

Pruned prune(const std::vector<Part>& parts, double price) {
    Pruned out;
    out.divided.assign(parts.size(), false);
    std::vector<double> value(parts.size()); // cost and price of the best tree below a part
    out.cells.assign(parts.size(), 1);
    for (std::size_t i = parts.size(); i-- > 0;) {
        const Part& part = parts[i];
        value[i] = part.moments.cost();
        if (part.split == Part::Split::none) continue;
        double divided = price * kKnotBytes * (part.children - 1);
        std::uint32_t count = 0;
        for (std::uint32_t k = part.first_child; k < part.first_child + part.children; ++k) {
            divided += value[k];
            if (out.divided[k] && parts[k].split != part.split) divided += price * kCurveBytes;
            count += out.cells[k];
        }
        if (divided >= value[i]) continue;
        value[i] = divided;
        out.divided[i] = true;
        out.cells[i] = count;
    }
    return out;
}

/// Turns what is left of a partition into curves: divisions along the same axis
/// become one curve.
class Flattener {
public:
    Flattener(const Partition& partition, const Pruned& pruned)
        : target_(partition.target()), parts_(partition.parts()), pruned_(pruned), cost_(parts_.size(), 0.0) {
        for (std::size_t i = parts_.size(); i-- > 0;) {
            cost_[i] = pruned.divided[i] ? 0.0 : parts_[i].moments.cost();
            for (std::uint32_t k = 0; pruned.divided[i] && k < parts_[i].children; ++k)
                cost_[i] += cost_[parts_[i].first_child + k];
        }
    }

    /// The sum of the costs of all cells.
    double cost() const { return cost_[0]; }

    Cascade cascade() const {
        Cascade out;
        out.roots = {0};
        add_curve(0, out);
        return out;
    }

private:
    /// The parts that become the segments of a curve that starts at part i.
    void collect(std::uint32_t i, Part::Split split, std::vector<std::uint32_t>& segments) const {
        if (!pruned_.divided[i] || parts_[i].split != split) {
            segments.push_back(i);
            return;
        }
        for (std::uint32_t k = 0; k < parts_[i].children; ++k) collect(parts_[i].first_child + k, split, segments);
    }

    std::int32_t add_curve(std::uint32_t i, Cascade& out) const {
        const Part::Split split = parts_[i].split;
        std::vector<std::uint32_t> segments;
        collect(i, split, segments);
        const auto index = static_cast<std::int32_t>(out.curves.size());
        out.curves.emplace_back();
        Curve curve;
        const bool rows = split != Part::Split::columns;
        curve.axis = rows ? target_.row_axis : target_.column_axis;
        for (std::size_t s = 0; s < segments.size(); ++s) {
            const Part& part = parts_[segments[s]];
            if (s > 0) curve.knots.push_back(rows ? part.box.row_begin : part.box.column_begin);
            curve.probability.push_back(cost_[i] > 0.0 ? cost_[segments[s]] / cost_[i] : 1.0);
        }
        // Small subtrees first: most links are then short enough for one byte.
        std::vector<std::size_t> order;
        for (std::size_t s = 0; s < segments.size(); ++s)
            if (pruned_.divided[segments[s]] && cost_[segments[s]] > 0.0) order.push_back(s);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return pruned_.cells[segments[a]] < pruned_.cells[segments[b]];
        });
        curve.children.assign(segments.size(), -1);
        for (std::size_t s : order) curve.children[s] = add_curve(segments[s], out);
        out.curves[static_cast<std::size_t>(index)] = std::move(curve);
        return index;
    }

    const Target& target_;
    const std::vector<Part>& parts_;
    const Pruned& pruned_;
    std::vector<double> cost_; ///< of the cells below each part
};

/// The tree at one price, stored, and what it comes to.
struct Candidate {
    double price = 0.0; ///< in units of the sum of costs a byte
    Fitted fitted;
    std::size_t cells = 0;
    double variance = 0.0; ///< relative variance of the stored density
};

class Search {
public:
    Search(const Target& target, const FitOptions& options)
        : goal_(options.goal), options_(options), partition_(target, integral(target), first_split(options)),
          whole_(partition_.parts().front().moments) {}

    /// Grows the partition until the best tree for the price of its finest divisions is beyond the goal, or
    /// nothing is left to divide; then moves the price to where the goal is met.
    Fitted run() {
        Candidate candidate = grow();
        progress(0.6);
        if (!beyond(candidate)) {
            if (goal_.kind == Goal::Kind::variance) throw std::runtime_error(unreachable(candidate));
            return std::move(candidate.fitted);
        }
        return bisect(std::move(candidate)).fitted;
    }

private:
    static Part::Split first_split(const FitOptions& options) {
        if (!options.order) return Part::Split::none;
        return *options.order == Order::z ? Part::Split::rows : Part::Split::columns;
    }

    Candidate at(double price) const {
        Candidate out;
        out.price = price;
        const Pruned pruned = prune(partition_.parts(), price);
        out.cells = pruned.cells[0];
        if (goal_.kind == Goal::Kind::cells && out.cells > goal_.cells) return out;
        const Flattener flattener(partition_, pruned);
        out.fitted.cascade = flattener.cascade();
        // E[(f/p)^2] is about the square of the sum of costs, so that a byte is worth twice as much in it.
        out.fitted.tree = encode_tree(out.fitted.cascade, 2.0 * price);
        const double sum = flattener.cost();
        out.variance = sum * sum * stored_excess(out.fitted.cascade, out.fitted.tree) - 1.0;
        return out;
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

    Candidate grow() {
        double finest = (whole_.cost() - whole_.flux) / 1024.0;
        Candidate candidate;
        for (std::size_t before = 0; before != partition_.parts().size(); finest *= 0.25) {
            before = partition_.parts().size();
            partition_.refine(finest);
            candidate = at(finest / kLeastBytes);
            if (beyond(candidate) || finest < kNegligible) break;
        }
        return candidate;
    }

    /// Halves the interval of prices, on a logarithmic scale, until the tree no longer changes.
    Candidate bisect(Candidate inside) const {
        Candidate outside = at(std::max(whole_.cost(), inside.price)); // a single cell
        if (beyond(outside)) return goal_.kind == Goal::Kind::variance ? outside : fail(outside);
        for (int step = 0; step < 40 && inside.cells > outside.cells + 1; ++step) {
            Candidate middle = at(std::sqrt(inside.price * outside.price));
            (beyond(middle) ? inside : outside) = std::move(middle);
            progress(0.6 + 0.4 * step / 40.0);
        }
        return goal_.kind == Goal::Kind::variance ? std::move(inside) : std::move(outside);
    }

    Candidate fail(const Candidate& smallest) const {
        throw std::runtime_error("a budget of " + std::to_string(goal_.budget) +
                                 " bytes is below the smallest file, " + std::to_string(size(smallest)) + " bytes");
    }

    std::string unreachable(const Candidate& finest) const {
        char text[160];
        std::snprintf(text, sizeof text, "a relative variance of %g is out of reach; the finest tree has %.3g",
                      goal_.variance, finest.variance);
        return text;
    }

    void progress(double share) const {
        if (options_.progress) options_.progress(share);
    }

    const Goal& goal_;
    const FitOptions& options_;
    Partition partition_;
    Moments whole_;
};

} // namespace

Fitted fit_tree(const Target& target, const FitOptions& options) { return Search(target, options).run(); }

} // namespace acdf::compress
