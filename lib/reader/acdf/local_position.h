/* Between directions and squares of a local environment map, by runtime tables where there are some. Part of
 * acdf/local.h. */
#ifndef ACDF_LOCAL_POSITION_H
#define ACDF_LOCAL_POSITION_H

#include <acdf/local_point.h>
#include <acdf/row_heights.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The square of a direction, as acdf_grid_square finds it. */
ACDF_INLINE int acdf_local_square(const AcdfGrid* grid, const float direction[3], uint32_t square[2]) {
    double position[2];
    return (acdf_grid_is_octahedral(grid) ? acdf_fold_square(grid->columns, grid->rows, direction, square)
                                          : acdf_row_square(grid->columns, grid->rows, direction, square)) ||
           acdf_grid_square(grid, direction, square, position);
}

/* The direction that what is left of the random numbers picks in a cell. Returns 0, and leaves `out`, where tables
 * have no answer. */
ACDF_INLINE int acdf_local_direction_by_tables(const AcdfLocal* local, const AcdfGrid* grid,
                                               const AcdfRange range[2], const double u[2], float out[3]) {
    if (!local->tables) return 0;
    if (local->tables->octahedral) return acdf_fold_direction(grid, range, u, out);
    return acdf_row_direction(acdf_local_heights(local->tables), grid->columns, range, u, out);
}

#ifdef __cplusplus
}
#endif
#endif
