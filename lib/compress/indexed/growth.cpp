#include "compress/indexed/growth.h"

#include "compress/parallel.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace acdf::compress {
namespace {

constexpr double kAhead = 1.0 / 3.0;                      // what the gain of two halvings counts
constexpr std::size_t kMostValues = std::size_t{1} << 26; // of the tables of all maps

struct Candidate {
    double gain;
    std::uint32_t node;
    bool operator<(const Candidate& other) const {
        return gain != other.gain ? gain < other.gain : node > other.node;
    }
};

/// Growth by any costs of boxes; `Cost` is called with a box, `ahead` of them are looked at.
template <class Cost>
class Grower {
public:
    Grower(const HalvedSums& shape, std::vector<IndexedNode>& nodes, const Cost& cost, bool ahead)
        : shape_(shape), nodes_(nodes), cost_(cost), ahead_(ahead) {}

    /// What halving a node gains, on its better axis, which it gets; 0: nothing.
    double consider(std::uint32_t number) {
        IndexedNode& node = nodes_[number];
        double best = 0.0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (!shape_.can_halve(node.box, axis)) continue;
            const HalvedBox lower = shape_.half(node.box, axis, 0), upper = shape_.half(node.box, axis, 1);
            const double a = cost_(lower), b = cost_(upper);
            double gain = node.cost - (a + b);
            if (ahead_) gain = std::max(gain, kAhead * (node.cost - (least(lower, a) + least(upper, b))));
            if (!(gain > best + 1e-12 * node.cost)) continue;
            best = gain;
            node.axis = static_cast<std::int8_t>(axis);
        }
        return best;
    }

    /// Adds both halves. Returns by how much costs fall.
    double halve(std::uint32_t number) {
        const auto lower = static_cast<std::uint32_t>(nodes_.size());
        nodes_[number].lower = lower;
        const IndexedNode node = nodes_[number];
        double fall = node.cost;
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            const HalvedBox half = shape_.half(node.box, static_cast<std::size_t>(node.axis), upper);
            nodes_.push_back({half, 0, cost_(half), -1});
            fall -= nodes_.back().cost;
        }
        return fall;
    }

private:
    double least(const HalvedBox& box, double as_leaf) const {
        double least = as_leaf;
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (shape_.can_halve(box, axis))
                least = std::min(least, cost_(shape_.half(box, axis, 0)) + cost_(shape_.half(box, axis, 1)));
        return least;
    }

    const HalvedSums& shape_;
    std::vector<IndexedNode>& nodes_;
    const Cost& cost_;
    bool ahead_;
};

double integral_of(const Grid& grid) {
    double sum = 0.0;
    for (std::uint32_t r = 0; r < grid.shape[0]; ++r) {
        double row = 0.0;
        for (std::uint32_t c = 0; c < grid.shape[1]; ++c)
            row += double{grid.values[std::size_t{r} * grid.shape[1] + c]} * grid.measure[1][c];
        sum += row * grid.measure[0][r];
    }
    return sum;
}

/// The shared tree below a tile, as that of one map: the squares of its costs are those of all maps, each of which
/// counts by what it costs in the tile.
class SharedCosts {
public:
    SharedCosts(const IndexedSums& sums, const HalvedBox& tile) : sums_(sums) {
        for (std::size_t map = 0; map < sums.maps(); ++map) {
            const double cost = sums.cost(map, tile);
            factor_.push_back(cost > 0.0 ? 1.0 / cost : 0.0);
        }
    }
    double operator()(const HalvedBox& box) const {
        double sum = 0.0;
        for (std::size_t map = 0; map < sums_.maps(); ++map) {
            const double cost = sums_.cost(map, box);
            sum += factor_[map] * cost * cost;
        }
        return std::sqrt(sum);
    }

private:
    const IndexedSums& sums_;
    std::vector<double> factor_;
};

} // namespace

IndexedSums::IndexedSums(const std::vector<Grid>& grids, const std::vector<double>& weights)
    : sums_(grids.size()), weights_(weights), scale_(grids.size()) {
    const std::size_t most = std::max<std::size_t>(kMostValues / grids.size(), std::size_t{1} << 12);
    for (std::size_t map = 0; map < grids.size(); ++map) {
        sums_[map] = std::make_unique<HalvedSums>(grids[map], most);
        scale_[map] = weights[map] / (integral_of(grids[map]) * sums_[map]->unit());
    }
}

IndexedGrowth grow_top(const IndexedSums& sums, std::size_t halvings) {
    IndexedGrowth out;
    const auto cost = [&](const HalvedBox& box) { return sums.cost(box); };
    Grower grower(sums.shape(), out.nodes, cost, true);
    out.nodes.push_back({sums.shape().whole(), 0, sums.cost(sums.shape().whole()), -1});
    std::priority_queue<Candidate> candidates;
    const auto consider = [&](std::uint32_t node) {
        if (const double gain = grower.consider(node); gain > 0.0) candidates.push({gain, node});
    };
    consider(0);
    for (; out.top < halvings && !candidates.empty(); ++out.top) {
        const std::uint32_t node = candidates.top().node;
        candidates.pop();
        grower.halve(node);
        consider(out.nodes[node].lower);
        consider(out.nodes[node].lower + 1);
    }
    return out;
}

IndexedGrowth grow_shared(const IndexedSums& sums, const IndexedGrowth& grown, std::size_t top,
                          std::size_t shared) {
    IndexedGrowth out;
    out.top = std::min(top, grown.top);
    out.nodes.assign(grown.nodes.begin(), grown.nodes.begin() + std::ptrdiff_t(2 * out.top + 1));
    const auto first_shared = static_cast<std::uint32_t>(out.nodes.size());
    std::vector<std::uint32_t> tiles, tile_of(first_shared);
    for (std::uint32_t i = 0; i < first_shared; ++i) {
        IndexedNode& node = out.nodes[i];
        if (node.lower != 0 && node.lower < first_shared) continue;
        node.lower = 0;
        node.axis = -1;
        tile_of[i] = static_cast<std::uint32_t>(tiles.size());
        tiles.push_back(i);
    }
    std::vector<SharedCosts> costs;
    costs.reserve(tiles.size());
    std::vector<double> whole(tiles.size());
    std::vector<double> gains(tiles.size());
    for (const std::uint32_t tile : tiles) costs.emplace_back(sums, out.nodes[tile].box);
    const auto gain_of = [&](std::uint32_t node) {
        const std::uint32_t tile = tile_of[node];
        return whole[tile] * Grower(sums.shape(), out.nodes, costs[tile], false).consider(node);
    };
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
        out.nodes[tiles[i]].cost = whole[i] = costs[i](out.nodes[tiles[i]].box);
        gains[i] = gain_of(tiles[i]);
    });
    std::priority_queue<Candidate> candidates;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (gains[i] > 0.0) candidates.push({gains[i], tiles[i]});
    for (std::size_t n = 0; n < shared && !candidates.empty(); ++n) {
        const std::uint32_t node = candidates.top().node, tile = tile_of[node];
        candidates.pop();
        whole[tile] -= Grower(sums.shape(), out.nodes, costs[tile], false).halve(node);
        tile_of.resize(out.nodes.size(), tile);
        for (std::uint32_t half = out.nodes[node].lower; half < out.nodes.size(); ++half)
            if (const double gain = gain_of(half); gain > 0.0) candidates.push({gain, half});
    }
    return out;
}

} // namespace acdf::compress
