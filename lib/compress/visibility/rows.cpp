#include "compress/visibility/rows.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// One of so many points is asked how well the others serve it.
constexpr std::size_t kEach = 8;

/// A range of cells and the points that count for them, both numbered from 0.
struct Region {
    std::vector<VisibilityPoint> points;
    std::vector<VisibleShare> shares;
    std::vector<VisibilitySums> sums;       ///< one a cell
    std::vector<std::vector<float>> priors; ///< of the cells around it, one a cell
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

void sum_up(Region& region, const VisibilityLight& light, const VisibilityCells::Range& range) {
    region.sums.assign(range.end - range.begin, VisibilitySums(light.parts));
    for (const VisibleShare& s : region.shares) region.sums[s.cell].add(light.of(s.point), s.weight);
}

/// Factors of the cells around each, as far as they are of the region.
void find_priors(Region& region, const VisibilityCells& tree, const VisibilityCells::Range& range,
                 std::size_t parts) {
    constexpr float kUnknown = 0.7f; // half of it arrives
    region.priors.clear();
    for (std::uint32_t cell = range.begin; cell < range.end; ++cell) {
        const VisibilityCells::Range around = tree.around(cell);
        VisibilitySums sums(parts);
        for (std::uint32_t c = std::max(around.begin, range.begin); c < std::min(around.end, range.end); ++c) {
            const VisibilitySums& one = region.sums[c - range.begin];
            sums.points += one.points;
            for (std::size_t p = 0; p < parts; ++p) {
                sums.all[p] += one.all[p];
                sums.seen[p] += one.seen[p];
            }
        }
        std::vector<float> prior(parts);
        for (std::size_t p = 0; p < parts; ++p)
            prior[p] = visible_factor(sums.all[p], sums.seen[p], std::max(sums.points, 1.0f), kUnknown, {});
        region.priors.push_back(std::move(prior));
    }
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

/// The second moment of points, each estimated from the others of its cells.
double moment_of_others(const Region& region, const VisibilityLight& light, const VisibilityCaution& caution) {
    double moment = 0.0;
    for (const VisibleShare& share : region.shares) {
        if (share.point % kEach != 0) continue;
        const VisibilitySums& cell = region.sums[share.cell];
        const std::vector<float>& prior = region.priors[share.cell];
        const float* given = light.of(share.point);
        const float others = std::max(cell.points - share.weight, 1e-6f);
        double arrives = 0.0, sampled = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p) {
            const float all = std::fabs(given[p]), seen = std::max(given[p], 0.0f);
            const float factor =
                visible_factor(std::max(cell.all[p] - share.weight * all, 0.0f),
                               std::max(cell.seen[p] - share.weight * seen, 0.0f), others, prior[p], caution);
            arrives += double{seen / factor};
            sampled += double{all * factor};
        }
        moment += double{share.weight} * arrives * sampled;
    }
    return moment;
}

VisibilityCaution best_caution(const Region& region, const VisibilityLight& light) {
    VisibilityCaution best;
    double least = -1.0;
    for (const float floor : {0.001f, 0.003f, 0.01f, 0.03f, 0.1f})
        for (const float prior : {0.5f, 1.0f, 2.0f}) {
            const VisibilityCaution caution{floor, prior};
            const double moment = moment_of_others(region, light, caution);
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
    AcdfVisibilityCell cell;
    const bool found = acdf_visibility_at(&table_, point.position.data(), point.normal.data(), &cell);
    return found ? cell.number : static_cast<std::uint32_t>(rows_.size());
}

std::vector<VisibleShare> shares_of(const CellNumbers& numbers, const std::vector<VisibilityPoint>& points) {
    std::vector<VisibleShare> out;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (const std::uint32_t cell = numbers.of(points[i]); cell < numbers.count())
            out.push_back({i, cell, 1.0f});
    tbb::parallel_sort(out.begin(), out.end(), [](const VisibleShare& a, const VisibleShare& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
    });
    return out;
}

VisibilityRows visibility_rows(const VisibilityParts& parts, const VisibilityCells& tree,
                               const VisibilityCells::Range& range, const std::vector<VisibleShare>& shares,
                               const std::vector<VisibilityPoint>& points, const Occluded& occluded, double dark) {
    Region region = region_of(range, shares, points);
    VisibilityLight light;
    trace_visibility(parts, region.points, occluded, light, dark);
    sum_up(region, light, range);
    rescale_by_cells(light, region);
    sum_up(region, light, range);
    find_priors(region, tree, range, light.parts);
    const VisibilityCaution caution = best_caution(region, light);
    VisibilityRows out;
    for (std::size_t cell = 0; cell < region.sums.size(); ++cell) {
        const VisibilitySums& known = region.sums[cell];
        out.all.insert(out.all.end(), known.all.begin(), known.all.end());
        for (std::size_t p = 0; p < light.parts; ++p)
            out.factors.push_back(visible_factor(known.all[p], known.seen[p], std::max(known.points, 1e-6f),
                                                 region.priors[cell][p], caution));
    }
    return out;
}

} // namespace acdf::compress
