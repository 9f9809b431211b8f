#include "tables/sides.h"

#include <algorithm>
#include <cmath>

namespace acdf {

namespace {

using u32 = std::uint32_t;

} // namespace

// Tangent of the local azimuth between columns.
double Sides::tangent_of(u32 column, u32 columns) {
    const std::uint64_t eighths = 8 * std::uint64_t{column};
    const std::uint64_t quarter = (eighths + columns) / (2 * std::uint64_t{columns}); // from phi = pi down
    double sine, cosine;
    acdf_sincospi(0.5 * static_cast<double>(quarter) - 2.0 * column / columns, &sine, &cosine);
    return sine / cosine;
}

Sides::Row Sides::row_of(u32 row, u32 rows) {
    const bool south = 2 * std::uint64_t{row} > rows;
    const double s = acdf_sine(static_cast<double>(south ? rows - row : row) / rows * (0.5 * ACDF_PI));
    const double cap = 2.0 * s * s;
    return {acdf_row_z(row, rows), cap, kSideMargin * std::sqrt(cap * (2.0 - cap)) + kSideMargin * kSideMargin};
}

double Sides::height(const Cell& cell) const {
    if (!octahedral()) return row(cell.first[1]).z - row(cell.last[1]).z;
    const AcdfRange rows = {cell.first[1], cell.last[1], 0.0};
    return acdf_grid_height(&grid_, &rows);
}

bool Sides::remember(std::size_t most) {
    if (octahedral()) return true;
    if (columns_ <= most && tangents_.reserve(columns_ + 1))
        for (u32 i = 0; i <= columns_; ++i) tangents_.add(tangent_of(i, columns_));
    if (rows_ <= most && heights_.reserve(rows_ + 1))
        for (u32 i = 0; i <= rows_; ++i) heights_.add(row_of(i, rows_));
    return !(tangents_.failed() || heights_.failed());
}

// The margin is at least kSideMargin as an angle: ACDF_OCTAHEDRAL_LEAST_SPEED.
int Sides::square_side(const Cell& cell, int axis, Side& out) const {
    const double count = axis == 0 ? columns_ : rows_, sign = axis == 0 ? -2.0 : 2.0;
    const double ends[2] = {cell.first[axis] / count, cell.last[axis] / count};
    out = {};
    out.low = cell.low[axis];
    out.high = cell.high[axis];
    for (int i = 0; i < 2; ++i) {
        out.local[i] = sign * (ends[i] - 0.5);
        out.margin[i] = kSideMargin;
        out.key[i] = ends[i] * static_cast<double>(ACDF_SQUARE_STEPS);
    }
    out.beyond = out.key[1] + 1.0;
    return 1;
}

int Sides::azimuths(const Cell& cell, Side* out) const {
    if (octahedral()) return square_side(cell, 0, out[0]);
    static const struct {
        double end; // of the piece, as a part of the columns
        double middle;
        u32 quarter;
    } pieces[5] = {{0.125, 0.0, 2}, {0.375, 0.25, 1}, {0.625, 0.5, 0}, {0.875, 0.75, 3}, {1.0, 1.0, 2}};
    const u32 first = cell.first[0], last = cell.last[0];
    const double columns = columns_, low = first, high = last;
    const auto number = [&](double at) { // only where the cell is cut: divisions take long
        return cell.low[0] + (at - low) * ((cell.high[0] - cell.low[0]) / (high - low));
    };
    int count = 0, begin = 0;
    for (int i = 0; i < 4; ++i)
        begin += low >= pieces[i].end * columns; // without a branch: one piece as often as another
    for (double from = low; from < high;) {
        const auto& piece = pieces[begin + count];
        const double end = piece.end * columns, to = std::min(high, end);
        Side& side = out[count++];
        side.piece = piece.quarter;
        side.low = from == low ? cell.low[0] : number(from);
        side.high = to == high ? cell.high[0] : number(to);
        side.local[0] = 2.0 * ACDF_PI * (piece.middle - from / columns);
        side.local[1] = 2.0 * ACDF_PI * (piece.middle - to / columns);
        side.margin[0] = side.margin[1] = kSideMargin;
        const double tangents[2] = {to == end && piece.end < 1.0 ? -1.0 : tangent(last),
                                    from == low ? tangent(first) : 1.0};
        side.beyond = 2.0 * (piece.quarter + 1.0) * static_cast<double>(ACDF_SLOPE_STEPS);
        for (int i = 0; i < 2; ++i) {
            side.ends[i] = tangents[i];
            side.key[i] = (2.0 * piece.quarter + 1.0 + tangents[i]) * static_cast<double>(ACDF_SLOPE_STEPS);
        }
        from = to;
    }
    return count;
}

int Sides::heights(const Cell& cell, Side* out) const {
    if (octahedral()) return square_side(cell, 1, out[0]);
    const Row ends[2] = {row(cell.first[1]), row(cell.last[1])};
    const Row equator = {0.0, 1.0, kSideMargin};
    const auto equator_number = [&] {
        return cell.low[1] + ends[0].z * ((cell.high[1] - cell.low[1]) / (ends[0].z - ends[1].z));
    };
    int count = 0;
    for (u32 south = 0; south < 2; ++south) {
        if (south ? !(ends[1].z < 0.0) : !(ends[0].z > 0.0)) continue;
        const Row* const row[2] = {south && ends[0].z > 0.0 ? &equator : &ends[0],
                                   !south && ends[1].z < 0.0 ? &equator : &ends[1]};
        Side& side = out[count++];
        side.piece = south;
        side.beyond = static_cast<double>(kSouthKeys) + 1.0;
        side.low = row[0] == &equator ? equator_number() : cell.low[1];
        side.high = row[1] == &equator ? equator_number() : cell.high[1];
        for (int i = 0; i < 2; ++i) {
            side.local[i] = row[i]->cap;
            side.margin[i] = row[i]->margin;
            const double key = row[i]->cap * static_cast<double>(ACDF_CAP_STEPS);
            side.key[i] = south ? static_cast<double>(kSouthKeys) - key : key;
            side.ends[i ^ static_cast<int>(south)] = row[i]->cap;
        }
    }
    return count;
}

float Sides::density(const Cell& cell) const {
    if (cell.dark) return 0.0f;
    return acdf_cell_pdf(acdf_positive(cell.probability), cell.last[0] - cell.first[0], columns_, height(cell),
                         1.0);
}

} // namespace acdf
