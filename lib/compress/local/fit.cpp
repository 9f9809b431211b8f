// Tiles, then curves within them at one price a byte, then a row of probabilities for each bin:
// docs/notes/local-method.md.
#include "compress/local/fit.h"

#include "compress/fit/shared.h"
#include "compress/local/light.h"
#include "compress/local/mixed_rows.h"
#include "compress/local/partner.h"
#include "compress/local/tile_curves.h"
#include "compress/local/tile_light.h"
#include "compress/local/tile_size.h"
#include "compress/local/whole.h"
#include "compress/parallel.h"

#include <acdf/local.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

namespace acdf::compress {
namespace {

/// Of a bound on weights, what cells alone may take; the rest is for the cosines of what lies in a tile.
constexpr double kWeightOfCells = 0.5;
constexpr int kRowRaises = 12; // of rows whose bytes do not keep a bound on weights

std::vector<double> worth_of_tiles(const Target& target, const std::vector<Box>& tiles, const Worth& worth) {
    std::vector<double> out;
    for (const Box& tile : tiles) {
        double sum = 0.0;
        for_each_block(target, tile, 0.05, [&](const Box& block, double share) {
            sum += share *
                   worth.mean.at(double(block.begin[1]) / target.columns, double(block.begin[0]) / target.rows);
        });
        out.push_back(sum);
    }
    return out;
}

constexpr std::uint32_t kManyBrightTiles = 2 * ACDF_MAX_BRIGHT_TILES; // the brightest half of them is taken

/// Tiles, and the rule by which they become bright tiles. Where that of most probes finds many more bright tiles
/// than there may be, as it does in large bright areas and for normals that nearly all light is hidden from, tiles
/// would be spent on them in vain: bright tiles are larger then, and only the brightest.
BrightTileRule divide(const Target& target, const Worth& worth, std::uint32_t count, TileTree& tiles) {
    BrightTileRule rule;
    tiles = divide_tiles(target, worth, count, rule);
    if (tiles.bright_tiles <= kManyBrightTiles) return rule;
    rule = {rule.alarm, 1.5 * rule.radius, true};
    for (int step = 0; step < 12; ++step, rule.alarm *= 3.0) {
        tiles = divide_tiles(target, worth, count, rule);
        if (tiles.bright_tiles <= kManyBrightTiles) break;
    }
    return rule;
}

/// Tiles of light so bright that, near the horizon, mixing the rows of bins would sample many samples below it.
std::vector<AcdfBrightTile> find_lights(const Target& target, const TileTree& tiles, const TileInsides& insides,
                                        double total, const Worth& worth, const BrightTileRule& rule) {
    std::vector<std::pair<double, AcdfBrightTile>> found;
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
        const Box& box = tiles.tiles[t];
        const double reach = radius(target, box), share = insides.tile_cost(t);
        const double alarm =
            share * total *
            worth.alarm.at(double(box.begin[1]) / target.columns, double(box.begin[0]) / target.rows);
        if (reach > rule.radius || alarm < rule.alarm || !(static_cast<float>(share) > 0.0f)) continue;
        const Direction middle = centre(target, box);
        AcdfBrightTile light = {};
        for (std::size_t k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(middle[k]);
        light.radius = static_cast<float>(reach + kHorizonMargin);
        light.share = static_cast<float>(share);
        light.tile = static_cast<std::uint32_t>(t);
        light.low[ACDF_AXIS_PHI] = box.begin[1];
        light.high[ACDF_AXIS_PHI] = box.end[1];
        light.low[ACDF_AXIS_THETA] = box.begin[0];
        light.high[ACDF_AXIS_THETA] = box.end[0];
        found.push_back({alarm, light});
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > ACDF_MAX_BRIGHT_TILES) found.resize(ACDF_MAX_BRIGHT_TILES);
    std::vector<AcdfBrightTile> out;
    for (const auto& light : found) out.push_back(light.second);
    std::sort(out.begin(), out.end(),
              [](const AcdfBrightTile& a, const AcdfBrightTile& b) { return a.tile < b.tile; });
    return out;
}

/// The row of `cost`, raised where what its bytes stand for is less than `least`.
std::vector<std::uint8_t> row_above(const LocalFit& fit, std::vector<double> cost, std::vector<double> least) {
    double sum = 0.0;
    for (std::size_t t = 0; t < cost.size(); ++t) sum += cost[t] = std::max(cost[t], least[t]);
    std::vector<std::uint8_t> row = encode_row(fit.tiles, cost);
    for (int step = 0; step < kRowRaises; ++step) {
        const std::vector<double> stored = decode_row(fit.tiles, fit.shared.codebook, row.data());
        bool any = false;
        for (std::size_t t = 0; t < cost.size(); ++t)
            if (stored[t] * sum < 0.99 * least[t]) {
                cost[t] *= least[t] / (stored[t] * sum);
                any = true;
            }
        if (!any) break;
        row = encode_row(fit.tiles, cost);
    }
    return row;
}

/// Rows and shares of all bins that occur; `costs(bin)` are what tiles are sampled in proportion to, and
/// `put(bin, costs)` stores that.
template <class Costs, class Put>
void fill_rows(const Costs& costs, const Put& put, LocalFit& out) {
    parallel_for(std::size_t{0}, out.tree.roots.size(), [&](std::size_t b) {
        if (out.tree.roots[b] == ACDF_NO_ROOT) return;
        const std::vector<double> cost = costs(b);
        double sum = 0.0;
        for (double c : cost) sum += c;
        put(b, cost);
        out.shares[b] = static_cast<float>(sum);
    });
}

void put_row(const std::vector<std::uint8_t>& row, std::uint32_t number, StoredRows& out) {
    std::copy(row.begin(), row.end(), out.codes.begin() + std::ptrdiff_t(number * row.size()));
}

} // namespace

LocalFitter::LocalFitter(const Target& target, const NormalBins& bins, const BinLight& light, const LocalSize& size,
                         const Progress& progress, const Partner& partner)
    : target_(target), bins_(bins), light_(light), size_(size), total_(integral(target)), progress_(progress) {
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (bins.subdivisions == 0) throw std::invalid_argument("cells of normals cannot share tiles");
    if (partner) beside_.emplace(target, light.points, bins, partner);
    report(0.1);
    rule_ = divide(beside_ ? beside_->excess(target) : target, light.worth, std::min(size.tiles, ACDF_MAX_TILES),
                   tiles_);
    report(0.4);
    if (beside_) filled_ = beside_->filled(target);
    worth_of_tiles_ = worth_of_tiles(target, tiles_.tiles, light.worth);
    if (whole_tree() == WholeTree::of_tiles) // of all normals the light times its worth adds up to 1
        for (double& worth : worth_of_tiles_) worth += size.whole_worth / total_;
    if (whole_tree() == WholeTree::own) refit_whole(size_.whole_bytes);
}

void LocalFitter::refit_whole(std::uint64_t bytes) { whole_ = fit_whole(target_, bytes); }

/// The curves at the lowest price at which they take at most `bytes`.
LocalFitter::Curves LocalFitter::fit_curves(std::uint64_t bytes) {
    const double any = std::numeric_limits<double>::infinity(), most_ratio = size_.max_weight < any ? 1.01 : any;
    const auto byte_price = [](double price) { return 2.0 * price; };
    const auto at = [&](double price) {
        Curves out;
        out.cascade = std::make_unique<TileCascade>(tiles_, *tile_curves_, price, whole_tree());
        out.tree = encode_tree(out.cascade->cascade, byte_price(price), most_ratio, whole_.tree.bytes);
        return out;
    };
    const std::uint64_t before = whole_.tree.bytes.size();
    TileSizer sizer(tiles_, *tile_curves_, most_ratio, whole_tree(), before);
    const auto too_large = [&](double price) { return sizer.bytes(price, byte_price(price)) > before + bytes; };
    constexpr double cheapest = 1e-14; // of the sum of costs: rounding, no gain
    double low = 1e-4, high = 1.0;
    for (;; low *= 0.25) {
        tile_curves_->refine(low);
        sizer.forget();
        if (too_large(low)) break;
        if (low < cheapest) return at(low);
    }
    for (int step = 0; step < 24; ++step) {
        const double middle = std::sqrt(low * high);
        (too_large(middle) ? low : high) = middle;
    }
    return at(high);
}

void LocalFitter::outline_curves(std::uint64_t bytes, LocalFit& out) {
    tile_curves_.emplace(beside_ ? filled_ : target_, tiles_.tiles, worth_of_tiles_,
                         kWeightOfCells * size_.max_weight);
    curves_ = fit_curves(bytes);
    out.tree = curves_.tree;
    for (std::int32_t curve : curves_.cascade->tile_curve)
        out.shared.tile_roots.push_back(curve < 0 ? ACDF_NO_ROOT : out.tree.offsets[std::size_t(curve)]);
}

LocalFit LocalFitter::outlined(std::uint64_t inside_bytes) {
    LocalFit out;
    out.tiles = tiles_;
    outline_curves(inside_bytes, out);
    report(0.8);
    out.bright_tiles = find_lights(target_, tiles_, *curves_.cascade, tile_curves_->total(), light_.worth, rule_);
    out.shared.splits = stored_splits(tiles_, [](const TileTree::Split& split) {
        return std::uint32_t{split.axis == 0 ? ACDF_AXIS_THETA : ACDF_AXIS_PHI} | split.position << 3;
    });
    out.shared.codebook = row_codebook();
    const std::size_t count = bins_.normals.size();
    out.shares.assign(count, 0.0f);
    out.tree.roots.assign(count, ACDF_NO_ROOT);
    for (std::size_t b = 0; b < count; ++b)
        if (bins_.weight[b] > 0.0) out.tree.roots[b] = out.shared.row_count++;
    out.shared.codes.resize(out.shared.row_count * tiles_.splits.size());
    if (beside_) out.records.resize(count, {1.0f, 0.0f});
    return out;
}

void LocalFitter::fill_beside(LocalFit& out) const {
    const FilledTiles light(target_, tiles_, *tile_curves_, *curves_.cascade, out.bright_tiles, *beside_, bins_);
    const double total = tile_curves_->total();
    const auto shares_of = [&](std::size_t b) {
        std::vector<double> shares = light.shares(b);
        for (double& share : shares) share /= total;
        out.records[b] = {light.recommended_light_share(b, shares),
                          static_cast<float>(light_.irradiance[b] / total)};
        return shares;
    };
    const auto put = [&](std::size_t b, const std::vector<double>& shares) {
        put_row(encode_row(tiles_, shares), out.tree.roots[b], out.shared);
    };
    fill_rows(shares_of, put, out);
}

void LocalFitter::fill_mixed(LocalFit& out) const {
    const TileLight light(target_, tiles_, *curves_.cascade, out.bright_tiles);
    const TileParts parts = mixed_rows(light, bins_, out.bright_tiles);
    const auto costs = [&](std::size_t b) { return std::vector<double>(parts[b].begin(), parts[b].end()); };
    const auto put = [&](std::size_t b, const std::vector<double>& c) {
        const std::uint32_t row = out.tree.roots[b];
        if (!std::isfinite(size_.max_weight)) put_row(encode_row(tiles_, c), row, out.shared);
        else put_row(row_above(out, c, light.least(bins_.normals[b], c, size_.max_weight)), row, out.shared);
    };
    fill_rows(costs, put, out);
}

void LocalFitter::fill(LocalFit& out) const {
    if (beside_) fill_beside(out);
    else fill_mixed(out);
    out.cascade = whole_tree() == WholeTree::own ? whole_.cascade : curves_.cascade->cascade;
    report(1.0);
}

LocalFit fit_local(const Target& target, const NormalBins& bins, const LocalSize& size, const Progress& progress,
                   const Partner& partner) {
    const BinLight light(target, bins);
    LocalFitter fitter(target, bins, light, size, progress, partner);
    LocalFit out = fitter.outlined(size.inside_bytes);
    fitter.fill(out);
    return out;
}

} // namespace acdf::compress
