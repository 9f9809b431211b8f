#include "compress/indexed/growth.h"

#include "compress/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>

namespace acdf::compress {
namespace {

constexpr float kAlike = 0.9f;                            // of a round of growth
constexpr std::size_t kMostValues = std::size_t{1} << 26; // of the tables of all maps

/// The shared tree below a tile, as that of one map: the squares of its costs are those of all maps, each of which
/// counts by what it costs in the tile.
class SharedTile {
public:
    SharedTile(const IndexedSums& sums, HalvedNode& tile) : sums_(sums) {
        for (std::size_t map = 0; map < sums.maps(); ++map) {
            const double cost = sums.cost(map, tile.box);
            factor_.push_back(cost > 0.0 ? 1.0 / cost : 0.0);
        }
        tile.cost = static_cast<float>(cost(tile.box));
        total_ = double{tile.cost};
    }

    /// Finds the axis that a node is best halved on. Returns what that gains; 0: nothing.
    double look(HalvedNode& node) const {
        double best = 0.0;
        node.axis = -1;
        for (int axis = 0; axis < 2; ++axis) {
            if (!sums_.axes().can_halve(node.box, axis)) continue;
            const double halves = cost(half(node.box, axis, 0)) + cost(half(node.box, axis, 1));
            const double gain = double{node.cost} - halves;
            if (!(gain > best + 1e-7 * double{node.cost})) continue;
            best = gain;
            node.axis = static_cast<std::int8_t>(axis);
        }
        return total_ * best;
    }

    /// Both halves of a node.
    std::array<HalvedNode, 2> halve(const HalvedNode& node) {
        std::array<HalvedNode, 2> out;
        total_ -= double{node.cost};
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            out[upper].box = half(node.box, node.axis, upper);
            out[upper].cost = static_cast<float>(cost(out[upper].box));
            total_ += double{out[upper].cost};
        }
        return out;
    }

private:
    double cost(HalvedBox box) const {
        double sum = 0.0;
        for (std::size_t map = 0; map < sums_.maps(); ++map) {
            const double of_map = sums_.cost(map, box);
            sum += factor_[map] * of_map * of_map;
        }
        return std::sqrt(sum);
    }

    const IndexedSums& sums_;
    std::vector<double> factor_;
    double total_ = 0.0; ///< of the costs of leaves
};

struct Candidate {
    double gain;
    std::uint32_t node;
    bool operator<(const Candidate& other) const {
        return gain != other.gain ? gain < other.gain : node > other.node;
    }
};

} // namespace

IndexedSums::IndexedSums(const std::vector<Grid>& grids, const std::vector<double>& weights)
    : HalvedCosts(axes_),
      file_axes_(grids[0].axes), axes_{HalvedAxis(grids[0].measure[0]), HalvedAxis(grids[0].measure[1])},
      sums_(grids.size()), weights_(weights), scale_(grids.size()),
      least_(std::accumulate(weights.begin(), weights.end(), 0.0)) {
    const std::size_t most = std::max<std::size_t>(kMostValues / grids.size(), std::size_t{1} << 12);
    for (std::size_t map = 0; map < grids.size(); ++map) {
        sums_[map] = std::make_unique<HalvedSums>(grids[map], most);
        scale_[map] = weights[map] / (integral(grids[map]) * sums_[map]->unit());
    }
}

IndexedGrowth grow_top(const IndexedSums& sums, std::size_t halvings) {
    HalvedGrowth growth({{0, halvings + 1}}, {kAlike});
    growth.run(sums, Loop(false), {});
    return {growth.nodes(), growth.leaves() - 1};
}

IndexedGrowth grow_shared(const IndexedSums& sums, const IndexedGrowth& grown, std::size_t top,
                          std::size_t shared) {
    IndexedGrowth out;
    out.top = std::min(top, grown.top);
    out.nodes.assign(grown.nodes.begin(), grown.nodes.begin() + std::ptrdiff_t(2 * out.top + 1));
    const auto first_shared = static_cast<std::uint32_t>(out.nodes.size());
    std::vector<SharedTile> tiles;
    std::vector<std::uint32_t> roots, tile_of(first_shared);
    for (std::uint32_t i = 0; i < first_shared; ++i) {
        HalvedNode& node = out.nodes[i];
        if (node.lower != 0 && node.lower < first_shared) continue;
        node.lower = 0;
        tile_of[i] = static_cast<std::uint32_t>(tiles.size());
        tiles.emplace_back(sums, node);
        roots.push_back(i);
    }
    std::vector<double> gains(tiles.size());
    parallel_for(std::size_t{0}, tiles.size(),
                 [&](std::size_t i) { gains[i] = tiles[i].look(out.nodes[roots[i]]); });
    std::priority_queue<Candidate> candidates;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (gains[i] > 0.0) candidates.push({gains[i], roots[i]});
    for (std::size_t n = 0; n < shared && !candidates.empty(); ++n) {
        const std::uint32_t node = candidates.top().node, tile = tile_of[node];
        candidates.pop();
        const auto halves = tiles[tile].halve(out.nodes[node]);
        out.nodes[node].lower = static_cast<std::uint32_t>(out.nodes.size());
        for (const HalvedNode& of : halves) {
            out.nodes.push_back(of);
            tile_of.push_back(tile);
            if (const double gain = tiles[tile].look(out.nodes.back()); gain > 0.0)
                candidates.push({gain, static_cast<std::uint32_t>(out.nodes.size() - 1)});
        }
    }
    return out;
}

} // namespace acdf::compress
