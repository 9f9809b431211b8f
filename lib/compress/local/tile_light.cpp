#include "compress/local/tile_light.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace acdf::compress {
namespace {

/// Of a tile that may be seen though none of its points are: its cost, of that of all it holds.
constexpr double kGlimpse = 1e-3;

constexpr std::size_t kViewLanes = TileLight::views_at_once;

// The loader takes the version that the processor has. Neither joins products and sums: they are equal to the bit.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define ACDF_BY_LANES __attribute__((target_clones("avx2", "default")))
#else
#define ACDF_BY_LANES
#endif

/// Of points, for each normal: the sum of amount . cos^2 above its horizon, and of amounts below. A point is added
/// to the sums of all normals together, without branches: half of them would be guessed wrong.
ACDF_BY_LANES void add_points(const LightPoint* points, std::size_t count, const double (&normals)[3][kViewLanes],
                              double (&squares)[kViewLanes], double (&amounts)[kViewLanes]) {
    // Copies, which compilers keep in registers.
    double n[3][kViewLanes], square[kViewLanes] = {}, hidden[kViewLanes] = {};
    for (std::size_t i = 0; i < 3; ++i) std::copy(std::begin(normals[i]), std::end(normals[i]), n[i]);
    for (const LightPoint* p = points; p != points + count; ++p) {
        const auto [x, y, z] = p->direction;
        const double amount = p->amount;
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 1 // it becomes vectors as long as it is a loop
#endif
        for (std::size_t k = 0; k < kViewLanes; ++k) {
            const double cosine = x * n[0][k] + y * n[1][k] + z * n[2][k];
            const double above = cosine > 0.0 ? cosine : 0.0, below = cosine > 0.0 ? 0.0 : amount;
            square[k] += amount * above * above;
            hidden[k] += below;
        }
    }
    std::copy(std::begin(square), std::end(square), squares);
    std::copy(std::begin(hidden), std::end(hidden), amounts);
}

} // namespace

TileLight::TileLight(const Target& target, const TileTree& tiles, const TileInsides& insides,
                     const std::vector<AcdfBrightTile>& bright_tiles)
    : target_(target), divided_(target), tiles_(tiles), tile_(tiles.tiles.size()) {
    std::vector<bool> is_light(tile_.size(), false);
    for (const AcdfBrightTile& light : bright_tiles) is_light[light.tile] = true;
    parallel_for(std::size_t{0}, tile_.size(), [&](std::size_t t) {
        if (!is_light[t] && insides.tile_cost(t) > 0.0) fill(insides, t);
    });
}

void TileLight::fill(const TileInsides& insides, std::size_t tile) {
    Tile& out = tile_[tile];
    out.cost = insides.tile_cost(tile);
    out.centre = centre(target_, tiles_.tiles[tile]);
    out.reach = radius(target_, tiles_.tiles[tile]);
    out.lit = insides.lit_cells(tile);
    for (const LitCell& cell : out.lit) {
        out.heaviest = std::max(out.heaviest, cell.weight);
        divided_.for_each_point(cell.box, [&](const Direction& direction, double share) {
            out.points.push_back({direction, cell.amount * share, 0.0});
        });
    }
    for (const LightPoint& p : out.points) {
        const auto [x, y, z] = p.direction;
        const std::array<double, 6> squares = {x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * z * x};
        for (std::size_t k = 0; k < squares.size(); ++k) out.moment[k] += p.amount * squares[k];
        out.amount += p.amount;
    }
}

TileLight::AcrossHorizon TileLight::across_horizon(const Tile& tile, const double (&normals)[3][views_at_once]) {
    AcrossHorizon out;
    add_points(tile.points.data(), tile.points.size(), normals, out.square, out.hidden);
    for (double& hidden : out.hidden) hidden = tile.amount > 0.0 ? hidden / tile.amount : 0.0;
    return out;
}

void TileLight::look(const Direction& normal, TileView& out) const { look(&normal, 1, &out); }

void TileLight::look(const Direction* normals, std::size_t count, TileView* out) const {
    double lanes[3][views_at_once], squares[views_at_once][6];
    for (std::size_t k = 0; k < views_at_once; ++k) {
        const auto [x, y, z] = normals[std::min(k, count - 1)];
        lanes[0][k] = x, lanes[1][k] = y, lanes[2][k] = z;
        const double of_normal[6] = {x * x, y * y, z * z, x * y, y * z, z * x};
        std::copy(std::begin(of_normal), std::end(of_normal), squares[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        out[k].cost.assign(tile_.size(), 0.0);
        out[k].hidden.assign(tile_.size(), 0.0);
    }
    for (std::size_t t = 0; t < tile_.size(); ++t) {
        const Tile& tile = tile_[t];
        if (!(tile.cost > 0.0)) continue;
        bool cut[views_at_once] = {}, any = false;
        for (std::size_t k = 0; k < count; ++k) {
            const double height = dot(tile.centre, normals[k]);
            if (height >= tile.reach) { // nearly everywhere
                double sum = 0.0;
                for (std::size_t i = 0; i < 6; ++i) sum += tile.moment[i] * squares[k][i];
                out[k].cost[t] = std::sqrt(std::max(0.0, sum));
            } else if (height <= -tile.reach - kHorizonMargin) {
                out[k].hidden[t] = 1.0;
            } else {
                any = cut[k] = true;
            }
        }
        if (!any) continue;
        const AcrossHorizon across = across_horizon(tile, lanes);
        for (std::size_t k = 0; k < count; ++k) {
            if (!cut[k]) continue;
            out[k].cost[t] = std::sqrt(across.square[k]);
            out[k].hidden[t] = across.hidden[k];
        }
    }
}

std::vector<double> TileLight::costs(const Direction& normal) const {
    TileView view;
    look(normal, view);
    for (std::size_t t = 0; t < tile_.size(); ++t) {
        const double least = kGlimpse * tile_[t].cost;
        if (view.cost[t] < least && view.hidden[t] > 0.0 && seen(t, normal)) view.cost[t] = least;
    }
    return view.cost;
}

std::vector<double> TileLight::least(const Direction& normal, const std::vector<double>& parts,
                                     double max_weight) const {
    std::vector<double> out(parts.size(), 0.0);
    for (std::size_t t = 0; t < out.size(); ++t) {
        if (!(parts[t] > 0.0)) continue;
        const double scale = tile_[t].cost / max_weight;
        const double cosine = largest_cosine(target_, tiles_.tiles[t], normal);
        if (tile_[t].heaviest * cosine * scale <= parts[t]) continue; // as nearly everywhere
        for (const LitCell& cell : tile_[t].lit)
            out[t] = std::max(out[t], cell.weight * largest_cosine(target_, cell.box, normal) * scale);
    }
    return out;
}

bool TileLight::seen(std::size_t tile, const Direction& normal) const {
    if (!(largest_cosine(target_, tiles_.tiles[tile], normal) > -kHorizonMargin)) return false;
    return std::any_of(tile_[tile].lit.begin(), tile_[tile].lit.end(), [&](const LitCell& cell) {
        return largest_cosine(target_, cell.box, normal) > -kHorizonMargin;
    });
}

} // namespace acdf::compress
