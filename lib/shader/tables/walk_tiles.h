// Words of the fast shape for shaders (acdf/shader/tiles.h).
#pragma once

#include "tables/growable.h"

#include <acdf/local.h>
#include <acdf/shader/grids.h>

namespace acdf {

/// Tiles, sums and grids nearly as they lie in the file; and sines.
class WalkTiles {
public:
    static constexpr std::size_t header_words = ACDF_TILES_END - ACDF_WALK_HEADER_WORDS;

    /// False where memory fails, and for sums or grids of 4 GiB.
    bool make(const AcdfLocal& local) noexcept;
    /// Of all; the header stands behind that of trees.
    std::size_t words() const noexcept { return words_; }
    /// Writes the header, and what it refers to from word `at` on.
    void place(const AcdfLocal& local, std::uint32_t* words, std::size_t at) const noexcept;

private:
    struct Record {
        std::uint32_t lows, sides, ends, rest;
    };

    void add(const AcdfLocal& local, std::uint32_t tile) noexcept;

    Growable<Record> records_;
    Growable<float> sines_;
    std::size_t grid_bytes_ = 0, words_ = 0;
};

} // namespace acdf
