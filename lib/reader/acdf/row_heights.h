/* Grids in floats, where these are sure to tell what acdf/grid.h does: the square of a direction, and the
 * directions of cells, as acdf/cells.h draws them; on lat-long grids (acdf_row_...) by a table of the heights
 * between rows, and densities without trigonometry. Cells without tilts. */
#ifndef ACDF_ROW_HEIGHTS_H
#define ACDF_ROW_HEIGHTS_H

#include <acdf/cells.h>
#include <acdf/grid.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Floats stay this angle (radians) inside a cell: four times ACDF_BORDER. */
#define ACDF_FLOAT_BORDER 0x1p-20f

/* The angle of (x, y) from the x axis in turns, from -1/2 to 1/2; within 2^-21 radians of acdf_atan2pi. */
ACDF_INLINE float acdf_turn_float(float y, float x) {
    const float ax = fabsf(x), ay = fabsf(y);
    /* Signs are multiplied by, as there. */
    const float level = copysignf(1.0f, ax - ay), east = copysignf(1.0f, x);
    const float eighth = acdf_atan_float((ay < ax ? ay : ax) / (ay > ax ? ay : ax)) * (float)(0.5 / ACDF_PI);
    const float quarter = (0.125f - 0.125f * level) + level * eighth;
    return copysignf((0.25f - 0.25f * east) + east * quarter, y);
}

/* Whether a place on an axis lies surely in the step that it is rounded down to. */
ACDF_INLINE int acdf_sure_step(float place, float border, uint32_t* step) {
    const int32_t whole = (int32_t)place;
    const float inside = place - (float)whole;
    *step = (uint32_t)whole;
    return inside > border && inside < 1.0f - border;
}

/* acdf_sphere_square without where the direction lies. Returns 0 where floats do not tell: next to the borders of
 * squares and to the poles, for directions whose length differs from 1 by more than 5e-5 or that are not finite. */
ACDF_INLINE int acdf_row_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2]) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float sin2 = x * x + y * y, length2 = sin2 + z * z;
    const float border = 2.0f * ACDF_FLOAT_BORDER * (float)(0.5 / ACDF_PI);
    if (!acdf_is_direction(sin2, length2)) return 0;
    return acdf_sure_step((float)columns * (0.5f - acdf_turn_float(y, x)), (float)columns * border, &square[0]) &
           acdf_sure_step((float)rows * 2.0f * acdf_turn_float(sqrtf(sin2), z), (float)rows * 2.0f * border,
                          &square[1]);
}

/* acdf_grid_pdf of a cell of probability p; z[i] is acdf_row_z of row i. */
ACDF_INLINE float acdf_row_pdf(const double* z, uint32_t columns, const AcdfRange range[2], double p) {
    return acdf_cell_pdf(p, range[0].high - range[0].low, columns, z[range[1].low] - z[range[1].high], 1.0);
}

/* The direction of acdf_sphere_place but for the rounding of floats. Returns 0, and leaves `out`, next to the
 * borders of a cell or to a pole, and where there are tilts. */
ACDF_INLINE int acdf_row_direction(const double* z, uint32_t columns, const AcdfRange range[2], const double u[2],
                                   float out[3]) {
    const double border = (double)columns * (ACDF_FLOAT_BORDER / (2.0 * ACDF_PI));
    const double west = u[0] * (double)(range[0].high - range[0].low), x = (double)range[0].low + west;
    const double z0 = z[range[1].low], z1 = z[range[1].high], height = z0 + u[1] * (z1 - z0);
    const double cap = 1.0 - fabs(height), from_pole = ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER;
    const double from_north = z0 - height, from_south = height - z1;
    const double least = from_north < from_south ? from_north : from_south; /* in one instruction */
    const double turn = 1.0 - x * (2.0 / (double)columns);                  /* the quotient waits for nothing */
    const int32_t quarter = (int32_t)(2.0 * turn + 4.5) - 4;                /* as in acdf_sincospi */
    AcdfVector d;
    /* The sine of the angle to the pole is below sqrt(2 cap). */
    if (west < border || (double)range[0].high - x < border || cap < from_pole ||
        least * least < 2.0 * ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER * cap || range[0].tilt != 0.0 ||
        range[1].tilt != 0.0)
        return 0;
    d = acdf_piece_direction((float)((turn - 0.5 * quarter) * ACDF_PI), (float)cap, (uint32_t)quarter & 3u,
                             (uint32_t)(height < 0.0));
    out[0] = d.x;
    out[1] = d.y;
    out[2] = d.z;
    return 1;
}

/* The same with its density, in a cell of probability p. */
ACDF_INLINE int acdf_row_place(const double* z, uint32_t columns, const AcdfRange range[2], const double u[2],
                               double p, AcdfDirectionSample* out) {
    if (!acdf_row_direction(z, columns, range, u, out->direction)) return 0;
    out->pdf = acdf_row_pdf(z, columns, range, p);
    return 1;
}

/* ---- the octahedral square -------------------------------------------------------------------------- */

/* The part of the square's side that is at least ACDF_FLOAT_BORDER: ACDF_OCTAHEDRAL_LEAST_SPEED. */
#define ACDF_FOLD_BORDER (0.5f * ACDF_FLOAT_BORDER)

/* As acdf_row_square. */
ACDF_INLINE int acdf_fold_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2]) {
    AcdfPlace place;
    if (!acdf_direction_place(1, direction, &place)) return 0;
    return acdf_sure_step((float)columns * (0.5f - 0.5f * place.slope), (float)columns * 2.0f * ACDF_FOLD_BORDER,
                          &square[0]) &
           acdf_sure_step((float)rows * (0.5f + 0.5f * place.cap), (float)rows * 2.0f * ACDF_FOLD_BORDER,
                          &square[1]);
}

/* As acdf_row_direction; poles are no borders. */
ACDF_INLINE int acdf_fold_direction(const AcdfGrid* grid, const AcdfRange range[2], const double u[2],
                                    float out[3]) {
    const double width[2] = {(double)(range[0].high - range[0].low), (double)(range[1].high - range[1].low)};
    const double from[2] = {u[0] * width[0], u[1] * width[1]};
    const double border[2] = {(double)grid->columns * ACDF_FOLD_BORDER, (double)grid->rows * ACDF_FOLD_BORDER};
    AcdfVector d;
    if (from[0] < border[0] || width[0] - from[0] < border[0] || from[1] < border[1] ||
        width[1] - from[1] < border[1] || range[0].tilt != 0.0 || range[1].tilt != 0.0)
        return 0;
    d = acdf_square_direction((float)(1.0 - 2.0 * ((double)range[0].low + from[0]) / (double)grid->columns),
                              (float)(2.0 * ((double)range[1].low + from[1]) / (double)grid->rows - 1.0));
    out[0] = d.x;
    out[1] = d.y;
    out[2] = d.z;
    return 1;
}

/* As acdf_row_place. */
ACDF_INLINE int acdf_fold_place(const AcdfGrid* grid, const AcdfRange range[2], const double u[2], double p,
                                AcdfDirectionSample* out) {
    const double half[2] = {0.5, 0.5};
    if (!acdf_fold_direction(grid, range, u, out->direction)) return 0;
    out->pdf = acdf_grid_pdf(grid, range, half, p);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
