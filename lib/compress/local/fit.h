// The fit of a local environment map: one probe, for every normal the light above its horizon times the cosine.
#pragma once

#include "compress/fit/fit.h"
#include "compress/fit/tiles.h"
#include "compress/local/light.h"
#include "compress/local/normals.h"
#include "compress/local/partner.h"
#include "compress/local/tile_curves.h"
#include "compress/partner.h"

#include <acdf/layout.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace acdf::compress {

/// How bins that share what they can are stored: curves in tiles and a byte a split in rows, which know visibility
/// cells and bounds on weights; or one tree of halvings, with a row of codes for each (local/halved/fit.h).
enum class LocalShape { small, halvings };

/// How large a local environment map becomes.
struct LocalSize {
    std::uint32_t tiles = 900;           ///< at most so many
    std::uint64_t inside_bytes = 131072; ///< of curves in tiles, at most (but for the least there must be)
    /// What the whole environment counts beside all normals together where its tree is made of curves in tiles.
    double whole_worth = 0.0;
    WholeTree whole = WholeTree::of_tiles; ///< beside an MIS partner it has curves of its own
    std::uint64_t whole_bytes = 16384;     ///< of those, at most
    /// The largest weight over the mean, as far as bins show it; not beside an MIS partner.
    double max_weight = std::numeric_limits<double>::infinity();
};

/// A local environment map, ready to be stored.
struct LocalFit {
    TileTree tiles;
    Cascade cascade;   ///< root 0: the environment as a whole
    EncodedTree tree;  ///< roots: one a bin, its row or ACDF_NO_ROOT where it is not stored
    StoredRows shared; ///< tiles, and a row for each bin
    std::vector<AcdfBrightTile> bright_tiles;
    std::vector<float> shares; ///< one a bin: its irradiance, bright tiles excepted, over the integral of the probe
    std::vector<AcdfPartnerRecord> records; ///< beside an MIS partner: one a bin
};

/// Fits tiles, what is in them, bright tiles, and the rows of all bins that occur. Deterministic for any number of
/// threads.
///
/// Beside an MIS partner a share is the flux that is left to the file, rows are 0 where the partner covers a tile,
/// and records hold the irradiance.
class LocalFitter {
public:
    /// Divides into tiles; `size.inside_bytes` is of no meaning. Target, bins and their light must outlive it.
    /// Throws std::invalid_argument where the target has no energy, or the bins are cells of a grid: rows are made
    /// for corners, whose mixture covers what a normal between them sees.
    LocalFitter(const Target& target, const NormalBins& bins, const BinLight& light, const LocalSize& size,
                const Progress& progress, const Partner& partner);

    /// Where the environment has curves of its own: at most `bytes` of them, not size.whole_bytes.
    void refit_whole(std::uint64_t bytes);
    /// A fit whose curves take at most `inside_bytes` (but for the least there must be): all of it, but
    /// shares are 0, and so is what rows and records hold. It is stored in as many bytes as it will be.
    LocalFit outlined(std::uint64_t inside_bytes);
    /// Shares, rows and records of the fit that was outlined last.
    void fill(LocalFit& fit) const;

private:
    struct Curves {
        std::unique_ptr<TileCascade> cascade;
        EncodedTree tree;
    };

    Curves fit_curves(std::uint64_t bytes);
    void outline_curves(std::uint64_t bytes, LocalFit& out);
    void fill_beside(LocalFit& out) const;
    void fill_mixed(LocalFit& out) const;
    WholeTree whole_tree() const { return beside_ ? WholeTree::own : size_.whole; }
    void report(double share) const {
        if (progress_) progress_(share);
    }

    const Target& target_;
    const NormalBins& bins_;
    const BinLight& light_;
    const LocalSize size_;
    const double total_; ///< the integral of the target
    const Progress progress_;
    std::optional<LocalPartner> beside_;
    Target filled_; ///< the rest of the target, beside an MIS partner
    TileTree tiles_;
    BrightTileRule rule_;
    std::vector<double> worth_of_tiles_;
    // Of the fit that was outlined last:
    std::optional<TileCurves> tile_curves_;
    Curves curves_;
    Fitted whole_; ///< the environment, where it has curves of its own
};

LocalFit fit_local(const Target& target, const NormalBins& bins, const LocalSize& size,
                   const Progress& progress = {}, const Partner& partner = {});

} // namespace acdf::compress
