/* Samples and pdfs of a BRDF file by its runtime tables (acdf/brdf_tables.h): those of the traversal, bit for bit.
 */
#ifndef ACDF_BRDF_PAIR_H
#define ACDF_BRDF_PAIR_H

#include <acdf/brdf_half.h>

#ifdef ACDF_SSE2
#define ACDF_BRDF_GUESSES 1 /* samples take tables; without vectors of two the traversal is as fast */
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What the rows around a view give to a cell: its probability. */
ACDF_INLINE double acdf_brdf_pair_share(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t cell) {
    const double* part = acdf_brdf_parts(brdf->tables, cell, view->lower);
    return (view->pair[0] * part[0] + view->pair[1] * part[1]) / (view->pair[0] + view->pair[1]);
}

/* Finds where wi lies, and its cell, of tables that have a grid. Returns 0 where none falls. */
ACDF_INLINE int acdf_brdf_pair_find(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3],
                                    AcdfBrdfPosition* place, uint32_t* cell) {
    double position[2], sign;
    if (!acdf_brdf_half_position(brdf, view, wi, place, &sign)) return 0;
    position[0] = acdf_brdf_bounded(place->position[0], brdf->columns);
    position[1] = acdf_brdf_bounded(place->position[1], brdf->rows);
    *cell = acdf_brdf_find_cell(brdf->tables, position);
    return 1;
}

/* The pdf there. */
ACDF_INLINE float acdf_brdf_pair_found(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t cell,
                                       const AcdfBrdfPosition* place) {
    double p = acdf_brdf_pair_share(brdf, view, cell); /* NaN where no view weighs anything */
    if (!(p > 0.0)) return 0.0f;
    p = acdf_brdf_mean_pdf(brdf, acdf_positive(p), acdf_brdf_area(brdf->tables, cell), place);
    return acdf_brdf_positive(p);
}

/* acdf_brdf_view_pdf, of tables that have a grid. */
ACDF_INLINE float acdf_brdf_pair_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]) {
    AcdfBrdfPosition place;
    uint32_t cell;
    return acdf_brdf_pair_find(brdf, view, wi, &place, &cell) ? acdf_brdf_pair_found(brdf, view, cell, &place)
                                                              : 0.0f;
}

#ifdef ACDF_BRDF_GUESSES

/* A traversal with two rows, as in acdf_blend_sample: the rescaled random numbers, the rows' weights in
 * the node, their sum, twice, and the part of each row that the node has. */
typedef struct AcdfPairWalk {
    __m128d x, weight, chosen, part;
} AcdfPairWalk;

/* Masks of a way to go. */
typedef union AcdfPairMask {
    uint64_t bits[2];
    __m128d lanes;
} AcdfPairMask;
typedef struct AcdfPairWay {
    AcdfPairMask upper; /* all bits where it is the upper part */
    AcdfPairMask cut;   /* of them the axis's */
    AcdfPairMask other; /* all bits of the other axis */
    AcdfPairMask one;   /* 1.0 on the axis */
} AcdfPairWay;

#define ACDF_ALL 0xFFFFFFFFFFFFFFFFu
#define ACDF_ONE 0x3FF0000000000000u
/* By acdf_way_number. */
static const AcdfPairWay acdf_pair_ways[4] = {
    {{{0, 0}}, {{0, 0}}, {{ACDF_ALL, 0}}, {{0, ACDF_ONE}}},
    {{{ACDF_ALL, ACDF_ALL}}, {{ACDF_ALL, 0}}, {{0, ACDF_ALL}}, {{ACDF_ONE, 0}}},
    {{{0, 0}}, {{0, 0}}, {{0, ACDF_ALL}}, {{ACDF_ONE, 0}}},
    {{{ACDF_ALL, ACDF_ALL}}, {{0, ACDF_ALL}}, {{ACDF_ALL, 0}}, {{0, ACDF_ONE}}}};
#undef ACDF_ALL
#undef ACDF_ONE

/* Both lanes: their sum. */
ACDF_INLINE __m128d acdf_pair_sum(__m128d of) { return _mm_add_pd(of, _mm_shuffle_pd(of, of, 1)); }

/* Goes a way at a split: rows give `lower` to its lower part and `low` in all, and their codes for that way are
 * `code`. */
ACDF_INLINE void acdf_pair_go(AcdfPairWalk* walk, uint32_t number, __m128d lower, __m128d low, __m128d code) {
    const AcdfPairWay* way = &acdf_pair_ways[number];
    __m128d chosen, scale;
    /* weight - lower, or lower */
    walk->weight = _mm_and_pd(_mm_sub_pd(_mm_and_pd(walk->weight, way->upper.lanes), lower),
                              _mm_castsi128_pd(_mm_set1_epi64x(0x7FFFFFFFFFFFFFFF)));
    chosen = acdf_pair_sum(walk->weight);
    scale = _mm_or_pd(_mm_and_pd(_mm_div_pd(chosen, walk->chosen), way->other.lanes), way->one.lanes);
    walk->x = _mm_mul_pd(_mm_sub_pd(walk->x, _mm_and_pd(low, way->cut.lanes)), scale);
    walk->chosen = chosen;
    walk->part = _mm_mul_pd(walk->part, code);
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

/* Goes on from a split as acdf_blend_sample does: here there is no guess which way. Returns the cell. */
ACDF_OUTLINE uint32_t acdf_brdf_pair_walk(const AcdfBrdf* brdf, const uint8_t* row0, const uint8_t* row1,
                                          uint32_t node, AcdfPairWalk* walk) {
    const double* codes = (const double*)acdf_brdf_words(brdf->tables, brdf->tables->codes);
    AcdfPairWalk at = *walk;
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &brdf->blend.splits[node];
        const double *code0 = codes + row0[node], *code1 = codes + row1[node];
        const uint32_t axis = split->place & 1u;
        const AcdfPairWay* way = &acdf_pair_ways[acdf_way_number(acdf_brdf_way(axis, 0))];
        const __m128d code = _mm_loadh_pd(_mm_load_sd(code0), code1), lower = _mm_mul_pd(at.weight, code);
        const __m128d upper = _mm_sub_pd(at.weight, lower);
        const __m128d sums = _mm_add_pd(_mm_unpacklo_pd(lower, upper), _mm_unpackhi_pd(lower, upper));
        const __m128d low = _mm_unpacklo_pd(sums, sums), high = _mm_unpackhi_pd(sums, sums);
        const __m128d below = _mm_or_pd(_mm_cmplt_pd(at.x, low), _mm_cmple_pd(high, _mm_setzero_pd()));
        __m128d chosen;
        if (_mm_movemask_pd(below) >> axis & 1) {
            at.weight = lower;
            at.part = _mm_mul_pd(at.part, code);
            chosen = low;
            node = split->child[0];
        } else {
            at.weight = upper;
            at.part = _mm_mul_pd(at.part, _mm_loadh_pd(_mm_load_sd(code0 + 256), code1 + 256));
            at.x = _mm_sub_pd(at.x, _mm_andnot_pd(way->other.lanes, low));
            chosen = high;
            node = split->child[1];
        }
        at.x = _mm_mul_pd(at.x,
                          _mm_or_pd(_mm_and_pd(_mm_div_pd(chosen, at.chosen), way->other.lanes), way->one.lanes));
        at.chosen = chosen;
    }
    *walk = at;
    return node & ~ACDF_TILE_FLAG;
}

/* Samples a cell of a mixture of the two rows around a view, as acdf_blend_sample does: the traversal goes where a
 * guess says, so that nothing waits for a comparison. Where one disagrees, the traversal goes the other way, and
 * then where the cell across that side is. Returns the cell's probability; 0 where there is nothing to sample, and
 * where all that is left of the weight is below the random numbers. */
ACDF_INLINE double acdf_brdf_pair_sample_cell(const AcdfBrdf* brdf, const AcdfBrdfView* view, const double u[2],
                                              __m128d* left, const AcdfBrdfPath** sampled) {
    const AcdfBrdfTables* tables = brdf->tables;
    const double* codes = (const double*)acdf_brdf_words(tables, tables->codes);
    const AcdfBrdfPath* paths = (const AcdfBrdfPath*)acdf_brdf_words(tables, tables->paths);
    const AcdfSplit* splits = brdf->blend.splits;
    const uint8_t *row0 = view->row[0], *row1 = view->row[1];
    const __m128d weight = _mm_set_pd(view->pair[1], view->pair[0]);
    const __m128d whole = _mm_add_pd(weight, _mm_shuffle_pd(weight, weight, 1));
    const AcdfBrdfPath* path = &paths[acdf_brdf_guess(tables, view->lower, u)];
    const double* parts[4]; /* codes by acdf_way_number: those of upper parts stand behind those of lower ones */
    uint64_t ways = path->ways;
    size_t i, depth = 0;
    AcdfPairWalk walk;
    __m128d share;
    for (i = 0; i < 4; ++i) ACDF_PREFETCH(&paths[path->beyond[i]]); /* six of ten samples go there */
    parts[0] = parts[2] = codes;
    parts[1] = parts[3] = codes + 256;
    walk.weight = weight;
    walk.part = _mm_set1_pd(1.0);
    walk.chosen = whole;
    walk.x = _mm_mul_pd(_mm_set_pd(u[1], u[0]), whole);
    for (; ways; ways >>= 4, ++depth) {
        const uint32_t split = path->splits[depth], code0 = row0[split], code1 = row1[split];
        const __m128d lower = _mm_mul_pd(walk.weight, _mm_loadh_pd(_mm_load_sd(codes + code0), codes + code1));
        const __m128d low = acdf_pair_sum(lower);
        uint32_t number = acdf_way_number(ways);
        const double* part;
        if (!(ways >> _mm_movemask_pd(_mm_cmplt_pd(walk.x, low)) & 1u)) {
            const uint32_t other = ~(uint32_t)ways & 15u;
            do { /* across sides, until one is this split's */
                path = &paths[path->beyond[number]];
                ways = path->ways >> 4 * depth;
            } while (((uint32_t)ways & 15u) != other);
            number ^= 3u;
        }
        part = parts[number];
        acdf_pair_go(&walk, number, lower, low, _mm_loadh_pd(_mm_load_sd(part + code0), part + code1));
    }
    if (depth == ACDF_PATH_SPLITS) {
        AcdfPairWalk rest = walk; /* functions called get its address: the traversal stays in registers */
        const uint32_t upper = (uint32_t)(path->ways >> (4 * depth - 4)) & 1u;
        path = &paths[acdf_brdf_pair_walk(brdf, row0, row1, splits[path->splits[depth - 1]].child[upper], &rest)];
        walk = rest;
    }
    *sampled = path;
    if (!(_mm_cvtsd_f64(walk.chosen) > 0.0)) return 0.0;
    *left = _mm_div_pd(walk.x, walk.chosen);
    share = _mm_mul_pd(weight, walk.part);
    share = _mm_div_sd(_mm_add_sd(share, _mm_unpackhi_pd(share, share)), whole);
    return acdf_positive(_mm_cvtsd_f64(share));
}

ACDF_INLINE __m128d acdf_pair_doubles(const int32_t of[2]) {
    return _mm_cvtepi32_pd(_mm_loadl_epi64((const __m128i*)(const void*)of));
}

/* acdf_brdf_view_sample, of tables that have guesses. Returns 0 where there is nothing to sample, and where
 * rounding wi may carry it over the border of its cell: then the traversal decides. */
ACDF_INLINE int acdf_brdf_pair_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1,
                                      AcdfDirectionSample* out) {
    const AcdfBrdfTables* tables = brdf->tables;
    const AcdfBrdfPath* path;
    AcdfBrdfPosition place;
    __m128d left, low, high, wide, position, reach, inside;
    double u[2], part[2], half[3], sign = 1.0, p, dot, radius;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (acdf_brdf_mirrored(brdf)) sign = acdf_brdf_mirror(&u[0]);
    p = acdf_brdf_pair_sample_cell(brdf, view, u, &left, &path);
    if (!(p > 0.0)) return 0;
    low = acdf_pair_doubles(path->low);
    high = acdf_pair_doubles(path->high);
    wide = _mm_sub_pd(high, low);
    position = _mm_min_pd(_mm_max_pd(left, _mm_set1_pd(0x1p-30)), _mm_set1_pd(1.0 - 0x1p-30));
    position = _mm_add_pd(low, _mm_mul_pd(position, wide));
    _mm_storeu_pd(part, _mm_mul_pd(position, _mm_loadu_pd(tables->inverse)));
    dot = acdf_brdf_reflect_at(brdf, view, part[0], part[1], sign, out->direction, &radius);
    /* Farther from the borders than acdf_brdf_reflect's `reach`, both sides times what that divides by. */
    reach = _mm_set_pd(0x1p-23 * (radius * dot + 0x1p-23) * (double)brdf->rows, 0x1p-23 * (double)brdf->columns);
    inside = _mm_min_pd(_mm_sub_pd(position, low), _mm_sub_pd(high, position));
    inside = _mm_mul_pd(inside, _mm_set_pd(dot * dot, dot * radius));
    if (_mm_movemask_pd(_mm_cmpgt_pd(inside, reach)) != 3) return 0;
    if (!acdf_brdf_half(view, out->direction, half, &place)) return 0;
    wide = _mm_mul_sd(wide, _mm_unpackhi_pd(wide, wide));
    out->pdf = acdf_brdf_positive(acdf_brdf_mean_pdf(brdf, p, _mm_cvtsd_f64(wide), &place));
    return 1;
}

/* About what acdf_brdf_pair_sample samples, for a third of its time: the middle of the cell that is guessed, and
 * the pdf there. Returns 0 where there is none. */
ACDF_INLINE int acdf_brdf_pair_about(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1,
                                     AcdfDirectionSample* out) {
    const AcdfBrdfTables* tables = brdf->tables;
    const AcdfBrdfPath* path;
    AcdfBrdfPosition place;
    uint32_t cell;
    double u[2], part[2], half[3], sign = 1.0, radius, p;
    int axis;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (acdf_brdf_mirrored(brdf)) sign = acdf_brdf_mirror(&u[0]);
    cell = acdf_brdf_guess(tables, view->lower, u);
    path = (const AcdfBrdfPath*)acdf_brdf_words(tables, tables->paths) + cell;
    for (axis = 0; axis < 2; ++axis)
        part[axis] = 0.5 * ((double)path->low[axis] + (double)path->high[axis]) * tables->inverse[axis];
    acdf_brdf_reflect_at(brdf, view, part[0], part[1], sign, out->direction, &radius);
    p = acdf_brdf_pair_share(brdf, view, cell);
    if (!(p > 0.0) || !acdf_brdf_half(view, out->direction, half, &place)) return 0;
    out->pdf = acdf_brdf_positive(acdf_brdf_mean_pdf(brdf, p, acdf_brdf_area(tables, cell), &place));
    return 1;
}

#endif

#ifdef __cplusplus
}
#endif
#endif
