#include "compress/visibility/rows.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// One of so many points is asked how well the others serve it.
constexpr std::size_t kEach = 8;

/// What is known of a cell before its own points: the share of each part that arrives, and how many points that is
/// worth.
struct Prior {
    std::vector<float> shares;
    float points = 0.0f;
};

/// A range of cells and the points that count for them, both numbered from 0.
struct Region {
    std::vector<VisibilityPoint> points;
    std::vector<VisibleShare> shares;
    std::vector<VisibilitySums> sums; ///< one a cell
    std::vector<Prior> priors;        ///< one a cell
};

/// All of a region that is known before its light.
Region region_of(const VisibilityCells::Range& range, const std::vector<VisibleShare>& shares,
                 const std::vector<VisibilityPoint>& points) {
    const auto first = [&](std::uint32_t cell) {
        return std::lower_bound(shares.begin(), shares.end(), cell,
                                [](const VisibleShare& s, std::uint32_t c) { return s.cell < c; });
    };
    Region out;
    out.shares.assign(first(range.begin), first(range.end));
    std::vector<std::uint32_t> numbers;
    for (const VisibleShare& share : out.shares) numbers.push_back(share.point);
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    for (VisibleShare& share : out.shares) {
        share.cell -= range.begin;
        share.point = static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), share.point) -
                                                 numbers.begin());
    }
    for (const std::uint32_t number : numbers) out.points.push_back(points[number]);
    return out;
}

/// Of each point.
std::vector<std::uint32_t> heaviest_cells(const Region& region) {
    std::vector<std::uint32_t> out(region.points.size(), 0);
    std::vector<float> weight(region.points.size(), 0.0f);
    for (const VisibleShare& share : region.shares)
        if (share.weight > weight[share.point]) {
            weight[share.point] = share.weight;
            out[share.point] = share.cell;
        }
    return out;
}

/// Whether a point is asked how well the others serve it.
bool is_asked(const VisibleShare& share) { return share.point % kEach == 0; }

/// Of all points that count for each cell, or of those that are not asked.
void sum_up(Region& region, const VisibilityLight& light, bool all) {
    for (VisibilitySums& sums : region.sums) sums = VisibilitySums(light.parts);
    for (const VisibleShare& s : region.shares)
        if (all || !is_asked(s)) region.sums[s.cell].add(light.of(s.point), s.weight);
}

/// How many points what is known of a cell counts as for its two halves: the more the less these differ, beside
/// what they would by chance. By the method of moments for beta-binomial counts, of all parts together.
float prior_points(const VisibilitySums& a, const VisibilitySums& b) {
    constexpr float kFewest = 1.0f, kMost = 32.0f;
    const float points = a.points + b.points;
    if (!(a.points > 0.0f && b.points > 0.0f && points > 1.5f)) return kMost;
    const float both = a.points * b.points / points;
    double spread = 0.0, chance = 0.0;
    for (std::size_t p = 0; p < a.all.size(); ++p) {
        const float all = a.all[p] + b.all[p], seen = a.seen[p] + b.seen[p];
        if (!(a.all[p] > 0.0f && b.all[p] > 0.0f && seen > 0.0f && seen < all)) continue;
        const float share = seen / all, own = share * (1.0f - share) * points / (points - 1.0f);
        const float difference = a.seen[p] / a.all[p] - b.seen[p] / b.all[p];
        chance += double{all * own};
        spread += 0.5 * double{all * (difference * difference - own / both)};
    }
    if (!(chance > 0.0 && spread > 0.0)) return kMost;
    return std::clamp(static_cast<float>(chance / spread) - 1.0f, kFewest, kMost);
}

VisibilitySums sum_of(const Region& region, const VisibilityCells::Range& range, std::uint32_t first) {
    VisibilitySums out = region.sums[range.begin - first];
    for (std::uint32_t c = range.begin + 1; c < range.end; ++c) out.add(region.sums[c - first]);
    return out;
}

/// What is known of the cells below a node before their own points: `shares` of the node itself, by as many points.
void find_priors(Region& region, const VisibilityCells& tree, std::uint32_t node, std::uint32_t first,
                 const std::vector<float>& shares, float points) {
    const VisibilityCells::Range range = tree.cells(node);
    if (range.end - range.begin == 1) {
        region.priors[range.begin - first] = {shares, points};
        return;
    }
    const VisibilitySums side[2] = {sum_of(region, tree.cells(tree.half(node, 0)), first),
                                    sum_of(region, tree.cells(tree.half(node, 1)), first)};
    VisibilitySums sums = side[0];
    sums.add(side[1]);
    std::vector<float> own(shares.size());
    for (std::size_t p = 0; p < own.size(); ++p)
        own[p] = visible_share(sums.all[p], sums.seen[p], std::max(sums.points, 1.0f), {shares[p], points});
    const float next = prior_points(side[0], side[1]);
    for (std::uint32_t k = 0; k < 2; ++k) find_priors(region, tree, tree.half(node, k), first, own, next);
}

/// The light of each point by what its cells see of each part: one ray a part shows little of it, and what a rare
/// ray finds must not count as the light of all.
void rescale_by_cells(VisibilityLight& light, const Region& region) {
    std::vector<double> arrives(light.points(), 0.0), weight(light.points(), 0.0);
    for (const VisibleShare& share : region.shares) {
        const VisibilitySums& cell = region.sums[share.cell];
        const float* given = light.of(share.point);
        double sum = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p)
            if (cell.all[p] > 0.0f) sum += double{std::fabs(given[p]) * (cell.seen[p] / cell.all[p])};
        arrives[share.point] += double{share.weight} * sum;
        weight[share.point] += double{share.weight}; // below 1 where a point is mixed with other regions
    }
    for (std::size_t i = 0; i < arrives.size(); ++i)
        if (light.scale[i] > 0.0 && weight[i] > 0.0) light.rescale(i, arrives[i] / weight[i] / light.scale[i]);
}

std::vector<float> factors_of(const Region& region, std::size_t cell, const VisibilityCaution& caution) {
    const VisibilitySums& known = region.sums[cell];
    const Prior& prior = region.priors[cell];
    std::vector<float> out;
    for (std::size_t p = 0; p < known.all.size(); ++p)
        out.push_back(visible_factor(known.all[p], known.seen[p], std::max(known.points, 1e-6f),
                                     {prior.shares[p], prior.points * caution.prior}, caution.floor));
    return out;
}

/// The second moment of the points that are asked, of factors that the others give.
double moment_of_asked(const Region& region, const VisibilityLight& light, const VisibilityCaution& caution) {
    double moment = 0.0;
    std::vector<float> factors;
    std::size_t cell = region.sums.size(); // of the factors; shares of a cell come together
    for (const VisibleShare& share : region.shares) {
        if (!is_asked(share)) continue;
        if (share.cell != cell) factors = factors_of(region, cell = share.cell, caution);
        const float* given = light.of(share.point);
        double arrives = 0.0, sampled = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p) {
            arrives += double{std::max(given[p], 0.0f) / factors[p]};
            sampled += double{std::fabs(given[p]) * factors[p]};
        }
        moment += double{share.weight} * arrives * sampled;
    }
    return moment;
}

VisibilityCaution best_caution(const Region& region, const VisibilityLight& light) {
    VisibilityCaution best;
    double least = -1.0;
    for (const float floor : {0.0003f, 0.001f, 0.003f, 0.01f, 0.03f, 0.1f})
        for (const float prior : {0.5f, 1.0f, 2.0f}) {
            const VisibilityCaution caution{floor, prior};
            const double moment = moment_of_asked(region, light, caution);
            if (least >= 0.0 && moment >= least) continue;
            least = moment;
            best = caution;
        }
    return best;
}

} // namespace

std::uint8_t visibility_code(double factor) {
    std::uint32_t low = 0, high = 255;
    while (low < high) { // the first that is no less
        const std::uint32_t middle = (low + high) / 2;
        if (acdf_visibility_of_code(static_cast<std::uint8_t>(middle)) < factor) low = middle + 1;
        else high = middle;
    }
    const auto at = [](std::uint32_t code) { return acdf_visibility_of_code(static_cast<std::uint8_t>(code)); };
    if (low > 0 && factor * factor < at(low - 1) * at(low)) --low;
    return static_cast<std::uint8_t>(low);
}

CellNumbers::CellNumbers(const AcdfVisibility& header, const std::vector<AcdfVisibilitySplit>& splits,
                         std::uint32_t cells)
    : header_(header), rows_(cells, 0) {
    header_.column_count = 0; // rows of one byte: a row's address is its number
    header_.split_count = static_cast<std::uint32_t>(splits.size());
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k) header_.transform[i][k] = i == k ? 1.0f : 0.0f;
    table_ = {&header_, splits.data(), nullptr, nullptr, rows_.data()};
}

std::uint32_t CellNumbers::of(const VisibilityPoint& point) const {
    auto cell = static_cast<std::uint32_t>(rows_.size());
    for_each(point, [&](std::uint32_t c, double) { cell = std::min(cell, c); });
    return cell;
}

std::vector<VisibleShare> shares_of(const CellNumbers& numbers, const std::vector<VisibilityPoint>& points) {
    std::vector<VisibleShare> out;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        numbers.for_each(points[i], [&](std::uint32_t cell, double weight) {
            out.push_back({i, cell, static_cast<float>(weight)});
        });
    tbb::parallel_sort(out.begin(), out.end(), [](const VisibleShare& a, const VisibleShare& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
    });
    return out;
}

VisibilityRows visibility_rows(const VisibilityParts& parts, const VisibilityParts& coarse,
                               const std::vector<VisibilitySums>& known, const VisibilityCells& tree,
                               std::uint32_t node, const std::vector<VisibleShare>& shares,
                               const std::vector<VisibilityPoint>& points, const Occluded& occluded, double dark) {
    const VisibilityCells::Range range = tree.cells(node);
    Region region = region_of(range, shares, points);
    VisibilityLight light;
    const std::vector<Ray> expected = parts.expect(coarse, known);
    const std::vector<std::uint32_t> cell = heaviest_cells(region);
    trace_visibility(
        parts, region.points, occluded, [&](std::size_t point) { return &expected[cell[point] * parts.count()]; },
        light, dark);
    region.sums.resize(range.end - range.begin);
    region.priors.resize(region.sums.size());
    sum_up(region, light, true);
    rescale_by_cells(light, region);
    sum_up(region, light, false);
    const auto find_all_priors = [&] {
        constexpr float kUnknown = 0.5f;
        find_priors(region, tree, node, range.begin, std::vector<float>(light.parts, kUnknown), 1.0f);
    };
    find_all_priors();
    const VisibilityCaution caution = best_caution(region, light);
    sum_up(region, light, true);
    find_all_priors();
    VisibilityRows out;
    for (std::size_t cell = 0; cell < region.sums.size(); ++cell) {
        const std::vector<float>&all = region.sums[cell].all, factors = factors_of(region, cell, caution);
        out.all.insert(out.all.end(), all.begin(), all.end());
        out.factors.insert(out.factors.end(), factors.begin(), factors.end());
    }
    return out;
}

} // namespace acdf::compress
