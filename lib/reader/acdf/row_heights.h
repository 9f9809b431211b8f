/* Cells of a lat-long grid by a table of the heights between its rows: directions in floats, as acdf/cells.h draws
 * them, and densities without trigonometry. Cells without tilts. */
#ifndef ACDF_ROW_HEIGHTS_H
#define ACDF_ROW_HEIGHTS_H

#include <acdf/pieces.h>
#include <acdf/sphere.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Floats stay this angle (radians) inside a cell: four times ACDF_BORDER. */
#define ACDF_FLOAT_BORDER 0x1p-20

/* acdf_grid_pdf of a cell of probability p; z[i] is acdf_row_z of row i. */
ACDF_INLINE float acdf_row_pdf(const double* z, uint32_t columns, const AcdfRange range[2], double p) {
    return acdf_cell_pdf(p, range[0].high - range[0].low, columns, z[range[1].low] - z[range[1].high], 1.0);
}

/* acdf_sphere_place but for the rounding of floats. Returns 0, and leaves `out`, next to the borders of a cell or
 * to a pole, and where there are tilts. */
ACDF_INLINE int acdf_row_place(const double* z, uint32_t columns, const AcdfRange range[2], const double u[2],
                               double p, AcdfDirectionSample* out) {
    const double border = (double)columns * (ACDF_FLOAT_BORDER / (2.0 * ACDF_PI));
    const double west = u[0] * (double)(range[0].high - range[0].low), x = (double)range[0].low + west;
    const double z0 = z[range[1].low], z1 = z[range[1].high], height = z0 + u[1] * (z1 - z0);
    const double cap = 1.0 - fabs(height), from_pole = ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER;
    const double least = (z0 - height < height - z1 ? z0 - height : height - z1);
    const double turn = 1.0 - 2.0 * x / (double)columns;
    const int32_t quarter = (int32_t)(2.0 * turn + 4.5) - 4; /* as in acdf_sincospi */
    AcdfVector d;
    /* The sine of the angle to the pole is below sqrt(2 cap). */
    if (west < border || (double)range[0].high - x < border || cap < from_pole ||
        least * least < 2.0 * ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER * cap || range[0].tilt != 0.0 ||
        range[1].tilt != 0.0)
        return 0;
    d = acdf_piece_direction((float)((turn - 0.5 * quarter) * ACDF_PI), (float)cap, (uint32_t)quarter & 3u,
                             (uint32_t)(height < 0.0));
    out->direction[0] = d.x;
    out->direction[1] = d.y;
    out->direction[2] = d.z;
    out->pdf = acdf_row_pdf(z, columns, range, p);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
