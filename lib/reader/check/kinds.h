// What files are checked for that environments of halvings have none of. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

/// BINS; needs parts.description. Sets parts.bins if its length is right; true: its shares are, too.
ACDF_ONCE bool check_bins(const Payload& payload, Report& report, Parts& parts) noexcept;
/// Whether there are as many bins as the indexed axes make.
ACDF_ONCE void check_bin_count(const Payload& payload, int rule, u64 bins, Report& report,
                               const Parts& parts) noexcept;
/// Axes of a local environment whose normals are the corners of an octahedron, and its bins.
ACDF_ONCE void check_local_axes(const Payload& description, Report& report, const Parts& parts) noexcept;
/// LOCL. Sets parts.local.
ACDF_ONCE void check_local_header(const Payload& description, const Payload& local, Report& report,
                                  Parts& parts) noexcept;
/// Axes of a BRDF, whose second one is `rows`, its bins, and VIEW. Sets parts.views and parts.nodes.
ACDF_ONCE void check_brdf_kind(const Payloads& payloads, const WantedAxis& rows, Report& report,
                               Parts& parts) noexcept;
/// What a BRDF on one tree of halvings has beside HALV: BINS, NORM and VIEW; needs parts.halvings. Sets what
/// check_rows and check_brdf_kind set.
ACDF_ONCE void check_halved_brdf(const Payloads& payloads, Report& report, Parts& parts) noexcept;
/// BINS and NORM, of bins that have rows at the top of a tree of halvings; needs parts.halvings. Sets parts.bins,
/// parts.normals and what belongs to it.
void check_rows(const Payloads& payloads, Report& report, Parts& parts) noexcept;
/// What a local environment on one tree of halvings has beside HALV: BINS, NORM and LOCL; needs parts.halvings.
/// Sets parts.normals and what belongs to it.
ACDF_ONCE void check_normals(const Payloads& payloads, Report& report, Parts& parts) noexcept;
/// The same of tables, and BINS and HALV. Sets parts.bins and parts.halvings.
ACDF_ONCE void check_table_kind(const Payloads& payloads, Report& report, const AcdfAllocator& allocator,
                                Parts& parts) noexcept;

} // namespace acdf
