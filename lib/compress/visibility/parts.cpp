#include "compress/visibility/parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace acdf::compress {
namespace {

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
    std::vector<Spread> edges;
    for (std::uint32_t tile = 0; tile < light_.size(); ++tile) edges.push_back(spread(tile, light_[tile]));
    PartRuns runs(std::move(edges));
    cut(runs, light_, columns);
}

VisibilityParts::VisibilityParts(const VisibilityParts& coarse, const std::vector<VisibilitySums>& cells)
    : local_(coarse.local_), rows_(coarse.rows_), grid_(coarse.grid_), light_(coarse.light_) {
    constexpr double kElsewhere = 0.05; // of all: where no ray has found an edge there may be one
    struct Part {
        double loss = 0.0, given = 0.0, width = 0.0;
        std::vector<double> shares; // of its tiles
    };
    std::vector<Part> parts(coarse.count());
    double edges = 0.0, whole = 0.0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        Part& part = parts[p];
        for (const VisibilitySums& cell : cells) {
            part.loss += std::sqrt(double{cell.seen[p]} * double{cell.all[p]}) - double{cell.seen[p]};
            part.given += double{cell.all[p]};
        }
        const auto first = light_.begin() + coarse.first_[p], end = light_.begin() + coarse.first_[p + 1];
        const double own = std::accumulate(first, end, 0.0);
        Spread spread;
        for (auto light = first; light != end; ++light) {
            part.shares.push_back(own > 0.0 ? *light / own : 0.0);
            spread.add(this->spread(static_cast<std::uint32_t>(light - light_.begin()), part.shares.back()));
        }
        part.width = part.given * spread.width();
        edges += part.loss;
        whole += part.width;
    }
    std::vector<Spread> spreads;
    std::vector<double> light;
    for (const Part& part : parts)
        for (const double share : part.shares) {
            const double density = (part.width > 0.0 ? part.loss / part.width : 0.0) +
                                   (whole > 0.0 ? kElsewhere * edges / whole : 1.0);
            light.push_back(part.given * share);
            spreads.push_back(spread(static_cast<std::uint32_t>(spreads.size()), light.back() * density));
        }
    PartRuns runs(std::move(spreads));
    for (std::size_t p = 0; p < parts.size(); ++p) runs.know(cells, p, coarse.first_[p], parts[p].shares);
    cut(runs, light, coarse.column_count());
}

/// Parts and columns; `light`: of tiles, which columns halve.
void VisibilityParts::cut(PartRuns& runs, const std::vector<double>& light, std::uint32_t columns) {
    first_ = runs.join(std::size_t{columns} + 1);
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

/// Light of a tile, spread as over a disk of its size.
Spread VisibilityParts::spread(std::uint32_t tile, double light) const {
    const std::array<float, 3> middle = place(tile, 0.5, 0.5);
    const double length = light * (1.0 - solid_angle(tile) / (4.0 * ACDF_PI));
    return {light, {length * double{middle[0]}, length * double{middle[1]}, length * double{middle[2]}}};
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

std::vector<Ray> VisibilityParts::expect(const VisibilityParts& coarse,
                                         const std::vector<VisibilitySums>& cells) const {
    std::vector<Ray> out;
    out.reserve(cells.size() * count());
    for (const VisibilitySums& cell : cells)
        for (std::size_t p = 0, first = 0; p < count(); ++p) {
            while (coarse.first_[first + 1] <= first_[p]) ++first;
            Ray ray = cell.ray(first);
            for (std::size_t more = first + 1; more < coarse.count() && coarse.first_[more] < first_[p + 1]; ++more)
                if (cell.ray(more) != ray) ray = Ray::unknown;
            out.push_back(ray);
        }
    return out;
}

void VisibilityParts::weigh(const AcdfLocalPoint& point, float* out) const {
    std::fill_n(out, count(), 0.0f);
    if (point.what != ACDF_LOCAL_ROWS) return;
    for (std::size_t p = 0; p < count(); ++p)
        out[p] = static_cast<float>(point.sum * 0x1p-52 * acdf_rows_mass(&point.by.rows, first_[p], first_[p + 1]));
}

} // namespace acdf::compress
