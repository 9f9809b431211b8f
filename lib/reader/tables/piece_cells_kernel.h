// What tables say of the pieces of sixteen cells, as Sides and CellsMaker tell it of one. Internal linkage: see
// cell_lanes_kernel.h.
#pragma once

#include "tables/cell_lanes_kernel.h"
#include "tables/piece_cells.h"

#include <cmath>

namespace {

/// An axis of cells: what acdf::Side tells, and what tables say of it.
struct PieceAxisLanes {
    alignas(64) double low[kCellLanes], high[kCellLanes]; // numbers
    double local[2][kCellLanes], margin[2][kCellLanes], key[2][kCellLanes], beyond[kCellLanes];
    double piece[kCellLanes], south[kCellLanes] = {}; // 0 or 1, as all that selects doubles: masks are as wide
    double begin[kCellLanes], width[kCellLanes];      // of an AcdfPieceAxis
    double numbers[2][kCellLanes];
    // As of an AcdfPieceAxis, and the keys.
    alignas(64) std::uint32_t low_number[kCellLanes], width_bits[kCellLanes];
    float widths[kCellLanes], origin[kCellLanes], slope[kCellLanes];
    std::uint32_t number_words[2][kCellLanes], key_words[2][kCellLanes];
};

/// Of the borders of lanes.
struct PieceBorders {
    alignas(64) double tangent[2][kCellLanes] = {}; // of columns
    double z[2][kCellLanes] = {}, cap[2][kCellLanes] = {}, margin[2][kCellLanes] = {};
    double height[kCellLanes] = {};
    double cut[kCellLanes] = {}; // whether a cell lies in several pieces
};

struct PieceGrid {
    double steps[2]; // columns and rows
    double ends[4];  // of the pieces of azimuth, in columns
    bool square;
};

static inline void find_borders(const acdf::PieceCells& of, const CellLanes& in, PieceBorders& out) {
    for (int i = 0; i < in.count; ++i) {
        out.tangent[0][i] = of.tangents[in.last[0][i]];
        out.tangent[1][i] = of.tangents[in.first[0][i]];
        const acdf::Sides::Row &first = of.rows[in.first[1][i]], &last = of.rows[in.last[1][i]];
        out.z[0][i] = first.z;
        out.z[1][i] = last.z;
        out.cap[0][i] = first.cap;
        out.cap[1][i] = last.cap;
        out.margin[0][i] = first.margin;
        out.margin[1][i] = last.margin;
        out.height[i] = first.z - last.z;
    }
}

// As Sides::azimuths, of a cell in one quarter.
static inline void set_azimuths(const PieceGrid& grid, const CellLanes& in, PieceBorders& borders,
                                PieceAxisLanes& out) {
    const double columns = grid.steps[0], *const ends = grid.ends;
    for (int i = 0; i < kCellLanes; ++i) {
        const double low = static_cast<std::int32_t>(in.first[0][i]),
                     high = static_cast<std::int32_t>(in.last[0][i]);
        const double part = (low >= ends[0] ? 0.25 : 0.0) + (low >= ends[1] ? 0.25 : 0.0) +
                            (low >= ends[2] ? 0.25 : 0.0) + (low >= ends[3] ? 0.25 : 0.0);
        const double quarter = part < 0.75 ? 2.0 - 4.0 * part : 6.0 - 4.0 * part;
        const double last = part < 1.0 ? (0.125 + part) * columns : columns;
        const double slope = part < 1.0 ? -1.0 : borders.tangent[0][i];
        borders.cut[i] = high > last ? 1.0 : 0.0;
        out.piece[i] = quarter;
        out.local[0][i] = 2.0 * ACDF_PI * (part - low / columns);
        out.local[1][i] = 2.0 * ACDF_PI * (part - high / columns);
        out.margin[0][i] = out.margin[1][i] = acdf::kSideMargin;
        out.beyond[i] = 2.0 * (quarter + 1.0) * static_cast<double>(ACDF_SLOPE_STEPS);
        const double tangent = high == last ? slope : borders.tangent[0][i];
        out.key[0][i] = (2.0 * quarter + 1.0 + tangent) * static_cast<double>(ACDF_SLOPE_STEPS);
        out.key[1][i] = (2.0 * quarter + 1.0 + borders.tangent[1][i]) * static_cast<double>(ACDF_SLOPE_STEPS);
    }
}

// As Sides::heights, of a cell in one hemisphere.
static inline void set_piece_heights(PieceBorders& borders, PieceAxisLanes& out) {
    const double most = static_cast<double>(acdf::kSouthKeys);
    for (int i = 0; i < kCellLanes; ++i) {
        const double south = borders.z[0][i] > 0.0 ? 0.0 : 1.0, ends = borders.z[1][i] < 0.0 ? 1.0 : 0.0;
        borders.cut[i] += (1.0 - south) * ends;
        out.piece[i] = out.south[i] = south;
        out.beyond[i] = most + 1.0;
        for (int end = 0; end < 2; ++end) {
            const double key = borders.cap[end][i] * static_cast<double>(ACDF_CAP_STEPS);
            out.local[end][i] = borders.cap[end][i];
            out.margin[end][i] = borders.margin[end][i];
            out.key[end][i] = south > 0.0 ? most - key : key;
        }
    }
}

// As Sides::square_side.
static inline void set_square_sides(double count, double sign, const std::uint32_t* first,
                                    const std::uint32_t* last, PieceAxisLanes& out) {
    const auto set = [&](int end, int i, std::uint32_t position) {
        const double part = static_cast<std::int32_t>(position) / count;
        out.local[end][i] = sign * (part - 0.5);
        out.margin[end][i] = acdf::kSideMargin;
        out.key[end][i] = part * static_cast<double>(ACDF_SQUARE_STEPS);
    };
    for (int i = 0; i < kCellLanes; ++i) {
        set(0, i, first[i]);
        set(1, i, last[i]);
        out.beyond[i] = out.key[1][i] + 1.0;
        out.piece[i] = 0.0;
    }
}

// x rounded down to a whole number; of what is not within 0 and 2^33 no cell is drawn, whatever it becomes.
static inline double whole_steps(double x) {
#if defined(__AVX2__)
    return std::floor(x);
#else // vectors convert to no more bits than 32
    const double positive = x > 0.0 ? x : 0.0, within = positive < 0x1p33 ? positive : 0x1p33;
    const double high = static_cast<std::int32_t>(within * 0x1p-16);
    return high * 0x1p16 + static_cast<std::int32_t>(within - high * 0x1p16);
#endif
}

// As steps_within, drawn_axis and dark_axis of cells.cpp.
static inline void reckon_axis(const CellLanes& in, PieceAxisLanes& axis) {
    for (int i = 0; i < kCellLanes; ++i) {
        const double from = axis.local[0][i], to = axis.local[1][i], width = axis.high[i] - axis.low[i];
        const double number = width / std::fabs(to - from), least = acdf::kPiecePart * width;
        const double margins[2] = {axis.margin[0][i] * number, axis.margin[1][i] * number};
        const double first = whole_steps((axis.low[i] + (margins[0] < least ? least : margins[0])) * 0x1p31) + 2.0;
        const double last = whole_steps((axis.high[i] - (margins[1] < least ? least : margins[1])) * 0x1p31) - 1.0;
        const bool down = axis.south[i] > 0.0;
        const double steps = in.from[i] < in.to[i] ? last - first : 0.0;
        const bool drawn = steps > 0.0;
        const double begin = down ? last : first, end = down ? axis.high[i] : axis.low[i];
        const double slope = (to - from) / width, origin = (down ? to : from) + (begin * 0x1p-31 - end) * slope;
        const double sign = to > from ? 1.0 : -1.0;
        const double inner = from + sign * axis.margin[0][i], outer = to - sign * axis.margin[1][i];
        const double dark_width = sign * (outer - inner) > 0.0 ? 1.0 : 0.0, dark_origin = down ? outer : inner;
        axis.begin[i] = drawn ? begin : 0.0;
        axis.width[i] = drawn ? steps * 0x1p21 : dark_width;
        axis.origin[i] = static_cast<float>(drawn ? origin : dark_origin);
        axis.slope[i] = static_cast<float>(drawn ? slope * 0x1p-52 : outer - inner);
        axis.numbers[0][i] = drawn ? first : 1.0;
        axis.numbers[1][i] = drawn ? last : 0.0;
    }
}

// Of what is more than -1 and, where a cell is, less than 2^31.
static inline std::uint32_t word_of(double x) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x < 0x1p31 - 1.0 ? x : 0x1p31 - 1.0));
}

static inline void round_axis(std::uint32_t pieces, PieceAxisLanes& axis) {
    for (int i = 0; i < kCellLanes; ++i) {
        const double last = axis.key[1][i] < axis.beyond[i] ? axis.key[1][i] : axis.beyond[i] - 1.0;
        axis.key_words[0][i] = word_of(axis.width[i] > 0.0 ? axis.key[0][i] : 1.0);
        axis.key_words[1][i] = word_of(axis.width[i] > 0.0 ? last : 0.0);
        axis.number_words[0][i] = word_of(axis.numbers[0][i]);
        axis.number_words[1][i] = word_of(axis.numbers[1][i]);
        axis.low_number[i] = word_of(axis.begin[i]);
        axis.widths[i] = static_cast<float>(axis.width[i]);
    }
    std::memcpy(axis.width_bits, axis.widths, sizeof axis.widths);
    for (int i = 0; i < kCellLanes; ++i)
        axis.width_bits[i] = (axis.width_bits[i] & ~pieces) | word_of(axis.piece[i]);
}

// An axis of the pieces from `out` on.
static inline void put_axis(const PieceAxisLanes& axis, AcdfPieceAxis* out) {
#ifdef ACDF_SSE2
    for (int i = 0; i < kCellLanes; i += 4) {
        const __m128i low = four_words(axis.low_number + i), width = four_words(axis.width_bits + i),
                      origin = four_words(axis.origin + i), slope = four_words(axis.slope + i);
        const __m128i a[2] = {_mm_unpacklo_epi32(low, width), _mm_unpackhi_epi32(low, width)};
        const __m128i b[2] = {_mm_unpacklo_epi32(origin, slope), _mm_unpackhi_epi32(origin, slope)};
        for (int k = 0; k < 2; ++k) {
            auto* const to = reinterpret_cast<__m128i*>(out + 2 * (i + 2 * k));
            _mm_storeu_si128(to, _mm_unpacklo_epi64(a[k], b[k]));
            _mm_storeu_si128(to + 2, _mm_unpackhi_epi64(a[k], b[k]));
        }
    }
#else
    for (int i = 0; i < kCellLanes; ++i) {
        float width;
        std::memcpy(&width, axis.width_bits + i, sizeof width);
        out[2 * i] = {axis.low_number[i], width, axis.origin[i], axis.slope[i]};
    }
#endif
}

static inline void put_spans(const std::uint32_t spans[2][kCellLanes], acdf::KeySpan* out) {
    for (int i = 0; i < kCellLanes; ++i) out[i] = {spans[0][i], spans[1][i]};
}

class PieceCellsWriter {
public:
    explicit PieceCellsWriter(const acdf::PieceCells& of)
        : of_(of),
          gatherer_(of.environment, *this), grid_{{static_cast<double>(of.environment.columns),
                                                   static_cast<double>(of.environment.rows)},
                                                  {0.125 * of.environment.columns, 0.375 * of.environment.columns,
                                                   0.625 * of.environment.columns, 0.875 * of.environment.columns},
                                                  of.environment.parameterization == ACDF_PARAM_OCTAHEDRAL} {}

    bool write() {
        const acdf::Cell whole = {
            1.0, {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {of_.environment.columns, of_.environment.rows}, false, false};
        const AcdfCurve root = acdf_curve_at(of_.environment.tree, of_.environment.root);
        gatherer_.gather(0, of_.environment.root, root, whole, 0, root.segments);
        gatherer_.put_blocks();
        return room_;
    }

    void put(const CellLanes& lanes) {
        acdf::PieceRows rows;
        room_ = room_ && of_.sink.room(of_.sink.maker, rows);
        if (!room_) return;
        double cut = 0.0;
        reckon(lanes);
        for (int i = 0; i < lanes.count; ++i) cut += borders_.cut[i];
        if (cut > 0.0) return put_one_by_one(lanes, rows);
        put_all(lanes, rows);
        of_.sink.keep(of_.sink.maker, static_cast<std::size_t>(lanes.count));
    }

private:
    void reckon(const CellLanes& lanes) {
        narrow_lanes(lanes, axes_);
        if (grid_.square) {
            for (int axis = 0; axis < 2; ++axis)
                set_square_sides(grid_.steps[axis], axis == 0 ? -2.0 : 2.0, lanes.first[axis], lanes.last[axis],
                                 axes_[axis]);
            for (int i = 0; i < kCellLanes; ++i)
                borders_.height[i] = 2.0 * steps_of(lanes, 1, i) / grid_.steps[1]; // acdf_grid_height
        } else {
            find_borders(of_, lanes, borders_);
            set_azimuths(grid_, lanes, borders_, axes_[0]);
            set_piece_heights(borders_, axes_[1]);
        }
        for (int axis = 0; axis < 2; ++axis) {
            reckon_axis(lanes, axes_[axis]);
            round_axis(axis == 0 ? 3 : 1, axes_[axis]);
        }
    }

    void put_all(const CellLanes& lanes, const acdf::PieceRows& rows) const {
        put_axis(axes_[0], &rows.pieces->azimuth);
        put_axis(axes_[1], &rows.pieces->height);
        for (int axis = 0; axis < 2; ++axis) {
            put_spans(axes_[axis].number_words, rows.numbers[axis]);
            put_spans(axes_[axis].key_words, rows.keys[axis]);
        }
        set_densities(grid_.steps[0], lanes, borders_.height, rows.densities);
    }

    // Cells that are cut have more pieces than one, and those behind them follow.
    void put_one_by_one(const CellLanes& lanes, acdf::PieceRows& rows) {
        AcdfPiece pieces[kCellLanes];
        float densities[kCellLanes];
        acdf::KeySpan numbers[2][kCellLanes], keys[2][kCellLanes];
        put_all(lanes, {pieces, densities, {numbers[0], numbers[1]}, {keys[0], keys[1]}});
        for (int i = 0; i < lanes.count && room_; ++i) {
            if (borders_.cut[i] > 0.0) {
                room_ = of_.sink.add_cut(of_.sink.maker, cell(lanes, i));
                continue;
            }
            room_ = of_.sink.room(of_.sink.maker, rows);
            if (!room_) return;
            *rows.pieces = pieces[i];
            *rows.densities = densities[i];
            for (int axis = 0; axis < 2; ++axis) {
                *rows.numbers[axis] = numbers[axis][i];
                *rows.keys[axis] = keys[axis][i];
            }
            of_.sink.keep(of_.sink.maker, 1);
        }
    }

    acdf::Cell cell(const CellLanes& lanes, int i) const {
        return {lanes.probability[i] * ((lanes.to[i] - lanes.from[i]) / lanes.all[i]),
                {axes_[0].low[i], axes_[1].low[i]},
                {axes_[0].high[i], axes_[1].high[i]},
                {lanes.first[0][i], lanes.first[1][i]},
                {lanes.last[0][i], lanes.last[1][i]},
                lanes.from[i] == lanes.to[i],
                false};
    }

    const acdf::PieceCells& of_;
    LaneGatherer<PieceCellsWriter> gatherer_;
    const PieceGrid grid_;
    PieceAxisLanes axes_[2];
    PieceBorders borders_;
    bool room_ = true;
};

} // namespace
