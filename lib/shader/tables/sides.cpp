#include "shader/tables/sides.h"

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

bool Sides::remember(std::size_t most) {
    if (columns_ <= most && tangents_.reserve(columns_ + 1))
        for (u32 i = 0; i <= columns_; ++i) tangents_.add(tangent_of(i, columns_));
    if (rows_ <= most && heights_.reserve(rows_ + 1))
        for (u32 i = 0; i <= rows_; ++i) heights_.add(row_of(i, rows_));
    return !(tangents_.failed() || heights_.failed());
}

int Sides::azimuths(const Cell& cell, Side* out) const {
    static const struct {
        double end; // of the piece, as a part of the columns
        double middle;
        u32 quarter;
    } pieces[5] = {{0.125, 0.0, 2}, {0.375, 0.25, 1}, {0.625, 0.5, 0}, {0.875, 0.75, 3}, {1.0, 1.0, 2}};
    const u32 first = cell.first[0];
    const double columns = columns_, low = first, high = cell.last[0];
    int count = 0, begin = 0;
    for (int i = 0; i < 4; ++i)
        begin += low >= pieces[i].end * columns; // without a branch: one piece as often as another
    for (double from = low; from < high;) {
        const auto& piece = pieces[begin + count];
        const double end = piece.end * columns, to = std::min(high, end);
        Side& side = out[count++];
        side.piece = piece.quarter;
        side.low = (from - low) / (high - low);
        side.high = (to - low) / (high - low);
        side.local[0] = 2.0 * ACDF_PI * (piece.middle - from / columns);
        side.local[1] = 2.0 * ACDF_PI * (piece.middle - to / columns);
        side.margin[0] = side.margin[1] = kSideMargin;
        const double most = from == low ? tangent(first) : 1.0;
        side.key = (2.0 * piece.quarter + 1.0 + most) * static_cast<double>(ACDF_SLOPE_STEPS);
        from = to;
    }
    return count;
}

int Sides::heights(const Cell& cell, Side* out) const {
    const Row ends[2] = {row(cell.first[1]), row(cell.last[1])};
    const Row equator = {0.0, 1.0, kSideMargin};
    const double to_equator = ends[0].z / (ends[0].z - ends[1].z);
    int count = 0;
    for (u32 south = 0; south < 2; ++south) {
        if (south ? !(ends[1].z < 0.0) : !(ends[0].z > 0.0)) continue;
        const Row* const row[2] = {south && ends[0].z > 0.0 ? &equator : &ends[0],
                                   !south && ends[1].z < 0.0 ? &equator : &ends[1]};
        Side& side = out[count++];
        side.piece = south;
        side.low = row[0] == &equator ? to_equator : 0.0;
        side.high = row[1] == &equator ? to_equator : 1.0;
        for (int i = 0; i < 2; ++i) {
            side.local[i] = row[i]->cap;
            side.margin[i] = row[i]->margin;
        }
    }
    return count;
}

float Sides::density(const Cell& cell) const {
    if (cell.dark) return 0.0f;
    const double height = row(cell.first[1]).z - row(cell.last[1]).z;
    return acdf_cell_pdf(acdf_positive(cell.probability), cell.last[0] - cell.first[0], columns_, height);
}

} // namespace acdf
