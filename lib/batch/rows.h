// Tiles of rows of halvings (acdf/normal_rows.h) of many calls at once. Each search takes a step in turn, so that
// no load waits for another, and no branch depends on where it leads.
#pragma once

#include "batch/descents.h"

#include <acdf/normal_rows.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace acdf::batch {

inline const std::uint32_t* row_ends(const AcdfNormalRows* rows, std::uint32_t row) {
    return ACDF_TOP_ARRAY(std::uint32_t, rows, rows->ends) + std::size_t{row} * rows->group_stride;
}

struct Tiles {
    alignas(64) double u[2][kBlock];          // in the tile, in the end
    alignas(64) double probability[kBlock];   // of the tile
    alignas(64) double wide[2][kBlock];       // steps of the tile; 1 of a leaf, which then changes nothing
    alignas(64) std::uint32_t low[kBlock][2]; // where they begin
    std::uint32_t tile[kBlock];
    Descents descents;

    // The k-th row that serves a call, and its weight. All calls have as many: what is added weighs 0.
    void set(std::size_t i, int k, const std::uint32_t* ends, const std::uint32_t* before, double weight) {
        ends_[k][i] = ends;
        before_[k][i] = before;
        weight_[k][i] = weight;
    }

    // acdf_rows_sample_tile of u, then the descent in the tile.
    template <int most>
    void sample(const AcdfNormalRows* rows, const AcdfHalving* nodes, std::size_t count) {
        const std::uint32_t* first = acdf_row_first(rows);
        for (std::size_t i = 0; i < count; ++i) {
            below_[i] = 0.0;
            mass_[i] = 0x1p52;
            from_[i] = 0;
            to_[i] = rows->groups;
        }
        search<most>(ends_, u[0], rows->groups, count);
        std::uint32_t longest = 1;
        for (std::size_t i = 0; i < count; ++i) {
            to_[i] = first[from_[i] + 1u];
            from_[i] = first[from_[i]];
            longest = std::max(longest, to_[i] - from_[i]);
            for (std::uint32_t at = from_[i] & ~15u; at <= to_[i]; at += 16u)
                for (int k = 0; k < most; ++k) ACDF_PREFETCH(before_[k][i] + at);
        }
        search<most>(before_, u[1], longest, count);
        for (std::size_t i = 0; i < count; ++i) {
            tile[i] = from_[i];
            ACDF_PREFETCH(acdf_row_tile(rows, tile[i]));
            probability[i] = mass_[i] * 0x1p-52;
        }
        begin(rows, nodes, count);
        for (std::size_t i = 0; i < count; ++i)
            for (int axis = 0; axis < 2; ++axis) {
                const auto wide_steps = static_cast<std::uint32_t>(wide[axis][i]);
                const auto step = static_cast<std::uint32_t>(u[axis][i] * wide[axis][i]);
                descents.target[i][axis] = low[i][axis] + (step < wide_steps ? step : wide_steps - 1u);
            }
        descents.sample(nodes);
    }

    // acdf_rows_find_tile of targets, and what of all samples it has, then the descent in the tile.
    template <int most>
    void find(const AcdfNormalRows* rows, const AcdfHalving* nodes, std::size_t count) {
        find_tiles(rows, count);
        for (std::size_t i = 0; i < count; ++i)
            for (int k = 0; k < most; ++k) ACDF_PREFETCH(before_[k][i] + tile[i]);
        begin(rows, nodes, count);
        for (std::size_t i = 0; i < count; ++i)
            probability[i] = (sum<most>(before_, i, tile[i] + 1u) - sum<most>(before_, i, tile[i])) * 0x1p-52;
        descents.find(nodes);
    }

private:
    using Rows = const std::uint32_t* [ACDF_MOST_ROWS_MIXED][kBlock];

    template <int most>
    double sum(const Rows& rows, std::size_t i, std::uint32_t at) const {
        double out = weight_[0][i] * static_cast<double>(rows[0][i][at]);
        for (int k = 1; k < most; ++k) out += weight_[k][i] * static_cast<double>(rows[k][i][at]);
        return out;
    }

    // acdf_rows_search, from `from_` to `to_`, which are at most `longest` apart.
    template <int most>
    void search(const Rows& rows, double* number, std::uint32_t longest, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const double x = number[i] * mass_[i], down = static_cast<double>(static_cast<std::int64_t>(x));
            number[i] = x;
            at_[i] = below_[i] + (down < mass_[i] ? down : mass_[i] - 1.0);
        }
        std::uint32_t step = 1;
        while (step < longest) step *= 2;
        while (step /= 2)
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t middle = std::min(from_[i] + step, to_[i]);
                from_[i] += step & (0u - static_cast<std::uint32_t>(sum<most>(rows, i, middle) <= at_[i]));
            }
        for (std::size_t i = 0; i < count; ++i) {
            const double lower = sum<most>(rows, i, from_[i]), upper = sum<most>(rows, i, from_[i] + 1u);
            number[i] = acdf_clamp((number[i] - (lower - below_[i])) / (upper - lower), 0.0, 1.0);
            below_[i] = lower;
            mass_[i] = upper - lower;
        }
    }

    // Where a search for a tile is: at a split, or ACDF_TOP_TILE | a tile.
    void find_tiles(const AcdfNormalRows* rows, std::size_t count) {
        const AcdfRowSplit* splits = acdf_row_splits(rows);
        const std::uint32_t* starts = ACDF_TOP_ARRAY(std::uint32_t, rows, rows->starts);
        const std::uint32_t root = rows->splits ? 0 : ACDF_TOP_TILE;
        std::size_t open = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t* position = descents.target[i];
            const auto x = static_cast<std::uint32_t>(std::uint64_t{position[0]} * rows->position_scale[0] >> 32);
            const auto y = static_cast<std::uint32_t>(std::uint64_t{position[1]} * rows->position_scale[1] >> 32);
            tile[i] = rows->bits ? starts[y << rows->bits | x] : root;
            from_[open] = static_cast<std::uint32_t>(i);
            open += !(tile[i] & ACDF_TOP_TILE);
        }
        while (open > 0) {
            std::size_t left = 0;
            for (std::size_t k = 0; k < open; ++k) {
                const std::uint32_t i = from_[k];
                const AcdfRowSplit& split = splits[tile[i]];
                tile[i] = split.child[descents.target[i][split.place & 1u] >= split.place >> 1];
                from_[left] = i;
                left += !(tile[i] & ACDF_TOP_TILE);
            }
            open = left;
        }
        for (std::size_t i = 0; i < count; ++i) {
            tile[i] &= ~ACDF_TOP_TILE;
            ACDF_PREFETCH(acdf_row_tile(rows, tile[i]));
        }
    }

    // Begins descents in tiles.
    void begin(const AcdfNormalRows* rows, const AcdfHalving* nodes, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const AcdfTopTile* at = acdf_row_tile(rows, tile[i]);
            const bool leaf = at->node == ACDF_LEAF;
            for (int axis = 0; axis < 2; ++axis) {
                const std::uint32_t from = leaf ? 0u : at->steps[axis].end[0],
                                    to = leaf ? 1u : at->steps[axis].end[1];
                descents.box[i][axis] = at->box[axis];
                descents.steps[i][axis] = {{from, to}};
                low[i][axis] = from;
                wide[axis][i] = static_cast<double>(to - from);
            }
            descents.begin(i, at->node);
            if (!leaf) ACDF_PREFETCH(nodes + at->node);
        }
    }

    double weight_[ACDF_MOST_ROWS_MIXED][kBlock];
    Rows ends_, before_;
    double below_[kBlock], mass_[kBlock], at_[kBlock];
    std::uint32_t from_[kBlock], to_[kBlock];
};

} // namespace acdf::batch
