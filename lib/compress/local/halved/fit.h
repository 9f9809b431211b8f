// A local environment map on one tree of halvings, with a row of codes for each normal
// (docs/notes/local-method.md).
#pragma once

#include "compress/fit/fit.h"
#include "compress/halvings/halvings.h"
#include "compress/halvings/rows.h"
#include "compress/local/halved/choice.h"
#include "compress/local/halved/filling.h"
#include "compress/local/halved/rows.h"
#include "compress/local/normals.h"
#include "compress/partner.h"
#include "compress/store/store.h"

#include <acdf/layout.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace acdf::compress {

/// What chunks HALV and NORM hold, and what BINS and COMP say of rows.
struct LocalHalvings : RowHalvings {
    std::vector<std::uint32_t> roots;       ///< one a bin: its row, or ACDF_NO_ROOT
    std::vector<float> shares;              ///< one a bin: its light over that of the probe
    std::vector<AcdfPartnerRecord> records; ///< beside an MIS partner: one a bin
    double mixing_variance = 0.0; ///< what mixed rows add to those that suit each normal, mean over normals
};

/// How large the parts of a fit become.
struct LocalHalvingsSize {
    std::uint32_t code_bits = 7;
    std::size_t top = 0;                                            ///< halvings with codes of rows, at most
    std::size_t halvings = std::numeric_limits<std::size_t>::max(); ///< of all, at most
    std::uint64_t bytes = 0;                                        ///< of HALV and NORM together, at most
    /// The largest weight over the mean, as far as bins show it; not beside an MIS partner.
    double max_weight = std::numeric_limits<double>::infinity();
};

/// Fits of one probe, of any size. Deterministic for any number of threads.
class LocalHalvingsFitter {
public:
    /// `target` must outlive it. `normals`: bins of any number, weighed as normals occur. `partner`: none, or one
    /// that follows the cosine. Throws std::invalid_argument where the target has no
    /// energy.
    LocalHalvingsFitter(const Target& target, const NormalBins& normals, const Partner& partner);

    /// Subdivisions and code bits for `bytes` of chunks HALV and NORM, and `of_bin` beside them for each bin;
    /// `fixed`: if not 0, the subdivisions.
    RowSize rows_for(double bytes, double of_bin, std::uint32_t fixed);
    /// Halvings with codes of rows of these bins.
    std::size_t top_for(double bytes, const NormalBins& bins, std::uint32_t code_bits);
    /// Throws std::runtime_error where no tree fits.
    LocalHalvings fit(const NormalBins& bins, const LocalHalvingsSize& size, const Progress& progress);

private:
    const HalvedGrowth& grown_top(std::size_t halvings);
    void weigh_light(SomeNormals normals);
    void fill_light(SomeNormals normals, double ratio);
    const HalvedCosts& below() const {
        if (filled_costs_) return *filled_costs_;
        return shared_->costs();
    }
    std::size_t codes_of(const std::vector<HalvedNode>& top, const NormalBins& bins) const;
    LocalHalvings grown(std::vector<HalvedNode> top, std::size_t all, const NormalBins& bins,
                        const LocalHalvingsSize& size, const Progress& progress) const;
    std::vector<double> weights_of(const std::vector<HalvedNode>& nodes, std::size_t top, double heaviest) const;
    void mixed(const RowTree& tree, const std::vector<HalvedNode>& nodes, const NormalBins& bins, double max_weight,
               LocalHalvings& out) const;
    void filled(const RowTree& tree, const std::vector<HalvedNode>& nodes, const NormalBins& bins,
                LocalHalvings& out) const;

    const Target& target_;
    const double unit_; ///< one over the mean of the target
    const Blocks blocks_;
    BlockMoments light_;                  ///< as tiles are found by
    std::optional<BlockMoments> squares_; ///< of g^2, without a partner
    std::optional<TopCosts> costs_;
    std::optional<SharedLight> shared_;
    std::optional<HalvedGrowth> top_;
    std::size_t top_asked_ = 0;
    std::optional<double> mixing_;
    // Beside a partner:
    double ratio_ = 0.0; ///< samples of ours for one of the partner's; 0: there is none
    AcdfHeuristic heuristic_ = ACDF_HEURISTIC_BALANCE;
    std::optional<Radiances> radiances_;
    std::optional<FilledLight> filled_light_;
    std::vector<BlockMoments> of_classes_;
    std::optional<FilledCosts> filled_costs_;
};

} // namespace acdf::compress
