/* Draws and densities of a BRDF file by its runtime tables (acdf/brdf_tables.h): those of the walk, bit for bit. */
#ifndef ACDF_BRDF_PAIR_H
#define ACDF_BRDF_PAIR_H

#include <acdf/brdf_half.h>

#ifdef ACDF_SQUARES_SSE2
#define ACDF_BRDF_GUESSES 1 /* draws take tables; without vectors of two the walk is as fast */
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What the rows around a view give to a cell: its probability. */
ACDF_INLINE double acdf_brdf_pair_share(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t cell) {
    const double* part = acdf_brdf_parts(brdf->tables, cell, view->lower);
    return (view->pair[0] * part[0] + view->pair[1] * part[1]) / (view->pair[0] + view->pair[1]);
}

/* acdf_brdf_view_pdf, of tables that have a grid. */
ACDF_INLINE float acdf_brdf_pair_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]) {
    AcdfBrdfPlace place;
    uint32_t square[2], cell;
    double sign, p;
    if (!acdf_brdf_place(brdf, view, wi, &place, &sign)) return 0.0f;
    square[0] = acdf_brdf_step(place.position[0], brdf->columns);
    square[1] = acdf_brdf_step(place.position[1], brdf->rows);
    cell = acdf_brdf_find_cell(brdf->tables, square);
    p = acdf_brdf_pair_share(brdf, view, cell); /* NaN where no view weighs anything */
    if (!(p > 0.0)) return 0.0f;
    p = acdf_brdf_mean_density(brdf, acdf_positive(p), acdf_brdf_area(brdf->tables, cell), &place);
    return acdf_brdf_positive(p);
}

#ifdef ACDF_BRDF_GUESSES

/* A walk with two rows, as acdf_blend_sample has it: what is left of the random numbers, of the rows' weights,
 * their sum, twice, and what part of each row is left. */
typedef struct AcdfPairWalk {
    __m128d x, weight, chosen, part;
} AcdfPairWalk;

/* Masks of the four ways to go: axis << 1 | upper. */
typedef struct AcdfPairMasks {
    uint64_t upper[4][2]; /* all bits where it is the upper part */
    uint64_t cut[4][2];   /* of them the axis's */
    uint64_t other[4][2]; /* all bits of the other axis */
    uint64_t one[4][2];   /* 1.0 on the axis */
} AcdfPairMasks;

#define ACDF_ALL 0xFFFFFFFFFFFFFFFFu
#define ACDF_ONE 0x3FF0000000000000u
static const AcdfPairMasks acdf_pair_masks = {{{0, 0}, {ACDF_ALL, ACDF_ALL}, {0, 0}, {ACDF_ALL, ACDF_ALL}},
                                              {{0, 0}, {ACDF_ALL, 0}, {0, 0}, {0, ACDF_ALL}},
                                              {{0, ACDF_ALL}, {0, ACDF_ALL}, {ACDF_ALL, 0}, {ACDF_ALL, 0}},
                                              {{ACDF_ONE, 0}, {ACDF_ONE, 0}, {0, ACDF_ONE}, {0, ACDF_ONE}}};
#undef ACDF_ALL
#undef ACDF_ONE

/* Of one of those arrays; `way` is 16 bytes times the way. */
ACDF_INLINE __m128d acdf_pair_mask(const uint64_t masks[4][2], uint32_t way) {
    return _mm_loadu_pd((const double*)(const void*)((const char*)masks + way));
}

/* Goes a way at a split where rows have these codes. Returns whether the random numbers lead there; where nothing
 * is left of the weight they may not. */
ACDF_INLINE int acdf_pair_step(AcdfPairWalk* walk, const double* code0, const double* code1, uint32_t way) {
    const uint32_t to = (way & 0x10u) << 4; /* 256 codes of upper parts follow those of lower ones */
    const __m128d lower = _mm_mul_pd(walk->weight, _mm_loadh_pd(_mm_load_sd(code0), code1));
    const __m128d upper = acdf_pair_mask(acdf_pair_masks.upper, way),
                  other = acdf_pair_mask(acdf_pair_masks.other, way);
    /* weight - lower, or lower */
    const __m128d weight = _mm_andnot_pd(_mm_set1_pd(-0.0), _mm_sub_pd(_mm_and_pd(walk->weight, upper), lower));
    const __m128d sums = _mm_add_pd(_mm_unpacklo_pd(lower, weight), _mm_unpackhi_pd(lower, weight));
    const __m128d low = _mm_unpacklo_pd(sums, sums), chosen = _mm_unpackhi_pd(sums, sums);
    const __m128d below = _mm_xor_pd(_mm_cmplt_pd(walk->x, low), upper);
    const __m128d scale =
        _mm_or_pd(_mm_and_pd(_mm_div_pd(chosen, walk->chosen), other), acdf_pair_mask(acdf_pair_masks.one, way));
    walk->x = _mm_mul_pd(_mm_sub_pd(walk->x, _mm_and_pd(low, acdf_pair_mask(acdf_pair_masks.cut, way))), scale);
    walk->weight = weight;
    walk->chosen = chosen;
    walk->part = _mm_mul_pd(walk->part, _mm_loadh_pd(_mm_load_sd(code0 + to), code1 + to));
    return _mm_movemask_pd(_mm_or_pd(below, other)) == 3;
}

/* The cell that the random numbers u lead to half-way between two views. */
ACDF_INLINE uint32_t acdf_brdf_guess(const AcdfBrdfTables* tables, uint32_t lower, const double u[2]) {
    const uint16_t* guesses = (const uint16_t*)acdf_brdf_words(tables, tables->guesses);
    const uint32_t bits = tables->guess_bits, most = (1u << bits) - 1u;
    const double entries = (double)(int32_t)(most + 1u);
    const uint32_t column = (uint32_t)(int32_t)(u[0] * entries), line = (uint32_t)(int32_t)(u[1] * entries);
    const uint32_t row = lower << bits | (line < most ? line : most);
    return guesses[row << bits | (column < most ? column : most)];
}

/* Goes on from a split as acdf_blend_sample does. */
ACDF_OUTLINE void acdf_brdf_pair_walk(const AcdfBrdf* brdf, const uint8_t* row0, const uint8_t* row1, uint32_t node,
                                      AcdfPairWalk* walk, uint32_t side[4]) {
    const double* codes = (const double*)acdf_brdf_words(brdf->tables, brdf->tables->codes);
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &brdf->blend.splits[node];
        const double *code0 = codes + row0[node], *code1 = codes + row1[node];
        const uint32_t axis = split->place & 1u;
        const AcdfPairWalk before = *walk;
        uint32_t upper = 1;
        if (!acdf_pair_step(walk, code0, code1, axis << 5 | 0x10u)) {
            *walk = before;
            acdf_pair_step(walk, code0, code1, axis << 5);
            upper = 0;
        }
        side[2 * axis + 1 - upper] = split->place >> 3;
        node = split->child[upper];
    }
}

/* Draws a cell of a mixture of the two rows around a view, as acdf_blend_sample does: the walk goes where a guess
 * says, so that nothing waits for a comparison, for as long as those agree. `side` becomes low and high of axis 0,
 * then of axis 1. Returns the cell's probability; 0 where there is nothing to draw. */
ACDF_INLINE double acdf_brdf_pair_draw(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u[2],
                                       uint32_t side[4]) {
    const AcdfBrdfTables* tables = brdf->tables;
    const double* codes = (const double*)acdf_brdf_words(tables, tables->codes);
    const AcdfSplit* splits = brdf->blend.splits;
    const uint8_t *row0 = view->row[0], *row1 = view->row[1];
    const __m128d weight = _mm_set_pd(view->pair[1], view->pair[0]);
    const __m128d whole = _mm_add_pd(weight, _mm_shuffle_pd(weight, weight, 1));
    uint32_t node = acdf_blend_root(&brdf->blend);
    uint64_t ways;
    AcdfPairWalk walk;
    __m128d left;
    ways = ((const uint64_t*)acdf_brdf_words(tables, tables->ways))[acdf_brdf_guess(tables, view->lower, u)];
    side[0] = side[2] = 0;
    side[1] = brdf->columns;
    side[3] = brdf->rows;
    walk.weight = weight;
    walk.chosen = whole;
    walk.x = _mm_mul_pd(_mm_set_pd(u[1], u[0]), whole);
    walk.part = _mm_set1_pd(1.0);
    for (; !(node & ACDF_TILE_FLAG); ways >>= 1) {
        const uint32_t place = splits[node].place, axis = place & 1u, upper = (uint32_t)ways & 1u;
        AcdfPairWalk next = walk;
        if (!acdf_pair_step(&next, codes + row0[node], codes + row1[node], axis << 5 | upper << 4)) {
            next = walk;
            acdf_brdf_pair_walk(brdf, row0, row1, node, &next, side);
            walk = next;
            break;
        }
        walk = next;
        side[2 * axis + 1 - upper] = place >> 3;
        node = splits[node].child[upper];
    }
    if (!(_mm_cvtsd_f64(walk.chosen) > 0.0)) return 0.0;
    left = _mm_div_pd(walk.x, walk.chosen); /* not more than 1, which rounding might bring about */
    left = _mm_min_pd(left, _mm_set1_pd(1.0));
    _mm_storel_pd(&u[0], left);
    _mm_storeh_pd(&u[1], left);
    left = _mm_mul_pd(weight, walk.part);
    left = _mm_div_sd(_mm_add_sd(left, _mm_unpackhi_pd(left, left)), whole);
    return acdf_positive(_mm_cvtsd_f64(left));
}

/* acdf_brdf_view_sample, of tables that have guesses. Returns 0 where there is nothing to draw, and where rounding
 * wi may carry it over the border of its cell: then the walk is to be asked. */
ACDF_INLINE int acdf_brdf_pair_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1,
                                      AcdfDirectionSample* out) {
    AcdfBrdfPlace place;
    uint32_t side[4];
    double u[2], position[2], reach[2], low[2], wide[2], half[3], sign = 1.0, p;
    int axis;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (acdf_brdf_mirrored(brdf)) sign = acdf_brdf_mirror(&u[0]);
    p = acdf_brdf_pair_draw(brdf, view, u, side);
    if (!(p > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis) {
        low[axis] = (double)side[2 * axis];
        wide[axis] = (double)(side[2 * axis + 1] - side[2 * axis]);
        position[axis] = low[axis] + acdf_clamp(u[axis], 0x1p-30, 1.0 - 0x1p-30) * wide[axis];
    }
    acdf_brdf_reflect(brdf, view, position, sign, out->direction, reach);
    for (axis = 0; axis < 2; ++axis)
        if (!(position[axis] >= low[axis] + reach[axis] &&
              position[axis] < (double)side[2 * axis + 1] - reach[axis]))
            return 0;
    if (!acdf_brdf_half(view, out->direction, half, &place)) return 0;
    out->pdf = acdf_brdf_positive(acdf_brdf_mean_density(brdf, p, wide[0] * wide[1], &place));
    return 1;
}

#endif

#ifdef __cplusplus
}
#endif
#endif
