#include "compress/tile_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// Of a tile that may be seen though none of its points are: its cost, of that of all it holds.
constexpr double kGlimpse = 1e-3;
/// Radians across which light in a cell is taken to have one cosine.
constexpr double kPointStep = 0.02;

} // namespace

TileLight::TileLight(const Target& target, const TileTree& tiles, const TileCascade& cascade,
                     const std::vector<AcdfLight>& lights)
    : target_(target), tiles_(tiles), tile_(tiles.tiles.size()) {
    std::vector<bool> is_light(tile_.size(), false);
    for (const AcdfLight& light : lights) is_light[light.tile] = true;
    tbb::parallel_for(std::size_t{0}, tile_.size(), [&](std::size_t t) {
        if (!is_light[t] && cascade.tile_cost(t) > 0.0) fill(cascade, t);
    });
}

void TileLight::fill(const TileCascade& cascade, std::size_t tile) {
    Tile& out = tile_[tile];
    out.cost = cascade.tile_cost(tile);
    out.centre = centre(target_, tiles_.tiles[tile]);
    out.reach = radius(target_, tiles_.tiles[tile]);
    cascade.for_each_cell(tile, [&](const Part& part) {
        // A cell of measure mu and probability P within the tile, P = cost of cell / cost of tile, adds mu / P
        // times the integral of g^2 cos^2: cost of tile . cost of cell . cos^2.
        const double amount = out.cost * part.moments.cost();
        if (!(amount > 0.0)) return;
        out.lit.push_back({part.box, part.moments.weight()});
        out.heaviest = std::max(out.heaviest, part.moments.weight());
        for_each_block(target_, part.box, kPointStep, [&](const Box& block, double share) {
            out.points.push_back({centre(target_, block), amount * share, 0.0});
        });
    });
    for (const LightPoint& p : out.points) {
        const auto [x, y, z] = p.direction;
        const std::array<double, 6> squares = {x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * z * x};
        for (std::size_t k = 0; k < squares.size(); ++k) out.moment[k] += p.amount * squares[k];
        out.amount += p.amount;
    }
}

double TileLight::across_horizon(const Tile& tile, const Direction& normal, double& hidden) {
    double sum = 0.0, below = 0.0;
    for (const LightPoint& p : tile.points) {
        const double cosine = dot(p.direction, normal);
        if (cosine > 0.0) sum += p.amount * cosine * cosine;
        else below += p.amount;
    }
    hidden = tile.amount > 0.0 ? below / tile.amount : 0.0;
    return sum;
}

void TileLight::look(const Direction& normal, TileView& out) const {
    const auto [x, y, z] = normal;
    const std::array<double, 6> squares = {x * x, y * y, z * z, x * y, y * z, z * x};
    out.cost.assign(tile_.size(), 0.0);
    out.hidden.assign(tile_.size(), 0.0);
    for (std::size_t t = 0; t < tile_.size(); ++t) {
        const Tile& tile = tile_[t];
        if (!(tile.cost > 0.0)) continue;
        const double height = dot(tile.centre, normal);
        if (height >= tile.reach) { // nearly everywhere
            double sum = 0.0;
            for (std::size_t k = 0; k < squares.size(); ++k) sum += tile.moment[k] * squares[k];
            out.cost[t] = std::sqrt(std::max(0.0, sum));
        } else if (height <= -tile.reach - kHorizonMargin) {
            out.hidden[t] = 1.0;
        } else {
            out.cost[t] = std::sqrt(across_horizon(tile, normal, out.hidden[t]));
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
