// Makes the runtime tables of acdf/cells.h.
#pragma once

#include "tables/tree_survey.h"

#include <acdf/allocator.h>
#include <acdf/cells.h>
#include <acdf/sample.h>
#include <acdf/wavefront.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// The tables of an environment, whose tree was surveyed, in `block`, which the caller gives back, of at most
/// `most_bytes`; null where there are none: where the survey was not done, for more than 65535 cells, where they
/// would take more bytes, and where memory fails. The work is linear in the cells. What is needed meanwhile lies in
/// `scratch` (null: wherever there is memory). The same bits by any instructions, of which `most` are the best that
/// are used.
AcdfCells* make_cells(const AcdfEnvironment& environment, const TreeSurvey& survey, std::size_t most_bytes,
                      const AcdfAllocator& allocator, AcdfBlock& block, Scratch* scratch = nullptr,
                      Instructions most = Instructions::avx512) noexcept;

/// The same for shaders: tables that answer always (AcdfPieceEnds), of any size. Null too where a block of cells
/// cannot name all that a point may lie in, which takes cells of less than 2^-11 radians about a pole.
AcdfCells* make_shader_cells(const AcdfEnvironment& environment, const TreeSurvey& survey,
                             AcdfBlock& block) noexcept;

} // namespace acdf
