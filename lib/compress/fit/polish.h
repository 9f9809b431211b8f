// Local improvement of a curve: its knots moved to where they lower the noise most.
#pragma once

#include "compress/fit/prune.h"

namespace acdf::compress {

/// Moves the knots of a bin over one axis, whose tree is a single curve, together to where the sum of the costs of
/// its cells is least nearby. Divisions that were found greedily may be a quarter above the least noise; after this
/// they are within a few per cent. `bin` is one of `flat` and comes from `partition`; a grid of more axes is left
/// alone, as what lies below a segment would have to move with it.
void polish(const Partition& partition, std::size_t bin, Flattened& flat);

} // namespace acdf::compress
