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
                 const Partner& partner);

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
    /// Whether the partner alone bounds weights of light of that radiance, at all normals that a row serves.
    bool bounds(std::size_t bin, double light) const;
    /// The cosine below which the partner gives light of that radiance less than `least` of what the CDF of all
    /// light, of `flux`, gives it.
    double scarce(double light, double flux, double least) const { return ACDF_PI * least * ratio_ * light / flux; }

private:
    double threshold(std::size_t bin, double cosine) const { return nu_[bin] * lobes_.density(cosine); }
    double solve(const std::vector<LightPoint>& points, const Direction& normal, double irradiance) const;

    Lobes lobes_;
    std::shared_ptr<const Filling> filling_;
    double ratio_;                         ///< samples of ours for one of the partner's
    std::vector<double> nu_;               ///< one a bin; 0 where it sees no light
    std::vector<double> least_irradiance_; ///< one a bin: of all normals that its row serves
    CoarseMap mean_; ///< radiance at the threshold, harmonic mean over normals: that of what is left to them
};

/// The light of tiles, from which rows of all bins are made.
class FilledTiles {
public:
    FilledTiles(const Target& target, const TileTree& tiles, const TileCurves& curves, const TileCascade& cascade,
                const std::vector<AcdfBrightTile>& bright_tiles, const LocalPartner& partner,
                const NormalBins& bins);

    /// The share of each tile for a bin; 0 for bright tiles, and where the partner covers all for all normals that
    /// the row serves.
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
    /// What bounds weights at normals between bins.
    struct Extent {
        Direction middle{};
        double reach = 0.0, flux = 0.0, brightest = 0.0; ///< 0: a bright tile, or dark
    };
    void keep_least(std::size_t bin, std::vector<double>& shares) const;
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
    std::vector<Extent> extents_;            ///< the same
    double flux_ = 0.0;                      ///< of all tiles
};

} // namespace acdf::compress
