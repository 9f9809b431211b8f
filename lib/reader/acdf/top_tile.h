/* Trees of halvings whose top has codes of several rows, and which is shared below that: what mixtures of maps
 * (lib/indexed) and of normals (acdf/normal_rows.h) have in common. Part of these. */
#ifndef ACDF_TOP_TILE_H
#define ACDF_TOP_TILE_H

#include <acdf/sample.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ACDF_WEIGHTS 0x1p21       /* of a mixture: the sum of its weights */
#define ACDF_TOP_TILE 0x80000000u /* a child that is a tile: this and its number */

/* A node at which codes of rows end. All rows share what is below. */
typedef struct AcdfTopTile {
    double scale;      /* pdf over probability, sr^-1 */
    uint32_t node;     /* of the shared tree, or ACDF_LEAF */
    AcdfSpan steps[2]; /* of that tree's random numbers */
    AcdfSpan box[2];
} AcdfTopTile;

/* The array at an offset of tables that are flat words. */
#define ACDF_TOP_ARRAY(type, top, offset)                                                                          \
    ((const type*)(const void*)((const uint32_t*)(const void*)(top) + (offset)))

/* Whole numbers in proportion to weights that are > 0, none of which becomes 0. */
ACDF_FN void acdf_whole_weights(const double* weight, uint32_t count, uint32_t* whole) {
    double sum = 0.0;
    int32_t left = (int32_t)ACDF_WEIGHTS;
    uint32_t i, most = 0;
    for (i = 0; i < count; ++i) {
        sum += weight[i];
        if (weight[i] > weight[most]) most = i;
    }
    for (i = 0; i < count; ++i) {
        const int32_t rounded = (int32_t)(weight[i] / sum * ACDF_WEIGHTS + 0.5), own = rounded < 1 ? 1 : rounded;
        whole[i] = (uint32_t)own;
        left -= own;
    }
    whole[most] += (uint32_t)left;
}

/* Steps of both axes. */
ACDF_INLINE double acdf_steps_in(const AcdfSpan steps[2]) {
    return (double)(steps[0].end[1] - steps[0].end[0]) * (double)(steps[1].end[1] - steps[1].end[0]);
}

/* Rescales random numbers of a tile, which is no leaf, to those of the cell that they lead to. Returns the cell's
 * share. */
ACDF_OUTLINE_ON_CPU double acdf_tile_descend(const AcdfHalving* nodes, const AcdfTopTile* tile, double u[2],
                                             AcdfSpan box[2]) {
    AcdfSpan steps[2];
    uint32_t number[2];
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        const uint32_t low = tile->steps[axis].end[0], wide = tile->steps[axis].end[1] - low;
        const uint32_t step = (uint32_t)(u[axis] * (double)wide);
        steps[axis] = tile->steps[axis];
        number[axis] = low + (step < wide ? step : wide - 1u);
    }
    acdf_halvings_sample(nodes, tile->node, number, steps, box);
    for (axis = 0; axis < 2; ++axis) {
        const double wide = (double)(tile->steps[axis].end[1] - tile->steps[axis].end[0]);
        const double t = (u[axis] * wide - (double)(steps[axis].end[0] - tile->steps[axis].end[0])) /
                         (double)(steps[axis].end[1] - steps[axis].end[0]);
        u[axis] = acdf_clamp(t, 0.0, 1.0);
    }
    return acdf_steps_in(steps) / acdf_steps_in(tile->steps);
}

/* The cell of a tile that u[2] in [0, 1] lead to, and in which they are rescaled. Returns its share. */
ACDF_INLINE double acdf_tile_sample(const AcdfHalving* nodes, const AcdfTopTile* tile, double u[2],
                                    AcdfSpan box[2]) {
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    return tile->node == ACDF_LEAF ? 1.0 : acdf_tile_descend(nodes, tile, u, box);
}

/* The cell of a tile that holds a grid step of each axis. Returns its share. */
ACDF_INLINE double acdf_tile_find(const AcdfHalving* nodes, const AcdfTopTile* tile, const uint32_t position[2],
                                  AcdfSpan box[2]) {
    AcdfSpan steps[2];
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF) return 1.0;
    steps[0] = tile->steps[0];
    steps[1] = tile->steps[1];
    acdf_halvings_find(nodes, tile->node, position, steps, box);
    return acdf_steps_in(steps) / acdf_steps_in(tile->steps);
}

/* Pdf over probability in a box, sr^-1; `heights` are those of rows of lat-long grids. */
ACDF_INLINE double acdf_box_scale(const double* heights, const AcdfGrid* grid, const AcdfSpan box[2]) {
    const double height = acdf_grid_is_octahedral(grid)
                              ? 2.0 * (double)(box[1].end[1] - box[1].end[0]) / (double)grid->rows
                              : heights[box[1].end[0]] - heights[box[1].end[1]];
    return (double)grid->columns / (2.0 * ACDF_PI * (double)(box[0].end[1] - box[0].end[0]) * height);
}

/* The same of a cell of a tile. */
ACDF_INLINE double acdf_tile_scale(const double* heights, const AcdfGrid* grid, const AcdfTopTile* tile,
                                   const AcdfSpan box[2]) {
    return tile->node == ACDF_LEAF ? tile->scale : acdf_box_scale(heights, grid, box);
}

/* The direction that random numbers in [0, 1] pick in a box. */
ACDF_INLINE void acdf_box_direction(const double* heights, const AcdfGrid* grid, const AcdfSpan box[2],
                                    const double u[2], float direction[3]) {
    AcdfDirectionSample sample;
    AcdfRange range[2];
    int i;
    acdf_halved_ranges(box, range);
    if (acdf_grid_is_octahedral(grid)) sample = acdf_octahedral_position(grid, range, u, 1.0);
    else
        sample = acdf_sphere_position_between(grid->columns, range, u, 1.0, heights[range[1].low],
                                              heights[range[1].high]);
    for (i = 0; i < 3; ++i) direction[i] = sample.direction[i];
}

/* A pdf in the range of float: 0 stays 0. */
ACDF_INLINE float acdf_float_pdf(double pdf) { return pdf > 0.0 ? acdf_positive_pdf(pdf) : 0.0f; }

#ifdef __cplusplus
}
#endif
#endif
