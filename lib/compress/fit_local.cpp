// Tiles, then curves within them at one price a byte, then a row of probabilities for each bin: docs/local.md.
#include "compress/fit_local.h"

#include "compress/fit_shared.h"
#include "compress/light.h"
#include "compress/local_company.h"
#include "compress/mixed_rows.h"
#include "compress/tile_curves.h"
#include "compress/tile_light.h"

#include <acdf/local.h>

#include <tbb/parallel_for.h>

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

struct Curves {
    std::unique_ptr<TileCascade> cascade;
    EncodedTree tree;
};

/// The curves at the lowest price at which they take at most `bytes`.
Curves fit_curves(const TileTree& tiles, TileCurves& curves, std::uint64_t bytes, double most_ratio) {
    const auto at = [&](double price) {
        Curves out;
        out.cascade = std::make_unique<TileCascade>(tiles, curves, price);
        out.tree = encode_tree(out.cascade->cascade, 2.0 * price, most_ratio);
        return out;
    };
    constexpr double cheapest = 1e-14; // of the sum of costs: rounding, no gain
    double price = 1e-4;
    Curves best;
    for (;; price *= 0.25) {
        curves.refine(price);
        best = at(price);
        if (best.tree.bytes.size() > bytes || price < cheapest) break;
    }
    if (best.tree.bytes.size() <= bytes) return best;
    double low = price, high = 1.0;
    best = at(high);
    for (int step = 0; step < 24; ++step) {
        const double middle = std::sqrt(low * high);
        Curves candidate = at(middle);
        if (candidate.tree.bytes.size() > bytes) {
            low = middle;
        } else {
            high = middle;
            best = std::move(candidate);
        }
    }
    return best;
}

constexpr std::uint32_t kManyLights = 2 * ACDF_MAX_LIGHTS; // the brightest half of them is taken

/// Tiles, and the rule by which they become lights. Where that of most probes finds many more lights than there may
/// be, as it does in large bright areas and for normals that nearly all light is hidden from, tiles would be spent
/// on them in vain: lights are larger then, and only the brightest.
LightRule divide(const Target& target, const Worth& worth, std::uint32_t count, TileTree& tiles) {
    LightRule rule;
    tiles = divide_tiles(target, worth, count, rule);
    if (tiles.lights <= kManyLights) return rule;
    rule = {rule.alarm, 1.5 * rule.radius, true};
    for (int step = 0; step < 12; ++step, rule.alarm *= 3.0) {
        tiles = divide_tiles(target, worth, count, rule);
        if (tiles.lights <= kManyLights) break;
    }
    return rule;
}

/// Tiles of light so bright that, near the horizon, mixing the rows of bins would draw many samples below it.
std::vector<AcdfLight> find_lights(const Target& target, const TileTree& tiles, const TileCascade& cascade,
                                   double total, const Worth& worth, const LightRule& rule) {
    std::vector<std::pair<double, AcdfLight>> found;
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t) {
        const Box& box = tiles.tiles[t];
        const double reach = radius(target, box), share = cascade.tile_cost(t);
        const double alarm =
            share * total *
            worth.alarm.at(double(box.begin[1]) / target.columns, double(box.begin[0]) / target.rows);
        if (reach > rule.radius || alarm < rule.alarm || !(static_cast<float>(share) > 0.0f)) continue;
        const Direction middle = centre(target, box);
        AcdfLight light = {};
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
    if (found.size() > ACDF_MAX_LIGHTS) found.resize(ACDF_MAX_LIGHTS);
    std::vector<AcdfLight> out;
    for (const auto& light : found) out.push_back(light.second);
    std::sort(out.begin(), out.end(), [](const AcdfLight& a, const AcdfLight& b) { return a.tile < b.tile; });
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

/// Rows and shares of all bins that occur; `costs(bin)` are what tiles are drawn in proportion to, and
/// `row(bin, costs)` the bytes of that.
template <class Costs, class Row>
void fill_rows(const Costs& costs, const Row& row_of, const NormalBins& bins, LocalFit& out) {
    const std::size_t count = bins.normals.size(), width = out.tiles.splits.size();
    out.shares.assign(count, 0.0f);
    out.tree.roots.assign(count, ACDF_NO_ROOT);
    for (std::size_t b = 0; b < count; ++b)
        if (bins.weight[b] > 0.0) out.tree.roots[b] = out.shared.row_count++;
    out.shared.codes.resize(out.shared.row_count * width);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
        if (out.tree.roots[b] == ACDF_NO_ROOT) return;
        const std::vector<double> cost = costs(b);
        double sum = 0.0;
        for (double c : cost) sum += c;
        const std::vector<std::uint8_t> row = row_of(b, cost);
        std::copy(row.begin(), row.end(), out.shared.codes.begin() + std::ptrdiff_t(out.tree.roots[b] * width));
        out.shares[b] = static_cast<float>(sum);
    });
}

} // namespace

LocalFit fit_local(const Target& target, const NormalBins& bins, const LocalSize& size, const Progress& progress,
                   const Company& company) {
    const auto report = [&](double share) {
        if (progress) progress(share);
    };
    if (!has_energy(target)) throw std::invalid_argument("a target without energy");
    if (bins.subdivisions == 0) throw std::invalid_argument("cells of normals cannot share tiles");
    const std::vector<LightPoint> points = light_points(target);
    const std::vector<double> flux = irradiance(points, bins);
    const Worth light_worth = worth(target, bins, flux);
    std::optional<LocalCompany> beside;
    if (company) beside.emplace(target, points, bins, flux, company);
    report(0.1);
    LocalFit out;
    const LightRule rule = divide(beside ? beside->excess(target) : target, light_worth,
                                  std::min(size.tiles, ACDF_MAX_TILES), out.tiles);
    report(0.4);
    const Target filled = beside ? beside->filled(target) : Target{};
    const Target& fitted = beside ? filled : target;
    const bool bounded = std::isfinite(size.max_weight);
    TileCurves tile_curves(fitted, out.tiles.tiles, worth_of_tiles(target, out.tiles.tiles, light_worth),
                           kWeightOfCells * size.max_weight);
    constexpr double near = 1.01, any = std::numeric_limits<double>::infinity();
    Curves curves = fit_curves(out.tiles, tile_curves, size.tree_bytes, bounded ? near : any);
    report(0.8);
    out.lights = find_lights(target, out.tiles, *curves.cascade, tile_curves.total(), light_worth, rule);
    out.tree = std::move(curves.tree);
    out.shared.splits = stored_splits(out.tiles, [](const TileTree::Split& split) {
        return std::uint32_t{split.axis == 0 ? ACDF_AXIS_THETA : ACDF_AXIS_PHI} | split.position << 3;
    });
    out.shared.codebook = row_codebook();
    for (std::int32_t curve : curves.cascade->tile_curve)
        out.shared.tile_roots.push_back(curve < 0 ? ACDF_NO_ROOT : out.tree.offsets[std::size_t(curve)]);
    if (beside) {
        const FilledTiles light(target, out.tiles, tile_curves, *curves.cascade, out.lights, *beside, bins);
        out.records.resize(bins.normals.size(), {1.0f, 0.0f});
        fill_rows(
            [&](std::size_t b) {
                std::vector<double> shares = light.shares(b);
                for (double& share : shares) share /= tile_curves.total();
                out.records[b] = {light.recommended_share(b, shares),
                                  static_cast<float>(flux[b] / tile_curves.total())};
                return shares;
            },
            [&](std::size_t, const std::vector<double>& shares) { return encode_row(out.tiles, shares); }, bins,
            out);
    } else {
        const TileLight light(target, out.tiles, *curves.cascade, out.lights);
        const TileParts parts = mixed_rows(light, bins, out.lights);
        fill_rows([&](std::size_t b) { return std::vector<double>(parts[b].begin(), parts[b].end()); },
                  [&](std::size_t b, const std::vector<double>& costs) {
                      if (!bounded) return encode_row(out.tiles, costs);
                      return row_above(out, costs, light.least(bins.normals[b], costs, size.max_weight));
                  },
                  bins, out);
    }
    out.cascade = std::move(curves.cascade->cascade);
    report(1.0);
    return out;
}

} // namespace acdf::compress
