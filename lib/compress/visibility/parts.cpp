#include "compress/visibility/parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace acdf::compress {
namespace {

/// Tiles that follow each other: what they are worth to be told apart from others, and their solid angle.
struct Run {
    double worth, angle;

    /// An edge of what hides light crosses it the more likely the wider it is.
    double cost() const { return worth * std::sqrt(angle); }
};
Run operator+(const Run& a, const Run& b) { return {a.worth + b.worth, a.angle + b.angle}; }

/// The bits of a number below 2^6 in reverse, over 2^6: van der Corput.
double reversed(std::uint32_t k) {
    double out = 0.0, digit = 0.5;
    for (; k > 0; k >>= 1, digit *= 0.5) out += digit * (k & 1u);
    return out;
}

} // namespace

VisibilityParts::VisibilityParts(const AcdfLocal& local, std::uint32_t bins, std::uint32_t columns)
    : local_(local), rows_(*local.rows_of_normals), grid_(acdf_environment_grid(&local.environment)),
      light_(mean_tiles(bins)) {
    cut(light_, light_, columns);
}

VisibilityParts::VisibilityParts(const VisibilityParts& coarse, const std::vector<double>& loss,
                                 const std::vector<double>& light)
    : local_(coarse.local_), rows_(coarse.rows_), grid_(coarse.grid_), light_(coarse.light_) {
    constexpr double kElsewhere = 0.02; // of all: where no ray has found an edge there may be one
    double sum = 0.0;
    for (std::size_t p = 0; p < coarse.count(); ++p) sum += loss[p];
    double all = 0.0;
    for (const double light : light_) all += light;
    std::vector<double> worth(light_.size(), 0.0), given(light_.size(), 0.0);
    for (std::size_t p = 0; p < coarse.count(); ++p) {
        double own = 0.0;
        for (std::uint32_t tile = coarse.first_[p]; tile < coarse.first_[p + 1]; ++tile) own += light_[tile];
        for (std::uint32_t tile = coarse.first_[p]; tile < coarse.first_[p + 1]; ++tile)
            given[tile] = own > 0.0 ? light[p] * light_[tile] / own : 0.0;
        for (std::uint32_t tile = coarse.first_[p]; tile < coarse.first_[p + 1]; ++tile)
            worth[tile] = (sum > 0.0 && own > 0.0 ? loss[p] / sum * light_[tile] / own : 0.0) +
                          kElsewhere * light_[tile] / all;
    }
    cut(worth, given, coarse.column_count());
}

/// Joins neighbours, those that cost least first, until no more parts are left.
void VisibilityParts::cut(const std::vector<double>& worth, const std::vector<double>& light,
                          std::uint32_t columns) {
    std::vector<Run> runs;
    for (std::uint32_t tile = 0; tile < worth.size(); ++tile) {
        runs.push_back({worth[tile], solid_angle(tile)});
        first_.push_back(tile);
    }
    const auto rise = [&](std::size_t i) {
        return (runs[i] + runs[i + 1]).cost() - runs[i].cost() - runs[i + 1].cost();
    };
    std::vector<double> rises;
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) rises.push_back(rise(i));
    while (runs.size() > std::size_t{columns} + 1) {
        const auto least = static_cast<std::size_t>(std::min_element(rises.begin(), rises.end()) - rises.begin());
        const auto next = static_cast<std::ptrdiff_t>(least) + 1;
        runs[least] = runs[least] + runs[least + 1];
        runs.erase(runs.begin() + next);
        first_.erase(first_.begin() + next);
        rises.erase(rises.begin() + next - 1);
        if (least > 0) rises[least - 1] = rise(least - 1);
        if (least < rises.size()) rises[least] = rise(least);
    }
    first_.push_back(rows_.splits + 1);
    std::vector<double> before{0.0};
    for (std::size_t p = 0; p < count(); ++p)
        before.push_back(std::accumulate(light.begin() + first_[p], light.begin() + first_[p + 1], before.back()));
    order(before, 0, static_cast<std::uint32_t>(count()), 0);
    aim();
}

/// Columns of parts [first, end), where `before` is the light of all parts before each: halves of about as much
/// light.
void VisibilityParts::order(const std::vector<double>& before, std::uint32_t first, std::uint32_t end,
                            std::uint32_t depth) {
    constexpr std::uint32_t kDeep = 40; // from there on halves of as many parts
    if (end - first < 2) return;
    const double half = 0.5 * (before[first] + before[end]);
    std::uint32_t middle = (first + end) / 2;
    if (depth < kDeep) {
        const auto begin = before.begin() + first + 1;
        middle =
            first + 1 + static_cast<std::uint32_t>(std::lower_bound(begin, before.begin() + end - 1, half) - begin);
        if (middle > first + 1 && half - before[middle - 1] < before[middle] - half) --middle;
    }
    const std::size_t own = columns_.size();
    columns_.push_back({static_cast<std::uint16_t>(first_[middle]), 0});
    part_of_column_.push_back(middle);
    order(before, first, middle, depth + 1);
    const std::size_t upper = columns_.size();
    order(before, middle, end, depth + 1);
    columns_[own].parts = static_cast<std::uint16_t>((middle - first < 2 ? 0x8000u : 0u) |
                                                     (end - middle < 2 ? 0u : static_cast<std::uint32_t>(upper)));
}

/// What the bins give to each tile, in the mean.
std::vector<double> VisibilityParts::mean_tiles(std::uint32_t bins) const {
    std::vector<double> out(rows_.splits + std::size_t{1}, 0.0);
    for (std::uint32_t b = 0; b < bins; ++b) {
        const AcdfBin& bin = local_.bins[b];
        if (bin.root == ACDF_NO_ROOT || !(bin.share > 0.0f)) continue;
        const std::uint32_t* before = acdf_row_before(&rows_, bin.root);
        for (std::size_t t = 0; t < out.size(); ++t) out[t] += (before[t + 1] - before[t]) * 0x1p-31;
    }
    return out;
}

double VisibilityParts::solid_angle(std::uint32_t tile) const {
    AcdfRange range[2];
    acdf_halved_ranges(acdf_row_tile(&rows_, tile)->box, range);
    return acdf_grid_solid_angle(&grid_, range);
}

std::array<float, 3> VisibilityParts::place(std::uint32_t tile, double u0, double u1) const {
    double u[2] = {u0, u1};
    const AcdfDirectionSample s =
        acdf_rows_direction(local_.environment.halved, &grid_, acdf_row_tile(&rows_, tile), 1.0, u);
    return {s.direction[0], s.direction[1], s.direction[2]};
}

/// Directions of each part, as its light is spread.
void VisibilityParts::aim() {
    for (std::size_t p = 0; p < count(); ++p) {
        const std::uint32_t end = first_[p + 1];
        double sum = 0.0;
        for (std::uint32_t tile = first_[p]; tile < end; ++tile) sum += light_[tile];
        const auto weight = [&](std::uint32_t tile) {
            return sum > 0.0 ? light_[tile] / sum : 1.0 / double(end - first_[p]);
        };
        std::uint32_t at = first_[p];
        double before = 0.0;
        for (std::uint32_t i = 0; i < directions; ++i) {
            const double u = (i + 0.5) / directions;
            while (at + 1 < end && u >= before + weight(at)) before += weight(at++);
            const double inside = weight(at) > 0.0 ? (u - before) / weight(at) : 0.5;
            directions_.push_back(place(at, acdf_clamp(inside, 0.0, 1.0), reversed(i) + 0.5 / directions));
        }
    }
}

std::vector<VisibilityParts::Tile> VisibilityParts::tiles(std::size_t part) const {
    std::vector<Tile> out;
    for (std::uint32_t number = first_[part]; number < first_[part + 1]; ++number) {
        const double middle[2] = {0.5, 0.5};
        AcdfRange range[2];
        acdf_halved_ranges(acdf_row_tile(&rows_, number)->box, range);
        const AcdfDirectionSample s = acdf_grid_position(&grid_, range, middle, 1.0);
        out.push_back({{s.direction[0], s.direction[1], s.direction[2]}, solid_angle(number), light_[number]});
    }
    return out;
}

bool VisibilityParts::find(const float direction[3], std::uint32_t& part) const {
    std::uint32_t square[2];
    double position[2];
    if (!acdf_grid_square(&grid_, direction, square, position)) return false;
    const std::uint32_t tile = acdf_rows_find_tile(&rows_, square);
    part = static_cast<std::uint32_t>(std::upper_bound(first_.begin(), first_.end(), tile) - first_.begin() - 1);
    return true;
}

void VisibilityParts::weigh(const AcdfLocalPoint& point, float* out) const {
    std::fill_n(out, count(), 0.0f);
    if (point.what != ACDF_LOCAL_ROWS) return;
    for (std::size_t p = 0; p < count(); ++p)
        out[p] = static_cast<float>(point.sum * 0x1p-52 * acdf_rows_mass(&point.by.rows, first_[p], first_[p + 1]));
}

} // namespace acdf::compress
