// The rules of environments of several maps: chunk MAPS, and the axes of maps. Not installed.
#pragma once

#include "reader/check/checker.h"
#include "reader/opened_file.h"

namespace acdf {

/// Where the parts of MAPS lie.
struct Maps {
    const AcdfMapsHeader* header = nullptr;
    const double* coordinates = nullptr;
    const AcdfMap* maps = nullptr; ///< header->map_count
    const u8* splits = nullptr;    ///< a bit for each halving; then the codes of each map
};

/// The axes and the tree of an open file of this kind, as checks of the reader take them.
void take_parts(const AcdfFile& file, Parts& parts) noexcept;

/// Rules 6036 to 6038 of MAPS, and 7020 to 7022, in time linear in the bytes; `parts` are those of `file`. Right
/// where nothing was reported.
Maps check_maps(const AcdfFile& file, const Parts& parts, Report& report) noexcept;

/// Reports every finding of these rules in a file of this kind: what `validate` goes on with where it found no
/// error.
Verdict validate_maps(const File& file, FindingSink sink, void* context) noexcept;

} // namespace acdf
