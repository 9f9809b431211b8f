// Random trees that use everything the format has: both axes in any order, returning to an axis, curves
// shared by segments and by parents, segments of probability 0, tilts, every width of every array, positions that
// count from the range's low end, and the long form of the number of segments.
#pragma once

#include "tests/lib/reader/builder.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>

namespace acdf_test {

struct RandomOptions {
    std::uint32_t columns = 64, rows = 32;
    int depth = 6;             ///< curves on a path, at most
    int segments = 6;          ///< of a curve, at most
    bool tilts = true;         ///< linear pdfs
    bool dark = true;          ///< segments of probability 0
    bool share = true;         ///< curves with several parents
    double end = 0.25;         ///< chance that a segment ends before `depth`
    bool narrow_cells = false; ///< knots next to each other: cells of one step
    bool long_curves = true;   ///< now and then more than 63 segments
    bool octahedral = false;   ///< axes u and v
};

/// Grids, depths and widths of cells in turns.
inline RandomOptions varied_options(std::uint32_t seed, std::uint32_t widest = 4096) {
    RandomOptions options;
    options.columns = seed % 3 == 0 ? 64 : seed % 3 == 1 ? 37 : widest;
    options.rows = seed % 2 == 0 ? 32 : 511;
    options.depth = 2 + static_cast<int>(seed % 9);
    options.narrow_cells = seed % 6 == 0;
    return options;
}

class RandomTree {
public:
    RandomTree(std::uint32_t seed, const RandomOptions& options) : rng_(seed), options_(options) {}

    EnvironmentSpec make() {
        EnvironmentSpec spec;
        spec.columns = options_.columns;
        spec.rows = options_.rows;
        spec.tree = make_tree();
        spec.root = 0;
        spec.octahedral = options_.octahedral;
        return spec;
    }

    /// A tree whose root is curve 0.
    TreeSpec make_tree() {
        const Range box[2] = {{0, options_.columns}, {0, options_.rows}};
        pool_.clear();
        shareable_.clear();
        return in_file_order(grow(box, 0, 3, 1));
    }

    /// Gives links that do not reach their child more bytes; false where all do.
    static bool widen_links(TreeSpec& tree) {
        bool changed = false;
        tree.encode();
        for (std::size_t i = 0; i < tree.curves.size(); ++i) {
            CurveSpec& curve = tree.curves[i];
            if (curve.link_bytes == 0 || curve.link_bytes == 4) continue;
            const std::uint32_t most = curve.link_bytes == 1 ? 0xFF : 0xFFFF;
            for (std::size_t s = 0; s < curve.segments(); ++s)
                if (curve.children[s] >= 0 && tree.starts[curve.child_at(s)] - tree.starts[i] > most) {
                    curve.link_bytes *= 2;
                    changed = true;
                    break;
                }
        }
        return changed;
    }

private:
    struct Range {
        std::uint32_t low, high;
        bool holds(const Range& o) const { return low <= o.low && o.high <= high; }
    };
    struct Shareable { // a curve whose subtree stays on one axis
        std::uint32_t axis;
        Range range;
        int curve, depth;
    };

    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_); }
    bool chance(double p) { return uniform() < p; }
    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(rng_); }

    std::vector<std::uint32_t> random_knots(const Range& range) {
        const std::uint32_t inside = range.high - range.low - 1;
        std::uint32_t count = below(static_cast<std::uint32_t>(options_.segments));
        if (chance(0.05)) count *= 8;
        if (options_.long_curves && chance(0.02)) count = 60 + below(250);
        count = std::min(count, inside);
        std::set<std::uint32_t> knots;
        while (knots.size() < count) {
            const std::uint32_t knot = range.low + 1 + below(inside);
            knots.insert(knot);
            if (options_.narrow_cells && knots.size() < count && knot + 1 < range.high) knots.insert(knot + 1);
        }
        return {knots.begin(), knots.end()};
    }

    std::vector<std::uint32_t> random_cumulative(std::size_t segments, std::uint32_t maximum) {
        std::vector<double> weights(segments);
        double sum = 0.0;
        for (double& w : weights) sum += w = options_.dark && chance(0.2) ? 0.0 : std::exp(4.0 * uniform());
        if (sum == 0.0) sum = weights[below(static_cast<std::uint32_t>(segments))] = 1.0;
        std::vector<std::uint32_t> cumulative;
        double partial = 0.0;
        for (std::size_t i = 0; i + 1 < segments; ++i) {
            partial += weights[i];
            cumulative.push_back(static_cast<std::uint32_t>(std::min(partial / sum, 1.0) * maximum));
        }
        return cumulative;
    }

    // `axes`: mask of the axes the subtree may split. Returns the index of the curve.
    int grow(const Range (&range)[2], unsigned tilted, unsigned axes, int depth) {
        axes &= ~tilted;
        CurveSpec curve;
        curve.axis = axes == 3 ? below(2) : axes == 2 ? 1 : 0;
        curve.positions = random_knots(range[curve.axis]);
        curve.cumulative_bytes = 1 << below(3);
        curve.cumulative = random_cumulative(curve.segments(), curve.maximum());
        if (options_.tilts && chance(0.3))
            for (std::size_t i = 0; i < curve.segments(); ++i)
                curve.tilts.push_back(chance(0.3) ? 0 : static_cast<int>(below(65535)) - 32767);
        const int self = static_cast<int>(pool_.size());
        pool_.push_back(curve);
        const std::vector<int> children = grow_children(curve, range, tilted, axes, depth);
        pool_[static_cast<std::size_t>(self)].children = children;
        if (std::any_of(children.begin(), children.end(), [](int c) { return c >= 0; }))
            pool_[static_cast<std::size_t>(self)].link_bytes = 1 << below(3);
        if (axes == 1 || axes == 2) shareable_.push_back({curve.axis, range[curve.axis], self, depth});
        return self;
    }

    std::vector<int> grow_children(const CurveSpec& curve, const Range (&range)[2], unsigned tilted, unsigned axes,
                                   int depth) {
        std::vector<int> children(curve.segments(), -1);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const std::uint32_t low = i == 0 ? 0 : curve.cumulative[i - 1];
            const std::uint32_t high = i + 1 == children.size() ? curve.maximum() : curve.cumulative[i];
            if (low == high || depth >= options_.depth || chance(options_.end)) continue;
            Range inner[2] = {range[0], range[1]};
            if (i > 0) inner[curve.axis].low = curve.positions[i - 1];
            if (i + 1 < children.size()) inner[curve.axis].high = curve.positions[i];
            unsigned below_tilted = tilted;
            if (!curve.tilts.empty() && curve.tilts[i] != 0) below_tilted |= 1u << curve.axis;
            const unsigned other = 3u & ~(1u << curve.axis);
            unsigned allowed = axes & ~below_tilted;
            if (options_.share && allowed == 3 && chance(0.5)) allowed = other;
            if (allowed == 0) continue;
            const int shared = options_.share && allowed == other ? find_shared(allowed == 2, inner, depth) : -1;
            children[i] = shared >= 0 ? shared : grow(inner, below_tilted, allowed, depth + 1);
        }
        return children;
    }

    int find_shared(std::uint32_t axis, const Range (&range)[2], int depth) {
        for (const Shareable& s : shareable_)
            if (s.axis == axis && range[axis].holds(s.range) && s.depth > depth && chance(0.7)) return s.curve;
        return -1;
    }

    void visit(int curve, std::vector<char>& seen, std::vector<int>& order) {
        if (seen[static_cast<std::size_t>(curve)]) return;
        seen[static_cast<std::size_t>(curve)] = 1;
        for (int child : pool_[static_cast<std::size_t>(curve)].children)
            if (child >= 0) visit(child, seen, order);
        order.push_back(curve);
    }

    // Children after all their parents; links as wide as they must be, or wider.
    TreeSpec in_file_order(int root) {
        std::vector<char> seen(pool_.size(), 0);
        std::vector<int> order, place(pool_.size(), -1);
        visit(root, seen, order);
        std::reverse(order.begin(), order.end());
        for (std::size_t i = 0; i < order.size(); ++i)
            place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
        TreeSpec tree;
        for (int index : order) {
            CurveSpec curve = pool_[static_cast<std::size_t>(index)];
            for (int& child : curve.children)
                if (child >= 0) child = place[static_cast<std::size_t>(child)];
            tree.curves.push_back(curve);
        }
        choose_positions(tree);
        while (widen_links(tree)) {
        }
        return tree;
    }

    // One byte where every path to the curve brings the same low end and the knots are near it.
    void choose_positions(TreeSpec& tree) {
        constexpr std::uint32_t unset = 0xFFFFFFFF, many = 0xFFFFFFFE;
        std::vector<std::array<std::uint32_t, 2>> lows(tree.curves.size(), {unset, unset});
        lows[0] = {0, 0};
        for (std::size_t i = 0; i < tree.curves.size(); ++i) {
            CurveSpec& curve = tree.curves[i];
            const std::uint32_t low = lows[i][curve.axis],
                                last = curve.positions.empty() ? 0 : curve.positions.back();
            curve.position_bytes = last > 0xFFFF || chance(0.2) ? 4 : 2;
            if (curve.positions.empty() || (low != many && last - low <= 0xFF && chance(0.7))) {
                curve.position_bytes = 1;
                curve.origin = low;
            }
            for (std::size_t s = 0; s < curve.children.size(); ++s) {
                if (curve.children[s] < 0) continue;
                std::array<std::uint32_t, 2> child = lows[i];
                if (s > 0) child[curve.axis] = curve.positions[s - 1];
                for (std::size_t axis = 0; axis < 2; ++axis) {
                    std::uint32_t& known = lows[curve.child_at(s)][axis];
                    known = known == unset || known == child[axis] ? child[axis] : many;
                }
            }
        }
    }

    std::mt19937 rng_;
    RandomOptions options_;
    std::vector<CurveSpec> pool_;
    std::vector<Shareable> shareable_;
};

/// A curve that splits `axis` at each position, every segment alike in probability.
inline CurveSpec even_curve(std::uint32_t axis, const std::vector<std::uint32_t>& positions) {
    CurveSpec curve;
    curve.axis = axis;
    curve.cumulative_bytes = curve.position_bytes = 2;
    curve.positions = positions;
    for (std::size_t i = 1; i <= positions.size(); ++i)
        curve.cumulative.push_back(static_cast<std::uint32_t>(65535 * i / (positions.size() + 1)));
    return curve;
}

} // namespace acdf_test
