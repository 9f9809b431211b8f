// Lists of boxes that are halved again and again (squares.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A box in a list, all that halving asks for in one word: its sides in steps of the rectangle where the list was
/// written, of 12 bits each - lower and upper one of axis 0, of axis 1 -, and above them its number.
using ListedBox = std::uint64_t;
constexpr std::uint32_t kListedBits = 12, kListedLast = (1u << kListedBits) - 1;

inline std::uint16_t listed_number(ListedBox box) { return static_cast<std::uint16_t>(box >> 4 * kListedBits); }

/// Elements behind the end of a list that may be read, and behind the end of a half that may be written.
constexpr std::size_t kBehindList = 8;

/// Across the middle of an axis: boxes begin below it where box & low_mask < low_middle, and reach it where box &
/// high_mask >= high_middle.
struct Halving {
    ListedBox low_mask, low_middle, high_mask, high_middle;
};

struct HalvedCounts {
    std::size_t lower, upper;
};

/// Leaves those that begin below the middle in the list, and writes those that reach it to `upper`, which begins
/// kBehindList elements behind the list or later.
HalvedCounts halve_boxes(ListedBox* list, std::size_t count, const Halving& across, ListedBox* upper) noexcept;

/// How many of every `step`th box the middle of each axis cuts.
void count_cut_boxes(const ListedBox* list, std::size_t count, std::size_t step, const Halving across[2],
                     std::size_t cut[2]) noexcept;

} // namespace acdf
