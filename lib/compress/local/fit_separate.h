// Local environment maps as Lawrence et al. 2005, §7.1 store them: each bin of normals has a tree of its own.
#pragma once

#include "compress/fit/fit.h"
#include "compress/local/normals.h"

#include <vector>

namespace acdf::compress {

/// What a bin's tree is fitted to.
enum class BinTarget {
    mean,  ///< the mean over the bin's normals of (f_n / E_n)^2: right for all of them, and covers what any can see
    centre ///< f of the middle normal, as the paper has it: biased for others, which may see what it does not
};

/// Trees, each of a bin, behind the environment's own.
struct SeparateFit {
    EncodedTree tree;          ///< roots: one a bin, ACDF_NO_ROOT where it is not stored
    std::vector<float> shares; ///< one a bin: the mean irradiance over the integral of the probe
};

/// `options` are those of one tree, of the fits cdf, pdf and uniform. Deterministic for any number of threads.
/// Throws std::invalid_argument where the target has no energy.
SeparateFit fit_local_separate(const Target& target, const NormalBins& bins, BinTarget kind,
                               const FitOptions& options);

/// The target of one bin: g times the root of the mean of (max(0, n . omega) / E_n)^2. Exposed for tests.
Target bin_target(const Target& target, const NormalBins& bins, std::size_t bin, BinTarget kind);

} // namespace acdf::compress
