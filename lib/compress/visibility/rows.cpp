#include "compress/visibility/rows.h"

#include "compress/parallel.h"
#include "compress/visibility/beside_cosine.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

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

/// A range of cells and their points, cell by cell, both numbered from 0.
struct Region {
    std::vector<VisibilityPoint> points;
    std::vector<std::uint32_t> cells; ///< one a point
    std::vector<VisibilitySums> sums; ///< one a cell
    std::vector<Prior> priors;        ///< one a cell
};

/// All of a region that is known before its light.
Region region_of(const VisibilityCells::Range& range, const PointsOfCells& of,
                 const std::vector<VisibilityPoint>& points) {
    Region out;
    for (std::uint32_t cell = range.begin; cell < range.end; ++cell)
        for (std::uint32_t i = of.first[cell]; i < of.first[cell + 1]; ++i) {
            out.points.push_back(points[of.point[i]]);
            out.cells.push_back(cell - range.begin);
        }
    out.sums.resize(range.end - range.begin);
    out.priors.resize(range.end - range.begin);
    return out;
}

/// Whether a point is asked how well the others serve it.
bool is_asked(std::size_t point) { return point % kEach == 0; }

/// Of all points of each cell, or of those that are not asked.
void sum_up(Region& region, const VisibilityLight& light, bool all) {
    for (VisibilitySums& sums : region.sums) sums = VisibilitySums(light.parts);
    for (std::size_t i = 0; i < region.points.size(); ++i)
        if (all || !is_asked(i)) region.sums[region.cells[i]].add(light.of(i));
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

/// The light of each point by what its cell sees of each part: one ray a part shows little of it, and what a rare
/// ray finds must not count as the light of all.
void rescale_by_cells(VisibilityLight& light, const Region& region) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
        if (!(light.scale[i] > 0.0)) continue;
        const VisibilitySums& cell = region.sums[region.cells[i]];
        const float* given = light.of(i);
        double arrives = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p)
            if (cell.all[p] > 0.0f) arrives += double{std::fabs(given[p]) * (cell.seen[p] / cell.all[p])};
        light.rescale(i, arrives / light.scale[i]);
    }
}

/// Which share of each part arrives.
std::vector<float> shares_of(const Region& region, std::size_t cell, const VisibilityCaution& caution) {
    const VisibilitySums& known = region.sums[cell];
    const Prior& prior = region.priors[cell];
    std::vector<float> out;
    for (std::size_t p = 0; p < known.all.size(); ++p)
        out.push_back(visible_share(known.all[p], known.seen[p], std::max(known.points, 1e-6f),
                                    {prior.shares[p], prior.points * caution.prior}));
    return out;
}

std::vector<float> factors_of(const Region& region, std::size_t cell, const VisibilityCaution& caution) {
    std::vector<float> out = shares_of(region, cell, caution);
    for (float& share : out) share = factor_of_share(share, caution.floor);
    return out;
}

/// The same beside the cosine around the normals of the cell's points.
std::vector<float> factors_of(const BesideCosine& beside, const Region& region, std::size_t cell,
                              const VisibilityCaution& caution) {
    std::vector<float> out = shares_of(region, cell, caution);
    const auto [first, last] = std::equal_range(region.cells.begin(), region.cells.end(), cell);
    if (first == last) return std::vector<float>(out.size(), 1.0f);
    std::vector<float> masses(out.size() * BesideCosine::groups, 0.0f);
    for (auto i = first; i != last; ++i) {
        const std::vector<float> own = beside.masses(region.points[std::size_t(i - region.cells.begin())].normal);
        for (std::size_t g = 0; g < masses.size(); ++g) masses[g] += own[g];
    }
    for (float& mass : masses) mass /= static_cast<float>(last - first);
    beside.factors(region.sums[cell].all.data(), out.data(), masses.data(), out.data());
    return out;
}

/// The second moment of the points that are asked, of factors that the others give.
double moment_of_asked(const Region& region, const VisibilityLight& light, const VisibilityCaution& caution) {
    double moment = 0.0;
    std::vector<float> factors;
    std::size_t cell = region.sums.size(); // of the factors; points of a cell come together
    for (std::size_t i = 0; i < region.points.size(); ++i) {
        if (!is_asked(i)) continue;
        if (region.cells[i] != cell) factors = factors_of(region, cell = region.cells[i], caution);
        const float* given = light.of(i);
        double arrives = 0.0, sampled = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p) {
            arrives += double{std::max(given[p], 0.0f) / factors[p]};
            sampled += double{std::fabs(given[p]) * factors[p]};
        }
        moment += arrives * sampled;
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
    table_ = {&header_, splits.data(), nullptr, nullptr, rows_.data(), nullptr};
}

std::uint32_t CellNumbers::of(const VisibilityPoint& point) const {
    AcdfVisibilityCell cell;
    const bool found = acdf_visibility_at(&table_, point.position.data(), point.normal.data(), &cell);
    return found ? cell.number : static_cast<std::uint32_t>(rows_.size());
}

PointsOfCells points_of_cells(const CellNumbers& numbers, const std::vector<VisibilityPoint>& points) {
    std::vector<std::uint32_t> cell(points.size());
    parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) { cell[i] = numbers.of(points[i]); });
    PointsOfCells out;
    out.first.assign(std::size_t{numbers.count()} + 2, 0); // of each cell, of what lies outside, and behind
    for (const std::uint32_t c : cell) ++out.first[c + 1];
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    std::vector<std::uint32_t> next = out.first;
    out.point.resize(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) out.point[next[cell[i]]++] = i;
    return out;
}

VisibilityRows visibility_rows(const VisibilityParts& parts, const VisibilityParts& coarse,
                               const std::vector<VisibilitySums>& known, const VisibilityCells& tree,
                               std::uint32_t node, const PointsOfCells& of,
                               const std::vector<VisibilityPoint>& points, const Occluded& occluded, double dark,
                               bool beside_cosine) {
    const VisibilityCells::Range range = tree.cells(node);
    Region region = region_of(range, of, points);
    VisibilityLight light;
    const std::vector<Ray> expected = parts.expect(coarse, known);
    trace_visibility(
        parts, region.points, occluded,
        [&](std::size_t point) { return &expected[region.cells[point] * parts.count()]; }, light, dark);
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
    std::optional<BesideCosine> beside;
    if (beside_cosine) beside.emplace(parts);
    for (std::size_t cell = 0; cell < region.sums.size(); ++cell) {
        const std::vector<float>& all = region.sums[cell].all;
        const std::vector<float> factors =
            beside ? factors_of(*beside, region, cell, caution) : factors_of(region, cell, caution);
        out.all.insert(out.all.end(), all.begin(), all.end());
        out.factors.insert(out.factors.end(), factors.begin(), factors.end());
    }
    return out;
}

} // namespace acdf::compress
