/* Only the light that a mixture can see: one freestanding header over acdf/blend.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract (SPEC.md §12).
 *
 * Positions and normals lie in the cells of a k-d tree. A cell has a row of bytes: how much of the bright tiles, of
 * the mixture as a whole and, at each split of tiles that counts in its region (a *column*), of its two parts
 * reaches it. Those *visibilities* multiply what rows of normals give to the two parts; the products are made to
 * add up to 1 again at each split, so that the pdf is exact whatever the bytes are. Near the border of two
 * cells their visibilities are mixed, linearly, so that nothing jumps where at most four cells meet. */
#ifndef ACDF_VISIBILITY_H
#define ACDF_VISIBILITY_H

#include <acdf/blend.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_MAX_CELLS_MIXED = 4 };

typedef struct AcdfVisibilityTable {
    const AcdfVisibility* header;      /* chunk PLAC; null where there is none */
    const AcdfVisibilitySplit* splits; /* behind it */
    const uint16_t* columns;           /* sets of one a split of tiles */
    const uint16_t* set_of_row;        /* null where there is but one set */
    const uint8_t* rows;
    uint32_t bright_tile_count;
} AcdfVisibilityTable;

/* The rows of cells around a position, and their weights, whose sum is 1. None: there are no visibility cells. */
typedef struct AcdfVisibilityMixture {
    uint32_t number[ACDF_MAX_CELLS_MIXED]; /* of the row */
    const uint8_t* row[ACDF_MAX_CELLS_MIXED];
    const uint16_t* columns[ACDF_MAX_CELLS_MIXED]; /* of the row */
    double weight[ACDF_MAX_CELLS_MIXED];
    int count;
    int alike; /* all have the same columns, as cells of one region have */
} AcdfVisibilityMixture;

/* The visibility that a byte stands for: 31/32 to 2^-16, in steps of 1/16 to 1/31. Its upper half is the exponent,
 * the lower one begins the mantissa. */
ACDF_FN double acdf_visibility_of_code(uint8_t code) {
    const uint64_t bits = (uint64_t)(code + (1007u << 4)) << 48;
    double out;
    memcpy(&out, &bits, sizeof out);
    return out;
}

/* The bytes of a row, and where those of one begin. */
ACDF_FN size_t acdf_visibility_width(const AcdfVisibilityTable* table) {
    return (size_t)1 + table->bright_tile_count + table->header->column_count;
}
ACDF_FN const uint8_t* acdf_visibility_row(const AcdfVisibilityTable* table, uint32_t number) {
    return table->rows + number * acdf_visibility_width(table);
}

/* Finds the rows of a mixture by their numbers. */
ACDF_INLINE void acdf_visibility_open(const AcdfVisibilityTable* table, uint32_t tile_count,
                                      AcdfVisibilityMixture* mixture) {
    const size_t width = acdf_visibility_width(table);
    int i;
    mixture->alike = 1;
    for (i = 0; i < mixture->count; ++i) {
        const uint32_t set = table->set_of_row ? table->set_of_row[mixture->number[i]] : 0;
        mixture->row[i] = table->rows + mixture->number[i] * width;
        mixture->columns[i] = table->columns + (size_t)set * (tile_count - 1);
        mixture->alike &= mixture->columns[i] == mixture->columns[0];
    }
}

/* Number `index` of a row: 0 is the mixture, 1 + k bright tile k. */
ACDF_FN double acdf_mixture_visibility(const AcdfVisibilityMixture* mixture, uint32_t index) {
    double sum = 0.0;
    int i;
    for (i = 0; i < mixture->count; ++i)
        sum += mixture->weight[i] * acdf_visibility_of_code(mixture->row[i][index]);
    return sum;
}

/* Those of all bright tiles. */
ACDF_FN void acdf_visibility_of_tiles(const AcdfVisibilityMixture* mixture, uint32_t count, double* out) {
    uint32_t k;
    int i;
    for (k = 0; k < count; ++k) out[k] = 0.0;
    for (i = 0; i < mixture->count; ++i) {
        const uint8_t* row = mixture->row[i] + 1;
        const double weight = mixture->weight[i];
        for (k = 0; k < count; ++k) out[k] += weight * acdf_visibility_of_code(row[k]);
    }
}

/* A position of the scene and a normal among the cells; 0 where it lies outside. */
ACDF_FN int acdf_visibility_coordinates(const AcdfVisibilityTable* table, const float position[3],
                                        const float normal[3], double out[6]) {
    const AcdfVisibility* header = table->header;
    const double x = (double)normal[0], y = (double)normal[1], z = (double)normal[2];
    const double length = sqrt(x * x + y * y + z * z);
    int k;
    for (k = 0; k < 3; ++k) out[3 + k] = (double)normal[k] / length;
    for (k = 0; k < 3; ++k) {
        const float* t = header->transform[k];
        out[k] = (double)t[0] * (double)position[0] + (double)t[1] * (double)position[1] +
                 (double)t[2] * (double)position[2] + (double)t[3];
        if (!(out[k] >= (double)header->low[k] && out[k] <= (double)header->high[k])) return 0;
    }
    return 1;
}

/* Finds the cells around a position and a normal (of any length but 0); `out` becomes empty outside of all of them.
 * Where it is within reach of so many borders that more than four cells would be mixed, the lighter side of a
 * border is left out. */
ACDF_FN void acdf_visibility_at(const AcdfVisibilityTable* table, uint32_t tile_count, const float position[3],
                                const float normal[3], AcdfVisibilityMixture* out) {
    uint32_t* const node = out->number;
    double x[6];
    int i;
    out->count = 0;
    if (!table->header || !acdf_visibility_coordinates(table, position, normal, x)) return;
    for (i = 0; i < ACDF_MAX_CELLS_MIXED; ++i) { /* all of them: points keep them as they lie */
        node[i] = 0;
        out->weight[i] = 0.0;
    }
    node[0] = table->header->split_count > 0 ? 0 : ACDF_VISIBILITY_ROW;
    out->weight[0] = 1.0;
    out->count = 1;
    for (i = 0; i < out->count; ++i) {
        uint32_t now = node[i];
        const uint8_t* row;
        while (!(now & ACDF_VISIBILITY_ROW)) {
            const AcdfVisibilitySplit* split = &table->splits[now];
            const double above = x[split->lower & 7u] - (double)split->position, blend = (double)split->blend;
            const uint32_t lower = split->lower >> 3, upper = split->upper;
            if (!(upper & ACDF_VISIBILITY_ROW))
                ACDF_PREFETCH(&table->splits[upper]); /* the lower one is the next */
            if (fabs(above) < blend && out->count < ACDF_MAX_CELLS_MIXED) {
                const double share = out->weight[i] * ((above + blend) / (2.0 * blend));
                node[out->count] = upper;
                out->weight[out->count++] = share;
                out->weight[i] -= share;
                now = lower;
            } else { /* which one is not to be guessed: no branch */
                now = lower ^ ((lower ^ upper) & (0u - (uint32_t)(above >= 0.0)));
            }
        }
        node[i] = now & ~ACDF_VISIBILITY_ROW;
        row = acdf_visibility_row(table, node[i]);
        ACDF_PREFETCH(row);
        ACDF_PREFETCH(row + acdf_visibility_width(table) / 2);
    }
    acdf_visibility_open(table, tile_count, out);
}

/* The odds of a split, out of 65535; below 0 where none of the cells has a column for it. */
ACDF_INLINE double acdf_visibility_odds(const AcdfVisibilityTable* table, const uint16_t* codebook,
                                        const AcdfVisibilityMixture* mixture, const int visibility, uint32_t node) {
    const uint32_t first = 1 + table->bright_tile_count;
    double odds = 0.0;
    int i, known = 0;
    if (mixture->alike) {
        const uint32_t column = mixture->columns[0][node];
        if (column == ACDF_NO_COLUMN) return -1.0;
        for (i = 0; i < visibility; ++i)
            odds += mixture->weight[i] * (double)codebook[mixture->row[i][first + column]];
        return odds;
    }
    for (i = 0; i < visibility; ++i) {
        const uint32_t column = mixture->columns[i][node];
        known |= column != ACDF_NO_COLUMN;
        odds += mixture->weight[i] *
                (column != ACDF_NO_COLUMN ? (double)codebook[mixture->row[i][first + column]] : 32767.5);
    }
    return known ? odds : -1.0;
}

/* What of the weights of rows falls into the two parts of a split, times their visibility; `lower` is what of each
 * row falls into the lower one, without it. */
ACDF_INLINE void acdf_visibility_split(const AcdfVisibilityTable* table, const AcdfBlend* blend,
                                       const AcdfMixture* mix, const int rows, const AcdfVisibilityMixture* mixture,
                                       const int visibility, uint32_t node, const double* weight, double* lower,
                                       double part[2]) {
    const uint16_t* codebook = blend->tiles->codebook;
    const double odds = acdf_visibility_odds(table, codebook, mixture, visibility, node);
    int i;
    part[0] = part[1] = 0.0;
    for (i = 0; i < rows; ++i) {
        part[0] += lower[i] = weight[i] * ((double)codebook[mix->row[i][node]] * (1.0 / 65535.0));
        part[1] += weight[i] - lower[i];
    }
    if (odds >= 0.0) {
        part[0] *= odds;
        part[1] *= 65535.0 - odds;
    }
}

ACDF_INLINE uint32_t acdf_visibility_sample_rows(const AcdfVisibilityTable* table, const AcdfBlend* blend,
                                                 const AcdfMixture* mix, const int rows,
                                                 const AcdfVisibilityMixture* mixture, const int visibility,
                                                 uint32_t node, double* u, AcdfRange* range, double* probability) {
    double weight[ACDF_MAX_ROWS_MIXED], lower[ACDF_MAX_ROWS_MIXED], part[2], p = 1.0;
    int i;
    for (i = 0; i < rows; ++i) weight[i] = mix->weight[i];
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t axis = split->place & 7u, position = split->place >> 3;
        double sum, x;
        acdf_visibility_split(table, blend, mix, rows, mixture, visibility, node, weight, lower, part);
        sum = part[0] + part[1];
        x = u[axis] * sum;
        if (!(x < part[0]) && part[1] > 0.0) {
            u[axis] = acdf_unit_interval((x - part[0]) / part[1]);
            p *= part[1] / sum;
            for (i = 0; i < rows; ++i) weight[i] -= lower[i];
            range[axis].low = position;
            node = split->child[1];
        } else {
            u[axis] = acdf_unit_interval(x / part[0]);
            p *= part[0] / sum;
            for (i = 0; i < rows; ++i) weight[i] = lower[i];
            range[axis].high = position;
            node = split->child[0];
        }
    }
    *probability = acdf_positive(p);
    return node & ~ACDF_TILE_FLAG;
}

ACDF_INLINE uint32_t acdf_visibility_find_rows(const AcdfVisibilityTable* table, const AcdfBlend* blend,
                                               const AcdfMixture* mix, const int rows,
                                               const AcdfVisibilityMixture* mixture, const int visibility,
                                               uint32_t node, const uint32_t* square, AcdfRange* range,
                                               double* probability) {
    double weight[ACDF_MAX_ROWS_MIXED], lower[ACDF_MAX_ROWS_MIXED], part[2], p = 1.0;
    int i, lit = rows > 0 && acdf_mixture_sum(mix) > 0.0; /* not within a bright tile */
    for (i = 0; i < rows; ++i) weight[i] = mix->weight[i];
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t axis = split->place & 7u, position = split->place >> 3;
        const int upper = square[axis] >= position;
        acdf_visibility_split(table, blend, mix, rows, mixture, visibility, node, weight, lower, part);
        if (upper)
            for (i = 0; i < rows; ++i) weight[i] -= lower[i];
        else
            for (i = 0; i < rows; ++i) weight[i] = lower[i];
        if (upper) range[axis].low = position;
        else range[axis].high = position;
        if (part[upper] > 0.0) p *= part[upper] / (part[0] + part[1]);
        else lit = 0;
        node = split->child[upper];
    }
    *probability = lit ? acdf_positive(p) : 0.0;
    return node & ~ACDF_TILE_FLAG;
}

/* The traversals for as many rows of normals and of visibility as there are, each known to the compiler where that
 * is usual.
 */
#define ACDF_VISIBILITY_WALK(rows, visibility)                                                                     \
    if (mix->count == (rows) && mixture->count == (visibility)) return ACDF_VISIBILITY_CALL(rows, visibility)
#define ACDF_VISIBILITY_WALKS                                                                                      \
    ACDF_VISIBILITY_WALK(3, 1);                                                                                    \
    ACDF_VISIBILITY_WALK(3, 2);                                                                                    \
    ACDF_VISIBILITY_WALK(3, 4);                                                                                    \
    ACDF_VISIBILITY_WALK(1, 1);                                                                                    \
    ACDF_VISIBILITY_WALK(1, 2);                                                                                    \
    ACDF_VISIBILITY_WALK(1, 4);                                                                                    \
    return ACDF_VISIBILITY_CALL(mix->count, mixture->count)

/* Samples a tile, as acdf_blend_sample_below does, of a mixture as a mixture sees it (which has a row at least). */
ACDF_FN uint32_t acdf_visibility_sample_below(const AcdfVisibilityTable* table, const AcdfBlend* blend,
                                              const AcdfMixture* mix, const AcdfVisibilityMixture* mixture,
                                              uint32_t node, double* u, AcdfRange* range, double* probability) {
#define ACDF_VISIBILITY_CALL(rows, visibility)                                                                     \
    acdf_visibility_sample_rows(table, blend, mix, rows, mixture, visibility, node, u, range, probability)
    ACDF_VISIBILITY_WALKS;
#undef ACDF_VISIBILITY_CALL
}

/* Finds the tile of a grid square, as acdf_blend_find_below does. */
ACDF_FN uint32_t acdf_visibility_find_below(const AcdfVisibilityTable* table, const AcdfBlend* blend,
                                            const AcdfMixture* mix, const AcdfVisibilityMixture* mixture,
                                            uint32_t node, const uint32_t* square, AcdfRange* range,
                                            double* probability) {
#define ACDF_VISIBILITY_CALL(rows, visibility)                                                                     \
    acdf_visibility_find_rows(table, blend, mix, rows, mixture, visibility, node, square, range, probability)
    ACDF_VISIBILITY_WALKS;
#undef ACDF_VISIBILITY_CALL
}
#undef ACDF_VISIBILITY_WALK
#undef ACDF_VISIBILITY_WALKS

#ifdef __cplusplus
}
#endif
#endif
