// Texels sampled in constant time, as GPU renderers do.
#pragma once

#include "measure/samplers/probe_grid.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Where the numbers come from that choose a texel and then either it or its alias.
enum class AliasNumbers {
    one, ///< both from u0: with random numbers of 24 bits large probes have texels that are never sampled
    two, ///< the texel from u0, the choice from u1
};

/// Walker's alias method over all texels (alias_choices); where in the texel comes from what is left of the random
/// numbers. Twelve bytes a texel. Not monotone: strata of random numbers do not stay strata of directions.
class AliasTable {
public:
    /// Throws std::invalid_argument where the target is no probe or black.
    explicit AliasTable(const compress::Target& target, AliasNumbers numbers = AliasNumbers::two);

    AcdfDirectionSample sample(double u0, double u1) const; ///< u0, u1 in [0, 1)
    float pdf(const float direction[3]) const;              ///< sr^-1; 0 for directions that are NaN or not unit
    std::uint64_t bytes() const { return entries_.size() * sizeof(Entry); }

private:
    struct Entry {
        float keep; ///< probability of the texel, else it is its alias
        std::uint32_t alias;
        float pdf; ///< sr^-1
    };

    ProbeGrid grid_;
    AliasNumbers numbers_;
    std::vector<Entry> entries_; ///< rows x columns
};

} // namespace acdf::measure
