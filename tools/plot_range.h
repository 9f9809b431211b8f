// The densities that the colours of a plot stand for.
#pragma once

#include "plot_density.h"

#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// Densities in sr^-1 shown by the first and the last colour; 0 < low < high.
struct DensityRange {
    double low = 0.0, high = 0.0;

    /// Where a density lies in the range on a logarithmic scale: 0 at or below low, 1 at or above high.
    double position(double density) const;
};

/// A range that few outliers cannot stretch: of the positive densities it leaves out the lowest that cover 1 % of
/// the sphere and the highest that hold 0.1 % of the probability; then it is rounded outwards to 1, 2 or 5 times
/// a power of ten. One to eight decades.
DensityRange automatic_range(const DensityImage& image);

/// "MIN:MAX", for example "1e-4:100".
std::optional<DensityRange> parse_range(const std::string& text);

/// As parse_range reads it.
std::string to_string(const DensityRange& range);

/// Exponents of the powers of ten in the range.
std::vector<int> decades(const DensityRange& range);

/// The other round densities in the range: 2 to 9 times a power of ten.
std::vector<double> minor_ticks(const DensityRange& range);

} // namespace acdf::tools
