// The pdfs that the colours of a plot stand for.
#pragma once

#include "tools/plot/pdf_image.h"

#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// Pdfs in sr^-1 shown by the first and the last colour; 0 < low < high.
struct PdfRange {
    double low = 0.0, high = 0.0;

    /// Where a pdf lies in the range on a logarithmic scale: 0 at or below low, 1 at or above high.
    double position(double pdf) const;
};

/// A range that few outliers cannot stretch: of the positive pdfs it leaves out the lowest that cover 1 % of
/// the sphere and the highest that hold 0.1 % of the probability; then it is rounded outwards to 1, 2 or 5 times
/// a power of ten. One to eight decades.
PdfRange automatic_range(const PdfImage& image);

/// "MIN:MAX", for example "1e-4:100".
std::optional<PdfRange> parse_range(const std::string& text);

/// As parse_range reads it.
std::string to_string(const PdfRange& range);

/// A round pdf: mantissa times ten to the exponent.
struct Tick {
    int mantissa = 1, exponent = 0; ///< mantissa in [1, 9]

    double pdf() const;
};

/// All round pdfs in the range, ascending.
std::vector<Tick> ticks(const PdfRange& range);

/// Whether to label a tick: those of powers of ten; in a range of up to two decades those of 2 and 5 too, and in a
/// range shorter than from 1 to 5 all.
bool is_major(const Tick& tick, const PdfRange& range);

} // namespace acdf::tools
