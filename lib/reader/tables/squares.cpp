// Halves the square of keys until few enough cells are left in each part.
#include "tables/squares.h"

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

constexpr std::size_t kUsualBoxes = 4; // for each block that there will be

constexpr std::size_t kRoomBehind = 2 * ACDF_BLOCK_CELLS; // lists: kBehindList, and what is less than a block

constexpr KeySpan kNone = {1, 0};

struct AxisOfBlock {
    int origin, last, shift; // keys: the first one; the last one, from there; bits that are finer than bytes
};

// Where the first `count` of sixteen boxes lie in a block, in bytes less 128: lower sides, then upper ones. Keys
// are looked at modulo 256 steps: in small rectangles there are fewer, and those of neighbours follow.
#ifdef ACDF_SSE2
__m128i lesser(__m128i a, __m128i b) {
    const __m128i above = _mm_cmpgt_epi32(a, b);
    return _mm_or_si128(_mm_and_si128(above, b), _mm_andnot_si128(above, a));
}

__m128 two_spans(const KeySpan* spans, const std::uint16_t* listed) {
    const auto* const low = reinterpret_cast<const __m64*>(spans + listed[0]);
    const auto* const high = reinterpret_cast<const __m64*>(spans + listed[1]);
    return _mm_loadh_pi(_mm_loadl_pi(_mm_setzero_ps(), low), high);
}

void set_sides(const AxisOfBlock& along, const KeySpan* spans, const std::uint16_t* listed, int count,
               std::int8_t* bytes) {
    const __m128i origin = _mm_set1_epi32(along.origin), last = _mm_set1_epi32(along.last),
                  zero = _mm_setzero_si128();
    const __m128i shift = _mm_cvtsi32_si128(along.shift);
    __m128i low[4], high[4];
    for (int i = 0; i < 4; ++i) {
        const __m128 first = two_spans(spans, listed + 4 * i), second = two_spans(spans, listed + 4 * i + 2);
        const __m128i from = _mm_sub_epi32(_mm_castps_si128(_mm_shuffle_ps(first, second, 0x88)), origin);
        const __m128i to = _mm_sub_epi32(_mm_castps_si128(_mm_shuffle_ps(first, second, 0xDD)), origin);
        low[i] = _mm_srl_epi32(_mm_and_si128(from, _mm_cmpgt_epi32(from, zero)), shift);
        high[i] = _mm_srl_epi32(lesser(to, last), shift);
    }
    const __m128i base = _mm_set1_epi8(static_cast<char>((along.origin >> along.shift & 0xFF) - 128));
    const __m128i numbers = _mm_set_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    const __m128i there = _mm_cmpgt_epi8(_mm_set1_epi8(static_cast<char>(count)), numbers);
    const auto bytes_of = [&](const __m128i* side, char otherwise) {
        const __m128i packed =
            _mm_packus_epi16(_mm_packs_epi32(side[0], side[1]), _mm_packs_epi32(side[2], side[3]));
        return _mm_or_si128(_mm_and_si128(there, _mm_add_epi8(packed, base)),
                            _mm_andnot_si128(there, _mm_set1_epi8(otherwise)));
    };
    auto* const out = reinterpret_cast<__m128i*>(bytes);
    _mm_storeu_si128(out, bytes_of(low, 127));
    _mm_storeu_si128(out + 1, bytes_of(high, -128));
}
#else
void set_sides(const AxisOfBlock& along, const KeySpan* spans, const std::uint16_t* listed, int count,
               std::int8_t* bytes) {
    const int base = (along.origin >> along.shift & 0xFF) - 128;
    for (int i = 0; i < ACDF_BLOCK_CELLS; ++i) {
        const KeySpan& span = spans[listed[i]];
        const int from = std::max(static_cast<int>(span.low) - along.origin, 0);
        const int to = std::min(static_cast<int>(span.high) - along.origin, along.last);
        bytes[i] = static_cast<std::int8_t>(i < count ? base + (from >> along.shift) : 127);
        bytes[ACDF_BLOCK_CELLS + i] = static_cast<std::int8_t>(i < count ? base + (to >> along.shift) : -128);
    }
}
#endif

} // namespace

bool SquaresMaker::make(const KeyBoxes& boxes, u32 key_bits, std::size_t work_a_box,
                        std::size_t most_bytes) noexcept {
    const std::size_t count = boxes.size();
    for (int axis = 0; axis < 2; ++axis) spans_[axis] = boxes.axis(axis);
    most_words_ = most_bytes / 4;
    work_ = work_a_box * (count + ACDF_BLOCK_CELLS);
    const Rectangle whole = {{0, 0}, {key_bits, key_bits}};
    const Frame frame = framed(whole);
    const std::size_t blocks = count / kUsualBoxes + 1;
    block_boxes_.reserve(blocks * ACDF_BLOCK_CELLS);
    block_cells_.reserve(blocks * ACDF_BLOCK_CELLS);
    block(whole, 0); // no cells: the empty one
    if (!list_all(count, frame)) return false;
    u32 bits = 0;
    while (bits < kMostBits && (std::size_t{3} << bits) < 2 * count) ++bits;
    grid_ = shaped(whole, 0, bits, 0);
    entries_.add(std::size_t{1} << bits, kEmptyEntry);
    divide(grid_, whole, frame, 0);
    return !(entries_.failed() || finer_.failed() || block_boxes_.failed() || block_cells_.failed() ||
             list_.failed());
}

SquaresMaker::Frame SquaresMaker::framed(const Rectangle& rectangle) {
    Frame frame = {{rectangle.origin[0], rectangle.origin[1]}, {0, 0}};
    for (int axis = 0; axis < 2; ++axis)
        if (rectangle.log2[axis] > kListedBits) frame.shift[axis] = rectangle.log2[axis] - kListedBits;
    return frame;
}

Halving SquaresMaker::halving(const Rectangle& rectangle, const Frame& frame, int axis) {
    const u32 middle = rectangle.origin[axis] + (1u << (rectangle.log2[axis] - 1)) - frame.origin[axis];
    const u32 low = 2 * kListedBits * static_cast<u32>(axis), high = low + kListedBits;
    const ListedBox step = middle >> frame.shift[axis], side = kListedLast;
    return {side << low, step << low, side << high, step << high};
}

// A box in the list of a rectangle that it touches.
ListedBox SquaresMaker::listed(std::size_t box, const Frame& frame) const {
    ListedBox sides = box;
    for (int axis = 1; axis >= 0; --axis) {
        const KeySpan& span = spans_[axis][box];
        const u32 origin = frame.origin[axis], low = std::max(span.low, origin);
        const u32 first = (low - origin) >> frame.shift[axis], last = (span.high - origin) >> frame.shift[axis];
        sides = sides << 2 * kListedBits | ListedBox{std::min(last, kListedLast)} << kListedBits | first;
    }
    return sides;
}

// All boxes that have keys of both axes.
bool SquaresMaker::list_all(std::size_t count, const Frame& frame) {
    if (!list_.reserve(2 * count + kRoomBehind)) return false;
    ListedBox* const list = list_.add(count, 0);
    std::size_t some = 0;
    for (std::size_t i = 0; i < count; ++i) {
        list[some] = listed(i, frame);
        some += (spans_[0][i].low <= spans_[0][i].high) & (spans_[1][i].low <= spans_[1][i].high);
    }
    list_.cut(some);
    return true;
}

// Halves the entries of a grid as often as it has bits, each time along the axis where that cuts fewer cells.
SquaresMaker::Grid SquaresMaker::shaped(const Rectangle& rectangle, std::size_t first, u32 bits,
                                        std::size_t number) const {
    Grid grid = {
        {rectangle.origin[0], rectangle.origin[1]}, {0, 0}, {rectangle.log2[0], rectangle.log2[1]}, number};
    const std::size_t step = 1 + (list_.size() - first) / kLookedAt;
    u32 low[2][kLookedAt] = {}, high[2][kLookedAt] = {}; // those that are not set are cut by nothing
    for (std::size_t k = first, i = 0; k < list_.size(); k += step, ++i)
        for (int axis = 0; axis < 2; ++axis) {
            const KeySpan& span = spans_[axis][listed_number(list_[k])];
            const u32 end = rectangle.origin[axis] + ((1u << rectangle.log2[axis]) - 1);
            low[axis][i] = std::max(span.low, rectangle.origin[axis]);
            high[axis][i] = std::min(span.high, end);
        }
    const auto cut_by_halving = [&](int axis) {
        const u32 shift = grid.shift[axis];
        u32 cuts = 0;
        for (std::size_t k = 0; k < kLookedAt && shift > 0; ++k)
            cuts += ((high[axis][k] >> (shift - 1)) - (low[axis][k] >> (shift - 1))) -
                    ((high[axis][k] >> shift) - (low[axis][k] >> shift));
        return cuts;
    };
    u32 cuts[2] = {cut_by_halving(0), cut_by_halving(1)};
    for (u32 i = 0; i < bits; ++i) {
        const int axis = grid.shift[0] == 0   ? 1
                         : grid.shift[1] == 0 ? 0
                         : cuts[0] != cuts[1] ? (cuts[0] < cuts[1] ? 0 : 1)
                                              : (grid.shift[0] >= grid.shift[1] ? 0 : 1);
        --grid.shift[axis];
        ++grid.bits[axis];
        cuts[axis] = cut_by_halving(axis);
    }
    return grid;
}

// The cells of the rectangle are the list from `first` on, at the end of the stack.
void SquaresMaker::divide(const Grid& grid, const Rectangle& rectangle, const Frame& frame, std::size_t first) {
    const std::size_t count = list_.size() - first;
    if (count <= ACDF_BLOCK_CELLS) return fill(grid, rectangle, block(rectangle, first));
    if (work_ < 2 * count || list_.failed() || words() > most_words_) { // the entries stay empty
        complete_ = false;
        return;
    }
    const bool may[2] = {rectangle.log2[0] > grid.shift[0], rectangle.log2[1] > grid.shift[1]};
    if ((may[0] && rectangle.log2[0] <= frame.shift[0]) || (may[1] && rectangle.log2[1] <= frame.shift[1])) {
        const Frame closer = framed(rectangle); // steps are too coarse
        for (std::size_t i = first; i < list_.size(); ++i) list_[i] = listed(listed_number(list_[i]), closer);
        return divide(grid, rectangle, closer, first);
    }
    work_ -= 2 * count;
    const int axis = best_axis(grid, rectangle, frame, first);
    if (axis < 0) return refine(grid, rectangle, frame, first);
    const std::size_t above = first + count + kBehindList;
    if (!list_.reserve(above + count + kRoomBehind)) return;
    const HalvedCounts counts =
        halve_boxes(list_.data() + first, count, halving(rectangle, frame, axis), list_.data() + above);
    Rectangle half = rectangle;
    half.origin[axis] += 1u << --half.log2[axis];
    list_.cut(above + counts.upper);
    divide(grid, half, frame, above);
    list_.cut(first + counts.lower);
    half.origin[axis] = rectangle.origin[axis];
    divide(grid, half, frame, first);
    list_.cut(first);
}

// The axis whose middle cuts fewer cells, of some; -1 where the rectangle is as small as an entry.
int SquaresMaker::best_axis(const Grid& grid, const Rectangle& rectangle, const Frame& frame,
                            std::size_t first) const {
    const bool may[2] = {rectangle.log2[0] > grid.shift[0], rectangle.log2[1] > grid.shift[1]};
    if (!may[0] || !may[1]) return may[0] ? 0 : may[1] ? 1 : -1;
    const Halving across[2] = {halving(rectangle, frame, 0), halving(rectangle, frame, 1)};
    const std::size_t count = list_.size() - first;
    std::size_t cut[2];
    count_cut_boxes(list_.data() + first, count, 1 + count / kLookedAt, across, cut);
    if (cut[0] != cut[1]) return cut[0] < cut[1] ? 0 : 1;
    return rectangle.log2[0] >= rectangle.log2[1] ? 0 : 1;
}

// A finer grid in a rectangle as small as an entry.
void SquaresMaker::refine(const Grid& grid, const Rectangle& rectangle, const Frame& frame, std::size_t first) {
    const std::size_t number = (finer_.size() >> ACDF_FINER_BITS);
    if (rectangle.log2[0] + rectangle.log2[1] < ACDF_FINER_BITS || number >> 28 ||
        !finer_.add(1u << ACDF_FINER_BITS, kEmptyEntry)) {
        complete_ = false;
        return;
    }
    const Grid finer = shaped(rectangle, first, ACDF_FINER_BITS, number + 1);
    fill(grid, rectangle, ACDF_SQUARES_FINER | finer.bits[0] << 28 | static_cast<u32>(number));
    divide(finer, rectangle, frame, first);
}

/// Adds a block with the cells from `first` on and returns its entry.
u32 SquaresMaker::block(const Rectangle& rectangle, std::size_t first) {
    const std::size_t number = block_cells_.size() / ACDF_BLOCK_CELLS, count = list_.size() - first;
    if (number >> ACDF_SQUARES_BLOCK_BITS) {
        complete_ = false;
        return kEmptyEntry;
    }
    auto* const bytes = reinterpret_cast<std::int8_t*>(block_boxes_.add(ACDF_BLOCK_CELLS, 0));
    std::uint16_t* const cells = block_cells_.add(ACDF_BLOCK_CELLS, 0);
    if (!bytes || !cells) return kEmptyEntry;
    // Always sixteen, the first one again for those that lack: nothing depends on how many there are.
    const std::size_t end = list_.size();
    if (!list_.reserve(end + ACDF_BLOCK_CELLS)) return kEmptyEntry;
    std::fill_n(list_.data() + end, ACDF_BLOCK_CELLS, count > 0 ? list_[first] : ListedBox{0});
    std::uint16_t numbers[ACDF_BLOCK_CELLS];
    for (std::size_t i = 0; i < ACDF_BLOCK_CELLS; ++i) numbers[i] = listed_number(list_[first + i]);
    for (int i = 0; i < ACDF_BLOCK_CELLS; ++i)
        cells[i] = static_cast<std::uint16_t>(numbers[i] & -static_cast<int>(i < static_cast<int>(count)));
    u32 shift[2];
    for (int axis = 0; axis < 2; ++axis) {
        shift[axis] = rectangle.log2[axis] > kByteBits ? rectangle.log2[axis] - kByteBits : 0;
        const AxisOfBlock along = {static_cast<int>(rectangle.origin[axis]),
                                   static_cast<int>((1u << rectangle.log2[axis]) - 1),
                                   static_cast<int>(shift[axis])};
        set_sides(along, count > 0 ? spans_[axis] : &kNone, numbers, static_cast<int>(count),
                  bytes + 2 * ACDF_BLOCK_CELLS * axis);
    }
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
