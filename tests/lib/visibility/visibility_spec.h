// Chunk PLAC, from format/SPEC.md alone.
#pragma once

#include "tests/lib/reader/files.h"

#include <vector>

namespace acdf_test {

constexpr std::uint32_t visibility_row = 0x10000000;

struct VisibilitySplitSpec {
    float position;
    std::uint32_t axis;
    std::uint32_t part[2]; ///< a split, or visibility_row | a row
};

constexpr std::uint16_t no_lower_column = 0x8000;

struct ColumnSpec {
    std::uint16_t tile, parts; ///< parts: the column of the upper part, or 0; and no_lower_column
};

struct VisibilitySpec {
    float low[3] = {-1.0f, -2.0f, 0.0f}, high[3] = {3.0f, 2.0f, 4.0f};
    float transform[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    std::vector<VisibilitySplitSpec> splits;
    std::uint32_t further_sets = 0;
    std::vector<ColumnSpec> columns;       ///< set by set
    std::vector<std::uint16_t> set_of_row; ///< empty, or one a row
    std::vector<Bytes> rows;

    Bytes encode() const {
        Bytes out;
        for (std::size_t v :
             {splits.size(), rows.size(), columns.size() / (1 + further_sets), std::size_t{further_sets}})
            put32(out, static_cast<std::uint32_t>(v));
        for (float x : low) put_float(out, x);
        for (float x : high) put_float(out, x);
        for (float x : transform) put_float(out, x);
        for (const VisibilitySplitSpec& split : splits) {
            put_float(out, split.position);
            put32(out, split.axis | split.part[0] << 3);
            put32(out, split.part[1]);
        }
        for (const ColumnSpec& column : columns) {
            put16(out, column.tile);
            put16(out, column.parts);
        }
        for (std::uint16_t set : set_of_row) put16(out, set);
        for (const Bytes& row : rows) out.insert(out.end(), row.begin(), row.end());
        return out;
    }
};

} // namespace acdf_test
