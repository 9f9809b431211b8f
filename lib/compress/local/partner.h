// Rows of a local environment map that is made for an MIS partner: what each normal samples beside it.
#pragma once

#include "compress/local/horizon.h"
#include "compress/local/light.h"
#include "compress/local/tile_curves.h"
#include "compress/partner.h"

#include <memory>
#include <vector>

namespace acdf::compress {

/// For each bin of normals the light from which on the partner leaves anything to do (water filling:
/// docs/method.md).
class LocalPartner {
public:
    /// `points`: light_points of the target.
    LocalPartner(const Target& target, const std::vector<LightPoint>& points, const NormalBins& bins,
                 const std::vector<double>& irradiance, const Partner& partner);

    /// The target, beside the partner of the mean normal: what curves within tiles are fitted to.
    Target filled(const Target& target) const;
    /// Light as its spread within a tile counts: (L - T)^2 / L above the threshold T. A share that is off by a
    /// factor 1 + e lets the combined pdf be off by 1 + e (L - T) / L.
    Target excess(const Target& target) const;

    /// Of light of a bin, `alone` and measure as in Moments: its share, see Filling.
    double share(std::size_t bin, double cosine, double alone, double measure) const;
    /// Whether a bin takes samples for such light, wherever it comes from.
    bool takes(std::size_t bin, double light) const { return light * lobes_.brightness(1.0) > threshold(bin, 1.0); }
    const Lobes& lobes() const { return lobes_; }

private:
    double threshold(std::size_t bin, double cosine) const { return nu_[bin] * lobes_.density(cosine); }
    double solve(const std::vector<LightPoint>& points, const Direction& normal, double irradiance) const;

    Lobes lobes_;
    std::shared_ptr<const Filling> filling_;
    double ratio_;           ///< samples of ours for one of the partner's
    std::vector<double> nu_; ///< one a bin; 0 where it sees no light
    CoarseMap mean_; ///< radiance at the threshold, harmonic mean over normals: that of what is left to them
};

/// The light of tiles, from which rows of all bins are made.
class FilledTiles {
public:
    FilledTiles(const Target& target, const TileTree& tiles, const TileCurves& curves, const TileCascade& cascade,
                const std::vector<AcdfBrightTile>& bright_tiles, const LocalPartner& partner,
                const NormalBins& bins);

    /// The share of each tile for a bin; 0 for bright tiles, and where the partner covers all.
    std::vector<double> shares(std::size_t bin) const;
    /// What of the samples ours should be, in (0, 1): least noise of both together, by the second moment.
    float recommended_light_share(std::size_t bin, std::vector<double> shares) const;

private:
    struct Piece {
        Direction direction{};
        Box box;
        double reach;   ///< of any direction in it, from the middle
        double light;   ///< root mean square in its cell
        double measure; ///< over 4 pi for all light
        double density; ///< within the tile, per measure
    };
    template <class Visit>
    void for_each_seen(std::size_t tile, std::size_t bin, const Visit& visit) const {
        for (const Piece& piece : pieces_[tile]) {
            const Direction& normal = bins_.normals[bin];
            double cosine = dot(piece.direction, normal);
            if (std::abs(cosine) < piece.reach && partner_.takes(bin, piece.light))
                cosine = mean_cosine(target_, piece.box, normal);
            if (cosine > 0.0) visit(piece, cosine);
        }
    }

    const Target& target_;
    const std::vector<AcdfBrightTile>& bright_tiles_;
    const LocalPartner& partner_;
    const NormalBins& bins_;
    std::vector<bool> is_light_;
    std::vector<std::vector<Piece>> pieces_; ///< of each tile
};

} // namespace acdf::compress
