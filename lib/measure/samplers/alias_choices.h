// Walker's alias method: one of n, each with its own probability, in constant time.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Of n positions that are sampled alike, what one stands for: itself, or another.
struct AliasChoice {
    float keep;          ///< probability that it stands for itself
    std::uint32_t alias; ///< what it stands for else
};

/// A slot for each mass (Walker, ACM TOMS 3(3), 1977), in linear time after Vose (IEEE TSE 17(9), 1991). Masses
/// have the mean 1; what has the mass 0 is never sampled.
std::vector<AliasChoice> alias_choices(std::vector<double> mass);

} // namespace acdf::measure
