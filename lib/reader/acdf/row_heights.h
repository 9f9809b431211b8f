/* Grids in floats, where these are sure to agree with acdf/grid.h: the square of a direction, and the
 * directions of cells, as acdf/cells.h samples them; on lat-long grids (acdf_row_...) by a table of the heights
 * between rows, and pdfs without trigonometry. Cells without tilts. */
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

/* Whether a position on an axis lies surely in the step that it is rounded down to. */
ACDF_INLINE int acdf_sure_step(float place, float border, uint32_t* step) {
    const int32_t whole = (int32_t)place;
    const float inside = place - (float)whole;
    *step = (uint32_t)whole;
    return inside > border && inside < 1.0f - border;
}

#ifdef ACDF_SSE2
/* The arc tangents of the roots of q, from 0 to 1, in turns: by the polynomial of acdf_atan_float, which does not
 * wait for the roots. */
ACDF_INLINE __m128 acdf_eighth_floats(__m128 q) {
    const __m128 q2 = _mm_mul_ps(q, q), root = _mm_mul_ps(_mm_sqrt_ps(q), _mm_set1_ps((float)(0.5 / ACDF_PI)));
#define ACDF_LINE(a, b) _mm_add_ps(_mm_set1_ps(a), _mm_mul_ps(q, _mm_set1_ps(b)))
    const __m128 low =
        _mm_add_ps(ACDF_LINE(0.99999988f, -0.33331813f), _mm_mul_ps(q2, ACDF_LINE(0.19966962f, -0.14003290f)));
    const __m128 high =
        _mm_add_ps(ACDF_LINE(0.098688655f, -0.058829753f), _mm_mul_ps(q2, ACDF_LINE(0.023780519f, -0.0045597920f)));
#undef ACDF_LINE
    return _mm_mul_ps(root, _mm_add_ps(low, _mm_mul_ps(_mm_mul_ps(q2, q2), high)));
}

/* acdf_turn_float of points with the squares of y and x; of y only the sign counts. */
ACDF_INLINE __m128 acdf_turn_floats(__m128 y, __m128 x, __m128 y2, __m128 x2) {
    const __m128 sign = _mm_set1_ps(-0.0f), one = _mm_set1_ps(1.0f);
    const __m128 level = _mm_or_ps(one, _mm_and_ps(sign, _mm_sub_ps(x2, y2)));
    const __m128 east = _mm_or_ps(one, _mm_and_ps(sign, x));
    const __m128 eighth = acdf_eighth_floats(_mm_div_ps(_mm_min_ps(y2, x2), _mm_max_ps(y2, x2)));
    const __m128 quarter = _mm_add_ps(_mm_sub_ps(_mm_set1_ps(0.125f), _mm_mul_ps(_mm_set1_ps(0.125f), level)),
                                      _mm_mul_ps(level, eighth));
    const __m128 half =
        _mm_add_ps(_mm_sub_ps(_mm_set1_ps(0.25f), _mm_mul_ps(_mm_set1_ps(0.25f), east)), _mm_mul_ps(east, quarter));
    return _mm_or_ps(half, _mm_and_ps(sign, y));
}

/* acdf_sure_step of both axes of a direction: its angle around the pole and from it, in turns and twice over. */
ACDF_INLINE int acdf_sure_steps(__m128 turn, __m128 steps, float border, uint32_t square[2]) {
    const __m128 west = _mm_setr_ps(-0.0f, 0.0f, -0.0f, 0.0f), half = _mm_setr_ps(0.5f, 0.0f, 0.5f, 0.0f);
    const __m128 place = _mm_mul_ps(steps, _mm_add_ps(half, _mm_xor_ps(turn, west)));
    const __m128i whole = _mm_cvttps_epi32(place);
    const __m128 inside = _mm_sub_ps(place, _mm_cvtepi32_ps(whole)), least = _mm_mul_ps(steps, _mm_set1_ps(border));
    _mm_storel_epi64((__m128i*)(void*)square, whole);
    return _mm_movemask_ps(_mm_and_ps(_mm_cmplt_ps(least, inside),
                                      _mm_cmplt_ps(inside, _mm_sub_ps(_mm_set1_ps(1.0f), least)))) == 15;
}
#endif

/* acdf_sphere_square without where the direction lies. Returns 0 where floats cannot decide: next to the borders of
 * squares and to the poles, for directions whose length differs from 1 by more than 5e-5 or that are not finite. */
ACDF_INLINE int acdf_row_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2]) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float x2 = x * x, y2 = y * y, z2 = z * z, sin2 = x2 + y2, length2 = sin2 + z2;
    const float border = 2.0f * ACDF_FLOAT_BORDER * (float)(0.5 / ACDF_PI);
    const float across = (float)columns, along = (float)rows * 2.0f;
    if (!acdf_is_direction(sin2, length2)) return 0;
#ifdef ACDF_SSE2
    return acdf_sure_steps(acdf_turn_floats(_mm_setr_ps(y, 0.0f, y, 0.0f), _mm_setr_ps(x, z, x, z),
                                            _mm_setr_ps(y2, sin2, y2, sin2), _mm_setr_ps(x2, z2, x2, z2)),
                           _mm_setr_ps(across, along, across, along), border, square);
#else
    return acdf_sure_step(across * (0.5f - acdf_turn_float(y, x)), across * border, &square[0]) &
           acdf_sure_step(along * acdf_turn_float(sqrtf(sin2), z), along * border, &square[1]);
#endif
}

/* acdf_grid_pdf of a cell of probability p; z[i] is acdf_row_z of row i. */
ACDF_INLINE float acdf_row_pdf(const double* z, uint32_t columns, const AcdfRange range[2], double p) {
    return acdf_cell_pdf(p, range[0].high - range[0].low, columns, z[range[1].low] - z[range[1].high], 1.0);
}

/* A number of quarters of a turn, from -2 to 2, rounded as acdf_sincospi does, as a double as well: what waits for
 * that has no way through the other registers. */
ACDF_INLINE double acdf_row_quarters(double x, int32_t* quarter) {
#ifdef ACDF_SSE2
    const __m128i four = _mm_cvttpd_epi32(_mm_set_sd(x + 4.5));
    *quarter = _mm_cvtsi128_si32(four) - 4;
    return _mm_cvtsd_f64(_mm_cvtepi32_pd(four)) - 4.0;
#else
    *quarter = (int32_t)(x + 4.5) - 4;
    return (double)*quarter;
#endif
}

/* The direction of acdf_sphere_position but for the rounding of floats. Returns 0, and leaves `out`, next to the
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
    int32_t quarter;
    const double quarters = acdf_row_quarters(2.0 * turn, &quarter);
    AcdfVector d;
    /* The sine of the angle to the pole is below sqrt(2 cap). */
    if (west < border || (double)range[0].high - x < border || cap < from_pole ||
        least * least < 2.0 * ACDF_FLOAT_BORDER * ACDF_FLOAT_BORDER * cap || range[0].tilt != 0.0 ||
        range[1].tilt != 0.0)
        return 0;
    d = acdf_piece_direction((float)((turn - 0.5 * quarters) * ACDF_PI), (float)cap, (uint32_t)quarter & 3u,
                             (uint32_t)(height < 0.0));
    out[0] = d.x;
    out[1] = d.y;
    out[2] = d.z;
    return 1;
}

/* ---- the octahedral square -------------------------------------------------------------------------- */

/* The part of the square's side that is at least ACDF_FLOAT_BORDER: ACDF_OCTAHEDRAL_LEAST_SPEED. */
#define ACDF_FOLD_BORDER (0.5f * ACDF_FLOAT_BORDER)

/* As acdf_row_square. */
ACDF_INLINE int acdf_fold_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2]) {
    AcdfDirectionKeys place;
    if (!acdf_keys_of_direction(1, direction, &place)) return 0;
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

/* acdf_grid_pdf of a cell of probability p. */
ACDF_INLINE float acdf_fold_pdf(const AcdfGrid* grid, const AcdfRange range[2], double p) {
    const double half[2] = {0.5, 0.5};
    return acdf_grid_pdf(grid, range, half, p);
}

#ifdef __cplusplus
}
#endif
#endif
