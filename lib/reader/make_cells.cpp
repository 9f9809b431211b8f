// Cuts the cells of a tree into pieces of the sphere (acdf/cells.h) and writes down what each needs.
#include "make_cells.h"

#include "make_squares.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kNumberBits = 31;
constexpr double kNumberSteps = 0x1p31;
constexpr std::size_t kMostPieces = 65535;
// A draw stays this angle (radians) inside its piece: four times ACDF_BORDER, for what floats round.
constexpr double kMargin = 0x1p-20;
// And this part of its numbers: more than a float rounds.
constexpr double kPart = 0x1p-21;
constexpr u32 kSouthKeys = (1u << ACDF_DIRECTION_BITS) - 1;

/// A cell as the walk of the tree finds it.
struct Cell {
    double probability;
    double low[2], high[2]; ///< random numbers
    u32 first[2], last[2];  ///< positions
    bool dark;
};

/// What the trigonometry of a border between rows gives.
struct Row {
    double z, cap; ///< cosine, 1 - |cosine|
    double margin; ///< kMargin, as a difference of z
};

/// The part of a cell's side that lies in one piece of the sphere: from low to high random numbers.
struct Side {
    u32 piece;        ///< quarter, or whether it is south
    double low, high; ///< random numbers
    double local[2];  ///< at low and high: local azimuth, or 1 - |z|
    double margin[2]; ///< of `local`
    double key[2];    ///< the lesser, and the greater
};

class CellsMaker {
public:
    CellsMaker(const AcdfEnvironment& environment, u32 tree_units)
        : environment_(environment), most_steps_(2 * std::size_t{tree_units} + 64) {}

    /// False where there can be no tables.
    bool gather();
    AcdfCells* assemble(std::size_t most_bytes);

private:
    bool walk(u32 at, const Cell& above);
    void add(const Cell& cell);
    void add_piece(const Side& azimuth, const Side& height, float pdf);
    int azimuths(const Cell& cell, Side* out) const;
    int heights(const Cell& cell, Side* out) const;
    bool remember();
    double tangent(u32 column) const;
    Row row(u32 row) const;

    AcdfEnvironment environment_;
    Growable<double> tangents_; ///< of each column, and of each row what follows, if there are not too many of them
    Growable<Row> rows_;
    std::size_t most_steps_, steps_ = 0;
    Growable<AcdfPiece> pieces_;
    Growable<float> densities_;
    Growable<KeyBox> numbers_, keys_;
};

bool CellsMaker::gather() {
    const Cell whole = {1.0, {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows}, false};
    const bool done = remember() && walk(environment_.root, whole) && pieces_.size() <= kMostPieces;
    return done && !(pieces_.failed() || densities_.failed() || numbers_.failed() || keys_.failed());
}

// As acdf_tree_sample, through all segments. A path passes at most 64 curves.
bool CellsMaker::walk(u32 at, const Cell& above) {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    const u32 axis = acdf_curve_axis(&curve), end = acdf_curve_maximum(&curve);
    const double maximum = end, width = above.high[axis] - above.low[axis];
    if (curve.tilts) return false;
    u32 low = 0;
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 high = acdf_curve_cumulative(&curve, i + 1);
        if (++steps_ > most_steps_ || pieces_.size() > kMostPieces) return false;
        Cell cell = above;
        cell.dark = high == low;
        cell.probability *= static_cast<double>(high - low) / maximum;
        cell.low[axis] = above.low[axis] + width * (low / maximum);
        if (high != end) cell.high[axis] = above.low[axis] + width * (high / maximum);
        AcdfRange range = {above.first[axis], above.last[axis], 0.0};
        acdf_curve_narrow(&curve, i, &range);
        cell.first[axis] = range.low;
        cell.last[axis] = range.high;
        const u32 link = acdf_curve_link(&curve, i);
        if (link == 0) add(cell);
        else if (!walk(at + link, cell)) return false;
        low = high;
    }
    return true;
}

// Tangent of the local azimuth between columns.
double tangent_of(u32 column, u32 columns) {
    const std::uint64_t eighths = 8 * std::uint64_t{column};
    const std::uint64_t quarter = (eighths + columns) / (2 * std::uint64_t{columns}); // from phi = pi down
    double sine, cosine;
    acdf_sincospi(0.5 * static_cast<double>(quarter) - 2.0 * column / columns, &sine, &cosine);
    return sine / cosine;
}
double CellsMaker::tangent(u32 column) const {
    return column < tangents_.size() ? tangents_[column] : tangent_of(column, environment_.columns);
}

Row row_of(u32 row, u32 rows) {
    const bool south = 2 * std::uint64_t{row} > rows;
    const double s = acdf_sine(static_cast<double>(south ? rows - row : row) / rows * (0.5 * ACDF_PI));
    const double cap = 2.0 * s * s;
    return {acdf_row_z(row, rows), cap, kMargin * std::sqrt(cap * (2.0 - cap)) + kMargin * kMargin};
}
Row CellsMaker::row(u32 row) const { return row < rows_.size() ? rows_[row] : row_of(row, environment_.rows); }

// Each column and row once, unless they are more than the tree can use.
bool CellsMaker::remember() {
    const u32 columns = environment_.columns, rows = environment_.rows;
    if (columns <= most_steps_ && tangents_.reserve(columns + 1))
        for (u32 i = 0; i <= columns; ++i) tangents_.add(tangent_of(i, columns));
    if (rows <= most_steps_ && rows_.reserve(rows + 1))
        for (u32 i = 0; i <= rows; ++i) rows_.add(row_of(i, rows));
    return !(tangents_.failed() || rows_.failed());
}

int CellsMaker::azimuths(const Cell& cell, Side* out) const {
    static const struct {
        double end; // of the piece, as a part of the columns
        double middle;
        u32 quarter;
    } pieces[5] = {{0.125, 0.0, 2}, {0.375, 0.25, 1}, {0.625, 0.5, 0}, {0.875, 0.75, 3}, {1.0, 1.0, 2}};
    const u32 first = cell.first[0], last = cell.last[0];
    const double columns = environment_.columns, low = first, high = last;
    const double number = (cell.high[0] - cell.low[0]) / (high - low); // of a column
    double from = low;
    int count = 0;
    for (const auto& piece : pieces) {
        const double end = piece.end * columns, to = std::min(high, end);
        if (!(from < to)) continue;
        Side& side = out[count++];
        side.piece = piece.quarter;
        side.low = cell.low[0] + (from - low) * number;
        side.high = to == high ? cell.high[0] : cell.low[0] + (to - low) * number;
        side.local[0] = 2.0 * ACDF_PI * (piece.middle - from / columns);
        side.local[1] = 2.0 * ACDF_PI * (piece.middle - to / columns);
        side.margin[0] = side.margin[1] = kMargin;
        const double tangents[2] = {to == end && piece.end < 1.0 ? -1.0 : tangent(last),
                                    from == low ? tangent(first) : 1.0};
        for (int i = 0; i < 2; ++i)
            side.key[i] = (2.0 * piece.quarter + 1.0 + tangents[i]) * static_cast<double>(ACDF_SLOPE_STEPS);
        from = to;
    }
    return count;
}

int CellsMaker::heights(const Cell& cell, Side* out) const {
    const Row ends[2] = {row(cell.first[1]), row(cell.last[1])};
    const Row equator = {0.0, 1.0, kMargin};
    const double number = (cell.high[1] - cell.low[1]) / (ends[0].z - ends[1].z); // of z
    int count = 0;
    for (u32 south = 0; south < 2; ++south) {
        if (south ? !(ends[1].z < 0.0) : !(ends[0].z > 0.0)) continue;
        const Row* const row[2] = {south && ends[0].z > 0.0 ? &equator : &ends[0],
                                   !south && ends[1].z < 0.0 ? &equator : &ends[1]};
        Side& side = out[count++];
        side.piece = south;
        side.low = row[0] == &equator ? cell.low[1] + ends[0].z * number : cell.low[1];
        side.high = row[1] == &equator ? cell.low[1] + ends[0].z * number : cell.high[1];
        for (int i = 0; i < 2; ++i) {
            side.local[i] = row[i]->cap;
            side.margin[i] = row[i]->margin;
            const double key = row[i]->cap * static_cast<double>(ACDF_CAP_STEPS);
            side.key[i] = south ? static_cast<double>(kSouthKeys) - key : key;
        }
    }
    return count;
}

void CellsMaker::add(const Cell& cell) {
    float pdf = 0.0f;
    if (!cell.dark) {
        const double dz = row(cell.first[1]).z - row(cell.last[1]).z;
        pdf = acdf_cell_pdf(acdf_positive(cell.probability), cell.last[0] - cell.first[0], environment_.columns, dz,
                            1.0);
    }
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = azimuths(cell, columns), row_count = heights(cell, rows);
    for (int r = 0; r < row_count; ++r)
        for (int c = 0; c < column_count; ++c) add_piece(columns[c], rows[r], pdf);
}

/// `bits` are put in place of the lowest ones.
float tagged(float x, u32 mask, u32 bits) { return acdf_bits_float((acdf_float_bits(x) & ~mask) | bits); }

// The steps of random numbers that surely lead into a side; none where first >= last.
struct Steps {
    std::int64_t first, last;
};
Steps steps_within(const Side& side) {
    const double width = side.high - side.low, number = width / std::fabs(side.local[1] - side.local[0]);
    return {
        static_cast<std::int64_t>((side.low + std::max(side.margin[0] * number, kPart * width)) * kNumberSteps) + 2,
        static_cast<std::int64_t>((side.high - std::max(side.margin[1] * number, kPart * width)) * kNumberSteps) -
            1};
}

// An axis whose numbers lead to it; where it is `down`, they are counted from the upper end.
AcdfPieceAxis drawn_axis(const Side& side, const Steps& steps, bool down) {
    const double slope = (side.local[1] - side.local[0]) / (side.high - side.low);
    const std::int64_t from = down ? steps.last : steps.first;
    const double beyond = static_cast<double>(from) / kNumberSteps - (down ? side.high : side.low);
    return {static_cast<u32>(from), static_cast<float>(steps.last - steps.first) * 0x1p21f,
            static_cast<float>(side.local[down] + beyond * slope), static_cast<float>(slope * 0x1p-52)};
}

// An axis that no numbers lead to: all within its margins. Width 1 or, where there is nothing, 0.
AcdfPieceAxis dark_axis(const Side& side, bool down) {
    const double sign = side.local[1] > side.local[0] ? 1.0 : -1.0;
    const double from = side.local[0] + sign * side.margin[0], to = side.local[1] - sign * side.margin[1];
    const bool any = sign * (to - from) > 0.0;
    return {0, any ? 1.0f : 0.0f, static_cast<float>(down ? to : from), static_cast<float>(to - from)};
}

void CellsMaker::add_piece(const Side& azimuth, const Side& height, float pdf) {
    const Side* const sides[2] = {&azimuth, &height};
    AcdfPieceAxis axes[2];
    KeyBox number, key;
    bool any[2];
    for (int axis = 0; axis < 2; ++axis) {
        const Side& side = *sides[axis];
        const bool down = axis == 1 && side.piece == 1; // heights are precise at the pole
        const Steps steps = steps_within(side);
        const bool drawn = pdf > 0.0f && steps.first < steps.last;
        axes[axis] = drawn ? drawn_axis(side, steps, down) : dark_axis(side, down);
        any[axis] = axes[axis].width > 0.0f;
        axes[axis].width = tagged(axes[axis].width, axis == 0 ? 3u : 1u, side.piece);
        number.low[axis] = drawn ? static_cast<u32>(steps.first) : 1;
        number.high[axis] = drawn ? static_cast<u32>(steps.last) : 0;
        key.low[axis] = static_cast<u32>(side.key[0]);
        key.high[axis] = static_cast<u32>(side.key[1]);
    }
    if (!(any[0] && any[1])) key = {{1, 1}, {0, 0}};
    pieces_.add({axes[0], axes[1]});
    densities_.add(pdf);
    numbers_.add(number);
    keys_.add(key);
}

std::size_t padded(std::size_t words) { return (words + 15) & ~std::size_t{15}; }

AcdfCells* CellsMaker::assemble(std::size_t most_bytes) {
    const std::size_t count = pieces_.size();
    SquaresMaker numbers, directions;
    if (!numbers.make(numbers_.data(), count, kNumberBits) ||
        !directions.make(keys_.data(), count, ACDF_DIRECTION_BITS))
        return nullptr;
    std::size_t words = padded(sizeof(AcdfCells) / 4) + numbers.words() + directions.words();
    words += padded(pieces_.bytes() / 4) + padded(densities_.bytes() / 4);
    void* const block = 4 * words <= most_bytes ? std::aligned_alloc(ACDF_ALIGNMENT, 4 * words) : nullptr;
    if (!block) return nullptr;
    u32* const tables = static_cast<u32*>(std::memset(block, 0, 4 * words));
    AcdfCells* const cells = new (block) AcdfCells();
    std::size_t at = padded(sizeof(AcdfCells) / 4);
    const auto copy = [&](const auto& from) {
        const std::size_t begin = at;
        std::memcpy(tables + at, from.data(), from.bytes());
        at = padded(at + from.bytes() / 4);
        return static_cast<u32>(begin);
    };
    cells->words = static_cast<u32>(words);
    cells->count = static_cast<u32>(count);
    cells->pieces = copy(pieces_);
    cells->densities = copy(densities_);
    at = numbers.place(tables, at, cells->numbers);
    directions.place(tables, at, cells->directions);
    return cells;
}

} // namespace

AcdfCells* make_cells(const AcdfEnvironment& environment, u32 tree_units, std::size_t most_bytes) noexcept {
    CellsMaker maker(environment, tree_units);
    return maker.gather() ? maker.assemble(most_bytes) : nullptr;
}

} // namespace acdf
