// The bytes of visibility cells: chunk PLAC and its rows.
#pragma once

#include "compress/store/store.h"
#include "compress/visibility/parts.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Bytes of a row: of a cell in which parts would give `light` to points, in any unit, and are to be multiplied by
/// `factors`.
void encode_visibility(const VisibilityParts& parts, const float* light, const float* factors, std::uint8_t* out);

/// What PLAC holds.
struct VisibilityChunk {
    AcdfVisibility header{}; ///< counts are those of the rest
    std::vector<AcdfVisibilitySplit> splits;
    std::vector<AcdfColumn> columns;       ///< sets of them
    std::vector<std::uint16_t> set_of_row; ///< empty where there is one set
    std::vector<std::uint8_t> rows;

    Chunk stored() const;
};

} // namespace acdf::compress
