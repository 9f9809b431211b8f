// A table that is made to be combined with another one by multiple importance sampling.
#pragma once

#include "build/accuracy/table.h"
#include "compress/grid.h"
#include "compress/partner.h"

#include <memory>
#include <vector>

namespace acdf::build {

/// What the cells of bins cost beside those of another table, which is sampled in proportion to its own numbers
/// within each bin: water filling (docs/method.md), bin by bin. Where that table has no energy in a bin it is no
/// partner.
class TablePartner {
public:
    /// `bins` and `others`: table_grids of two arrays of one shape, whose values must outlive this. Without a
    /// partner `others` may be empty.
    TablePartner(const std::vector<compress::Grid>& bins, const std::vector<compress::Grid>& others,
                 const compress::Partner& partner);

    /// `bins` with their costs.
    const std::vector<compress::Grid>& bins() const { return bins_; }

private:
    std::vector<compress::Grid> bins_;
    std::vector<std::vector<float>> left_, least_;
    std::shared_ptr<const compress::Filling> filling_;
};

/// Compares a file that has the MIS partner of a table with `bins`, as measure_bins does: variance, weights and
/// violations are those of both together, N times the variance of N samples of which the file has its share. Errors
/// of the pdf are 0. Throws std::invalid_argument as measure_bins does.
std::vector<BinAccuracy> measure_bins_beside(const File& file, const std::vector<compress::Grid>& bins,
                                             const std::vector<compress::Grid>& others);

/// For each bin of such a file the share of samples to take from it for the least second moment: a multiple of
/// 1/32; 1 where there is nothing to sample.
std::vector<float> recommended_light_shares(const File& file, const std::vector<compress::Grid>& bins,
                                            const std::vector<compress::Grid>& others);

} // namespace acdf::build
