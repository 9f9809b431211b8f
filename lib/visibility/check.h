// The rules of visibility cells and portals, 7009 to 7019 of SPEC.md. Not installed.
#pragma once

#include "reader/check/checker.h"

#include <acdf/visibility/visible_local.h>

namespace acdf {

/// Of a code of a column: the share of the lower side.
extern const double (&visibility_odds)[256];

/// PLAC of a local environment whose rows of normals have so many splits. Sets `cells` if it is right.
ACDF_ONCE void check_cells(const Payload& payload, u32 splits, Report& report, AcdfVisibilityTable& cells) noexcept;
/// PORT of a file with as many rows of cells. Sets `portals` if it is right.
ACDF_ONCE void check_portals(const Payload& payload, u32 rows, Report& report, AcdfPortalTable& portals) noexcept;

/// Reports every finding that the checks can go on to of an open file, of any kind: none where it has no cells.
/// Linear in the size of the two chunks. Cells and portals of `view` are set where the verdict has no errors.
ACDF_ONCE Verdict check_visibility(const AcdfFile& file, FindingSink sink, void* context,
                                   AcdfVisibleLocal& view) noexcept;

/// The same without the view: what `validate` goes on with where it found no error.
Verdict validate_visibility(const File& file, FindingSink sink, void* context) noexcept;

} // namespace acdf
