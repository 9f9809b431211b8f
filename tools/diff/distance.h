// How far two files are from each other, as what samples from them sees it.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace acdf::tools {

struct Distance {
    std::size_t conditions = 0;     ///< normals, views or bins that were compared; 1: none to choose
    double mean = 0.0, worst = 0.0; ///< over conditions: the share of samples that fall elsewhere (total variation)
    double largest_ratio = 1.0;     ///< of the two pdfs, wherever samples of either fall; infinite where one is 0
    double total = 0.0;             ///< of the two integrals: what they differ by, over the larger one
};

/// Why pdfs of the two cannot be compared: another kind or number of axes, visibility cells. Empty: they can
/// be.
std::string why_not_compared(const File& a, const File& b);

/// Of two files that can be compared, from `samples` of either for each condition (0: 2048, or 65536 where there is
/// one condition alone). 0 throughout where all pdfs are the same; else the share is known to about a
/// thousandth.
Distance distance(const File& a, const File& b, std::uint32_t samples);

} // namespace acdf::tools
