// The primaries that an image file declares.
#pragma once

#include <acdf/builder.h>

#include <optional>
#include <vector>

namespace acdf::input {

/// Luminance as a sum of channels, by the CIE x and y of red, green, blue and white (images::Header); white has
/// luminance 1. None where it is that of Rec. 709 to a thousandth, and where there are no primaries that span
/// colours. What is negative, as of ACES 2065's blue, is 0, as light is.
std::optional<builder::ChannelWeights> luminance_of(const std::vector<float>& chromaticities);

/// Whether channels are CIE X, Y and Z themselves.
bool are_xyz(const std::vector<float>& chromaticities);

} // namespace acdf::input
