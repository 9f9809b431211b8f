// Chunk PORT, from format/SPEC.md alone.
#pragma once

#include "tests/lib/reader/files.h"

#include <array>
#include <vector>

namespace acdf_test {

struct PortalSpec {
    float corner[3];
    float sides[2];
    std::uint32_t map;
};

struct PortalMapSpec {
    float axis[9];
    float unit;
    std::vector<std::uint32_t> light; ///< of its cells, axis 0 first
};

struct PortalsSpec {
    std::uint32_t size = 4, pieces = 2;
    std::vector<PortalSpec> portals;
    std::vector<PortalMapSpec> maps;
    std::vector<Bytes> rows; ///< one a row of visibility cells

    Bytes encode() const {
        Bytes out;
        for (std::size_t v : {portals.size(), maps.size(), std::size_t{size}, std::size_t{pieces}})
            put32(out, static_cast<std::uint32_t>(v));
        for (const PortalSpec& portal : portals) {
            for (float x : portal.corner) put_float(out, x);
            for (float x : portal.sides) put_float(out, x);
            put32(out, portal.map);
        }
        for (const PortalMapSpec& map : maps) {
            for (float x : map.axis) put_float(out, x);
            put_float(out, map.unit);
        }
        for (const PortalMapSpec& map : maps)
            for (std::uint32_t row = 0; row <= size; ++row)
                for (std::uint32_t column = 0; column <= size; ++column) put32(out, sum(map, column, row));
        for (const Bytes& row : rows) out.insert(out.end(), row.begin(), row.end());
        return out;
    }

private:
    std::uint32_t sum(const PortalMapSpec& map, std::uint32_t column, std::uint32_t row) const {
        std::uint32_t all = 0;
        for (std::uint32_t r = 0; r < row; ++r)
            for (std::uint32_t c = 0; c < column; ++c) all += map.light[r * size + c];
        return all;
    }
};

} // namespace acdf_test
