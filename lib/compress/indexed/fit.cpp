#include "compress/indexed/fit.h"

#include "compress/halvings/bit_writer.h"
#include "compress/halvings/code_bits.h"
#include "compress/halvings/codes.h"
#include "compress/indexed/growth.h"

#include <acdf/halvings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kSharedBits = 8;               // of the codes that maps share
constexpr std::uint32_t kOwnBits[] = {7, 6, 8};        // tried, for those of each map
constexpr double kOwnParts[] = {0.8, 0.97, 0.6, 0.35}; // tried, of the bytes, for them

/// From a tree that is grown to codes.
class Storing {
public:
    Storing(const IndexedSums& sums, const IndexedGrowth& grown, std::uint32_t own_bits)
        : sums_(sums), grown_(grown), own_(own_bits) {
        out_.halvings.code_bits = kSharedBits;
        out_.code_bits = own_bits;
    }

    IndexedTree run() {
        add_shared_weights();
        descend();
        out_.rows.resize(sums_.maps());
        double variance = 0.0;
        for (std::size_t map = 0; map < sums_.maps(); ++map) variance += add_row(map);
        out_.variance = variance / double(sums_.maps());
        return std::move(out_);
    }

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    bool is_top(std::uint32_t node) const { return node < 2 * grown_.top + 1; }
    /// Its halves are numbered below those of the shared part.
    bool is_own(std::uint32_t node) const {
        return grown_.nodes[node].lower != 0 && is_top(grown_.nodes[node].lower);
    }

    /// Of the codes that all maps share, and, at the top, of what is stored beside those of each map.
    void add_shared_weights() {
        weights_.assign(grown_.nodes.size(), 0.0);
        for (std::size_t i = weights_.size(); i-- > 0;) {
            const HalvedNode& node = grown_.nodes[i];
            weights_[i] = node.lower ? weights_[node.lower] + weights_[node.lower + 1] : double{node.cost};
        }
        // Below a tile costs are roots: the tile as a whole weighs what its maps cost.
        for (std::size_t i = 2 * grown_.top + 1; i-- > 0;) {
            const auto node = static_cast<std::uint32_t>(i);
            if (is_own(node)) weights_[i] = weights_[grown_.nodes[i].lower] + weights_[grown_.nodes[i].lower + 1];
            else weights_[i] = sums_.cost(grown_.nodes[i].box);
        }
    }

    struct Part {
        std::uint32_t node, tile; ///< tile: its number, kNone above
        AcdfSpan steps[2];
        double share; ///< of the steps of its tile
    };
    struct Tile {
        std::uint32_t node = 0;
        std::vector<std::pair<std::uint32_t, double>> leaves; ///< nodes, and their shares
    };

    /// The shared tree, in preorder.
    void descend() {
        const HalvingCodes codes(kSharedBits);
        std::vector<Part> open{{0, kNone, {{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}}, 1.0}};
        while (!open.empty()) {
            Part part = open.back();
            open.pop_back();
            const HalvedNode& node = grown_.nodes[part.node];
            const std::size_t axis = node.axis == 1 ? 1 : 0;
            const std::uint32_t wide = part.steps[axis].end[1] - part.steps[axis].end[0];
            const bool halved = node.lower != 0 && weights_[part.node] > 0.0 && wide >= 2 * kStepsOfFloats;
            const bool own = halved && is_own(part.node);
            if (part.tile == kNone && !own) {
                part.tile = static_cast<std::uint32_t>(tiles_.size());
                part.share = 1.0;
                tiles_.push_back({part.node, {}});
                order_.push_back({part.node, false});
            }
            if (!halved) {
                out_.halvings.axes.push_back(-1);
                tiles_[part.tile].leaves.emplace_back(part.node, part.share);
                continue;
            }
            if (own) order_.push_back({part.node, true});
            const std::uint32_t code =
                codes.best(wide, weights_[node.lower], weights_[node.lower + 1], kStepsOfFloats, kStepsOfFloats);
            const std::uint32_t lower = codes.lower(wide, code);
            out_.halvings.axes.push_back(static_cast<std::int8_t>(sums_.file_axis(axis)));
            out_.halvings.codes.push_back(static_cast<std::uint16_t>(code));
            out_.has_codes.push_back(own);
            Part half[2] = {part, part};
            for (std::uint32_t upper = 0; upper < 2; ++upper) {
                half[upper].node = node.lower + upper;
                half[upper].steps[axis].end[1 - upper] = part.steps[axis].end[0] + lower;
                half[upper].share *= double(upper ? wide - lower : lower) / double(wide);
            }
            open.push_back(half[1]);
            open.push_back(half[0]);
        }
    }

    /// Of a map, what its cells cost once a tile has all samples: a sum of squares over shares.
    double moment_of(std::size_t map, const Tile& tile) const {
        double sum = 0.0;
        for (const auto& [node, share] : tile.leaves) {
            const double cost = sums_.cost(map, grown_.nodes[node].box);
            if (cost > 0.0) sum += cost * (cost / share);
        }
        return sum;
    }

    /// The codes of a map. Returns its relative variance, times its weight.
    double add_row(std::size_t map) {
        std::vector<double> weights(2 * grown_.top + 1), lit(weights.size()), moments(tiles_.size());
        std::size_t tile = tiles_.size();
        for (std::size_t i = order_.size(); i-- > 0;) {
            const auto [node, own] = order_[i];
            if (own) {
                const std::uint32_t lower = grown_.nodes[node].lower;
                weights[node] = weights[lower] + weights[lower + 1];
                lit[node] = lit[lower] + lit[lower + 1];
                continue;
            }
            --tile;
            moments[tile] = moment_of(map, tiles_[tile]);
            weights[node] = std::sqrt(moments[tile]);
            lit[node] = weights[node] > 0.0 ? kStepsOfFloats : 0.0;
        }
        std::vector<std::uint32_t> steps(weights.size());
        steps[0] = ACDF_STEPS;
        double moment = 0.0;
        for (const auto& [node, own] : order_) {
            const std::uint32_t wide = steps[node];
            if (!own) {
                if (moments[tile] > 0.0) moment += moments[tile] / (double(wide) * 0x1p-31);
                ++tile;
                continue;
            }
            const std::uint32_t lower = grown_.nodes[node].lower;
            const std::uint32_t code =
                own_.best(wide, weights[lower], weights[lower + 1], lit[lower], lit[lower + 1]);
            out_.rows[map].push_back(static_cast<std::uint16_t>(code));
            steps[lower] = own_.lower(wide, code);
            steps[lower + 1] = wide - steps[lower];
        }
        const double weight = sums_.weight_of(map);
        return moment / weight - weight; // costs have the weight once, their squares twice
    }

    const IndexedSums& sums_;
    const IndexedGrowth& grown_;
    HalvingCodes own_;
    std::vector<double> weights_;
    std::vector<Tile> tiles_;
    std::vector<std::pair<std::uint32_t, bool>> order_; ///< nodes at the top in preorder; whether they are halved
    IndexedTree out_;
};

std::size_t words(std::size_t bits) { return (bits + 31) / 32 * 4; }

/// Bytes of codes and structure, of HALV and MAPS.
std::size_t tree_bytes(std::size_t top, std::size_t halvings, std::size_t maps, std::uint32_t own_bits) {
    return halvings_bytes(halvings + 1, kAxisBits, kSharedBits) + words(halvings) + words(top * maps * own_bits);
}

} // namespace

IndexedTree fit_indexed(const std::vector<IndexedMap>& maps, std::uint64_t bytes, const Progress& progress) {
    std::vector<Grid> grids;
    std::vector<double> weights;
    for (const IndexedMap& map : maps) {
        grids.push_back(grid_of(*map.grid));
        grids.back().values = map.values.data();
        grids.back().peaks = grids.back().left = grids.back().least = nullptr;
        weights.push_back(map.weight);
    }
    const IndexedSums sums(grids, weights);
    if (tree_bytes(0, 0, maps.size(), 8) > bytes) throw std::runtime_error("no tree fits into the budget");
    const auto top_within = [&](double part, std::uint32_t bits) {
        return static_cast<std::size_t>(part * double(bytes) * 8.0 / double(maps.size() * bits + kSharedBits + 4));
    };
    const IndexedGrowth grown = grow_top(sums, top_within(0.97, 6));
    IndexedTree best;
    double done = 0.0;
    const auto attempt = [&](double part, std::uint32_t bits) {
        const std::size_t top = std::min(top_within(part, bits), grown.top);
        std::size_t shared = 8 * static_cast<std::size_t>(bytes) / (kSharedBits + 4);
        while (shared > 0 && tree_bytes(top, top + shared, maps.size(), bits) > bytes)
            shared -= std::min(shared, 1 + (tree_bytes(top, top + shared, maps.size(), bits) - bytes) * 8 / 16);
        IndexedTree tree = Storing(sums, grow_shared(sums, grown, top, shared), bits).run();
        if (progress) progress(done += 1.0 / 6.0);
        if (!best.halvings.axes.empty() && tree.variance >= best.variance) return false;
        best = std::move(tree);
        return true;
    };
    double part = kOwnParts[0];
    for (const double tried : kOwnParts)
        if (attempt(tried, kOwnBits[0])) part = tried;
    for (const std::uint32_t bits : {kOwnBits[1], kOwnBits[2]}) attempt(part, bits);
    return best;
}

std::vector<std::uint8_t> maps_chunk(const IndexedTree& tree, const std::vector<double>& coordinates,
                                     const std::vector<AcdfMap>& maps, std::uint32_t sun) {
    const auto splits = static_cast<std::uint32_t>(std::count(tree.has_codes.begin(), tree.has_codes.end(), true));
    const AcdfMapsHeader header = {static_cast<std::uint32_t>(maps.size()), splits, tree.code_bits, sun};
    std::vector<std::uint8_t> bytes;
    const auto append = [&](const void* data, std::size_t size) {
        const auto* from = static_cast<const std::uint8_t*>(data);
        bytes.insert(bytes.end(), from, from + size);
    };
    append(&header, sizeof header);
    append(coordinates.data(), coordinates.size() * sizeof(double));
    append(maps.data(), maps.size() * sizeof(AcdfMap));
    BitWriter bits(bytes);
    for (const bool own : tree.has_codes) bits.put(own, 1);
    bits.pad();
    for (const std::vector<std::uint16_t>& row : tree.rows)
        for (const std::uint16_t code : row) bits.put(code, tree.code_bits);
    bits.pad();
    return bytes;
}

} // namespace acdf::compress
