/* Sampling from a cut, and its pdf (acdf/product/cut.h). One freestanding header, valid C99, C++17 and
 * CUDA/HIP/SYCL. */
#ifndef ACDF_CUT_SAMPLE_H
#define ACDF_CUT_SAMPLE_H

#include <acdf/product/cut.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A side of a box of random numbers, in bytes: rounded to 1/256. */
ACDF_INLINE uint32_t acdf_cut_side(double number) {
    const int32_t scaled = (int32_t)(256.0 * number);
    return (uint32_t)(scaled < 0xFF ? scaled : 0xFF) ^ 0x80u;
}

/* Sets which random numbers sample each part: those of a split are shared by its children; share[~i] is that of
 * part i, share[i] of split i. */
ACDF_FN void acdf_cut_borders(AcdfCut* cut, const double* share) {
    /* Of splits and parts, as shares are: low and high on axis 0, on axis 1. Each in an array of its own: what is
     * stored in pieces and loaded as a whole would be waited for. */
    double numbers[4][2 * ACDF_CUT_MAX_PARTS];
    uint32_t sides[2 * ACDF_CUT_MAX_PARTS]; /* the same in bytes */
    const int whole = ACDF_CUT_MAX_PARTS - (cut->count == 1);
    int i, k;
    for (k = 0; k < 4; ++k) numbers[k][whole] = (double)(k & 1);
    sides[whole] = 0x7F807F80u;
    for (i = 0; i < cut->count - 1; ++i) {
        const AcdfCutSplit* split = &cut->split[i];
        const uint32_t axis = split->place & 1u, shift = 16 * axis;
        const int at = ACDF_CUT_MAX_PARTS + i;
        const int child[2] = {ACDF_CUT_MAX_PARTS + split->child[0], ACDF_CUT_MAX_PARTS + split->child[1]};
        const double low = numbers[2 * axis][at], high = numbers[2 * axis + 1][at];
        const double lower = share[split->child[0]], upper = share[split->child[1]];
        const double told = low + (high - low) * (lower / (lower + upper));
        const double border = upper > 0.0 && told < high ? told : high; /* numbers are below 1 */
        const uint32_t side = acdf_cut_side(border) * 0x01010101u;
        for (k = 0; k < 4; ++k) numbers[k][child[0]] = numbers[k][child[1]] = numbers[k][at];
        numbers[2 * axis + 1][child[0]] = numbers[2 * axis][child[1]] = border;
        sides[child[0]] = sides[at] ^ ((sides[at] ^ side) & 0xFF00u << shift);
        sides[child[1]] = sides[at] ^ ((sides[at] ^ side) & 0xFFu << shift);
    }
    for (i = 0; i < cut->count; ++i) {
        AcdfCutPart* part = &cut->part[i];
        const int at = ACDF_CUT_MAX_PARTS + ~i;
        part->numbers[0][0] = numbers[0][at];
        part->numbers[0][1] = numbers[1][at];
        part->numbers[1][0] = numbers[2][at];
        part->numbers[1][1] = numbers[3][at];
    }
    for (i = 0; i < cut->count; i += ACDF_BLOCK_CELLS) {
        uint8_t* byte = (uint8_t*)cut->boxes[(uint32_t)i / ACDF_BLOCK_CELLS];
        const uint32_t* side = sides + ACDF_CUT_MAX_PARTS + ~i;
        for (k = 0; k < ACDF_BLOCK_CELLS; ++k, ++byte) {
            const uint32_t box = i + k < cut->count ? side[-k] : 0x807F807Fu; /* which holds nothing */
            byte[0] = (uint8_t)box;
            byte[ACDF_BLOCK_CELLS] = (uint8_t)(box >> 8);
            byte[2 * ACDF_BLOCK_CELLS] = (uint8_t)(box >> 16);
            byte[3 * ACDF_BLOCK_CELLS] = (uint8_t)(box >> 24);
        }
    }
}

/* Makes the cut ready to be sampled from: to be called when all parts have their probabilities, which need not add
 * up to 1. Parts without light get none. Where nothing is left the cut is emptied. */
ACDF_FN void acdf_cut_finish(AcdfCut* cut) {
    /* Of parts and splits, so that a child's number finds its own without a branch that nobody guesses: part ~n
     * stands before split 0, which is in the middle. */
    double shares[2 * ACDF_CUT_MAX_PARTS], *share = shares + ACDF_CUT_MAX_PARTS, sum = 0.0;
    int i;
    for (i = 0; i < cut->count; ++i) {
        const AcdfCutPart* part = &cut->part[i];
        sum += share[~i] = part->sum > 0.0 && part->probability > 0.0 ? part->probability : 0.0;
    }
    if (!(sum > 0.0) || !acdf_is_finite(sum)) {
        cut->count = 0;
        return;
    }
    for (i = 0; i < cut->count; ++i) cut->part[i].probability = share[~i] /= sum;
    for (i = cut->count - 2; i >= 0; --i) /* a split's children stand behind it */
        share[i] = share[cut->split[i].child[0]] + share[cut->split[i].child[1]];
    acdf_cut_borders(cut, share);
}

/* Number by number: of a mixture that is copied as a whole, and then given other weights, nvcc 13.0 sums the old
 * ones. */
ACDF_FN AcdfMixture acdf_cut_mixture(const AcdfLocalPoint* point, const AcdfCutPart* part) {
    AcdfMixture mix;
    int i;
    mix.count = point->mix.count;
    for (i = 0; i < ACDF_NORMALS_MIXED; ++i) {
        mix.row[i] = point->mix.row[i];
        mix.weight[i] = i < mix.count ? part->weight[i] : 0.0;
    }
    return mix;
}

ACDF_FN void acdf_cut_range(const AcdfCutPart* part, AcdfRange range[2]) {
    int i;
    for (i = 0; i < 2; ++i) {
        range[i].low = part->low[i];
        range[i].high = part->high[i];
        range[i].tilt = 0.0;
    }
}

/* What random numbers of a part's mixture are of all that it gives, which is returned. */
ACDF_INLINE double acdf_cut_of_all(const AcdfMixture* mix, const double* u, double from[2]) {
    const double whole = acdf_mixture_sum(mix);
    from[0] = u[0] * whole;
    from[1] = u[1] * whole;
    return whole;
}

/* Samples a tile of a part from its mixture; *inside becomes its share of that. */
ACDF_FN uint32_t acdf_cut_sample_tile(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCutPart* part,
                                      const AcdfMixture* mix, double* u, AcdfRange* range, double* inside) {
    if (acdf_local_tabled(local)) {
        const uint32_t* words = acdf_local_words(local->tables);
        const AcdfTileTables* tables = &local->tables->tiles;
        double from[2];
        const double whole = acdf_cut_of_all(mix, u, from);
        const uint32_t tile =
            acdf_tile_sample(words, tables, mix, point->by.tabled.codes, part->entry, from, u, inside);
        acdf_tile_range(acdf_tile_record(words, tables, tile), range);
        *inside = acdf_positive(*inside / whole);
        return tile;
    }
    return acdf_blend_sample_below(&local->blend, mix, part->node, u, range, inside);
}

/* Finds the tile of a square in a part, and its share of the part's mixture. */
ACDF_FN uint32_t acdf_cut_find_tile(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCutPart* part,
                                    const AcdfMixture* mix, const uint32_t* square, AcdfRange* range,
                                    double* inside) {
    if (acdf_local_tabled(local)) {
        const uint32_t tile = acdf_tile_at(acdf_local_words(local->tables), &local->tables->tiles, square);
        *inside = acdf_local_found_tile(local, point, mix, tile, part->depth, range);
        return tile;
    }
    return acdf_blend_find_below(&local->blend, mix, part->node, square, range, 0, inside);
}

/* A number in [0, 1) of what is given. */
ACDF_INLINE double acdf_cut_number(double u) {
    const double most = 1.0 - 0x1p-53, x = acdf_unit_interval(u);
    return x < most ? x : most;
}

/* Whether numbers in [0, 1) sample a part. */
ACDF_INLINE int acdf_cut_samples(const AcdfCutPart* part, const double u[2]) {
    return (part->numbers[0][0] <= u[0]) & (u[0] < part->numbers[0][1]) & (part->numbers[1][0] <= u[1]) &
           (u[1] < part->numbers[1][1]);
}

/* The parts of a block that numbers in steps of 1/256 may sample. */
ACDF_INLINE uint32_t acdf_cut_candidates(const AcdfCut* cut, int block, const uint32_t step[2]) {
#ifdef ACDF_SSE2
    const __m128i* box = (const __m128i*)(const void*)cut->boxes[block];
    return acdf_boxes_by_vectors(_mm_loadu_si128(box), _mm_loadu_si128(box + 1), _mm_loadu_si128(box + 2),
                                 _mm_loadu_si128(box + 3), step[0], step[1]);
#else
    return acdf_boxes_around(cut->boxes[block], step[0], step[1]);
#endif
}

/* The first part from a number on that numbers in [0, 1) may sample, the last part if there is no other. No branch
 * depends on which. */
ACDF_INLINE int acdf_cut_guess(const AcdfCut* cut, const double u[2], int from) {
    const uint32_t step[2] = {(uint32_t)(int32_t)(u[0] * 256.0), (uint32_t)(int32_t)(u[1] * 256.0)};
    int first;
    for (first = from & ~63; first < cut->count; first += 64) {
        uint32_t mask[2] = {0, 0};
        int k;
        for (k = 0; k < 4 && first + k * ACDF_BLOCK_CELLS < cut->count; ++k)
            mask[k >> 1] |= acdf_cut_candidates(cut, first / ACDF_BLOCK_CELLS + k, step)
                            << (k & 1) * ACDF_BLOCK_CELLS;
        for (k = 0; k < 2; ++k) {
            const int passed = from - (first + 32 * k);
            if (passed > 0) mask[k] &= passed < 32 ? ~0u << passed : 0u;
        }
        if (mask[0] | mask[1])
            return first + (mask[0] ? 0 : 32) + (int)acdf_lowest_bit(mask[0] ? mask[0] : mask[1]);
    }
    return cut->count - 1;
}

/* Samples a part by numbers in [0, 1), where all before number `guess` are known not to be sampled: u becomes what
 * is left of the random numbers. */
ACDF_INLINE const AcdfCutPart* acdf_cut_sample_guessed(const AcdfCut* cut, int guess, double u[2]) {
    const AcdfCutPart* part = &cut->part[guess];
    int i;
    while (!acdf_cut_samples(part, u) && guess + 1 < cut->count)
        part = &cut->part[guess = acdf_cut_guess(cut, u, guess + 1)];
    for (i = 0; i < 2; ++i) {
        const double width = part->numbers[i][1] - part->numbers[i][0], x = u[i] - part->numbers[i][0];
        u[i] = x < width ? x / width : 1.0;
    }
    return part;
}

/* Asks for what samples from a part read of it, and of rows where they begin in it. */
ACDF_INLINE void acdf_cut_part_ahead(const AcdfCut* cut, int number) {
    ACDF_PREFETCH(&cut->part[number].numbers[0][0]);
    ACDF_PREFETCH(&cut->part[number].depth);
}

/* Samples a part. */
ACDF_FN const AcdfCutPart* acdf_cut_choose_part(const AcdfCut* cut, double u[2]) {
    const int number = acdf_cut_guess(cut, u, 0);
    acdf_cut_part_ahead(cut, number);
    return acdf_cut_sample_guessed(cut, number, u);
}

/* Whether u0 in [0, 1] samples a bright tile of a part, not from its mixture. */
ACDF_INLINE int acdf_cut_samples_bright_tile(const AcdfCutPart* part, double u0) {
    return (part->bright_tiles > 0.0) & ((u0 * part->sum < part->bright_tiles) | !(part->sum > part->bright_tiles));
}

/* Samples that light; u[0] becomes what is left of it, *probability that of the light. Returns its tile. */
ACDF_FN uint32_t acdf_cut_sample_bright_tile(const AcdfLocal* local, const AcdfCut* cut, const AcdfCutPart* part,
                                             double* u, AcdfRange* range, double* probability) {
    uint32_t k = part->first_light, chosen = part->end_light;
    double x = u[0] * part->sum, weight = 0.0;
    for (; k < part->end_light; ++k) {
        if (!(cut->light[k] > 0.0)) continue;
        if (chosen < part->end_light) x -= weight;
        chosen = k;
        weight = cut->light[k];
        if (x < weight) break;
    }
    u[0] = acdf_unit_interval(x / weight);
    for (k = 0; k < 2; ++k) {
        range[k].low = local->bright_tiles[chosen].low[k];
        range[k].high = local->bright_tiles[chosen].high[k];
    }
    *probability = acdf_positive(part->probability * (weight / part->sum));
    return local->bright_tiles[chosen].tile;
}

/* u0 as a number of the part's mixture alone, where it samples from that. */
ACDF_INLINE double acdf_cut_number_of_mixture(const AcdfCutPart* part, double u0) {
    return acdf_unit_interval((u0 * part->sum - part->bright_tiles) / (part->sum - part->bright_tiles));
}

/* The probability of a tile that is `inside` of the part's mixture. */
ACDF_INLINE double acdf_cut_tile_probability(const AcdfCutPart* part, const AcdfMixture* mix, double inside) {
    return acdf_positive(part->probability * (acdf_mixture_sum(mix) / part->sum * inside));
}

/* Samples a cell of a part; u and range as in acdf_tree_sample. Returns its probability, > 0. */
ACDF_FN double acdf_cut_sample_part(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                    const AcdfCutPart* part, double* u, AcdfRange* range) {
    double probability;
    uint32_t tile;
    if (acdf_cut_samples_bright_tile(part, u[0])) {
        tile = acdf_cut_sample_bright_tile(local, cut, part, u, range, &probability);
    } else {
        const AcdfMixture mix = acdf_cut_mixture(point, part);
        u[0] = acdf_cut_number_of_mixture(part, u[0]);
        tile = acdf_cut_sample_tile(local, point, part, &mix, u, range, &probability);
        probability = acdf_cut_tile_probability(part, &mix, probability);
    }
    return acdf_local_sample_inside(local, tile, probability, u, range);
}

/* The probability of a tile that is `inside` of the part's mixture; 0 where no sample can fall. */
ACDF_FN double acdf_cut_found_probability(const AcdfLocal* local, const AcdfCut* cut, const AcdfCutPart* part,
                                          const AcdfMixture* mix, uint32_t tile, double inside) {
    uint32_t light = part->first_light;
    if (!(part->probability > 0.0)) return 0.0;
    if (inside > 0.0) return acdf_cut_tile_probability(part, mix, inside);
    /* No row gives a bright tile any probability. */
    while (light < part->end_light && local->bright_tiles[light].tile < tile) ++light;
    if (light == part->end_light || local->bright_tiles[light].tile != tile || !(cut->light[light] > 0.0))
        return 0.0;
    return acdf_positive(part->probability * (cut->light[light] / part->sum));
}

/* The part that holds a grid square. */
ACDF_FN const AcdfCutPart* acdf_cut_find(const AcdfCut* cut, const uint32_t* square) {
    int child = cut->count > 1 ? 0 : ~0;
    while (child >= 0) {
        const AcdfCutSplit* split = &cut->split[child];
        child = split->child[square[split->place & 7u] >= split->place >> 3];
    }
    return &cut->part[~child];
}

/* What of the mixture a part has, out of 2^52, where rows of halvings serve a point. In it all tiles are as
 * visible.
 */
ACDF_INLINE double acdf_cut_row_mass(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCutPart* part) {
    if (point->cells == 0) return part->sum * 0x1p52;
    return acdf_rows_mass(&point->by.rows, part->tile, acdf_cut_end(local->rows_of_normals, part));
}

/* acdf_cut_pdf where rows of halvings serve a point. */
ACDF_FN float acdf_cut_row_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                               const AcdfGrid* grid, const uint32_t square[2]) {
    const AcdfNormalRows* rows = local->rows_of_normals;
    const AcdfCutPart* part = acdf_cut_find(cut, square);
    AcdfRowCell cell;
    double mass;
    uint32_t tile;
    if (!(part->probability > 0.0)) return 0.0f;
    mass = acdf_cut_row_mass(local, point, part);
    tile = acdf_rows_find_below(rows, acdf_cut_node(part), square);
    cell = acdf_rows_find_cell(local->environment.halved, grid, acdf_row_tile(rows, tile), square);
    return acdf_float_pdf(part->probability * (acdf_rows_mass(&point->by.rows, tile, tile + 1u) / mass) *
                          cell.share * cell.scale);
}

/* acdf_cut_sample where rows of halvings serve a point: from a part, u in [0, 1]. */
ACDF_FN AcdfDirectionSample acdf_cut_row_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                const AcdfCutPart* part, const AcdfGrid* grid, double u[2]) {
    const AcdfNormalRows* rows = local->rows_of_normals;
    const AcdfRowMixture* mix = &point->by.rows;
    const double all = acdf_cut_row_mass(local, point, part);
    double below = acdf_rows_sum(mix, mix->before, part->tile), mass = all;
    const uint32_t tile =
        acdf_rows_search(mix, mix->before, part->tile, acdf_cut_end(rows, part), &below, &mass, &u[1]);
    return acdf_rows_direction(local->environment.halved, grid, acdf_row_tile(rows, tile),
                               part->probability * (mass / all), u);
}

/* Pdf per steradian with which acdf_cut_sample samples `direction` (unit); of cuts that are finished. */
ACDF_CALLED float acdf_cut_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                               const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    const AcdfCutPart* part;
    AcdfMixture mix;
    AcdfRange range[2];
    double p;
    uint32_t square[2], tile;
    if (cut->count == 0 || !acdf_local_square(&grid, direction, square)) return 0.0f;
    if (local->rows_of_normals) return acdf_cut_row_pdf(local, point, cut, &grid, square);
    part = acdf_cut_find(cut, square);
    if (!(part->probability > 0.0)) return 0.0f;
    mix = acdf_cut_mixture(point, part);
    acdf_cut_range(part, range);
    tile = acdf_cut_find_tile(local, point, part, &mix, square, range, &p);
    p = acdf_cut_found_probability(local, cut, part, &mix, tile, p);
    p = acdf_local_find_inside(local, tile, p, square, range);
    return p > 0.0 ? acdf_local_cell_pdf(local, &grid, direction, range, p) : 0.0f;
}

/* The direction that what is left of the random numbers picks in a cell of probability p. */
ACDF_INLINE AcdfDirectionSample acdf_cut_direction_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                          const AcdfCut* cut, const AcdfGrid* grid,
                                                          const AcdfRange range[2], const double u[2], double p) {
    AcdfDirectionSample out = acdf_local_direction_sample(local, point, grid, range, u, p);
    /* A slope makes the pdf depend on where the rounded direction lies. */
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) out.pdf = acdf_cut_pdf(local, point, cut, out.direction);
    return out;
}

/* Samples a direction; u0 (axis 0) and u1 (axis 1) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0
 * (and no direction) where the cut is empty. */
ACDF_CALLED AcdfDirectionSample acdf_cut_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                const AcdfCut* cut, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    const AcdfCutPart* part;
    AcdfRange range[2];
    double u[2], p;
    if (cut->count == 0) return out;
    u[0] = acdf_cut_number(u0);
    u[1] = acdf_cut_number(u1);
    part = acdf_cut_choose_part(cut, u);
    if (local->rows_of_normals) return acdf_cut_row_sample(local, point, part, &grid, u);
    acdf_cut_range(part, range);
    p = acdf_cut_sample_part(local, point, cut, part, u, range);
    return acdf_cut_direction_sample(local, point, cut, &grid, range, u, p);
}

#ifdef __cplusplus
}
#endif
#endif
