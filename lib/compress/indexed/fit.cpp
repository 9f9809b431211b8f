#include "compress/indexed/fit.h"

#include "compress/halvings/bit_writer.h"
#include "compress/halvings/code_bits.h"
#include "compress/halvings/codes.h"
#include "compress/halvings/rows.h"
#include "compress/indexed/growth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kOwnBits[] = {7, 6, 8};        // tried, for those of each map
constexpr double kOwnParts[] = {0.8, 0.97, 0.6, 0.35}; // tried, of the bytes, for them

/// Of the codes that all maps share, and, at the top, of what is stored beside those of each map.
std::vector<double> weights_of(const IndexedSums& sums, const IndexedGrowth& grown) {
    std::vector<double> weights(grown.nodes.size());
    const std::size_t first_shared = 2 * grown.top + 1;
    for (std::size_t i = weights.size(); i-- > 0;) {
        const HalvedNode& node = grown.nodes[i];
        // Below a tile costs are roots: the tile as a whole weighs what its maps cost.
        if (i < first_shared && node.lower >= first_shared) weights[i] = sums.cost(node.box);
        else if (node.lower) weights[i] = weights[node.lower] + weights[node.lower + 1];
        else weights[i] = i < first_shared ? sums.cost(node.box) : double{node.cost};
    }
    return weights;
}

/// Of a map, what its cells cost once a tile has all samples: a sum of squares over shares.
double moment_of(const IndexedSums& sums, const IndexedGrowth& grown, std::size_t map, const RowTree::Tile& tile) {
    double sum = 0.0;
    for (const RowTree::Leaf& leaf : tile.leaves) {
        const double cost = sums.cost(map, grown.nodes[leaf.node].box);
        if (cost > 0.0) sum += cost * (cost / leaf.share);
    }
    return sum;
}

/// From a tree that is grown to codes.
IndexedTree stored(const IndexedSums& sums, const IndexedGrowth& grown, std::uint32_t own_bits) {
    const RowTree tree(grown.nodes, grown.top, weights_of(sums, grown), {sums.file_axis(0), sums.file_axis(1)});
    const HalvingCodes own(own_bits);
    IndexedTree out;
    out.halvings = tree.halvings();
    out.has_codes = tree.has_codes();
    out.code_bits = own_bits;
    double variance = 0.0;
    for (std::size_t map = 0; map < sums.maps(); ++map) {
        std::vector<double> moments, parts;
        for (const RowTree::Tile& tile : tree.tiles()) {
            moments.push_back(moment_of(sums, grown, map, tile));
            parts.push_back(std::sqrt(moments.back()));
        }
        CodedRow row = tree.row(own, parts, Unreached::stored);
        double moment = 0.0;
        for (std::size_t t = 0; t < moments.size(); ++t)
            if (moments[t] > 0.0) moment += moments[t] / (double(row.steps[t]) * 0x1p-31);
        const double weight = sums.weight_of(map);
        variance += moment / weight - weight; // costs have the weight once, their squares twice
        out.rows.push_back(std::move(row.codes));
    }
    out.variance = variance / double(sums.maps());
    return out;
}

std::size_t words(std::size_t bits) { return (bits + 31) / 32 * 4; }

/// Bytes of codes and structure, of HALV and MAPS.
std::size_t tree_bytes(std::size_t top, std::size_t halvings, std::size_t maps, std::uint32_t own_bits) {
    return halvings_bytes(halvings + 1, kAxisBits, kSharedCodeBits) + words(halvings) +
           words(top * maps * own_bits);
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
        return static_cast<std::size_t>(part * double(bytes) * 8.0 /
                                        double(maps.size() * bits + kSharedCodeBits + 4));
    };
    const IndexedGrowth grown = grow_top(sums, top_within(0.97, 6));
    IndexedTree best;
    double done = 0.0;
    const auto attempt = [&](double part, std::uint32_t bits) {
        const std::size_t top = std::min(top_within(part, bits), grown.top);
        std::size_t shared = 8 * static_cast<std::size_t>(bytes) / (kSharedCodeBits + 4);
        while (shared > 0 && tree_bytes(top, top + shared, maps.size(), bits) > bytes)
            shared -= std::min(shared, 1 + (tree_bytes(top, top + shared, maps.size(), bits) - bytes) * 8 / 16);
        IndexedTree tree = stored(sums, grow_shared(sums, grown, top, shared), bits);
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
    put_rows(tree.has_codes, tree.rows, tree.code_bits, bytes);
    return bytes;
}

} // namespace acdf::compress
