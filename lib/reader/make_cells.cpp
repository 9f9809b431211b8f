// Writes down what each piece of a cell needs (acdf/cells.h).
#include "make_cells.h"

#include "make_sides.h"
#include "make_squares.h"
#include "memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kNumberBits = 31;
constexpr double kNumberSteps = 0x1p31;
constexpr std::size_t kLeastBytes = 84;          // a cell, with its part of both grids
constexpr std::size_t kLeastDirectionBytes = 16; // of them, of the grid of directions
// A draw stays this part of its numbers inside its piece: more than a float rounds.
constexpr double kPart = 0x1p-21;
// Tables for shaders may be made for minutes: no part of them may be missing.
constexpr std::size_t kWholeWork = std::size_t{1} << 14;

class CellsMaker {
public:
    /// total: tables that answer always.
    CellsMaker(const AcdfEnvironment& environment, u32 tree_units, bool total)
        : environment_(environment), sides_(acdf_environment_grid(&environment)),
          most_steps_(2 * std::size_t{tree_units} + 64), total_(total) {}

    /// False where there can be no tables, or none of at most so many bytes.
    bool gather(std::size_t most_bytes);
    AcdfCells* assemble(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block);

private:
    bool count(u32 at);
    bool add(const Cell& cell);
    void add_piece(const Side& azimuth, const Side& height, float pdf);
    void add_whole_piece(const Side& azimuth, const Side& height, float pdf);

    AcdfEnvironment environment_;
    Sides sides_;
    std::size_t most_steps_, steps_ = 0, cells_ = 0;
    bool total_;
    Growable<AcdfPiece> pieces_;
    Growable<AcdfPieceEnds> ends_;
    Growable<float> densities_;
    Growable<KeyBox> numbers_, keys_;
};

bool CellsMaker::gather(std::size_t most_bytes) {
    const Cell whole = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows},
                        false, false};
    if (!count(environment_.root) || cells_ * kLeastBytes > most_bytes) return false;
    const std::size_t about = cells_ + cells_ / 16 + 64; // pieces
    if (!(pieces_.reserve(about) && densities_.reserve(about) && numbers_.reserve(about) && keys_.reserve(about)))
        return false;
    const bool done =
        sides_.remember(most_steps_) &&
        each_cell(environment_.tree, environment_.root, whole, [&](const Cell& cell) { return add(cell); }) &&
        pieces_.size() <= kMostPieces;
    return done &&
           !(pieces_.failed() || ends_.failed() || densities_.failed() || numbers_.failed() || keys_.failed());
}

// Whether the cells are few enough, in proportion to the tree, and without tilts: before any work is spent on them.
bool CellsMaker::count(u32 at) {
    const AcdfCurve curve = acdf_curve_at(environment_.tree, at);
    if (curve.tilts) return false;
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        cells_ += link == 0;
        if (++steps_ > most_steps_ || cells_ > kMostPieces || (link != 0 && !count(at + link))) return false;
    }
    return true;
}

bool CellsMaker::add(const Cell& cell) {
    if (pieces_.size() > kMostPieces) return false;
    const float pdf = sides_.density(cell);
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = sides_.azimuths(cell, columns), row_count = sides_.heights(cell, rows);
    for (int r = 0; r < row_count; ++r)
        for (int c = 0; c < column_count; ++c) add_piece(columns[c], rows[r], pdf);
    return true;
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

// All steps of random numbers that lead into a side. Each leads into one of an axis, if not into a dark one.
Steps all_steps(const Side& side) {
    return {static_cast<std::int64_t>(std::ceil(side.low * kNumberSteps)),
            static_cast<std::int64_t>(std::ceil(side.high * kNumberSteps)) - 1};
}

// An axis whose numbers, too few to be sure of most, lead evenly to all within its margins.
AcdfPieceAxis narrow_axis(const Side& side, const Steps& all, bool down) {
    AcdfPieceAxis axis = dark_axis(side, down);
    axis.low = static_cast<u32>(down ? all.last : all.first);
    axis.width = static_cast<float>(all.last - all.first + 1) * 0x1p21f;
    axis.slope /= axis.width;
    return axis;
}

// What rounding makes of the ends of a piece must be in its keys: one more on each side.
void widen(u32& low, u32& high, u32 first, u32 last) {
    low = low > first ? std::min(low, last) - 1 : first;
    high = high < last ? std::max(high, first) + 1 : last;
}

// Everything in a piece: no step of a number and no direction between two of them.
AcdfPieceEnds ends_of(const Side& azimuth, const Side& height, const Steps steps[2]) {
    AcdfPieceEnds ends = {};
    for (int axis = 0; axis < 2; ++axis) {
        ends.numbers[axis][0] = static_cast<u32>(steps[axis].first);
        ends.numbers[axis][1] =
            static_cast<u32>(std::max(steps[axis].last + 1 - steps[axis].first, std::int64_t{0}));
    }
    for (int i = 0; i < 2; ++i) {
        ends.slope[i] = static_cast<float>(azimuth.ends[i]);
        ends.cap[i] = static_cast<float>(height.ends[i]);
    }
    if (azimuth.ends[1] >= 1.0) ends.slope[1] = 2.0f; // of a quarter, and the equator, ends included
    if (height.ends[1] >= 1.0) ends.cap[1] = 2.0f;
    return ends;
}

void CellsMaker::add_whole_piece(const Side& azimuth, const Side& height, float pdf) {
    const Side* const sides[2] = {&azimuth, &height};
    const Steps steps[2] = {all_steps(azimuth), all_steps(height)};
    const bool drawn = pdf > 0.0f && steps[0].first <= steps[0].last && steps[1].first <= steps[1].last;
    AcdfPieceAxis axes[2];
    KeyBox number = {{1, 1}, {0, 0}}, key;
    for (int axis = 0; axis < 2; ++axis) {
        const Side& side = *sides[axis];
        const bool down = axis == 1 && side.piece == 1;
        const Steps sure = steps_within(side);
        const bool few = 2 * (sure.last - sure.first) < steps[axis].last - steps[axis].first;
        axes[axis] = !drawn ? dark_axis(side, down)
                     : few  ? narrow_axis(side, steps[axis], down)
                            : drawn_axis(side, sure, down);
        axes[axis].width = tagged(axes[axis].width, axis == 0 ? 3u : 1u, side.piece);
        if (drawn) {
            number.low[axis] = static_cast<u32>(steps[axis].first);
            number.high[axis] = static_cast<u32>(steps[axis].last);
        }
        key.low[axis] = side.first_key();
        key.high[axis] = side.last_key();
    }
    widen(key.low[0], key.high[0], azimuth.piece << 23, ((azimuth.piece + 1) << 23) - 1);
    widen(key.low[1], key.high[1], height.piece << 24, ((height.piece + 1) << 24) - 1);
    pieces_.add({axes[0], axes[1]});
    ends_.add(ends_of(azimuth, height, steps));
    densities_.add(pdf);
    numbers_.add(number);
    keys_.add(key);
}

void CellsMaker::add_piece(const Side& azimuth, const Side& height, float pdf) {
    if (total_) return add_whole_piece(azimuth, height, pdf);
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
        key.low[axis] = side.first_key();
        key.high[axis] = side.last_key();
    }
    if (!(any[0] && any[1])) key = {{1, 1}, {0, 0}};
    pieces_.add({axes[0], axes[1]});
    densities_.add(pdf);
    numbers_.add(number);
    keys_.add(key);
}

AcdfCells* CellsMaker::assemble(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) {
    const std::size_t count = pieces_.size();
    const std::size_t work = total_ ? kWholeWork : SquaresMaker::kUsualWork;
    SquaresMaker numbers, directions;
    const std::size_t others = pieces_.bytes() + densities_.bytes() + count * kLeastDirectionBytes;
    if (others > most_bytes || !numbers.make(numbers_.data(), count, kNumberBits, work, most_bytes - others) ||
        4 * numbers.words() > most_bytes - others || !directions.make(keys_.data(), count, sides_.key_bits(), work))
        return nullptr;
    if (total_ && !(numbers.complete() && directions.complete())) return nullptr;
    std::size_t words = whole_lines(sizeof(AcdfCells) / 4) + numbers.words() + directions.words();
    words +=
        whole_lines(pieces_.bytes() / 4) + whole_lines(densities_.bytes() / 4) + whole_lines(ends_.bytes() / 4);
    if (4 * words > most_bytes) return nullptr;
    block = take_block(allocator, 4 * words);
    if (!block.data) return nullptr;
    std::size_t at = whole_lines(sizeof(AcdfCells) / 4);
    u32* const tables = static_cast<u32*>(std::memset(block.data, 0, 4 * at));
    AcdfCells* const cells = new (block.data) AcdfCells();
    const auto copy = [&](const auto& from) { return copy_lines(from, tables, at); };
    cells->words = static_cast<u32>(words);
    cells->count = static_cast<u32>(count);
    cells->octahedral = environment_.parameterization == ACDF_PARAM_OCTAHEDRAL;
    cells->pieces = copy(pieces_);
    cells->densities = copy(densities_);
    if (total_) cells->ends = copy(ends_);
    at = numbers.place(tables, at, cells->numbers);
    directions.place(tables, at, cells->directions);
    return cells;
}

} // namespace

AcdfCells* make_cells(const AcdfEnvironment& environment, u32 tree_units, std::size_t most_bytes,
                      const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    CellsMaker maker(environment, tree_units, false);
    return maker.gather(most_bytes) ? maker.assemble(most_bytes, allocator, block) : nullptr;
}

AcdfCells* make_shader_cells(const AcdfEnvironment& environment, u32 tree_units, AcdfBlock& block) noexcept {
    CellsMaker maker(environment, tree_units, true);
    return maker.gather(SIZE_MAX) ? maker.assemble(SIZE_MAX, {}, block) : nullptr;
}

} // namespace acdf
