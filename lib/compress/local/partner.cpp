#include "compress/local/partner.h"

#include "compress/local/least_share.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kPieceStep = 0.02; // radians across which light in a cell has one cosine
/// Of the samples that the CDF of all light gives a tile, those that stay at normals which see it at their horizon,
/// where the partner has few.
constexpr double kLeastOfCdf = 0.015;
constexpr double kBounded = 150.0; // weights that need no such samples
constexpr double kSpacing = 2.45;  // the distance of neighbouring bins, times the subdivisions

/// The mean of the cosines above the horizon of a disc of directions.
double seen_cosine(double height, double radius) {
    if (height >= radius) return height;
    return height > -radius ? (height + radius) * (height + radius) / (4.0 * radius) : 0.0;
}

/// For each bin the sum of amounts times what `cosine` makes of a point's height above its horizon, and radius.
template <class Cosine>
std::vector<double> sums_of_light(const std::vector<LightPoint>& points, const NormalBins& bins,
                                  const Cosine& cosine) {
    std::vector<double> out(bins.normals.size(), 0.0);
    parallel_for(std::size_t{0}, out.size(), [&](std::size_t b) {
        for (const LightPoint& p : points) out[b] += p.amount * cosine(dot(p.direction, bins.normals[b]), p.radius);
    });
    return out;
}

} // namespace

LocalPartner::LocalPartner(const Target& target, const std::vector<LightPoint>& points, const NormalBins& bins,
                           const Partner& partner)
    : lobes_(partner.kind), filling_(std::make_shared<const Filling>(partner.heuristic)),
      ratio_(partner.light / partner.other), nu_(bins.normals.size(), 0.0) {
    const std::vector<double> irradiance = sums_of_light(points, bins, seen_cosine);
    const double spacing = kSpacing / bins.subdivisions;
    least_irradiance_ = sums_of_light(
        points, bins, [spacing](double height, double radius) { return std::max(0.0, height - radius - spacing); });
    parallel_for(std::size_t{0}, nu_.size(), [&](std::size_t b) {
        if (irradiance[b] > 0.0) nu_[b] = solve(points, bins.normals[b], irradiance[b]);
    });
    Target grid;
    grid.columns = CoarseMap::columns;
    grid.rows = CoarseMap::rows;
    grid.parameterization = target.parameterization;
    parallel_for(std::size_t{0}, mean_.values.size(), [&](std::size_t i) {
        const Direction d = direction_at(grid, double(i / grid.columns) + 0.5, double(i % grid.columns) + 0.5);
        double sum = 0.0, weight = 0.0;
        for (std::size_t b = 0; b < nu_.size(); ++b) {
            const double cosine = dot(d, bins.normals[b]);
            if (!(nu_[b] > 0.0) || !(cosine > 0.0)) continue;
            const double own = bins.weight[b] * cosine / irradiance[b];
            sum += own * lobes_.brightness(cosine) / threshold(b, cosine);
            weight += own;
        }
        mean_.values[i] = sum > 0.0 ? weight / sum : 0.0;
    });
}

/// nu n_b at which the shares of all light come to nu n_l.
double LocalPartner::solve(const std::vector<LightPoint>& points, const Direction& normal,
                           double irradiance) const {
    struct Seen {
        double light, density, measure;
    };
    std::vector<Seen> seen;
    double all = 0.0, partner = 0.0;
    for (const LightPoint& p : points) {
        const double cosine = seen_cosine(dot(p.direction, normal), p.radius);
        if (!(cosine > 0.0) || !(p.measure > 0.0)) continue;
        const double brightness = lobes_.brightness(cosine), density = lobes_.density(cosine);
        partner += density * p.measure;
        all += p.amount * brightness;
        if (p.amount > 0.0) seen.push_back({p.amount / p.measure * brightness, density, p.measure});
    }
    if (!(all > 0.0)) return irradiance / ratio_;
    double low = all / (ratio_ + partner) / 64.0, high = all / ratio_;
    for (int step = 0; step < 32; ++step) {
        const double nu = std::sqrt(low * high);
        double sum = 0.0;
        for (const Seen& s : seen) {
            const double at = nu * s.density;
            if (s.light > at) sum += filling_->above(s.light / at) * at * s.measure;
        }
        (sum > nu * ratio_ ? low : high) = nu;
    }
    return high;
}

Target LocalPartner::filled(const Target& target) const {
    Target out = of_values(target);
    out.filling = filling_;
    out.left.resize(target.values.size());
    out.least.resize(target.values.size());
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const std::size_t i = std::size_t{r} * target.columns + c;
            const Left left =
                left_to_partner(target.values[i], mean_.at(double(c) / target.columns, double(r) / target.rows));
            out.left[i] = left.left;
            out.least[i] = left.least;
        }
    });
    return out;
}

Target LocalPartner::excess(const Target& target) const {
    Target out = of_values(target);
    parallel_for(std::uint32_t{0}, target.rows, [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            float& value = out.values[std::size_t{r} * target.columns + c];
            const double g = value, at = mean_.at(double(c) / target.columns, double(r) / target.rows);
            value = g > at ? static_cast<float>((g - at) * ((g - at) / g)) : 0.0f;
        }
    });
    return out;
}

bool LocalPartner::bounds(std::size_t bin, double light) const {
    return ACDF_PI * (1.0 + ratio_) * light <= kBounded * least_irradiance_[bin];
}

double LocalPartner::share(std::size_t bin, double cosine, double alone, double measure) const {
    const double at = threshold(bin, cosine) * measure;
    if (!(at > 0.0)) return 0.0;
    return at * filling_->above(alone * lobes_.brightness(cosine) / at);
}

FilledTiles::FilledTiles(const Target& target, const TileTree& tiles, const TileCurves& curves,
                         const TileCascade& cascade, const std::vector<AcdfBrightTile>& bright_tiles,
                         const LocalPartner& partner, const NormalBins& bins)
    : target_(target), bright_tiles_(bright_tiles), partner_(partner), bins_(bins),
      is_light_(tiles.tiles.size(), false), pieces_(tiles.tiles.size()), extents_(tiles.tiles.size()) {
    for (const AcdfBrightTile& light : bright_tiles) is_light_[light.tile] = true;
    parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t t) {
        double shares = 0.0, costs = 0.0;
        const Filling* filling = curves.partition(t).grid().filling;
        const auto share_of = [&](const Part& part) {
            return shares > 0.0 ? part.moments.share(filling) / shares : part.moments.cost() / costs;
        };
        cascade.for_each_cell(t, [&](const Part& part) {
            shares += part.moments.share(filling);
            costs += part.moments.cost();
        });
        if (!(costs > 0.0)) return;
        cascade.for_each_cell(t, [&](const Part& part) {
            const double energy = part.moments.energy, measure = part.moments.measure;
            if (!(energy > 0.0)) return;
            const double light = std::sqrt(energy / measure) * curves.total(), density = share_of(part) / measure;
            for_each_block(target, part.box, kPieceStep, [&](const Box& block, double share) {
                pieces_[t].push_back({centre(target, block), block, radius(target, block) + kHorizonMargin, light,
                                      measure * share, density});
            });
        });
        Extent& extent = extents_[t];
        for (const Piece& piece : pieces_[t]) {
            extent.flux += piece.light * piece.measure;
            extent.brightest = std::max(extent.brightest, piece.light);
        }
        extent.middle = centre(target, tiles.tiles[t]);
        extent.reach = radius(target, tiles.tiles[t]);
    });
    for (const Extent& extent : extents_) flux_ += extent.flux;
}

/// Of the mixture at any normal each row is a part, and what the horizon of the one hides the other may see. There
/// weights are at most those of the CDF of all light over kLeastOfCdf, or about kBounded.
void FilledTiles::keep_least(std::size_t bin, std::vector<double>& shares) const {
    double all = 0.0;
    for (const double share : shares) all += share;
    const double spacing = kSpacing / bins_.subdivisions;
    for (std::size_t t = 0; t < shares.size(); ++t) {
        const Extent& extent = extents_[t];
        if (is_light_[t] || !(extent.flux > 0.0) || partner_.bounds(bin, extent.brightest)) continue;
        const double height = dot(extent.middle, bins_.normals[bin]), around = extent.reach + spacing;
        if (height < -around || height - around > partner_.scarce(extent.brightest, flux_, kLeastOfCdf)) continue;
        shares[t] = std::max(shares[t], kLeastOfCdf * all * (extent.flux / flux_));
    }
}

std::vector<double> FilledTiles::shares(std::size_t bin) const {
    std::vector<double> out(pieces_.size(), 0.0);
    for (std::size_t t = 0; t < out.size(); ++t) {
        if (is_light_[t]) continue;
        for_each_seen(t, bin, [&](const Piece& piece, double cosine) {
            out[t] += partner_.share(bin, cosine, piece.light * piece.measure, piece.measure);
        });
    }
    keep_least(bin, out);
    return out;
}

float FilledTiles::recommended_light_share(std::size_t bin, std::vector<double> shares) const {
    struct Term {
        double square, ours, partner;
    };
    double sum = 0.0;
    for (const AcdfBrightTile& light : bright_tiles_) {
        const Direction d{double{light.direction[0]}, double{light.direction[1]}, double{light.direction[2]}};
        shares[light.tile] = double{light.share} * std::max(0.0, dot(d, bins_.normals[bin]));
    }
    for (const double share : shares) sum += share;
    if (!(sum > 0.0)) return 1.0f;
    std::vector<Term> terms;
    for (std::size_t t = 0; t < shares.size(); ++t)
        for_each_seen(t, bin, [&](const Piece& piece, double cosine) {
            const double f = piece.light * partner_.lobes().brightness(cosine);
            terms.push_back(
                {f * f * piece.measure, shares[t] / sum * piece.density, partner_.lobes().density(cosine)});
        });
    const auto moment = [&](double share) {
        double out = 0.0;
        for (const Term& term : terms) out += term.square / (share * term.ours + (1.0 - share) * term.partner);
        return out;
    };
    return least_share(moment, 12);
}

} // namespace acdf::compress
