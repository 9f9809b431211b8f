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
    for (i = 0; i < cut->count; i += ACDF_BLOCK_BOXES) {
        uint8_t* byte = (uint8_t*)cut->boxes[(uint32_t)i / ACDF_BLOCK_BOXES];
        const uint32_t* side = sides + ACDF_CUT_MAX_PARTS + ~i;
        for (k = 0; k < ACDF_BLOCK_BOXES; ++k, ++byte) {
            const uint32_t box = i + k < cut->count ? side[-k] : 0x807F807Fu; /* which holds nothing */
            byte[0] = (uint8_t)box;
            byte[ACDF_BLOCK_BOXES] = (uint8_t)(box >> 8);
            byte[2 * ACDF_BLOCK_BOXES] = (uint8_t)(box >> 16);
            byte[3 * ACDF_BLOCK_BOXES] = (uint8_t)(box >> 24);
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
        for (k = 0; k < 4 && first + k * ACDF_BLOCK_BOXES < cut->count; ++k)
            mask[k >> 1] |= acdf_cut_candidates(cut, first / ACDF_BLOCK_BOXES + k, step)
                            << (k & 1) * ACDF_BLOCK_BOXES;
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

/* Samples a part. */
ACDF_FN const AcdfCutPart* acdf_cut_choose_part(const AcdfCut* cut, double u[2]) {
    return acdf_cut_sample_guessed(cut, acdf_cut_guess(cut, u, 0), u);
}

/* The part that holds a grid square. */
ACDF_FN const AcdfCutPart* acdf_cut_find(const AcdfCut* cut, const uint32_t* square) {
    int child = cut->count > 1 ? 0 : ~0;
    while (child >= 0) {
        const AcdfCutSplit* split = &cut->split[child];
        child = split->child[square[split->place & 1u] >= split->place >> 1];
    }
    return &cut->part[~child];
}

/* What of the mixture a part has, out of 2^52. In it all tiles are as visible. */
ACDF_INLINE double acdf_cut_mass(const AcdfVisiblePoint* point, const AcdfCutPart* part) {
    return !point->in_cell ? part->sum * 0x1p52 : acdf_rows_mass(&point->local.by.rows, part->first, part->end);
}

/* Pdf per steradian with which acdf_cut_sample samples `direction` (unit); of cuts that are finished. */
ACDF_CALLED float acdf_cut_pdf(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point, const AcdfCut* cut,
                               const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&light->local.environment);
    AcdfRowSpot spot;
    AcdfRowCell cell;
    const AcdfCutPart* part;
    double inside;
    if (cut->count == 0) return 0.0f;
    spot = acdf_rows_spot(light->local.rows_of_normals, &grid, direction);
    if (!acdf_rows_locate(light->local.rows_of_normals, light->local.environment.halved, &grid, &spot, direction,
                          &cell))
        return 0.0f;
    part = acdf_cut_find(cut, spot.square);
    if (!(part->probability > 0.0)) return 0.0f;
    inside = acdf_rows_mass(&point->local.by.rows, spot.tile, spot.tile + 1u) / acdf_cut_mass(point, part);
    return acdf_float_pdf(part->probability * inside * cell.share * cell.scale);
}

/* Samples a direction; u0 (axis 0) and u1 (axis 1) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0
 * (and no direction) where the cut is empty. */
ACDF_CALLED AcdfDirectionSample acdf_cut_sample(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point,
                                                const AcdfCut* cut, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(&light->local.environment);
    const AcdfRowMixture* mix = &point->local.by.rows;
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    const AcdfCutPart* part;
    double u[2], all, below, mass;
    uint32_t tile;
    if (cut->count == 0) return out;
    u[0] = acdf_cut_number(u0);
    u[1] = acdf_cut_number(u1);
    part = acdf_cut_choose_part(cut, u);
    all = mass = acdf_cut_mass(point, part);
    below = acdf_rows_sum(mix, mix->before, part->first);
    tile = acdf_rows_search(mix, mix->before, part->first, part->end, &below, &mass, &u[1]);
    return acdf_rows_direction(light->local.environment.halved, &grid,
                               acdf_row_tile(light->local.rows_of_normals, tile), part->probability * (mass / all),
                               u);
}

#ifdef __cplusplus
}
#endif
#endif
