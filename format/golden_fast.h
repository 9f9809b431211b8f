// What the bins of the golden files of the fast shape share (make_golden.cpp).
#pragma once

#include "compress/store/store.h"

#include <acdf/sphere.h>

#include <cstdint>

constexpr std::uint32_t kGoldenFastLight = 9; ///< a tile

/// A tile for each of 12 columns above row 3 of 8 and one below, so that there are two groups; cells of 1 x 1, 1 x
/// 2 and 1 x 4 texels, dark lines and tiles.
inline acdf::compress::StoredRows golden_fast_rows() {
    constexpr std::uint32_t columns = 12, tiles = 24, row_count = 5;
    acdf::compress::StoredRows rows;
    for (std::uint32_t i = 0; i < columns; ++i) { // in preorder: a column is cut off, and divided
        const auto tile = static_cast<std::uint16_t>(ACDF_TILE_FLAG | (2 * i)),
                   next = static_cast<std::uint16_t>(2 * i);
        if (i + 1 < columns)
            rows.splits.push_back({ACDF_AXIS_PHI | (i + 1) << 3,
                                   {static_cast<std::uint16_t>(next + 1), static_cast<std::uint16_t>(next + 2)}});
        rows.splits.push_back({ACDF_AXIS_THETA | 3u << 3, {tile, static_cast<std::uint16_t>(tile + 1)}});
    }
    for (std::uint32_t i = 0; i < 256; ++i) rows.codebook.push_back(static_cast<std::uint16_t>(257 * i));
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
        rows.tile_roots.push_back(static_cast<std::uint32_t>(rows.grid.size()));
        const std::uint32_t length = tile % 2 == 0 ? 3 : 5, shift = tile % 3,
                            lines = (length + (1u << shift) - 1) >> shift;
        rows.grid.insert(rows.grid.end(), {0, static_cast<std::uint8_t>(shift)});
        for (std::uint32_t i = 0; i < lines; ++i) // the second one of three and more is dark
            rows.grid.push_back(
                static_cast<std::uint8_t>(i + 1 == lines ? 255 : 40 + 30 * (i == 1 && lines > 2 ? 0 : i)));
        rows.grid.insert(rows.grid.end(), lines, 255);
    }
    rows.grid.insert(rows.grid.end(), ACDF_FAST_CELLS, 0);
    rows.row_count = row_count;
    for (std::uint32_t r = 0; r < row_count; ++r)
        for (std::uint32_t g = 0; g < 16; ++g) {
            const std::uint32_t end = g == 0 ? 5000 * (r + 1) : 32767;
            rows.sums.insert(rows.sums.end(),
                             {static_cast<std::uint8_t>(end), static_cast<std::uint8_t>(end >> 8)});
        }
    for (std::uint32_t r = 0; r < row_count; ++r)
        for (std::uint32_t tile = 0; tile < 32; ++tile) {
            const std::uint32_t i = tile == kGoldenFastLight ? tile % 16 - 1 : tile % 16, last = tile < 16 ? 15 : 7;
            rows.sums.push_back(static_cast<std::uint8_t>(i >= last ? 255 : (7 + 2 * r) * (i + 1)));
        }
    return rows;
}
