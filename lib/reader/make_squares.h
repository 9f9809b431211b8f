// Makes the grids of acdf/squares.h.
#pragma once

#include "growable.h"

#include <acdf/squares.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// What the lists of blocks can name.
constexpr std::size_t kMostPieces = 65535;

/// The keys that may lead to a cell, ends included.
struct KeyBox {
    std::uint32_t low[2], high[2];
};

/// The arrays of an AcdfSquares.
class SquaresMaker {
public:
    /// Over boxes (at most 65536) of keys of `key_bits` bits. Boxes with low > high are in no block. The work is in
    /// proportion to `count`, whatever the boxes: where it would be more, entries name the empty block. Once there
    /// are more than `most_bytes` it ends, too. Returns false where memory fails.
    bool make(const KeyBox* boxes, std::size_t count, std::uint32_t key_bits, std::size_t work_a_box = kUsualWork,
              std::size_t most_bytes = SIZE_MAX) noexcept;
    /// Whether every entry names all boxes that it touches.
    bool complete() const noexcept { return complete_; }

    /// Boxes that may be looked at for each that there is, a division of a list counted once each: usual trees take
    /// 20 to 30.
    static constexpr std::size_t kUsualWork = 96;

    /// Words that `place` writes.
    std::size_t words() const noexcept;
    /// Writes the arrays at tables[at], a multiple of 16, and where they are to `out`. Returns the end.
    std::size_t place(std::uint32_t* tables, std::size_t at, AcdfSquares& out) const noexcept;

private:
    struct Rectangle {
        std::uint32_t origin[2], log2[2];
    };
    /// A grid over a rectangle, with 2^bits entries along each axis of 2^shift keys each.
    struct Grid {
        std::uint32_t origin[2];
        std::uint32_t bits[2], shift[2];
        std::size_t number; ///< 0: the coarsest; else that of the finer grid, and 1
    };
    Grid shaped(const Rectangle& rectangle, std::size_t first, std::uint32_t bits, std::size_t number) const;
    void divide(const Grid& grid, const Rectangle& rectangle, std::size_t first);
    void refine(const Grid& grid, const Rectangle& rectangle, std::size_t first);
    std::uint32_t block(const Rectangle& rectangle, std::size_t first);
    void fill(const Grid& grid, const Rectangle& rectangle, std::uint32_t entry);
    int best_axis(const Grid& grid, const Rectangle& rectangle, std::size_t first) const;

    const KeyBox* boxes_ = nullptr;
    Grid grid_ = {};
    std::size_t work_ = 0, most_words_ = 0; ///< work that is left
    bool complete_ = true;
    Growable<std::uint32_t> entries_, finer_, block_boxes_;
    Growable<std::uint16_t> block_cells_;
    Growable<std::uint16_t> list_; ///< a stack of lists of cells: of the rectangle, of both halves, of theirs
};

} // namespace acdf
