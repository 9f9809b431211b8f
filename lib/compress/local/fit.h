// The fit of a local environment map: one probe, for every normal the light above its horizon times the cosine.
#pragma once

#include "compress/company.h"
#include "compress/fit/fit.h"
#include "compress/fit/tiles.h"
#include "compress/local/company.h"
#include "compress/local/light.h"
#include "compress/local/normals.h"
#include "compress/local/tile_curves.h"

#include <acdf/layout.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace acdf::compress {

/// How large a local environment map becomes.
struct LocalSize {
    std::uint32_t tiles = 900;         ///< at most so many
    std::uint64_t tree_bytes = 131072; ///< of the curves within tiles, at most (but for the least there must be)
    /// What weights are held to, over their mean, as far as bins tell; not beside a company.
    double max_weight = std::numeric_limits<double>::infinity();
};

/// A local environment map, ready to be stored.
struct LocalFit {
    TileTree tiles;
    Cascade cascade;   ///< root 0: the environment as a whole
    EncodedTree tree;  ///< roots: one a bin, its row or ACDF_NO_ROOT where it is not stored
    StoredRows shared; ///< tiles, and a row for each bin
    std::vector<AcdfLight> lights;
    std::vector<float> shares; ///< one a bin: its irradiance, lights excepted, over the integral of the probe
    std::vector<AcdfCompanyRecord> records; ///< beside a company: one a bin
};

/// Fits tiles, the curves in them, lights, and the rows of all bins that occur. Deterministic for any number of
/// threads.
///
/// Beside a company a share is the flux that is left to the file, rows are 0 where the company covers a tile, and
/// records tell the irradiance.
class LocalFitter {
public:
    /// Divides into tiles; `size.tree_bytes` is of no meaning. Target and bins must outlive it. Throws
    /// std::invalid_argument where the target has no energy, or the bins are cells of a grid: rows are made for
    /// corners, whose mixture covers what a normal between them sees.
    LocalFitter(const Target& target, const NormalBins& bins, const LocalSize& size, const Progress& progress,
                const Company& company);

    /// A fit whose curves take at most `tree_bytes` (but for the least there must be): all of it, but shares are 0,
    /// and so is what rows and records hold. It is stored in as many bytes as it will be.
    LocalFit outlined(std::uint64_t tree_bytes);
    /// Shares, rows and records of the fit that was outlined last.
    void fill(LocalFit& fit) const;

private:
    struct Curves {
        std::unique_ptr<TileCascade> cascade;
        EncodedTree tree;
    };

    Curves fit_curves(std::uint64_t bytes);
    void report(double share) const {
        if (progress_) progress_(share);
    }

    const Target& target_;
    const NormalBins& bins_;
    const double max_weight_;
    const Progress progress_;
    std::vector<double> flux_; ///< the irradiance of each bin
    Worth worth_;
    std::optional<LocalCompany> beside_;
    Target filled_; ///< what is left of the target beside a company
    TileTree tiles_;
    LightRule rule_;
    std::vector<double> worth_of_tiles_;
    std::optional<TileCurves> tile_curves_; ///< of the fit that was outlined last
    Curves curves_;
};

LocalFit fit_local(const Target& target, const NormalBins& bins, const LocalSize& size,
                   const Progress& progress = {}, const Company& company = {});

} // namespace acdf::compress
