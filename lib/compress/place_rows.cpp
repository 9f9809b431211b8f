#include "compress/place_rows.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// One of so many points is asked how well the others serve it.
constexpr std::size_t kEach = 8;

/// A point and a cell that it counts for.
struct Share {
    std::uint32_t point = 0, cell = 0;
    double weight = 0.0;
};

/// Sums of all cells, points near a border in those on both sides of it, as readers mix them.
struct CellSums {
    std::vector<PlaceSums> of;
    std::vector<Share> shares; ///< those of a cell together
};

std::vector<Share> shares_of(const CellNumbers& numbers, const std::vector<PlacePoint>& points) {
    std::vector<Share> out;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        numbers.for_each(points[i], [&](std::uint32_t cell, double weight) { out.push_back({i, cell, weight}); });
    std::stable_sort(out.begin(), out.end(), [](const Share& a, const Share& b) { return a.cell < b.cell; });
    return out;
}

CellSums cell_sums(const PlaceCells& tree, const CellNumbers& numbers, const PlaceLight& light,
                   const std::vector<PlacePoint>& points) {
    CellSums out{std::vector<PlaceSums>(tree.cell_count(), PlaceSums(light.parts)), shares_of(numbers, points)};
    const auto first_of = [&](std::uint32_t cell) {
        return std::lower_bound(out.shares.begin(), out.shares.end(), cell,
                                [](const Share& s, std::uint32_t c) { return s.cell < c; });
    };
    tbb::parallel_for(0u, tree.cell_count(), [&](std::uint32_t cell) {
        for (auto s = first_of(cell); s != out.shares.end() && s->cell == cell; ++s)
            out.of[cell].add(light, s->point, s->weight);
    });
    return out;
}

/// The light of each point by what its cells see of each part: one ray a part tells little of it, and what a rare
/// ray finds must not count as the light of all.
void rescale_by_cells(PlaceLight& light, const CellSums& sums) {
    std::vector<double> arrives(light.points(), 0.0);
    for (const Share& share : sums.shares) {
        const PlaceSums& cell = sums.of[share.cell];
        double sum = 0.0;
        for (std::size_t p = 0; p < light.parts; ++p)
            if (cell.all[p] > 0.0) sum += light.all(share.point, p) * (cell.seen[p] / cell.all[p]);
        arrives[share.point] += share.weight * sum;
    }
    for (std::size_t i = 0; i < arrives.size(); ++i)
        if (light.scale[i] > 0.0) light.rescale(i, arrives[i] / light.scale[i]);
}

/// The second moment of points, each by what the others of its cells tell.
double moment_of_others(const CellSums& sums, const PlaceCells& tree, const PlaceLight& light,
                        const PlaceCaution& caution) {
    std::vector<double> moment(sums.shares.size(), 0.0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, moment.size(), 256), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const Share& share = sums.shares[i];
            if (share.point % kEach != 0) continue;
            const PlaceSums& cell = sums.of[share.cell];
            const std::vector<float>& prior = tree.prior(share.cell);
            double arrives = 0.0, drawn = 0.0;
            for (std::size_t p = 0; p < light.parts; ++p) {
                const double all = light.all(share.point, p), seen = light.seen(share.point, p);
                if (!(all > 0.0)) continue;
                const double factor = place_factor(std::max(cell.all[p] - share.weight * all, 0.0),
                                                   std::max(cell.seen[p] - share.weight * seen, 0.0),
                                                   cell.points - share.weight, double{prior[p]}, caution);
                arrives += seen / factor;
                drawn += all * factor;
            }
            moment[i] = share.weight * arrives * drawn;
        }
    });
    double sum = 0.0;
    for (const double m : moment) sum += m;
    return sum;
}

PlaceCaution best_caution(const CellSums& sums, const PlaceCells& tree, const PlaceLight& light) {
    PlaceCaution best;
    double least = -1.0;
    for (const double floor : {0.001, 0.003, 0.01, 0.03, 0.1})
        for (const double prior : {0.5, 1.0, 2.0}) {
            const PlaceCaution caution{floor, prior};
            const double moment = moment_of_others(sums, tree, light, caution);
            if (least >= 0.0 && moment >= least) continue;
            least = moment;
            best = caution;
        }
    return best;
}

} // namespace

CellNumbers::CellNumbers(const AcdfPlaces& header, const std::vector<AcdfPlaceSplit>& splits, std::uint32_t cells)
    : header_(header), rows_(cells, 0) {
    header_.column_count = 0; // rows of one byte: a row's address is its number
    header_.split_count = static_cast<std::uint32_t>(splits.size());
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k) header_.transform[i][k] = i == k ? 1.0f : 0.0f;
    table_ = {&header_, splits.data(), nullptr, rows_.data(), 0};
}

std::uint32_t CellNumbers::of(const PlacePoint& point) const {
    auto cell = static_cast<std::uint32_t>(rows_.size());
    for_each(point, [&](std::uint32_t c, double) { cell = std::min(cell, c); });
    return cell;
}

PlaceRows place_rows(const PlaceCells& tree, const CellNumbers& numbers, PlaceLight& light,
                     const std::vector<PlacePoint>& points) {
    rescale_by_cells(light, cell_sums(tree, numbers, light, points));
    const CellSums sums = cell_sums(tree, numbers, light, points);
    const PlaceCaution caution = best_caution(sums, tree, light);
    const std::size_t size = std::size_t{tree.cell_count()} * light.parts;
    PlaceRows out{std::vector<float>(size), std::vector<float>(size)};
    tbb::parallel_for(0u, tree.cell_count(), [&](std::uint32_t cell) {
        const PlaceSums& known = sums.of[cell];
        for (std::size_t p = 0; p < light.parts; ++p) {
            const std::size_t i = cell * light.parts + p;
            out.all[i] = static_cast<float>(known.all[p]);
            out.factors[i] = static_cast<float>(
                place_factor(known.all[p], known.seen[p], known.points, double{tree.prior(cell)[p]}, caution));
        }
    });
    return out;
}

} // namespace acdf::compress
