// BRDFs as Lawrence et al. 2005, §6.2 store them: a tree for each bin of views, of which the nearest serves.
#pragma once

#include "compress/brdf/fit.h"

namespace acdf::compress {

/// The fits uniform, cdf and pdf: nothing is shared. Bins are of equal angle.
BrdfFit fit_separate(const Reflected& reflected, const BrdfOptions& options);

} // namespace acdf::compress
