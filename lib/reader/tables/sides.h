// Cells of trees as parts of the eight pieces of the sphere, or as boxes of the octahedral square (acdf/cells.h).
#pragma once

#include "tables/curve_segments.h"
#include "tables/growable.h"

#include <acdf/cells.h>
#include <acdf/grid.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A cell as the traversal of a tree finds it.
struct Cell {
    double probability;
    double low[2], high[2];          ///< random numbers
    std::uint32_t first[2], last[2]; ///< positions
    bool dark, tilted;
};

/// A segment of a curve: the part of a cell that it leaves, along the curve's axis.
struct CellPart {
    double share;              ///< of the cell's probability
    double low, high;          ///< random numbers
    std::uint32_t first, last; ///< positions
    bool dark, tilted;

    Cell in(const Cell& above, std::uint32_t axis) const {
        Cell cell = above;
        cell.probability *= share;
        cell.low[axis] = low;
        cell.high[axis] = high;
        cell.first[axis] = first;
        cell.last[axis] = last;
        cell.dark = dark;
        cell.tilted = above.tilted || tilted;
        return cell;
    }
};

/// The segments of a curve in the cell `above` that it divides, one after the other, as parts of that.
class CellParts {
public:
    CellParts(const AcdfCurve& curve, const Cell& above)
        : axis_(acdf_curve_axis(&curve)), tilts_(reinterpret_cast<const std::int16_t*>(curve.tilts)),
          segments_(curve, above.first[axis_], above.last[axis_]), all_(segments_.maximum()),
          low_(above.low[axis_]), high_(above.high[axis_]), width_(high_ - low_) {}
    std::uint32_t axis() const { return axis_; }
    std::uint32_t link() const { return segments_.link(); }
    CurveSegment segment() { return segments_.next(); }
    /// Random numbers of a segment.
    double low(const CurveSegment& segment) const { return low_ + width_ * (segment.from / all_); }
    double high(const CurveSegment& segment) const { return high(segment, segment.to / all_); }
    /// All of the next segment. Only where each of those before was asked for so: one division less.
    CellPart next() {
        const std::uint32_t i = segments_.number();
        const double from = from_;
        const CurveSegment segment = segments_.next();
        from_ = segment.to / all_;
        return {static_cast<double>(segment.to - segment.from) / all_,
                low_ + width_ * from,
                high(segment, from_),
                segment.first,
                segment.last,
                segment.to == segment.from,
                tilts_ && tilts_[i] != 0};
    }
    /// What a segment leaves of the cell, where nothing is tilted.
    Cell cell(const Cell& above, const CurveSegment& segment) const {
        return CellPart{static_cast<double>(segment.to - segment.from) / all_,
                        low(segment),
                        high(segment),
                        segment.first,
                        segment.last,
                        segment.to == segment.from,
                        false}
            .in(above, axis_);
    }

private:
    double high(const CurveSegment& segment, double part) const {
        return segment.to != segments_.maximum() ? low_ + width_ * part : high_;
    }

    std::uint32_t axis_;
    const std::int16_t* tilts_;
    CurveSegments segments_;
    double all_; ///< the maximum
    double low_, high_, width_;
    double from_ = 0.0; ///< the part of all at which the next segment begins
};

/// Calls add(above, axis, part) for each cell of a curve at `at`, which divides the cell `above`, and of the curves
/// below it, in their order, as long as it returns true. Returns whether it always did. A path passes at most 64
/// curves.
template <class Add>
bool each_cell(const std::uint8_t* tree, std::uint32_t at, const Cell& above, const Add& add) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    CellParts parts(curve, above);
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t link = parts.link();
        const CellPart part = parts.next();
        if (link == 0 ? !add(above, parts.axis(), part)
                      : !each_cell(tree, at + link, part.in(above, parts.axis()), add))
            return false;
    }
    return true;
}

/// The part of a cell's side that lies in one piece of the sphere: from low to high random numbers.
struct Side {
    std::uint32_t piece; ///< quarter, or whether it is south; 0 on the square
    double low, high;    ///< random numbers
    double local[2];     ///< at low and high: local azimuth, 1 - |z|, or 1 - 2 u, 2 v - 1
    double margin[2];    ///< of `local`, in which nothing is sure
    double key[2];       ///< of acdf_keys_of_direction: the lesser, and the greater
    double beyond;       ///< the first key behind its piece; that of a quarter is the next one's
    double ends[2];      ///< tangents of azimuth or 1 - |z|: the lesser, and the greater; not on the square

    std::uint32_t first_key() const { return static_cast<std::uint32_t>(key[0]); }
    /// In another quarter local azimuths are others: it is not to be looked for there.
    std::uint32_t last_key() const { return static_cast<std::uint32_t>(key[1] < beyond ? key[1] : beyond - 1.0); }
};

/// A sample stays this angle (radians) inside its piece: four times ACDF_BORDER, for what floats round.
constexpr double kSideMargin = 0x1p-20;
constexpr std::uint32_t kSouthKeys = (1u << ACDF_DIRECTION_BITS) - 1;

/// Cuts cells of a grid.
class Sides {
public:
    explicit Sides(const AcdfGrid& grid) : grid_(grid), columns_(grid.columns), rows_(grid.rows) {}

    /// Trigonometry of each column and row once, unless they are more than `most`. False where memory fails.
    bool remember(std::size_t most);
    /// Of axis 0 into out[5]; returns how many.
    int azimuths(const Cell& cell, Side* out) const;
    /// Of axis 1 into out[2]; returns how many.
    int heights(const Cell& cell, Side* out) const;
    /// acdf_grid_height of a cell.
    double height(const Cell& cell) const;
    /// Bits of a key.
    std::uint32_t key_bits() const { return octahedral() ? ACDF_SQUARE_BITS : ACDF_DIRECTION_BITS; }
    /// The pdf of a cell without tilts, sr^-1; 0 for a dark one.
    float density(const Cell& cell) const;
    /// What the trigonometry of a border between rows gives.
    struct Row {
        double z, cap; ///< cosine, 1 - |cosine|
        double margin; ///< of the angle, as a difference of z
    };
    /// Of each column and row, where they are remembered; else null.
    const double* tangents() const { return tangents_.size() > 0 ? tangents_.data() : nullptr; }
    const Row* rows() const { return heights_.size() > 0 ? heights_.data() : nullptr; }

private:
    bool octahedral() const { return acdf_grid_is_octahedral(&grid_) != 0; }
    int square_side(const Cell& cell, int axis, Side& out) const;
    double tangent(std::uint32_t column) const {
        return column < tangents_.size() ? tangents_[column] : tangent_of(column, columns_);
    }
    static double tangent_of(std::uint32_t column, std::uint32_t columns);
    Row row(std::uint32_t row) const { return row < heights_.size() ? heights_[row] : row_of(row, rows_); }
    static Row row_of(std::uint32_t row, std::uint32_t rows);

    AcdfGrid grid_;
    std::uint32_t columns_, rows_;
    Growable<double> tangents_;
    Growable<Row> heights_;
};

} // namespace acdf
