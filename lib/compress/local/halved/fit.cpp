#include "compress/local/halved/fit.h"

#include "compress/halvings/bit_writer.h"
#include "compress/halvings/code_bits.h"
#include "compress/halvings/rows.h"
#include "compress/local/halved/rows.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr float kAlike = 0.9f; // of a round of growth
constexpr std::size_t kMostTop = 16384;
constexpr double kFewestRows = 387.0, kFewestAt = 1048576.0, kFewestFalls = 0.6; // rows that a size has at least

std::size_t words(std::size_t bits) { return (bits + 31) / 32 * 4; }

std::size_t whole_chunk(std::size_t bytes) {
    return (bytes + ACDF_ALIGNMENT - 1) / ACDF_ALIGNMENT * ACDF_ALIGNMENT;
}

std::size_t bytes_of(std::size_t halvings, std::size_t codes, std::uint32_t code_bits) {
    return whole_chunk(halvings_bytes(halvings + 1, kAxisBits, kSharedCodeBits)) +
           whole_chunk(sizeof(AcdfNormalsHeader) + words(halvings) + words(codes * code_bits));
}

/// The most halvings with which chunks take at most `bytes`.
std::size_t halvings_within(std::uint64_t bytes, std::size_t codes, std::uint32_t code_bits) {
    std::size_t low = 0, high = std::min<std::uint64_t>(bytes, ACDF_MOST_HALVINGS);
    while (low < high) {
        const std::size_t middle = low + (high - low + 1) / 2;
        if (bytes_of(middle, codes, code_bits) <= bytes) low = middle;
        else high = middle - 1;
    }
    return low;
}

} // namespace

Chunk normals_chunk(const LocalHalvings& fit) {
    const auto splits = static_cast<std::uint32_t>(std::count(fit.has_codes.begin(), fit.has_codes.end(), true));
    const AcdfNormalsHeader header = {static_cast<std::uint32_t>(fit.rows.size()), splits, fit.code_bits, 0};
    Chunk chunk{ACDF_CHUNK_NORMALS, {}};
    chunk.bytes.resize(sizeof header);
    std::memcpy(chunk.bytes.data(), &header, sizeof header);
    BitWriter bits(chunk.bytes);
    for (const bool own : fit.has_codes) bits.put(own, 1);
    bits.pad();
    for (const std::vector<std::uint16_t>& row : fit.rows)
        for (const std::uint16_t code : row) bits.put(code, fit.code_bits);
    bits.pad();
    return chunk;
}

LocalHalvingsFitter::LocalHalvingsFitter(const Target& target, const NormalBins& normals)
    : target_(target), unit_(4.0 * ACDF_PI / integral(target)), blocks_(target), light_(blocks_),
      squares_(blocks_) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    const auto scaled = [&](std::uint32_t r, float* out, bool squared) {
        const float* row = target_.row(r);
        for (std::uint32_t c = 0; c < target_.columns; ++c) {
            const double g = double{row[c]} * unit_;
            out[c] = positive_float(squared ? g * g : g);
        }
        return out;
    };
    light_.integrate([&](std::uint32_t r, float* out) { return scaled(r, out, false); });
    squares_.integrate([&](std::uint32_t r, float* out) { return scaled(r, out, true); });
    costs_.emplace(blocks_, light_, few_normals(normals));
    shared_.emplace(blocks_, worth_of_blocks(blocks_, costs_->normals()), unit_);
}

const HalvedGrowth& LocalHalvingsFitter::grown_top(std::size_t halvings) {
    halvings = std::min(halvings, kMostTop);
    if (top_ && top_asked_ >= halvings) return *top_;
    top_asked_ = halvings;
    top_.emplace(std::vector<TreeSize>{{0, halvings + 1}}, GrowthLimits{kAlike});
    top_->run(*costs_, Loop(false), {});
    return *top_;
}

RowSize LocalHalvingsFitter::rows_for(double bytes, double of_bin, std::uint32_t fixed) {
    const double rows = fixed ? 4.0 * fixed * fixed + 2.0 : kFewestRows * std::pow(bytes / kFewestAt, kFewestFalls);
    const HalvedGrowth& top = grown_top(static_cast<std::size_t>(bytes * 8.0 / (rows * 6.0 * 0.5)) + 1);
    if (!mixing_) mixing_ = mixing_variance(blocks_, light_, top.nodes(), octahedral_bins(8));
    return choose_rows(top, *mixing_, bytes, of_bin, fixed);
}

std::size_t LocalHalvingsFitter::top_for(double bytes, std::size_t rows, std::uint32_t code_bits) {
    const HalvedGrowth& top =
        grown_top(static_cast<std::size_t>(bytes * 8.0 / (double(rows) * code_bits * 0.5)) + 1);
    return choose_top(top, *shared_, rows, code_bits, bytes);
}

/// How many codes rows have: where they see any light of a node that is halved.
std::size_t LocalHalvingsFitter::codes_of(const std::vector<HalvedNode>& top, const NormalBins& bins) const {
    Normals stored;
    for (std::size_t b = 0; b < bins.normals.size(); ++b)
        if (bins.weight[b] > 0.0) stored.add(bins.normals[b]);
    std::vector<std::vector<std::uint8_t>> sees(top.size(), std::vector<std::uint8_t>(stored.size()));
    parallel_for(std::size_t{0}, top.size(), [&](std::size_t i) {
        if (top[i].lower != 0) return;
        std::vector<float> seen(stored.size());
        light_.seen(top[i].box, stored, seen.data());
        for (std::size_t b = 0; b < seen.size(); ++b) sees[i][b] = seen[b] > 0.0f;
    });
    std::size_t codes = 0;
    for (std::size_t i = top.size(); i-- > 0;) {
        if (top[i].lower == 0) continue;
        for (std::size_t b = 0; b < stored.size(); ++b)
            codes += sees[i][b] = sees[top[i].lower][b] | sees[top[i].lower + 1][b];
    }
    return codes;
}

/// h of a cell: the square of its light, times its measure over its share of a tile's samples.
BlockMoments LocalHalvingsFitter::light_of_tiles(const RowTree& tree, const std::vector<HalvedNode>& nodes) const {
    BlockMoments out(blocks_);
    const HalvedAxes& axes = shared_->costs().axes();
    const std::uint32_t rows = blocks_.rows(), columns = blocks_.columns();
    const auto add = [&](HalvedBox box, double share) {
        std::uint32_t r[2] = {box.rows, box.rows + 1}, c[2] = {box.columns, box.columns + 1};
        const bool low = box.rows < 2 * rows, left = box.columns < 2 * columns;
        while (r[0] < rows) r[0] *= 2, r[1] *= 2;
        while (c[0] < columns) c[0] *= 2, c[1] *= 2;
        if (low && left) {
            const double factor = axes.measure(box) / share;
            for (std::uint32_t i = r[0]; i < r[1]; ++i)
                for (std::uint32_t k = c[0]; k < c[1]; ++k) {
                    BlockMoment& to = out[{i, k}];
                    to = squares_[{i, k}];
                    for (float& q : to.quad) q = static_cast<float>(double{q} * factor);
                    to.sum = static_cast<float>(double{to.sum} * factor);
                }
            return;
        }
        // It cuts blocks: of the part in each, all light comes from the middle.
        const auto cut = [&](std::uint32_t number, std::uint32_t blocks) {
            while (number >= 2 * blocks) number /= 2;
            return number;
        };
        for (std::uint32_t i = low ? r[0] : box.rows; i < (low ? r[1] : box.rows + 1); ++i)
            for (std::uint32_t k = left ? c[0] : box.columns; k < (left ? c[1] : box.columns + 1); ++k) {
                HalvedBox part{i, k};
                double of = 1.0; // texels may be larger than blocks
                for (; !axes.rows.has(part.rows); part.rows /= 2) of *= 0.5;
                for (; !axes.columns.has(part.columns); part.columns /= 2) of *= 0.5;
                const double alone = shared_->alone(part) * of;
                if (!(alone > 0.0)) continue;
                const double light = alone * alone / (axes.measure(part) * of) * axes.measure(box) / share;
                const Direction d =
                    direction_at(target_, 0.5 * (axes.rows.low(part.rows) + axes.rows.high(part.rows)),
                                 0.5 * (axes.columns.low(part.columns) + axes.columns.high(part.columns)));
                BlockMoment& to = out[{cut(i, rows), cut(k, columns)}];
                to = to + moment_of(d, light);
            }
    };
    for (const RowTree::Tile& tile : tree.tiles())
        for (const RowTree::Leaf& leaf : tile.leaves)
            if (leaf.share > 0.0) add(nodes[leaf.node].box, leaf.share);
    out.add_up();
    return out;
}

LocalHalvings LocalHalvingsFitter::fit(const NormalBins& bins, const LocalHalvingsSize& size,
                                       const Progress& progress) {
    const auto report = [&](double share) {
        if (progress) progress(share);
    };
    const HalvedGrowth& grown = grown_top(size.top);
    std::size_t halvings = std::min({size.top, size.halvings, grown.leaves() - 1}), codes = 0, all = 0;
    std::vector<HalvedNode> top;
    for (;; halvings = halvings * 3 / 4) {
        top = first_halvings(grown.nodes(), halvings);
        codes = codes_of(top, bins);
        if (bytes_of(halvings, codes, size.code_bits) <= size.bytes) break;
        if (halvings == 0) throw std::runtime_error("no tree fits into the budget");
    }
    report(0.2);
    all = std::min(halvings_within(size.bytes, codes, size.code_bits), size.halvings);
    HalvedGrowth growth({{0, all + 1}}, {kAlike});
    growth.run_below(std::move(top), shared_->costs(), Loop(false),
                     [&](double share) { report(0.2 + 0.3 * share); });
    const std::vector<HalvedNode>& nodes = growth.nodes();
    std::vector<double> weights(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const std::uint32_t lower = nodes[i].lower;
        weights[i] = lower ? weights[lower] + weights[lower + 1] : shared_->alone(nodes[i].box);
    }
    const RowTree tree(nodes, halvings, weights, {target_.row_axis, target_.column_axis});
    std::vector<HalvedBox> tiles;
    for (const RowTree::Tile& tile : tree.tiles()) tiles.push_back(nodes[tile.node].box);
    const BlockMoments light = light_of_tiles(tree, nodes);
    report(0.6);
    const MixedRows rows(light, tiles, bins);
    RowParts parts = rows.parts();
    report(0.9);
    LocalHalvings out;
    out.halvings = tree.halvings();
    out.has_codes = tree.has_codes();
    out.code_bits = size.code_bits;
    out.shares.assign(bins.normals.size(), 0.0f);
    out.roots.assign(bins.normals.size(), ACDF_NO_ROOT);
    std::uint32_t count = 0;
    for (std::size_t b = 0; b < out.roots.size(); ++b)
        if (bins.weight[b] > 0.0) out.roots[b] = count++;
    out.rows.resize(count);
    const HalvingCodes own(size.code_bits);
    parallel_for(std::size_t{0}, parts.size(), [&](std::size_t b) {
        if (parts[b].empty()) return;
        double sum = 0.0;
        for (const float part : parts[b]) sum += double{part};
        CodedRow row = tree.row(own, {parts[b].begin(), parts[b].end()}, Unreached::left_out);
        out.shares[b] = positive_float(sum / (4.0 * ACDF_PI));
        for (std::size_t t = 0; t < parts[b].size(); ++t)
            parts[b][t] = static_cast<float>(row.steps[t] * 0x1p-31 * sum);
        out.rows[out.roots[b]] = std::move(row.codes);
    });
    out.relative_variance = rows.variance(parts);
    report(1.0);
    return out;
}

} // namespace acdf::compress
