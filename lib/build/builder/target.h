// Targets of what the caller gives.
#pragma once

#include "build/builder/guard.h"
#include "build/builder/sources.h"

#include <acdf/builder.h>

namespace acdf::builder {

// Throw what guard.h turns into a Status. `progress` covers [0, 1].
Target make_target(const Pixels& pixels, const TargetOptions& options, int threads,
                   const build::Progress& progress);
IndexedMap make_indexed_map(const Pixels& pixels, const TargetOptions& options, int threads,
                            const build::Progress& progress);
Target make_target(const Rows& rows, const TargetOptions& options, int threads, const build::Progress& progress);

} // namespace acdf::builder
