// Words of several maps for shaders (acdf/shader/maps.h).
#pragma once

#include "shader/tables/growable.h"

#include <acdf/indexed/indexed.h>
#include <acdf/shader/maps.h>

namespace acdf {

/// Coordinates, suns, and what each map gives to the parts of splits.
class WalkMaps {
public:
    /// False where memory fails.
    bool make(const AcdfIndexed& maps) noexcept;
    std::size_t words() const noexcept { return words_.size(); }
    /// Writes them from word `at` on.
    void place(std::uint32_t* words, std::size_t at) const noexcept;

private:
    void add_coordinates(const AcdfIndexed& maps) noexcept;
    void add_maps(const AcdfIndexed& maps) noexcept;
    bool add_shares(const AcdfTop& top) noexcept;

    Growable<std::uint32_t> words_; ///< offsets count from their beginning
};

} // namespace acdf
