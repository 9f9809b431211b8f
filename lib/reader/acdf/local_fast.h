/* Draws and densities in local environment maps of the fast shape (acdf/fast.h). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_FAST_H
#define ACDF_LOCAL_FAST_H

#include <acdf/local_point.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The grid of a tile and its box, by tables. */
ACDF_INLINE AcdfFastGrid acdf_local_fast_record(const AcdfLocal* local, uint32_t tile, AcdfRange* range) {
    const AcdfTileRecord* record = acdf_local_tile(local->tables, tile);
    AcdfFastGrid out;
    int axis;
    out.ends = local->fast.grid + record->root + 2;
    for (axis = 0; axis < 2; ++axis) {
        out.shift[axis] = record->step[axis];
        out.count[axis] = record->step[2 + axis];
    }
    acdf_tile_range(record, range);
    return out;
}

/* The grid of a tile that was drawn, and its box. */
ACDF_INLINE AcdfFastGrid acdf_local_fast_drawn(const AcdfLocal* local, uint32_t tile, AcdfRange* range) {
    uint32_t node = acdf_blend_root(&local->blend), before = 0;
    if (local->tables) return acdf_local_fast_record(local, tile, range);
    /* Splits and tiles are numbered as the walk meets them; a part has a tile more than splits. */
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &local->blend.splits[node];
        const uint32_t upper = split->child[1];
        const uint32_t first = upper & ACDF_TILE_FLAG ? upper & ~ACDF_TILE_FLAG : before + (upper - node);
        const int in_upper = tile >= first;
        acdf_range_cut(&range[split->place & 7u], split->place >> 3, in_upper);
        if (in_upper) before = first;
        node = split->child[in_upper];
    }
    return acdf_fast_grid(&local->fast, local->blend.roots[tile], range);
}

/* The tile of a square; *grid and range become its own. */
ACDF_INLINE uint32_t acdf_local_fast_found(const AcdfLocal* local, const uint32_t* square, AcdfFastGrid* grid,
                                           AcdfRange* range) {
    uint32_t node = acdf_blend_root(&local->blend);
    if (local->tables) {
        node = acdf_tile_at(acdf_local_words(local->tables), &local->tables->tiles, square);
        *grid = acdf_local_fast_record(local, node, range);
        return node;
    }
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &local->blend.splits[node];
        const uint32_t axis = split->place & 7u, position = split->place >> 3;
        const int in_upper = square[axis] >= position;
        acdf_range_cut(&range[axis], position, in_upper);
        node = split->child[in_upper];
    }
    node &= ~ACDF_TILE_FLAG;
    *grid = acdf_fast_grid(&local->fast, local->blend.roots[node], range);
    return node;
}

/* acdf_local_blend_sample of this shape. */
ACDF_FN double acdf_local_fast_sample(const AcdfLocal* local, const AcdfLocalPoint* point, double* u,
                                      AcdfRange* range) {
    double probability;
    uint32_t tile;
    const AcdfLight* light = acdf_local_draw_light(local, point, u, &probability);
    AcdfFastGrid grid;
    if (light) {
        tile = light->tile;
        probability = acdf_positive(probability / point->sum);
    } else {
        tile = acdf_fast_draw_tile(&local->fast, &point->fast, u, &probability);
        probability = acdf_positive(acdf_mixture_sum(&point->mix) / point->sum * probability);
    }
    grid = acdf_local_fast_drawn(local, tile, range);
    return acdf_positive(probability * acdf_fast_draw_cell(&grid, u, range));
}

/* acdf_local_blend_find of this shape. */
ACDF_FN double acdf_local_fast_find(const AcdfLocal* local, const AcdfLocalPoint* point, const uint32_t* square,
                                    AcdfRange* range) {
    AcdfFastGrid grid;
    const uint32_t tile = acdf_local_fast_found(local, square, &grid, range);
    const double inside = acdf_fast_find_cell(&grid, square, range);
    const double probability = acdf_local_tile_probability(local, point, tile, acdf_fast_share(&point->fast, tile));
    return probability > 0.0 && inside > 0.0 ? acdf_positive(probability * inside) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
