// Cells of visibility from counts of rays: a k-d tree over positions and normals, fine where what is seen differs.
#pragma once

#include "compress/store/store.h"
#include "compress/visibility/counts.h"
#include "compress/visibility/parts.h"

#include <cstdint>

namespace acdf::compress {

/// How large they may be, and what for.
struct LearnedSize {
    std::uint64_t bytes = 3 << 20; ///< of the chunk, at most (but for that of one cell)
    bool beside_cosine = false;    ///< rows for what cosine samples, as many as those of light, leave over
};

/// Chunk PLAC of what rays found: `parts` are those that counts were made for. The same for any number of threads.
/// One cell, in which all is as without it, where there are no counts.
Chunk learned_visibility(const VisibilityParts& parts, const VisibilityCounts::Sorted& counts,
                         const LearnedSize& size);

} // namespace acdf::compress
