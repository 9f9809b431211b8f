/* The grid of directions that the positions of a file lie on: lat-long (acdf/sphere.h) or the octahedral square
 * (acdf/octahedral.h). What is sampled, searched and weighted on both. */
#ifndef ACDF_GRID_H
#define ACDF_GRID_H

#include <acdf/octahedral.h>
#include <acdf/sphere.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfGrid {
    uint32_t columns, rows;    /* steps of axis 0 and of axis 1 */
    uint32_t parameterization; /* ACDF_PARAM_OCTAHEDRAL; all else is ACDF_PARAM_LATLONG */
} AcdfGrid;

ACDF_FN int acdf_grid_is_octahedral(const AcdfGrid* grid) {
    return grid->parameterization == ACDF_PARAM_OCTAHEDRAL;
}

/* The part of a cell's solid angle that its rows make: the difference of z, on the square that of 2 v. */
ACDF_FN double acdf_grid_height(const AcdfGrid* grid, const AcdfRange* rows) {
    if (acdf_grid_is_octahedral(grid)) return 2.0 * (double)(rows->high - rows->low) / (double)grid->rows;
    return acdf_row_z(rows->low, grid->rows) - acdf_row_z(rows->high, grid->rows);
}

/* Solid angle of a cell, sr. */
ACDF_FN double acdf_grid_solid_angle(const AcdfGrid* grid, const AcdfRange range[2]) {
    return 2.0 * ACDF_PI * (double)(range[0].high - range[0].low) / (double)grid->columns *
           acdf_grid_height(grid, &range[1]);
}

/* Pdf per steradian in a cell of probability p. */
ACDF_FN float acdf_grid_pdf(const AcdfGrid* grid, const AcdfRange range[2], double p) {
    return acdf_cell_pdf(p, range[0].high - range[0].low, grid->columns, acdf_grid_height(grid, &range[1]));
}

/* A position on one axis of the square, at fraction t of a range, ACDF_BORDER inside it. */
ACDF_FN double acdf_octahedral_position_on(const AcdfRange* range, double t, uint32_t resolution) {
    const double border = (double)resolution * (0.5 * ACDF_BORDER), low = (double)range->low;
    const double at = low + t * (double)(range->high - range->low);
    return acdf_clamp(at, low + border, (double)range->high - border) / (double)resolution;
}

/* The direction at the rescaled random numbers u in a cell of probability p of an octahedral square. */
ACDF_FN AcdfDirectionSample acdf_octahedral_position(const AcdfGrid* grid, const AcdfRange range[2],
                                                     const double u[2], double p) {
    AcdfDirectionSample out;
    double d[3];
    int i;
    acdf_octahedral_direction(acdf_octahedral_position_on(&range[0], u[0], grid->columns),
                              acdf_octahedral_position_on(&range[1], u[1], grid->rows), d);
    for (i = 0; i < 3; ++i) out.direction[i] = (float)d[i];
    out.pdf = acdf_grid_pdf(grid, range, p);
    return out;
}
/* The same of either grid. */
ACDF_FN AcdfDirectionSample acdf_grid_position(const AcdfGrid* grid, const AcdfRange range[2], const double u[2],
                                               double p) {
    if (acdf_grid_is_octahedral(grid)) return acdf_octahedral_position(grid, range, u, p);
    return acdf_sphere_position(grid->columns, grid->rows, range, u, p);
}

/* The grid square of a direction, and where on the axes it lies (of lat-long grids axis 0 alone). Returns 0 for
 * directions that are NaN or whose length differs from 1 by more than about 5e-4. */
ACDF_FN int acdf_grid_square(const AcdfGrid* grid, const float direction[3], uint32_t square[2],
                             double position[2]) {
    const double d[3] = {direction[0], direction[1], direction[2]};
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    position[1] = 0.0;
    if (!acdf_grid_is_octahedral(grid))
        return acdf_sphere_square(grid->columns, grid->rows, direction, square, &position[0]);
    if (!acdf_are_finite(direction) || !(length > 0.9995 && length < 1.0005)) return 0;
    acdf_octahedral_point(d, &position[0], &position[1]);
    position[0] *= (double)grid->columns;
    position[1] *= (double)grid->rows;
    square[0] = (uint32_t)position[0] < grid->columns ? (uint32_t)position[0] : grid->columns - 1;
    square[1] = (uint32_t)position[1] < grid->rows ? (uint32_t)position[1] : grid->rows - 1;
    return 1;
}

/* The fractions t[axis] at which a direction lies across its cell, in the measures of the axes. */
ACDF_FN void acdf_grid_fractions(const AcdfGrid* grid, const float direction[3], const double position[2],
                                 const AcdfRange range[2], double t[2]) {
    int i;
    if (!acdf_grid_is_octahedral(grid)) {
        const double z0 = acdf_row_z(range[1].low, grid->rows);
        acdf_sphere_fractions(direction, position[0], range, z0, z0 - acdf_row_z(range[1].high, grid->rows), t);
        return;
    }
    for (i = 0; i < 2; ++i)
        t[i] = acdf_clamp((position[i] - (double)range[i].low) / (double)(range[i].high - range[i].low), 0.0, 1.0);
}

#ifdef __cplusplus
}
#endif
#endif
