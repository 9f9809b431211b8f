// Cells of trees as parts of the eight pieces of the sphere, or as boxes of the octahedral square (acdf/cells.h).
#pragma once

#include "tables/growable.h"

#include <acdf/cells.h>
#include <acdf/grid.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A cell as the walk of a tree finds it.
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

/// A segment of a curve as it is stored.
struct CellSegment {
    std::uint32_t from, to;    ///< cumulative values
    std::uint32_t first, last; ///< positions
};

/// The segments of a curve in the cell `above` that it divides, one after the other. What is the same for all is
/// kept by value: it is not to be read again after each store.
class CellParts {
public:
    CellParts(const AcdfCurve& curve, const Cell& above)
        : curve_(curve), axis_(acdf_curve_axis(&curve)), cumulative_code_(ACDF_CURVE_CUMULATIVE_CODE(curve.header)),
          position_code_(ACDF_CURVE_POSITION_CODE(curve.header)), maximum_(acdf_curve_maximum(&curve)),
          all_(maximum_), low_(above.low[axis_]), high_(above.high[axis_]), width_(high_ - low_),
          end_(above.last[axis_]),
          origin_(position_code_ == 0 ? above.first[axis_] : 0), border_{0, above.first[axis_]} {}
    std::uint32_t axis() const { return axis_; }
    /// The distance to the child of the next segment; 0: it ends.
    std::uint32_t link() const { return acdf_curve_link(&curve_, next_); }
    CellSegment segment() {
        const Border from = border_;
        ++next_;
        border_ = next_ < curve_.segments ? border(next_) : Border{maximum_, end_};
        return {from.cumulative, border_.cumulative, from.position, border_.position};
    }
    /// Random numbers of a segment.
    double low(const CellSegment& segment) const { return low_ + width_ * (segment.from / all_); }
    double high(const CellSegment& segment) const { return high(segment, segment.to / all_); }
    /// All of the next segment. Only where each of those before was asked for so: one division less.
    CellPart next() {
        const std::uint32_t i = next_;
        const double from = from_;
        const CellSegment segment = this->segment();
        from_ = segment.to / all_;
        return {static_cast<double>(segment.to - segment.from) / all_,
                low_ + width_ * from,
                high(segment, from_),
                segment.first,
                segment.last,
                segment.to == segment.from,
                curve_.tilts && reinterpret_cast<const std::int16_t*>(curve_.tilts)[i] != 0};
    }
    /// What a segment leaves of the cell, where nothing is tilted.
    Cell cell(const Cell& above, const CellSegment& segment) const {
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
    struct Border {
        std::uint32_t cumulative, position;
    };
    double high(const CellSegment& segment, double part) const {
        return segment.to != maximum_ ? low_ + width_ * part : high_;
    }
    Border border(std::uint32_t i) const {
        return {acdf_load(curve_.cumulative, i - 1, cumulative_code_),
                origin_ + acdf_load(curve_.positions, i - 1, position_code_)};
    }

    AcdfCurve curve_;
    std::uint32_t axis_, cumulative_code_, position_code_, maximum_;
    double all_; ///< the maximum
    std::uint32_t next_ = 0;
    double low_, high_, width_;
    std::uint32_t end_, origin_;
    Border border_;
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
    double key[2];       ///< of acdf_direction_place: the lesser, and the greater
    double beyond;       ///< the first key behind its piece; that of a quarter is the next one's
    double ends[2];      ///< tangents of azimuth or 1 - |z|: the lesser, and the greater; not on the square

    std::uint32_t first_key() const { return static_cast<std::uint32_t>(key[0]); }
    /// In another quarter local azimuths are others: it is not to be looked for there.
    std::uint32_t last_key() const { return static_cast<std::uint32_t>(key[1] < beyond ? key[1] : beyond - 1.0); }
};

/// A draw stays this angle (radians) inside its piece: four times ACDF_BORDER, for what floats round.
constexpr double kSideMargin = 0x1p-20;
/// A draw stays this part of its numbers inside its piece: more than a float rounds.
constexpr double kPiecePart = 0x1p-21;
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
    /// Density of a cell without tilts, sr^-1; 0 for a dark one.
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
