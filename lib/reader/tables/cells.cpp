// Writes down what each piece of a cell needs (acdf/cells.h).
#include "tables/cells.h"

#include "memory.h"
#include "tables/piece_cells.h"
#include "tables/sides.h"
#include "tables/squares.h"

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
constexpr KeySpan kNoKeys = {1, 0};
// Tables for shaders may be made for minutes: no part of them may be missing.
constexpr std::size_t kWholeWork = std::size_t{1} << 14;

// The part of a cell's axis that is in one piece of the sphere.
struct AxisPart {
    AcdfPieceAxis axis;
    KeySpan number, key;
};
struct AxisParts {
    int count;
    bool drawn;
    AxisPart part[5]; // set as far as they are counted
};

class CellsMaker {
public:
    /// total: tables that answer always.
    CellsMaker(const AcdfEnvironment& environment, const TreeSurvey& survey, bool total, Scratch* scratch,
               Instructions most)
        : environment_(environment), survey_(survey), scratch_(scratch), instructions_(most),
          sides_(acdf_environment_grid(&environment)), total_(total), pieces_(scratch), ends_(scratch),
          densities_(scratch), numbers_(scratch), keys_(scratch) {}

    /// False where there can be no tables, or none of at most so many bytes.
    bool gather(std::size_t most_bytes);
    AcdfCells* assemble(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block);

private:
    bool is_remembered() const;
    bool add_all();
    PieceSink sink() noexcept;
    bool room(PieceRows& rows) noexcept;
    void keep(std::size_t count) noexcept;
    bool add_cut(const Cell& cell) noexcept;
    bool add_whole(const Cell& cell);
    void cut(const Cell& cell, u32 axis);
    void add_piece(const AxisPart& azimuth, const AxisPart& height, float pdf);
    void add_whole_piece(const Side& azimuth, const Side& height, float pdf);

    AcdfEnvironment environment_;
    const TreeSurvey& survey_;
    Scratch* scratch_;
    Instructions instructions_;
    Sides sides_;
    bool total_;
    Growable<AcdfPiece> pieces_;
    Growable<AcdfPieceEnds> ends_;
    Growable<float> densities_;
    KeyBoxes numbers_, keys_;
    AxisParts parts_[2] = {}; ///< of a cell that is cut
};

bool CellsMaker::gather(std::size_t most_bytes) {
    if (!survey_.done()) return false;
    const std::size_t cells = survey_.cells(), about = cells + cells / 16 + 64; // pieces, and room for sixteen
    if (cells > kMostPieces || cells * kLeastBytes > most_bytes) return false;  // before any work is spent on them
    if (!(pieces_.reserve(about) && densities_.reserve(about) && numbers_.reserve(about) && keys_.reserve(about)))
        return false;
    const bool done = sides_.remember(survey_.most_steps()) && add_all() && pieces_.size() <= kMostPieces;
    return done &&
           !(pieces_.failed() || ends_.failed() || densities_.failed() || numbers_.failed() || keys_.failed());
}

// Whether cells can be reckoned sixteen at a time.
bool CellsMaker::is_remembered() const {
    if (environment_.parameterization != ACDF_PARAM_OCTAHEDRAL) return sides_.tangents() && sides_.rows();
    return std::max(environment_.columns, environment_.rows) >> 31 == 0;
}

bool CellsMaker::add_all() {
    const Cell whole = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows},
                        false, false};
    if (!total_ && is_remembered())
        return write_piece_cells({environment_, sides_.tangents(), sides_.rows(), sink()}, instructions_);
    return each_cell(environment_.tree, environment_.root, whole,
                     [&](const Cell& above, u32 axis, const CellPart& part) {
                         const Cell cell = part.in(above, axis);
                         return total_ ? add_whole(cell) : add_cut(cell);
                     });
}

PieceSink CellsMaker::sink() noexcept {
    return {this, [](void* maker, PieceRows& rows) noexcept { return static_cast<CellsMaker*>(maker)->room(rows); },
            [](void* maker, std::size_t count) noexcept { static_cast<CellsMaker*>(maker)->keep(count); },
            [](void* maker, const Cell& cell) noexcept { return static_cast<CellsMaker*>(maker)->add_cut(cell); }};
}

bool CellsMaker::room(PieceRows& rows) noexcept {
    const std::size_t count = pieces_.size(), more = count + ACDF_BLOCK_CELLS;
    if (count > kMostPieces ||
        !(pieces_.reserve(more) && densities_.reserve(more) && numbers_.reserve(more) && keys_.reserve(more)))
        return false;
    rows = {pieces_.data() + count,
            densities_.data() + count,
            {numbers_.axis(0) + count, numbers_.axis(1) + count},
            {keys_.axis(0) + count, keys_.axis(1) + count}};
    return true;
}

void CellsMaker::keep(std::size_t count) noexcept {
    const std::size_t all = pieces_.size() + count;
    pieces_.cut(all);
    densities_.cut(all);
    numbers_.cut(all);
    keys_.cut(all);
}

bool CellsMaker::add_cut(const Cell& cell) noexcept {
    if (pieces_.size() > kMostPieces) return false;
    const float pdf = sides_.density(cell);
    for (u32 axis = 0; axis < 2; ++axis) cut(cell, axis);
    for (int r = 0; r < parts_[1].count; ++r)
        for (int c = 0; c < parts_[0].count; ++c) add_piece(parts_[0].part[c], parts_[1].part[r], pdf);
    return true;
}

bool CellsMaker::add_whole(const Cell& cell) {
    if (pieces_.size() > kMostPieces) return false;
    const float pdf = sides_.density(cell);
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = sides_.azimuths(cell, columns), row_count = sides_.heights(cell, rows);
    for (int r = 0; r < row_count; ++r)
        for (int c = 0; c < column_count; ++c) add_whole_piece(columns[c], rows[r], pdf);
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
    return {static_cast<std::int64_t>((side.low + std::max(side.margin[0] * number, kPiecePart * width)) *
                                      kNumberSteps) +
                2,
            static_cast<std::int64_t>((side.high - std::max(side.margin[1] * number, kPiecePart * width)) *
                                      kNumberSteps) -
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
void widen(KeySpan& key, u32 first, u32 last) {
    key.low = key.low > first ? std::min(key.low, last) - 1 : first;
    key.high = key.high < last ? std::max(key.high, first) + 1 : last;
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
    KeySpan number[2] = {kNoKeys, kNoKeys}, key[2];
    for (int axis = 0; axis < 2; ++axis) {
        const Side& side = *sides[axis];
        const bool down = axis == 1 && side.piece == 1;
        const Steps sure = steps_within(side);
        const bool few = 2 * (sure.last - sure.first) < steps[axis].last - steps[axis].first;
        axes[axis] = !drawn ? dark_axis(side, down)
                     : few  ? narrow_axis(side, steps[axis], down)
                            : drawn_axis(side, sure, down);
        axes[axis].width = tagged(axes[axis].width, axis == 0 ? 3u : 1u, side.piece);
        if (drawn) number[axis] = {static_cast<u32>(steps[axis].first), static_cast<u32>(steps[axis].last)};
        key[axis] = {side.first_key(), side.last_key()};
    }
    widen(key[0], azimuth.piece << 23, ((azimuth.piece + 1) << 23) - 1);
    widen(key[1], height.piece << 24, ((height.piece + 1) << 24) - 1);
    pieces_.add({axes[0], axes[1]});
    ends_.add(ends_of(azimuth, height, steps));
    densities_.add(pdf);
    numbers_.add(number[0], number[1]);
    keys_.add(key[0], key[1]);
}

// Cuts an axis of a cell at the borders of the pieces of the sphere.
void CellsMaker::cut(const Cell& cell, u32 axis) {
    AxisParts& out = parts_[axis];
    Side sides[5]; // set as far as they are counted
    out.count = axis == 0 ? sides_.azimuths(cell, sides) : sides_.heights(cell, sides);
    out.drawn = !cell.dark;
    for (int i = 0; i < out.count; ++i) {
        const Side& side = sides[i];
        AxisPart& part = out.part[i];
        const bool down = axis == 1 && side.piece == 1; // heights are precise at the pole
        const Steps steps = steps_within(side);
        const bool drawn = out.drawn && steps.first < steps.last;
        part.axis = drawn ? drawn_axis(side, steps, down) : dark_axis(side, down);
        part.number = drawn ? KeySpan{static_cast<u32>(steps.first), static_cast<u32>(steps.last)} : kNoKeys;
        part.key = part.axis.width > 0.0f ? KeySpan{side.first_key(), side.last_key()} : kNoKeys;
        part.axis.width = tagged(part.axis.width, axis == 0 ? 3u : 1u, side.piece);
    }
}

void CellsMaker::add_piece(const AxisPart& azimuth, const AxisPart& height, float pdf) {
    pieces_.add({azimuth.axis, height.axis});
    densities_.add(pdf);
    numbers_.add(azimuth.number, height.number);
    keys_.add(azimuth.key, height.key);
}

AcdfCells* CellsMaker::assemble(std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) {
    const std::size_t count = pieces_.size();
    const std::size_t work = total_ ? kWholeWork : SquaresMaker::kUsualWork;
    SquaresMaker numbers(scratch_, instructions_), directions(scratch_, instructions_);
    const std::size_t others = pieces_.bytes() + densities_.bytes() + count * kLeastDirectionBytes;
    if (others > most_bytes || !numbers.make(numbers_, kNumberBits, work, most_bytes - others) ||
        4 * numbers.words() > most_bytes - others || !directions.make(keys_, sides_.key_bits(), work))
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

AcdfCells* make_cells(const AcdfEnvironment& environment, const TreeSurvey& survey, std::size_t most_bytes,
                      const AcdfAllocator& allocator, AcdfBlock& block, Scratch* scratch,
                      Instructions most) noexcept {
    CellsMaker maker(environment, survey, false, scratch, most);
    return maker.gather(most_bytes) ? maker.assemble(most_bytes, allocator, block) : nullptr;
}

AcdfCells* make_shader_cells(const AcdfEnvironment& environment, const TreeSurvey& survey,
                             AcdfBlock& block) noexcept {
    CellsMaker maker(environment, survey, true, nullptr, Instructions::avx512);
    return maker.gather(SIZE_MAX) ? maker.assemble(SIZE_MAX, {}, block) : nullptr;
}

} // namespace acdf
