// What a fit approximates: a non-negative function, constant on each rectangle of a grid.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// f on rows x columns, row-major; each axis carries the measure of its steps. For a probe the columns are
/// azimuths and the rows elevations, so that the measure of a texel is its exact solid angle.
struct Target {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<float> values;          ///< f >= 0, finite
    std::vector<double> column_measure; ///< one a column, > 0
    std::vector<double> row_measure;    ///< one a row, > 0
    std::uint32_t column_axis = 0;      ///< axis numbers in the file
    std::uint32_t row_axis = 1;

    const float* row(std::uint32_t r) const { return values.data() + std::size_t{r} * columns; }
};

/// Weights of the red, green and blue channel in the target. Rec. 709 luminance by default.
struct ChannelWeights {
    double r = 0.2126, g = 0.7152, b = 0.0722;
};

/// The target of a lat-long probe of `rgb` (rows x columns x 3): weighted channels, negatives as 0 channel
/// by channel, measure dphi and dz = d cos(theta) (Lawrence et al. 2005, §3). Throws std::invalid_argument on
/// non-finite input.
Target environment_target(const float* rgb, std::uint32_t columns, std::uint32_t rows,
                          const ChannelWeights& weights);

/// The same function with rows and columns exchanged.
Target transposed(const Target& target);

/// The integral of f, by compensated summation.
double integral(const Target& target);

} // namespace acdf::compress
