// Local environment files on one tree of halvings.
#pragma once

#include "build/local.h"

namespace acdf::build {

/// As build_local, of bins that share what they can.
Local build_halved(const compress::Target& target, const Source& source, const LocalOptions& options,
                   const Progress& progress);

} // namespace acdf::build
