#include "compress/local/halved/choice.h"

#include "compress/halvings/row_size.h"
#include "compress/local/halved/mixtures.h"
#include "compress/parallel.h"

#include <acdf/layout.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kMixingAt = 8;                  // subdivisions
constexpr double kMixingFalls = 2.2;                    // the exponent with which it falls as they grow
constexpr double kMixingLeft = 0.8;                     // of what it adds, once rows are made for it
constexpr std::size_t kMixingHalvings = 500, kEach = 3; // tiles, and of mixtures one in so many
constexpr double kUsualTop = 0.75;                      // of the bytes, for codes of rows
constexpr std::uint32_t kLeastSubdivisions = 3, kMostSubdivisions = 20;
constexpr double kLeastLeft = 0.25; // of the bytes, for all but bins

double rows_of(std::uint32_t subdivisions) { return 4.0 * subdivisions * subdivisions + 2.0; }

} // namespace

double mixing_variance(const Blocks& blocks, const BlockMoments& light, const std::vector<HalvedNode>& top,
                       const NormalBins& bins) {
    std::vector<HalvedBox> tiles;
    for (const HalvedNode& node : first_halvings(top, std::min(kMixingHalvings, top.size() / 2)))
        if (node.lower == 0 && light[node.box].sum > 0.0f && blocks.has(node.box)) tiles.push_back(node.box);
    const Mixtures all(bins);
    struct Sums {
        double moments = 0.0, mixed = 0.0, cost = 0.0;
    };
    std::vector<std::size_t> some;
    Normals normals; // of each mixture, and of its three bins
    for (std::size_t j = 0; j < all.of.size(); j += kEach) {
        some.push_back(j);
        normals.x.push_back(all.normals.x[j]);
        normals.y.push_back(all.normals.y[j]);
        normals.z.push_back(all.normals.z[j]);
        for (const std::uint32_t bin : all.of[j].bin) normals.add(bins.normals[bin]);
    }
    std::vector<float> roots(tiles.size() * normals.size());
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
        float* of = &roots[t * normals.size()];
        light.seen(tiles[t], normals, of);
        const float sum = light[tiles[t]].sum;
        for (std::size_t i = 0; i < normals.size(); ++i) of[i] = std::sqrt(of[i] * sum);
    });
    double out = 0.0, weight = 0.0;
    for (std::size_t k = 0; k < some.size(); ++k) {
        const Mixture& m = all.of[some[k]];
        Sums sums;
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const float* of = &roots[t * normals.size() + 4 * k];
            const double cost = double{m.length * of[0]};
            const double mixed = double{m.weight[0] * of[1] + m.weight[1] * of[2] + m.weight[2] * of[3]};
            if (!(mixed > 0.0)) continue;
            sums.moments += cost * (cost / mixed);
            sums.mixed += mixed;
            sums.cost += cost;
        }
        if (!(sums.cost > 0.0)) continue;
        out += m.frequency * (sums.moments * sums.mixed / (sums.cost * sums.cost) - 1.0);
        weight += m.frequency;
    }
    return weight > 0.0 ? out / weight : 0.0;
}

RowSize choose_rows(const HalvedGrowth& top, double mixing, double bytes, double of_bin, std::uint32_t fixed) {
    RowSize best;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t n = fixed ? fixed : kLeastSubdivisions; n <= (fixed ? fixed : kMostSubdivisions); ++n)
        for (const std::uint32_t bits : {6u, 7u, 8u}) {
            const double left = std::max(0.0, bytes - of_bin * rows_of(n));
            if (!fixed && n > kLeastSubdivisions && left <= kLeastLeft * bytes) continue;
            const auto halvings =
                std::min(static_cast<std::size_t>(halvings_for(kUsualTop * left, rows_of(n) * bits * kSeen)),
                         top.leaves() - 1);
            const double last = double((1u << bits) - 1), depth = std::log2(double(halvings) + 1.0);
            // A code is off by its share of an angle of a quarter turn, evenly; shallow halvings are hardly.
            const double rounding = ACDF_PI * ACDF_PI / 12.0 / (last * last) * 0.66 * depth;
            const double variance = mixing * std::pow(double(kMixingAt) / n, kMixingFalls) * kMixingLeft +
                                    2.0 * (top.cost(halvings + 1) - 1.0) + rounding;
            if (!(variance < least)) continue;
            least = variance;
            best = {n, bits};
        }
    return best;
}

} // namespace acdf::compress
