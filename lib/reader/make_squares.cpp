// Halves the square of keys until few enough cells are left in each part.
#include "make_squares.h"

#include <algorithm>
#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kEmptyBlock = 0;
constexpr u32 kEmptyEntry = kEmptyBlock; // whatever the shifts
constexpr u32 kByteBits = 8;
constexpr u32 kMostBits = 16;         // of the grid
constexpr std::size_t kLookedAt = 32; // cells, to choose an axis

} // namespace

bool SquaresMaker::make(const KeyBox* boxes, std::size_t count, u32 key_bits, std::size_t work_a_box,
                        std::size_t most_bytes) noexcept {
    boxes_ = boxes;
    most_words_ = most_bytes / 4;
    work_ = work_a_box * (count + ACDF_BLOCK_CELLS);
    const Rectangle whole = {{0, 0}, {key_bits, key_bits}};
    block(whole, 0); // no cells: the empty one
    list_.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i)
        if (boxes[i].low[0] <= boxes[i].high[0] && boxes[i].low[1] <= boxes[i].high[1])
            list_.add(static_cast<std::uint16_t>(i));
    u32 bits = 0;
    while (bits < kMostBits && (std::size_t{3} << bits) < 2 * count) ++bits;
    grid_ = shaped(whole, 0, bits, 0);
    entries_.add(std::size_t{1} << bits, kEmptyEntry);
    divide(grid_, whole, 0);
    return !(entries_.failed() || finer_.failed() || block_boxes_.failed() || block_cells_.failed() ||
             list_.failed());
}

// Halves the entries of a grid as often as it has bits, each time along the axis where that cuts fewer cells.
SquaresMaker::Grid SquaresMaker::shaped(const Rectangle& rectangle, std::size_t first, u32 bits,
                                        std::size_t number) const {
    Grid grid = {
        {rectangle.origin[0], rectangle.origin[1]}, {0, 0}, {rectangle.log2[0], rectangle.log2[1]}, number};
    const std::size_t step = 1 + (list_.size() - first) / kLookedAt;
    u32 low[2][kLookedAt], high[2][kLookedAt];
    std::size_t count = 0;
    for (std::size_t k = first; k < list_.size(); k += step, ++count)
        for (int axis = 0; axis < 2; ++axis) {
            const KeyBox& box = boxes_[list_[k]];
            const u32 end = rectangle.origin[axis] + ((1u << rectangle.log2[axis]) - 1);
            low[axis][count] = std::max(box.low[axis], rectangle.origin[axis]);
            high[axis][count] = std::min(box.high[axis], end);
        }
    for (u32 i = 0; i < bits; ++i) {
        u32 cuts[2] = {0, 0};
        for (int axis = 0; axis < 2; ++axis) {
            const u32 shift = grid.shift[axis];
            for (std::size_t k = 0; k < count && shift > 0; ++k)
                cuts[axis] += ((high[axis][k] >> (shift - 1)) - (low[axis][k] >> (shift - 1))) -
                              ((high[axis][k] >> shift) - (low[axis][k] >> shift));
        }
        const int axis = grid.shift[0] == 0   ? 1
                         : grid.shift[1] == 0 ? 0
                         : cuts[0] != cuts[1] ? (cuts[0] < cuts[1] ? 0 : 1)
                                              : (grid.shift[0] >= grid.shift[1] ? 0 : 1);
        --grid.shift[axis];
        ++grid.bits[axis];
    }
    return grid;
}

// The cells of the rectangle are the list from `first` on, at the end of the stack.
void SquaresMaker::divide(const Grid& grid, const Rectangle& rectangle, std::size_t first) {
    const std::size_t end = list_.size(), count = end - first;
    if (count <= ACDF_BLOCK_CELLS) return fill(grid, rectangle, block(rectangle, first));
    if (work_ < 2 * count || list_.failed() || words() > most_words_) { // the entries stay empty
        complete_ = false;
        return;
    }
    work_ -= 2 * count;
    const int axis = best_axis(grid, rectangle, first);
    if (axis < 0) return refine(grid, rectangle, first);
    Rectangle half = rectangle;
    const u32 middle = rectangle.origin[axis] + (1u << --half.log2[axis]);
    if (!list_.reserve(end + 2 * count + 1)) return;
    std::uint16_t* lower = list_.data() + end;
    std::uint16_t* upper = lower + count;
    for (std::size_t i = first; i < end; ++i) {
        const std::uint16_t cell = list_[i];
        *lower = *upper = cell;
        lower += boxes_[cell].low[axis] < middle;
        upper += boxes_[cell].high[axis] >= middle;
    }
    const std::size_t lower_end = static_cast<std::size_t>(lower - list_.data());
    list_.cut(static_cast<std::size_t>(upper - list_.data()));
    half.origin[axis] = middle;
    divide(grid, half, end + count);
    list_.cut(lower_end);
    half.origin[axis] = rectangle.origin[axis];
    divide(grid, half, end);
    list_.cut(end);
}

// The axis whose middle cuts fewer cells, of some; -1 where the rectangle is as small as an entry.
int SquaresMaker::best_axis(const Grid& grid, const Rectangle& rectangle, std::size_t first) const {
    const bool may[2] = {rectangle.log2[0] > grid.shift[0], rectangle.log2[1] > grid.shift[1]};
    if (!may[0] || !may[1]) return may[0] ? 0 : may[1] ? 1 : -1;
    const u32 middle[2] = {rectangle.origin[0] + (1u << (rectangle.log2[0] - 1)),
                           rectangle.origin[1] + (1u << (rectangle.log2[1] - 1))};
    std::size_t cut[2] = {0, 0};
    const std::size_t step = 1 + (list_.size() - first) / kLookedAt;
    for (std::size_t i = first; i < list_.size(); i += step) {
        const KeyBox& box = boxes_[list_[i]];
        for (int axis = 0; axis < 2; ++axis)
            cut[axis] += (box.low[axis] < middle[axis]) & (box.high[axis] >= middle[axis]);
    }
    if (cut[0] != cut[1]) return cut[0] < cut[1] ? 0 : 1;
    return rectangle.log2[0] >= rectangle.log2[1] ? 0 : 1;
}

// A finer grid in a rectangle as small as an entry.
void SquaresMaker::refine(const Grid& grid, const Rectangle& rectangle, std::size_t first) {
    const std::size_t number = (finer_.size() >> ACDF_FINER_BITS);
    if (rectangle.log2[0] + rectangle.log2[1] < ACDF_FINER_BITS || number >> 28 ||
        !finer_.add(1u << ACDF_FINER_BITS, kEmptyEntry)) {
        complete_ = false;
        return;
    }
    const Grid finer = shaped(rectangle, first, ACDF_FINER_BITS, number + 1);
    fill(grid, rectangle, ACDF_SQUARES_FINER | finer.bits[0] << 28 | static_cast<u32>(number));
    divide(finer, rectangle, first);
}

/// Adds a block with the cells from `first` on and returns its entry.
u32 SquaresMaker::block(const Rectangle& rectangle, std::size_t first) {
    const std::size_t number = block_cells_.size() / ACDF_BLOCK_CELLS;
    if (number >> ACDF_SQUARES_BLOCK_BITS) {
        complete_ = false;
        return kEmptyEntry;
    }
    auto* const bytes = reinterpret_cast<std::int8_t*>(block_boxes_.add(ACDF_BLOCK_CELLS, 0));
    std::uint16_t* const cells = block_cells_.add(ACDF_BLOCK_CELLS, 0);
    if (!bytes || !cells) return kEmptyEntry;
    u32 shift[2];
    for (int axis = 0; axis < 2; ++axis) {
        shift[axis] = rectangle.log2[axis] > kByteBits ? rectangle.log2[axis] - kByteBits : 0;
        const u32 origin = rectangle.origin[axis], last = (1u << rectangle.log2[axis]) - 1;
        std::int8_t* const low = bytes + 32 * axis;
        std::int8_t* const high = low + ACDF_BLOCK_CELLS;
        std::fill_n(low, ACDF_BLOCK_CELLS, std::int8_t{127});
        std::fill_n(high, ACDF_BLOCK_CELLS, std::int8_t{-128});
        // Keys are looked at modulo 256 steps: in small rectangles there are fewer, and those of neighbours follow.
        const u32 base = origin >> shift[axis] & 0xFFu;
        for (std::size_t i = first; i < list_.size(); ++i) {
            const KeyBox& box = boxes_[list_[i]];
            const u32 from = box.low[axis] > origin ? box.low[axis] - origin : 0;
            const u32 to = std::min(box.high[axis] - origin, last);
            low[i - first] = static_cast<std::int8_t>(static_cast<int>(base + (from >> shift[axis])) - 128);
            high[i - first] = static_cast<std::int8_t>(static_cast<int>(base + (to >> shift[axis])) - 128);
        }
    }
    std::copy(list_.data() + first, list_.data() + list_.size(), cells);
    return shift[0] << 26 | shift[1] << 21 | static_cast<u32>(number);
}

void SquaresMaker::fill(const Grid& grid, const Rectangle& rectangle, u32 entry) {
    u32* const entries = grid.number > 0 ? finer_.data() + ((grid.number - 1) << ACDF_FINER_BITS) : entries_.data();
    u32 begin[2], count[2];
    for (int axis = 0; axis < 2; ++axis) {
        begin[axis] = (rectangle.origin[axis] - grid.origin[axis]) >> grid.shift[axis];
        count[axis] = 1u << (rectangle.log2[axis] - grid.shift[axis]);
    }
    for (u32 row = begin[1]; row < begin[1] + count[1]; ++row)
        std::fill_n(entries + (std::size_t{row} << grid.bits[0]) + begin[0], count[0], entry);
}

std::size_t SquaresMaker::words() const noexcept {
    return whole_lines(block_boxes_.size()) + whole_lines(block_cells_.size() / 2) + whole_lines(entries_.size()) +
           whole_lines(finer_.size());
}

std::size_t SquaresMaker::place(u32* tables, std::size_t at, AcdfSquares& out) const noexcept {
    const auto copy = [&](const auto& from) { return copy_lines(from, tables, at); };
    out.shift0 = grid_.shift[0];
    out.shift1 = grid_.shift[1];
    out.bits0 = grid_.bits[0];
    out.bits1 = grid_.bits[1];
    out.boxes = copy(block_boxes_);
    out.cells = copy(block_cells_);
    out.grid = copy(entries_);
    out.finer = copy(finer_);
    out.blocks = static_cast<u32>(block_cells_.size() / ACDF_BLOCK_CELLS);
    return at;
}

} // namespace acdf
