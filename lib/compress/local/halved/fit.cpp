#include "compress/local/halved/fit.h"

#include "compress/halvings/code_bits.h"
#include "compress/halvings/row_size.h"
#include "compress/halvings/rows.h"
#include "compress/local/halved/filled_rows.h"
#include "compress/local/halved/least_parts.h"
#include "compress/local/halved/tile_light.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr float kAlike = 0.9f; // of a round of growth
constexpr std::size_t kMostTop = 16384;
constexpr std::size_t kCountedHalvings = 500; // at the top, by which codes of rows are counted
// Beside a partner: 8 subdivisions at 128 KiB and 12 at 1 MB.
constexpr double kFilledSubdivisions = 8.0, kFilledAt = 131072.0, kFilledRises = 0.2, kFilledFewBits = 400e3;
// Beside a partner cells are worth little until they part what is brighter than a threshold from what is not: gains
// do not foretell it, and a tile has at least so many cells.
constexpr std::size_t kFewestCells = 4;
constexpr double kWeightOfCells = 0.6;  // of a bound on weights; the rest is for cosines of what lies in a tile
constexpr int kRaises = 4;              // of rows whose codes do not keep it
constexpr std::size_t kFewestCodes = 4; // of those foreseen, one in so many
constexpr double kFewestRows = 387.0, kFewestAt = 1048576.0, kFewestFalls = 0.6; // rows that a size has at least

std::size_t codes_in(const LocalHalvings& fit) {
    std::size_t codes = 0;
    for (const std::vector<std::uint16_t>& row : fit.rows) codes += row.size();
    return codes;
}

} // namespace

LocalHalvingsFitter::LocalHalvingsFitter(const Target& target, const NormalBins& normals, const Partner& partner)
    : target_(target), unit_(4.0 * ACDF_PI / integral(target)), blocks_(target), light_(blocks_),
      heuristic_(partner.heuristic) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (partner) fill_light(few_normals(normals), partner.light / partner.other);
    else weigh_light(few_normals(normals));
}

void LocalHalvingsFitter::weigh_light(SomeNormals normals) {
    const auto integrate = [&](BlockMoments& moments, const auto& of) {
        moments.integrate([&](std::uint32_t r, float* out) {
            const float* row = target_.row(r);
            for (std::uint32_t c = 0; c < target_.columns; ++c) out[c] = of(relative_light(row[c], unit_));
            return out;
        });
    };
    squares_.emplace(blocks_);
    integrate(light_, [](float light) { return light; });
    integrate(*squares_, [](float light) { return light * light; });
    weigh_by_light(blocks_, light_, normals);
    shared_.emplace(blocks_, worth_of_blocks(blocks_, normals), unit_);
    costs_.emplace(blocks_, light_, std::vector<LitNormals>{{&light_, std::move(normals)}});
}

void LocalHalvingsFitter::fill_light(SomeNormals normals, double ratio) {
    ratio_ = ratio;
    radiances_.emplace(blocks_, unit_);
    filled_light_.emplace(blocks_, normals, *radiances_, ratio);
    const FilledLight& filled = *filled_light_;
    const std::vector<std::uint32_t> row_of = blocks_of_texels(blocks_.borders(0)),
                                     column_of = blocks_of_texels(blocks_.borders(1));
    const auto integrate = [&](BlockMoments& moments, const auto& of) {
        moments.integrate([&](std::uint32_t r, float* out) {
            const float* row = target_.row(r);
            for (std::uint32_t c = 0; c < target_.columns; ++c) {
                const HalvedBox block{blocks_.rows() + row_of[r], blocks_.columns() + column_of[c]};
                const float light = relative_light(row[c], unit_);
                out[c] = light > 0.0f ? of(light, filled.spread(block, light)) : 0.0f;
            }
            return out;
        });
    };
    integrate(light_, [](float, float spread) { return spread; });
    for (std::size_t k = 0; k < FilledLight::kClasses; ++k) of_classes_.emplace_back(blocks_);
    std::vector<LitNormals> lit;
    for (std::size_t k = 0; k < of_classes_.size(); ++k) {
        if (filled.classes()[k].weights.empty()) continue;
        const auto threshold = static_cast<float>(filled.threshold(k));
        integrate(of_classes_[k], [threshold](float light, float spread) {
            const float above = std::max(0.0f, light - threshold), own = above * above / light;
            return spread > 0.0f ? own * (own / spread) : 0.0f;
        });
        lit.push_back({&of_classes_[k], filled.classes()[k]});
    }
    shared_.emplace(blocks_, worth_of_blocks(blocks_, filled.normals()), unit_);
    filled_costs_.emplace(blocks_, *shared_, filled);
    costs_.emplace(blocks_, light_, std::move(lit));
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
    if (ratio_ > 0.0) {
        const double n = kFilledSubdivisions * std::pow(bytes / kFilledAt, kFilledRises);
        return {fixed ? fixed : static_cast<std::uint32_t>(std::clamp(std::lround(n), 3l, 20l)),
                bytes < kFilledFewBits ? 6u : 7u};
    }
    const double rows =
        fixed ? 4.0 * fixed * fixed + 2.0 : std::max(1.0, kFewestRows * std::pow(bytes / kFewestAt, kFewestFalls));
    const HalvedGrowth& top =
        grown_top(static_cast<std::size_t>(std::min(bytes * 8.0 / (rows * 6.0 * 0.5), 1e9)) + 1);
    if (!mixing_) mixing_ = mixing_variance(blocks_, light_, top.nodes(), octahedral_bins(8));
    return choose_rows(top, *mixing_, bytes, of_bin, fixed);
}

std::size_t LocalHalvingsFitter::top_for(double bytes, const NormalBins& bins, std::uint32_t code_bits) {
    const double rows = double(bins.stored());
    const HalvedGrowth& few = grown_top(kCountedHalvings);
    const std::size_t counted = std::min(kCountedHalvings, few.leaves() - 1);
    const double seen =
        counted > 0 ? double(codes_of(first_halvings(few.nodes(), counted), bins)) / double(counted) : rows * kSeen;
    const double row_bits = std::max(1.0, seen * code_bits);
    const HalvedGrowth& top = grown_top(static_cast<std::size_t>(std::min(bytes * 8.0 / row_bits, 1e9)) + 1);
    return choose_top(top, below(), shared_->cost_unit(), row_bits, bytes);
}

/// How many codes rows have: where they see any light of a node that is halved.
std::size_t LocalHalvingsFitter::codes_of(const std::vector<HalvedNode>& top, const NormalBins& bins) const {
    Normals stored;
    std::vector<Direction> normals;
    for (std::size_t b = 0; b < bins.normals.size(); ++b)
        if (bins.weight[b] > 0.0) stored.add(bins.normals[b]), normals.push_back(bins.normals[b]);
    std::vector<double> thresholds(normals.size());
    if (radiances_)
        parallel_for(std::size_t{0}, normals.size(),
                     [&](std::size_t b) { thresholds[b] = radiances_->seen(normals[b], ratio_).threshold; });
    std::vector<std::vector<std::uint8_t>> sees(top.size(), std::vector<std::uint8_t>(stored.size()));
    parallel_for(std::size_t{0}, top.size(), [&](std::size_t i) {
        if (top[i].lower != 0) return;
        std::vector<float> seen(stored.size());
        light_.seen(top[i].box, stored, seen.data());
        const double brightest = radiances_ ? radiances_->brightest(top[i].box) : 0.0;
        for (std::size_t b = 0; b < seen.size(); ++b)
            sees[i][b] = seen[b] > 0.0f && (!radiances_ || brightest > thresholds[b]);
    });
    std::size_t codes = 0;
    for (std::size_t i = top.size(); i-- > 0;) {
        if (top[i].lower == 0) continue;
        for (std::size_t b = 0; b < stored.size(); ++b)
            codes += sees[i][b] = sees[top[i].lower][b] | sees[top[i].lower + 1][b];
    }
    return codes;
}

/// Of leaves, and of nodes what is below. Samples of a leaf weigh at most `heaviest` times those of its tile.
std::vector<double> LocalHalvingsFitter::weights_of(const std::vector<HalvedNode>& nodes, std::size_t top,
                                                    double heaviest) const {
    std::vector<double> out(nodes.size()), moments(nodes.size()); // of the light alone
    const std::size_t below = 2 * top + 1;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const std::uint32_t lower = nodes[i].lower;
        if (lower) {
            out[i] = out[lower] + out[lower + 1];
            moments[i] = moments[lower] + moments[lower + 1];
        } else {
            const double alone = shared_->alone(nodes[i].box);
            out[i] = filled_costs_ ? filled_costs_->weight(nodes[i].box) : alone;
            if (heaviest > 0.0)
                out[i] = std::max(out[i], peak_of(peaks_of(target_), shared_->costs().axes(), nodes[i].box) *
                                              unit_ / heaviest);
            moments[i] = out[i] > 0.0 ? alone * (alone / out[i]) : 0.0;
        }
        // Above tiles only points without a normal follow the codes that all share, without a partner.
        if (i < below && (lower == 0 || lower >= below)) out[i] = std::sqrt(moments[i] * out[i]);
    }
    return out;
}

namespace {

std::vector<HalvedBox> boxes_of(const RowTree& tree, const std::vector<HalvedNode>& nodes) {
    std::vector<HalvedBox> out;
    for (const RowTree::Tile& tile : tree.tiles()) out.push_back(nodes[tile.node].box);
    return out;
}

/// The row of each bin, in codes; `parts` become what it gives to tiles, by its share.
void code(const RowTree& tree, const NormalBins& bins, RowParts& parts, LocalHalvings& out) {
    out.halvings = tree.halvings();
    out.has_codes = tree.has_codes();
    out.shares.assign(bins.normals.size(), 0.0f);
    out.roots.assign(bins.normals.size(), ACDF_NO_ROOT);
    std::uint32_t count = 0;
    for (std::size_t b = 0; b < out.roots.size(); ++b)
        if (bins.weight[b] > 0.0) out.roots[b] = count++;
    out.rows.resize(count);
    const HalvingCodes own(out.code_bits);
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
}

} // namespace

void LocalHalvingsFitter::mixed(const RowTree& tree, const std::vector<HalvedNode>& nodes, const NormalBins& bins,
                                double max_weight, LocalHalvings& out) const {
    const std::vector<HalvedBox> tiles = boxes_of(tree, nodes);
    const BlockMoments light = light_of_tiles(blocks_, *shared_, *squares_, tree, nodes);
    const MixedRows rows(light, tiles, bins);
    RowParts wanted = rows.parts(), parts;
    std::optional<LeastParts> least;
    if (std::isfinite(max_weight)) least.emplace(blocks_, shared_->costs().axes(), unit_, max_weight, tree, nodes);
    for (int step = 0; step <= kRaises; ++step) { // a code may stand for less than half of what is wanted
        parts = wanted;
        code(tree, bins, parts, out);
        if (!least || !least->raise(bins, parts, rows.surplus(parts), wanted)) break;
    }
    out.mixing_variance = rows.variance(parts);
}

void LocalHalvingsFitter::filled(const RowTree& tree, const std::vector<HalvedNode>& nodes, const NormalBins& bins,
                                 LocalHalvings& out) const {
    const std::vector<HalvedBox> tiles = boxes_of(tree, nodes);
    std::vector<std::vector<FilledCell>> cells;
    const HalvedAxes& axes = shared_->costs().axes();
    for (const RowTree::Tile& tile : tree.tiles()) {
        cells.emplace_back();
        for (const RowTree::Leaf& leaf : tile.leaves) {
            const HalvedBox box = nodes[leaf.node].box;
            const double alone = shared_->alone(box), measure = axes.measure(box);
            cells.back().push_back({alone * alone / measure, measure, leaf.share});
        }
    }
    const FilledRows rows(light_, tiles, cells, bins, *radiances_, ratio_, heuristic_);
    RowParts parts = rows.parts();
    code(tree, bins, parts, out);
    out.records.assign(bins.normals.size(), {1.0f, 0.0f});
    parallel_for(std::size_t{0}, parts.size(), [&](std::size_t b) {
        if (!parts[b].empty()) out.records[b] = rows.record(b, parts[b], 4.0 * ACDF_PI);
    });
}

LocalHalvings LocalHalvingsFitter::grown(std::vector<HalvedNode> top, std::size_t all, const NormalBins& bins,
                                         const LocalHalvingsSize& size, const Progress& progress) const {
    const std::size_t halvings = top.size() / 2;
    const double heaviest = std::isfinite(size.max_weight) ? kWeightOfCells * size.max_weight : 0.0;
    HalvedGrowth growth({{0, all + 1}}, {kAlike, 0.0, heaviest});
    growth.run_below(std::move(top), below(), Loop(false), [&](double share) { progress(0.6 * share); });
    const RowTree tree(growth.nodes(), halvings, weights_of(growth.nodes(), halvings, heaviest),
                       {target_.row_axis, target_.column_axis});
    progress(0.7);
    LocalHalvings out;
    out.code_bits = size.code_bits;
    if (ratio_ > 0.0) filled(tree, growth.nodes(), bins, out);
    else mixed(tree, growth.nodes(), bins, size.max_weight, out);
    progress(1.0);
    return out;
}

LocalHalvings LocalHalvingsFitter::fit(const NormalBins& bins, const LocalHalvingsSize& size,
                                       const Progress& progress) {
    const HalvedGrowth& whole_top = grown_top(size.top);
    std::size_t halvings = std::min({size.top, size.halvings, whole_top.leaves() - 1}), codes = 0;
    const bool partner = ratio_ > 0.0;
    std::vector<HalvedNode> top;
    for (;; halvings = halvings * 3 / 4) {
        top = first_halvings(whole_top.nodes(), halvings);
        codes = codes_of(top, bins);
        const std::size_t least = partner ? std::min(kFewestCells * halvings, target_.values.size() - 1) : halvings;
        if (row_bytes(std::max(least, halvings), codes, size.code_bits) <= size.bytes &&
            are_dense(bins.stored(), halvings, codes / kFewestCodes, size.code_bits))
            break;
        if (halvings == 0) throw std::runtime_error("no tree fits into the budget");
    }
    const auto attempt = [&](std::size_t most_codes, double begin, double end) {
        const std::size_t all = std::min(halvings_within(size.bytes, most_codes, size.code_bits), size.halvings);
        return grown(top, all, bins, size, [&](double share) {
            if (progress) progress(begin + share * (end - begin));
        });
    };
    LocalHalvings out = attempt(codes, 0.2, partner ? 0.6 : 1.0);
    // Beside a partner rows have fewer codes than they might: what those leave is for halvings that all share.
    const std::size_t used = codes_in(out);
    if (!partner || used + used / 32 >= codes) return out;
    LocalHalvings more = attempt(used + used / 64, 0.6, 1.0);
    return row_bytes(more.halvings.codes.size(), codes_in(more), size.code_bits) <= size.bytes ? more : out;
}

} // namespace acdf::compress
