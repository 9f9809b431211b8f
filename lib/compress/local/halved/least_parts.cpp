#include "compress/local/halved/least_parts.h"

#include "compress/halvings/sums.h"
#include "compress/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr float kNear = 0.99f;
constexpr float kMostSurplus = 1.3f; // that is made up for: raising rows by more raises what they sample as much

/// The largest cosine to a normal in a cone, 0 below the horizon.
float largest_cosine(const BoxCone& cone, const float n[3]) {
    if (cone.sine > 1.0f) return 1.0f;
    const float d = cone.axis[0] * n[0] + cone.axis[1] * n[1] + cone.axis[2] * n[2], s = cone.sine;
    const float reach = std::sqrt(1.0f - s * s);
    if (d >= reach) return 1.0f;
    return std::max(0.0f, d * reach + std::sqrt(std::max(0.0f, 1.0f - d * d)) * s);
}

} // namespace

LeastParts::LeastParts(const Blocks& blocks, const HalvedAxes& axes, double unit, double max_weight,
                       const RowTree& tree, const std::vector<HalvedNode>& nodes)
    : blocks_(blocks) {
    const float* peaks = peaks_of(blocks.grid());
    std::vector<std::vector<Cell>> of_tile(tree.tiles().size());
    largest_.resize(of_tile.size());
    parallel_for(std::size_t{0}, of_tile.size(), [&](std::size_t t) {
        std::vector<Cell>& cells = of_tile[t];
        for (const RowTree::Leaf& leaf : tree.tiles()[t].leaves) {
            if (!(leaf.share > 0.0)) continue;
            const HalvedBox box = nodes[leaf.node].box, place = blocks.around(box);
            const auto part = static_cast<float>(peak_of(peaks, axes, box) * (unit / max_weight) / leaf.share);
            largest_[t] = std::max(largest_[t], part);
            const bool same = !cells.empty() && cells.back().place.rows == place.rows &&
                              cells.back().place.columns == place.columns;
            if (same) cells.back().part = std::max(cells.back().part, part);
            else cells.push_back({place, part});
        }
    });
    for (const std::vector<Cell>& cells : of_tile) {
        begin_.push_back(cells_.size());
        cells_.insert(cells_.end(), cells.begin(), cells.end());
    }
    begin_.push_back(cells_.size());
}

float LeastParts::least(std::size_t tile, const float normal[3]) const {
    float out = 0.0f;
    for (std::size_t i = begin_[tile]; i < begin_[tile + 1]; ++i)
        if (cells_[i].part > out)
            out = std::max(out, cells_[i].part * largest_cosine(blocks_.cone(cells_[i].place), normal));
    return out;
}

bool LeastParts::raise(const NormalBins& bins, const RowParts& rows, const std::vector<float>& surplus,
                       RowParts& wanted) const {
    std::atomic<bool> any{false};
    parallel_for(std::size_t{0}, rows.size(), [&](std::size_t b) {
        const float scale = std::min(surplus[b], kMostSurplus);
        float normal[3];
        for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<float>(bins.normals[b][k]);
        for (std::size_t t = 0; t < rows[b].size(); ++t) {
            const float part = rows[b][t];
            if (!(part > 0.0f) || part >= scale * largest_[t]) continue;
            const float least = scale * this->least(t, normal);
            if (part >= kNear * least) continue;
            any = true;
            wanted[b][t] *= least / part;
        }
    });
    return any;
}

} // namespace acdf::compress
