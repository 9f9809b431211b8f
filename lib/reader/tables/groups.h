// Makes the runtime tables of acdf/groups.h.
#pragma once

#include "tables/tree_survey.h"

#include <acdf/allocator.h>
#include <acdf/parallel.h>
#include <acdf/sample.h>
#include <acdf/wavefront.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// The tables of an environment, whose tree was surveyed, in `block`, which the caller gives back, of at most
/// `most_bytes`; null where there are none: where the survey was not done, for trees of one cell, for grids of 2^31
/// steps and more, where they would take more bytes, and where memory fails. The work is linear in the cells.
/// What is needed meanwhile lies in `scratch` (null: wherever there is memory). The same bits by any instructions,
/// of which `most` are the best that are used, and by any number of threads.
AcdfGroups* make_groups(const AcdfEnvironment& environment, const TreeSurvey& survey, std::size_t most_bytes,
                        const AcdfAllocator& allocator, AcdfBlock& block, Scratch* scratch = nullptr,
                        Instructions most = Instructions::avx512, const AcdfParallel& parallel = {}) noexcept;

} // namespace acdf
