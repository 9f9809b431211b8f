/* Visibility cells: only the light that reaches a position. One freestanding header over acdf/normal_rows.h, valid
 * C99, C++17 and CUDA/HIP/SYCL, with the same contract (SPEC.md §12).
 *
 * Positions and normals lie in the cells of a k-d tree. The tiles of the tree of halvings, in their order, are
 * parted at *columns*, which all cells of a region have. A cell has a row of bytes: how much of all light reaches
 * it and, at each column, how much from either side. Those multiply what rows of normals give to the sides; the
 * products are made to add up to 1 again at each column, so that the pdf is exact whatever the bytes are. */
#ifndef ACDF_VISIBILITY_CELLS_H
#define ACDF_VISIBILITY_CELLS_H

#include <acdf/normal_rows.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfVisibilityTable {
    const AcdfVisibility* header;      /* chunk PLAC; null where there is none */
    const AcdfVisibilitySplit* splits; /* behind it */
    const AcdfColumn* columns;         /* sets of them */
    const uint16_t* set_of_row;        /* null where there is but one set */
    const uint8_t* rows;
    const double* odds; /* [256]: of what a column's code gives both sides, the share of the lower one */
} AcdfVisibilityTable;

/* A visibility cell. */
typedef struct AcdfVisibilityCell {
    uint32_t number; /* of its row */
    const uint8_t* row;
    const AcdfColumn* columns; /* of the row */
} AcdfVisibilityCell;

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
    return (size_t)1 + table->header->column_count;
}
ACDF_FN const uint8_t* acdf_visibility_row(const AcdfVisibilityTable* table, uint32_t number) {
    return table->rows + number * acdf_visibility_width(table);
}

ACDF_INLINE AcdfVisibilityCell acdf_visibility_cell(const AcdfVisibilityTable* table, uint32_t number) {
    AcdfVisibilityCell out;
    out.number = number;
    out.row = acdf_visibility_row(table, number);
    out.columns =
        table->columns + (size_t)(table->set_of_row ? table->set_of_row[number] : 0) * table->header->column_count;
    return out;
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

/* Finds the cell of a position and a normal (of any length but 0). Returns 0 outside of all cells, and where there
 * are none. */
ACDF_FN int acdf_visibility_at(const AcdfVisibilityTable* table, const float position[3], const float normal[3],
                               AcdfVisibilityCell* out) {
    double x[6];
    uint32_t node;
    if (!table->header || !acdf_visibility_coordinates(table, position, normal, x)) return 0;
    node = table->header->split_count > 0 ? 0 : ACDF_VISIBILITY_ROW;
    while (!(node & ACDF_VISIBILITY_ROW)) {
        const AcdfVisibilitySplit* split = &table->splits[node];
        const uint32_t lower = split->lower >> 3, upper = split->upper;
        const uint32_t above = (uint32_t)(x[split->lower & 7u] >= (double)split->position);
        if (!(upper & ACDF_VISIBILITY_ROW)) ACDF_PREFETCH(&table->splits[upper]); /* the lower one is the next */
        node = lower ^ ((lower ^ upper) & (0u - above)); /* which one is not to be guessed: no branch */
    }
    *out = acdf_visibility_cell(table, node & ~ACDF_VISIBILITY_ROW);
    ACDF_PREFETCH(out->row);
    ACDF_PREFETCH(out->row + acdf_visibility_width(table) / 2);
    return 1;
}

/* ---- rows of codes as a position sees them ----------------------------------------------------------------- */

/* A mixture of rows, and the cell of a position. */
typedef struct AcdfVisibleRows {
    const AcdfNormalRows* rows;
    const AcdfRowMixture* mix;
    const AcdfVisibilityTable* table;
    const AcdfVisibilityCell* cell;
} AcdfVisibleRows;

#define ACDF_UNSEEN                                                                                                \
    0x1p-6 /* of the samples, those that are as without cells: no weight grows more than 64-fold                   \
            */
#define ACDF_NO_PARTS 0xFFFFFFFFu

/* Tiles [first, end) of a cell, parted at `column`, or ACDF_NO_PARTS: of the mixture, out of 2^52, `below` lie
 * before them and `mass` in them; of the cell's samples they have `share`. */
typedef struct AcdfVisiblePart {
    uint32_t column, first, end;
    double below, mass, share;
} AcdfVisiblePart;

ACDF_INLINE AcdfVisiblePart acdf_visible_all(const AcdfVisibleRows* in) {
    AcdfVisiblePart out;
    out.column = in->table->header->column_count > 0 ? 0 : ACDF_NO_PARTS;
    out.first = 0;
    out.end = in->rows->splits + 1u;
    out.below = 0.0;
    out.mass = 0x1p52;
    out.share = 1.0;
    return out;
}

/* Both sides of a column. */
typedef struct AcdfVisibleSides {
    AcdfColumn column;
    double lower;    /* what of the mixture the lower side has */
    double given[2]; /* what of the samples both have, to a common scale */
} AcdfVisibleSides;

ACDF_INLINE AcdfVisibleSides acdf_visible_sides(const AcdfVisibleRows* in, const AcdfVisiblePart* at) {
    const double odds = in->table->odds[in->cell->row[1u + at->column]];
    AcdfVisibleSides out;
    out.column = in->cell->columns[at->column];
    out.lower = acdf_rows_sum(in->mix, in->mix->before, out.column.tile) - at->below;
    out.given[0] = out.lower * odds;
    out.given[1] = (at->mass - out.lower) * (1.0 - odds);
    return out;
}
ACDF_INLINE void acdf_visible_enter(AcdfVisiblePart* at, const AcdfVisibleSides* sides, uint32_t upper) {
    const uint32_t parts = sides->column.parts;
    at->share *= sides->given[upper] / (sides->given[0] + sides->given[1]);
    if (upper) {
        at->below += sides->lower;
        at->mass -= sides->lower;
        at->first = sides->column.tile;
        at->column = parts & 0x7FFFu ? parts & 0x7FFFu : ACDF_NO_PARTS;
    } else {
        at->mass = sides->lower;
        at->end = sides->column.tile;
        at->column = parts & 0x8000u ? ACDF_NO_PARTS : at->column + 1u;
    }
}

/* What of the samples of a cell lies in a tile, and in those before it. */
ACDF_INLINE double acdf_visible_in_cell(const AcdfVisibleRows* in, uint32_t tile, double* before) {
    AcdfVisiblePart at = acdf_visible_all(in);
    double mass;
    *before = 0.0;
    while (at.column != ACDF_NO_PARTS) {
        const AcdfVisibleSides sides = acdf_visible_sides(in, &at);
        const uint32_t upper = (uint32_t)(tile >= sides.column.tile);
        if (upper && sides.given[0] > 0.0)
            *before += at.share * (sides.given[0] / (sides.given[0] + sides.given[1]));
        if (!(sides.given[upper] > 0.0)) return 0.0;
        acdf_visible_enter(&at, &sides, upper);
    }
    *before += at.share * (acdf_rows_mass(in->mix, at.first, tile) / at.mass);
    mass = tile < at.end ? acdf_rows_mass(in->mix, tile, tile + 1u) : 0.0;
    return at.share * (mass / at.mass);
}

/* What of all samples a tile has: exactly that of acdf_visible_sample_tile. */
ACDF_INLINE double acdf_visible_share(const AcdfVisibleRows* in, uint32_t tile) {
    double before, share = acdf_visible_in_cell(in, tile, &before);
    share = (1.0 - ACDF_UNSEEN) * share + ACDF_UNSEEN * (acdf_rows_mass(in->mix, tile, tile + 1u) * 0x1p-52);
    return share > 0.0 ? acdf_positive(share) : 0.0;
}

/* What of all samples lies in the tiles before one. */
ACDF_INLINE double acdf_visible_before(const AcdfVisibleRows* in, uint32_t tile) {
    double before;
    acdf_visible_in_cell(in, tile, &before);
    return (1.0 - ACDF_UNSEEN) * before + ACDF_UNSEEN * (acdf_rows_mass(in->mix, 0, tile) * 0x1p-52);
}

/* Samples a tile as the cell sees it. u in [0, 1] is rescaled to [0, 1] in the tile. */
ACDF_INLINE uint32_t acdf_visible_choose_tile(const AcdfVisibleRows* in, double u[2]) {
    AcdfVisiblePart at = acdf_visible_all(in);
    while (at.column != ACDF_NO_PARTS) {
        const AcdfVisibleSides sides = acdf_visible_sides(in, &at);
        const double x = u[0] * (sides.given[0] + sides.given[1]);
        const uint32_t upper = (uint32_t)(!(x < sides.given[0]) && sides.given[1] > 0.0);
        u[0] = acdf_unit_interval(upper ? (x - sides.given[0]) / sides.given[1] : x / sides.given[0]);
        acdf_visible_enter(&at, &sides, upper);
    }
    return acdf_rows_search(in->mix, in->mix->before, at.first, at.end, &at.below, &at.mass, &u[1]);
}

/* Samples a tile, and what of all samples it has; u as above. */
ACDF_INLINE const AcdfTopTile* acdf_visible_sample_tile(const AcdfVisibleRows* in, double u[2], double* share) {
    uint32_t tile;
    if (u[0] < ACDF_UNSEEN) {
        u[0] = u[0] / ACDF_UNSEEN;
        tile = (uint32_t)(acdf_rows_sample_tile(in->rows, in->mix, u, share) - acdf_row_tile(in->rows, 0));
    } else {
        u[0] = (u[0] - ACDF_UNSEEN) / (1.0 - ACDF_UNSEEN);
        tile = acdf_visible_choose_tile(in, u);
    }
    *share = acdf_visible_share(in, tile);
    return acdf_row_tile(in->rows, tile);
}

#ifdef __cplusplus
}
#endif
#endif
