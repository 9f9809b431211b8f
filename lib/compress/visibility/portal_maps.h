// Portals of a scene, and maps of the light that they face.
#pragma once

#include "compress/target.h"

#include <acdf/visibility/portals.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A rectangle that light comes through, among the cells of visibility: a corner and two sides at right angles.
/// Light comes from the side that across x up points to.
struct PortalRectangle {
    std::array<double, 3> corner{}, across{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0};
};

/// All of chunk PORT but its rows.
struct PortalSet {
    AcdfPortals header{};
    std::vector<AcdfPortal> portals;
    std::vector<AcdfPortalMap> maps;
    std::vector<std::uint32_t> sums; ///< (size + 1)^2 a map

    /// A view into this, with rows of the chunk.
    AcdfPortalTable table(const std::uint8_t* rows) const {
        return {&header, portals.data(), maps.data(), sums.data(), rows};
    }
    std::size_t row_bytes() const { return 1 + std::size_t{header.portal_count} * header.pieces * header.pieces; }
    std::size_t bytes() const {
        return sizeof header + portals.size() * sizeof(AcdfPortal) + maps.size() * sizeof(AcdfPortalMap) +
               sums.size() * sizeof(std::uint32_t);
    }
};

/// Throws std::invalid_argument where a rectangle, portal `number` from 0, is none.
void check_rectangle(const PortalRectangle& rectangle, std::size_t number);

/// Maps of the light of `target`, a probe; those of portals that face the same way are one. They take `bytes` at
/// most, as far as that can be. The same for any number of threads. Throws std::invalid_argument where a rectangle
/// is none, or no light reaches it from outside, and where there are more than ACDF_MAX_PORTALS.
PortalSet make_portals(const Target& target, const std::vector<PortalRectangle>& rectangles, std::uint64_t bytes);

} // namespace acdf::compress
