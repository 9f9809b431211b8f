// Makes the grids of acdf/squares.h.
#pragma once

#include "tables/box_lists.h"
#include "tables/growable.h"

#include <acdf/squares.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// What the lists of blocks can name.
constexpr std::size_t kMostPieces = 65535;

/// The keys of an axis that may lead to a cell, ends included; below 2^31. None where low > high.
struct KeySpan {
    std::uint32_t low, high;
};

/// The keys that may lead to cells: those of each axis next to each other, as lists are divided along one.
class KeyBoxes {
public:
    explicit KeyBoxes(Scratch* scratch = nullptr) noexcept
        : spans_{Growable<KeySpan>(scratch), Growable<KeySpan>(scratch)} {}

    void add(const KeySpan& first, const KeySpan& second) noexcept {
        spans_[0].add(first);
        spans_[1].add(second);
    }
    bool reserve(std::size_t count) noexcept { return spans_[0].reserve(count) && spans_[1].reserve(count); }
    void cut(std::size_t count) noexcept {
        for (auto& spans : spans_) spans.cut(count);
    }
    std::size_t size() const noexcept { return spans_[1].size(); }
    bool failed() const noexcept { return spans_[0].failed() || spans_[1].failed(); }
    KeySpan* axis(int i) noexcept { return spans_[i].data(); }
    const KeySpan* axis(int i) const noexcept { return spans_[i].data(); }

private:
    Growable<KeySpan> spans_[2];
};

/// The arrays of an AcdfSquares.
class SquaresMaker {
public:
    explicit SquaresMaker(Scratch* scratch = nullptr) noexcept
        : entries_(scratch), finer_(scratch), block_boxes_(scratch), block_cells_(scratch), list_(scratch) {}

    /// Over boxes (at most 65536) of keys of `key_bits` bits. Boxes without keys of an axis are in no block. The
    /// work is in proportion to how many there are, whatever the boxes: where it would be more, entries name the
    /// empty block. Once there are more than `most_bytes` it ends, too. Returns false where memory fails.
    bool make(const KeyBoxes& boxes, std::uint32_t key_bits, std::size_t work_a_box = kUsualWork,
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
    /// Where the boxes of a list were written: sides are counted from its origin, in steps of 2^shift keys.
    struct Frame {
        std::uint32_t origin[2], shift[2];
    };
    static Frame framed(const Rectangle& rectangle);
    static Halving halving(const Rectangle& rectangle, const Frame& frame, int axis);
    ListedBox listed(std::size_t box, const Frame& frame) const;
    bool list_all(std::size_t count, const Frame& frame);
    Grid shaped(const Rectangle& rectangle, std::size_t first, std::uint32_t bits, std::size_t number) const;
    void divide(const Grid& grid, const Rectangle& rectangle, const Frame& frame, std::size_t first);
    void refine(const Grid& grid, const Rectangle& rectangle, const Frame& frame, std::size_t first);
    std::uint32_t block(const Rectangle& rectangle, std::size_t first);
    void fill(const Grid& grid, const Rectangle& rectangle, std::uint32_t entry);
    int best_axis(const Grid& grid, const Rectangle& rectangle, const Frame& frame, std::size_t first) const;

    const KeySpan* spans_[2] = {nullptr, nullptr}; ///< of each axis
    Grid grid_ = {};
    std::size_t work_ = 0, most_words_ = 0; ///< work that is left
    bool complete_ = true;
    Growable<std::uint32_t> entries_, finer_, block_boxes_;
    Growable<std::uint16_t> block_cells_;
    Growable<ListedBox> list_; ///< a stack of lists of cells: of the lower half of a rectangle, of the upper one
};

} // namespace acdf
