// How many knots one row of a probe needs, adaptive against equally spaced: the study of Lawrence et al. 2005,
// Fig. 6.
#pragma once

#include "compress/cascade.h"
#include "compress/fit/curve.h"
#include "compress/target.h"

#include <acdf/layout.h>

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// A row as a pdf p* over [0, 1], constant on each texel.
class Scanline {
public:
    /// Throws std::invalid_argument where there is no such row, or no light in it.
    Scanline(const compress::Target& target, std::uint32_t row);

    std::uint32_t texels() const { return static_cast<std::uint32_t>(row_.mass.size()); }
    /// The curve that a fit makes of the row with at most so many segments: uniform and cdf with pdfs constant on
    /// each segment, pdf linear.
    compress::Curve fit(AcdfFit fit, std::uint32_t segments) const;
    /// sqrt of the integral of (p - p*)^2 over [0, 1].
    double rms_error(const compress::Curve& curve) const;
    /// The fewest equally spaced segments whose error is at most this; of all texels there is none.
    std::uint32_t uniform_segments(double rms_error) const;
    /// The integral of p*^2 less 1: 0 for a constant row.
    double contrast() const;

private:
    compress::Distribution row_;
    std::vector<float> values_;
    std::vector<double> uniform_error_; ///< of 1, 2, ... segments
};

/// A fit with so many segments, and how many equally spaced ones are as accurate.
struct KnotGain {
    std::uint32_t segments = 0;
    double rms_error = 0.0;
    std::uint32_t uniform_segments = 0;

    /// Of knots, the ends of the row included.
    double factor() const { return (uniform_segments + 1.0) / (segments + 1.0); }
};
/// `segments` are those that the fit makes, which may be fewer than asked for.
KnotGain knot_gain(const Scanline& scanline, AcdfFit fit, std::uint32_t segments);

enum class RowChoice { smooth, peaky };
/// The row of least or most contrast of those between 45 and 135 degrees from the pole: towards it rows get smooth
/// because they get short. Throws std::invalid_argument where none has any light.
std::uint32_t choose_row(const compress::Target& target, RowChoice choice);

} // namespace acdf::measure
