/* A cut through the tiles of a local environment map: boxes that cover the sphere, each a split of the file with
 * all below it, each with a probability of its own. What product sampling weighs at a shading point
 * (acdf/product/product.h). One freestanding header over acdf/local.h, valid C99, C++17 and CUDA/HIP/SYCL, with the
 * same contract.
 *
 * Within a part the pdf is that of the local map, light times cosine; how much each part gets is up to whoever
 * made the cut. A direction's part is found by the cut's own splits, then the map's traversal goes on from there:
 * what the cut does first the map need not do again. */
#ifndef ACDF_CUT_H
#define ACDF_CUT_H

#include <acdf/box_middle.h>
#include <acdf/local.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    ACDF_CUT_MAX_PARTS = 96,
    ACDF_CUT_BLOCKS = ACDF_CUT_MAX_PARTS / ACDF_BLOCK_CELLS,
    ACDF_CUT_MAX_BRIGHT_TILES = 64
};

/* A box: what lies below a split or in a tile. What samples and pdfs read stands first. */
typedef struct AcdfCutPart {
    double numbers[2][2];              /* random numbers that sample it: from low to high of axis 0, of axis 1 */
    double weight[ACDF_NORMALS_MIXED]; /* what each row gives to it */
    double bright_tiles;               /* weights of the bright tiles in it */
    double sum;                        /* of all weights */
    double probability;                /* of the cut, for its maker to set */
    uint16_t node;                     /* the split, or the tile with its flag */
    uint16_t entry;                    /* the same in runtime tables */
    uint16_t first_light, end_light;   /* which bright tiles lie in it */
    uint32_t low[2], high[2];
    uint32_t tile;  /* the first tile in it; they are numbered in the order of the traversal */
    uint16_t owner; /* 2 * split of the cut + side; of the whole: not used */
    uint16_t depth; /* how many splits lie above it */
} AcdfCutPart;

typedef struct AcdfCutSplit {
    uint32_t place;   /* axis and position, as in AcdfSplit */
    int16_t child[2]; /* another split; or the complement of a part's number */
} AcdfCutSplit;

typedef struct AcdfCut {
    int count;              /* of parts; 0: there is nothing to sample */
    int nearest;            /* which of the rows weighs most */
    const uint16_t* hearts; /* by tables: which tiles that row lights most below each split; null: they have none */
    AcdfVisibilityMixture cells; /* of the point, where it has any */
    AcdfCutPart part[ACDF_CUT_MAX_PARTS];
    AcdfCutSplit split[ACDF_CUT_MAX_PARTS - 1];
    uint32_t boxes[ACDF_CUT_BLOCKS][16];     /* `numbers` of 16 parts each, as AcdfSquares has boxes */
    double light[ACDF_CUT_MAX_BRIGHT_TILES]; /* weight of each */
} AcdfCut;

ACDF_FN double acdf_cut_bright_tiles(const AcdfCut* cut, uint32_t first, uint32_t end) {
    double sum = 0.0;
    for (; first < end; ++first) sum += cut->light[first];
    return sum;
}

/* Whether a cut can be made where rows of halvings serve a point: numbers of nodes and tiles have 15 bits. */
ACDF_INLINE int acdf_cut_serves_rows(const AcdfLocal* local) {
    return local->rows_of_normals->splits < ACDF_TILE_FLAG;
}

/* A node of rows of halvings, as parts number it, and back. */
ACDF_INLINE uint16_t acdf_cut_of_node(uint32_t node) {
    return (uint16_t)((node & ACDF_TOP_TILE ? ACDF_TILE_FLAG : 0u) | (node & ~ACDF_TOP_TILE));
}
ACDF_INLINE uint32_t acdf_cut_node(const AcdfCutPart* part) {
    return part->node & ACDF_TILE_FLAG ? ACDF_TOP_TILE | (part->node & ~ACDF_TILE_FLAG) : part->node;
}

/* The end of the tiles of a part: the one behind the last. */
ACDF_INLINE uint32_t acdf_cut_end(const AcdfNormalRows* rows, const AcdfCutPart* part) {
    uint32_t node = acdf_cut_node(part);
    while (!(node & ACDF_TOP_TILE)) node = acdf_row_splits(rows)[node].child[1];
    return (node & ~ACDF_TOP_TILE) + 1u;
}

/* acdf_cut_begin where rows of halvings serve a point. */
ACDF_FN void acdf_cut_begin_rows(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfCut* cut) {
    AcdfCutPart* whole = &cut->part[0];
    int k;
    memset(whole, 0, sizeof *whole);
    cut->count = 1;
    cut->nearest = 0;
    cut->hearts = 0;
    for (k = 1; k < point->by.rows.count; ++k)
        if (point->by.rows.weight[k] > point->by.rows.weight[cut->nearest]) cut->nearest = k;
    if (point->cells > 0) acdf_local_cells(local, point, &cut->cells);
    whole->node = local->rows_of_normals->splits ? 0 : ACDF_TILE_FLAG;
    whole->high[0] = local->environment.columns;
    whole->high[1] = local->environment.rows;
    whole->sum = 1.0;
    whole->probability = 1.0;
}

/* Which tiles row k of a point lights most below each split, by tables; null: they have none. */
ACDF_INLINE const uint16_t* acdf_cut_hearts(const AcdfLocal* local, const AcdfLocalPoint* point, int k) {
    const AcdfLocalTables* tables = local->tables;
    if (!tables || !tables->hearts || point->mix.count == 0) return 0;
    return acdf_local_hearts(tables, point->by.tabled.codes[k]);
}

/* The whole as one part, of probability 1. For points that bright tiles and shared tiles serve (ACDF_LOCAL_BLEND),
 * or rows of halvings (ACDF_LOCAL_ROWS). */
ACDF_FN void acdf_cut_begin(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfCut* cut) {
    AcdfCutPart* whole = &cut->part[0];
    uint32_t i;
    int k;
    if (local->rows_of_normals) {
        acdf_cut_begin_rows(local, point, cut);
        return;
    }
    cut->count = 1;
    if (acdf_local_tabled(local)) {
        const AcdfBrightTilePair* pair = acdf_local_bright_tiles(local->tables);
        const AcdfScaledNormal normal = acdf_local_scaled_normal(point);
        const AcdfHorizon horizon = acdf_horizon(&normal);
        for (i = 0; i < local->bright_tile_count; i += 2)
            acdf_store_weights(acdf_bright_tile_pair_weights(pair++, &horizon), &cut->light[i]);
    } else
        for (i = 0; i < local->bright_tile_count; ++i)
            cut->light[i] = acdf_local_bright_tile_weight(local, point, i);
    whole->node = (uint16_t)acdf_blend_root(&local->blend);
    whole->entry = (uint16_t)(local->tables ? local->tables->tiles.root : 0);
    whole->depth = 0;
    whole->tile = 0;
    whole->first_light = 0;
    whole->end_light = (uint16_t)local->bright_tile_count;
    whole->owner = 0;
    whole->low[0] = whole->low[1] = 0;
    whole->high[0] = local->environment.columns;
    whole->high[1] = local->environment.rows;
    for (k = 0; k < ACDF_NORMALS_MIXED; ++k) whole->weight[k] = k < point->mix.count ? point->mix.weight[k] : 0.0;
    cut->nearest = 0;
    for (k = 1; k < point->mix.count; ++k)
        if (point->mix.weight[k] > point->mix.weight[cut->nearest]) cut->nearest = k;
    cut->hearts = acdf_cut_hearts(local, point, cut->nearest);
    whole->bright_tiles = acdf_cut_bright_tiles(cut, 0, whole->end_light);
    whole->sum = whole->bright_tiles + acdf_mixture_sum(&point->mix);
    whole->probability = 1.0;
}

/* The rows of a point as divisions read them, in tables or in the file. */
ACDF_INLINE const uint8_t* const* acdf_cut_rows(const AcdfLocal* local, const AcdfLocalPoint* point) {
    return acdf_local_tabled(local) ? point->by.tabled.codes : point->mix.row;
}

/* Asks for what divisions of the whole into `parts` read of the rows, so that it comes while something else is
 * done: the upper splits, which stand first, and for many parts all. */
ACDF_FN void acdf_cut_ahead(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut, int parts) {
    const uint32_t some = 32u * (uint32_t)(parts < ACDF_CUT_MAX_PARTS ? parts : ACDF_CUT_MAX_PARTS);
    uint32_t split, end;
    int i;
    if (!cut->hearts) return;
    end = local->tables->tiles.stride < some ? local->tables->tiles.stride : some;
    for (split = 0; split < end; split += 32) ACDF_PREFETCH(cut->hearts + split);
    for (i = 0; i < point->mix.count; ++i)
        for (split = 0; split < end; split += 64) ACDF_PREFETCH(acdf_cut_rows(local, point)[i] + split);
}

/* Whether a part can be divided: it is no tile, and there is room. */
ACDF_FN int acdf_cut_divisible(const AcdfCut* cut, int part) {
    return !(cut->part[part].node & ACDF_TILE_FLAG) && cut->count < ACDF_CUT_MAX_PARTS;
}

/* What each row gives to the halves of a part, `upper` and the part itself; *high becomes the sum of the upper one.
 * Returns that of the lower one. */
ACDF_INLINE double acdf_cut_share_rows(const uint16_t* codebook, const uint8_t* const* row, const int rows,
                                       uint32_t split, AcdfCutPart* part, AcdfCutPart* upper, double* high) {
    double low = 0.0;
    int i;
    *high = 0.0;
    for (i = 0; i < rows; ++i) {
        const double weight = part->weight[i];
        const double code = (double)codebook[row[i][split]];
        const double lower = weight * (code * (1.0 / 65535.0));
        low += part->weight[i] = lower;
        *high += upper->weight[i] = weight - lower;
    }
    return low;
}
ACDF_FN double acdf_cut_share(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfCutPart* part,
                              AcdfCutPart* upper, double* high) {
    const uint16_t* codebook = local->blend.tiles->codebook;
    const uint8_t* const* row = acdf_cut_rows(local, point);
    const uint32_t split = acdf_local_tabled(local) ? part->entry : part->node;
    switch (point->mix.count) {
    case 3:
        return acdf_cut_share_rows(codebook, row, 3, split, part, upper, high);
    default:
        return acdf_cut_share_rows(codebook, row, point->mix.count, split, part, upper, high);
    }
}

/* The bright tiles of the halves of a part, whose numbers `upper` has, too. */
ACDF_FN void acdf_cut_share_bright_tiles(const AcdfLocal* local, const AcdfCut* cut, AcdfCutPart* part,
                                         AcdfCutPart* upper) {
    const uint32_t end = part->end_light;
    uint32_t k, count = 0;
    double sum[2] = {0.0, 0.0};
    for (k = part->first_light; k < end; ++k) {
        const uint32_t below = (uint32_t)(local->bright_tiles[k].tile < upper->tile);
        sum[below ^ 1u] += cut->light[k];
        count += below;
    }
    part->bright_tiles = sum[0];
    upper->bright_tiles = sum[1];
    upper->end_light = part->end_light;
    part->end_light = upper->first_light = (uint16_t)(part->first_light + count);
}

/* Adds a split of a part. Returns the upper half, which is the last part. */
ACDF_INLINE AcdfCutPart* acdf_cut_add_split(AcdfCut* cut, int number, uint32_t place) {
    const int count = cut->count - 1;
    AcdfCutPart *part = &cut->part[number], *upper = &cut->part[cut->count];
    cut->split[count].place = place;
    cut->split[count].child[0] = (int16_t)~number;
    cut->split[count].child[1] = (int16_t)~cut->count;
    if (count > 0) cut->split[part->owner >> 1].child[part->owner & 1u] = (int16_t)count;
    ++cut->count;
    part->owner = (uint16_t)(2 * count);
    upper->owner = (uint16_t)(2 * count + 1);
    return upper;
}

/* What of all samples the lower half of a part has, where rows of halvings serve a point: a whole number, out of
 * 2^52, but for points in visibility cells. */
ACDF_INLINE double acdf_cut_lower_rows(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                       const AcdfCutPart* part, const AcdfRowSplit* split) {
    AcdfVisibleRows in;
    if (point->cells == 0) return acdf_rows_mass(&point->by.rows, part->tile, split->tile) * 0x1p-52;
    in.rows = local->rows_of_normals;
    in.mix = &point->by.rows;
    in.table = &local->visibility;
    in.cells = &cut->cells;
    return acdf_clamp(acdf_visible_before(&in, split->tile) - acdf_visible_before(&in, part->tile), 0.0, part->sum);
}

/* acdf_cut_divide where rows of halvings serve a point. */
ACDF_FN void acdf_cut_divide_rows(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfCut* cut, int number) {
    const AcdfNormalRows* rows = local->rows_of_normals;
    AcdfCutPart *part = &cut->part[number], *upper = &cut->part[cut->count];
    const AcdfRowSplit* split = &acdf_row_splits(rows)[part->node];
    const uint32_t axis = split->place & 1u, position = split->place >> 1;
    const double lower = acdf_cut_lower_rows(local, point, cut, part, split);
    *upper = *part;
    acdf_cut_add_split(cut, number, axis | position << 3);
    upper->sum -= lower;
    part->sum = lower;
    part->high[axis] = upper->low[axis] = position;
    part->node = acdf_cut_of_node(split->child[0]);
    upper->node = acdf_cut_of_node(split->child[1]);
    upper->tile = split->tile;
}

/* Divides a part at its split: it becomes the lower half, and the last part is the upper one. */
ACDF_CALLED void acdf_cut_divide(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfCut* cut, int number) {
    AcdfCutPart *part = &cut->part[number], *upper = 0;
    const AcdfSplit* split = 0;
    uint32_t axis, position;
    uint16_t child;
    double low, high;
    if (local->rows_of_normals) {
        acdf_cut_divide_rows(local, point, cut, number);
        return;
    }
    split = &local->blend.splits[part->node];
    axis = split->place & 7u;
    position = split->place >> 3;
    child = split->child[1];
    upper = acdf_cut_add_split(cut, number, split->place);
    /* Splits are numbered as the traversal meets them, and so are tiles: as many as the splits of the lower half,
     * and one. */
    upper->tile = child & ACDF_TILE_FLAG ? child & ~ACDF_TILE_FLAG : part->tile + child - part->node;
    low = acdf_cut_share(local, point, part, upper, &high);
    acdf_cut_share_bright_tiles(local, cut, part, upper);
    part->sum = low + part->bright_tiles;
    upper->sum = high + upper->bright_tiles;
    memcpy(upper->low, part->low, sizeof upper->low);
    memcpy(upper->high, part->high, sizeof upper->high);
    part->high[axis] = upper->low[axis] = position;
    part->node = split->child[0];
    upper->node = child;
    if (local->tables) {
        const AcdfSplit* same =
            acdf_tile_splits(acdf_local_words(local->tables), &local->tables->tiles) + part->entry;
        part->entry = same->child[0];
        upper->entry = same->child[1];
        upper->depth = ++part->depth;
    }
}

/* acdf_cut_heart where rows of halvings serve a point: the middle of the tile that is reached where the traversal
 * always takes the half to which the row of most weight gives more. */
ACDF_FN uint32_t acdf_cut_row_heart(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                    int number, float direction[3]) {
    const AcdfNormalRows* rows = local->rows_of_normals;
    const uint32_t* before = point->by.rows.before[cut->nearest];
    const AcdfCutPart* part = &cut->part[number];
    uint32_t first = part->tile, end = acdf_cut_end(rows, part);
    uint32_t node = acdf_cut_node(part), box[2][2], k;
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &acdf_row_splits(rows)[node];
        const uint32_t upper = (uint32_t)(before[split->tile] - before[first] < before[end] - before[split->tile]);
        if (upper) first = split->tile;
        else end = split->tile;
        node = split->child[upper];
    }
    node &= ~ACDF_TOP_TILE;
    for (k = 0; k < 2; ++k) {
        box[k][0] = acdf_row_tile(rows, node)->box[k].end[0];
        box[k][1] = acdf_row_tile(rows, node)->box[k].end[1];
    }
    acdf_box_middle(local, (const uint32_t(*)[2])box, direction);
    return node;
}

/* A direction from which a part is lit much: of its brightest light, where bright tiles give it more than all else;
 * else the middle of the tile that is reached where the traversal always takes the half to which the nearest bin
 * gives more. Returns the tile's number. */
ACDF_CALLED uint32_t acdf_cut_heart(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                    int number, float direction[3]) {
    const AcdfCutPart* part = &cut->part[number];
    uint32_t node = part->node, box[2][2], k;
    const uint16_t* codebook;
    const uint8_t* row;
    if (local->rows_of_normals) return acdf_cut_row_heart(local, point, cut, number, direction);
    codebook = local->blend.tiles->codebook;
    row = point->mix.row[cut->nearest];
    if (part->bright_tiles > 0.5 * part->sum) {
        uint32_t brightest = part->first_light;
        for (k = brightest + 1; k < part->end_light; ++k)
            if (cut->light[k] > cut->light[brightest]) brightest = k;
        for (k = 0; k < 3; ++k) direction[k] = local->bright_tiles[brightest].direction[k];
        return local->bright_tiles[brightest].tile;
    }
    if (cut->hearts) {
        const uint32_t tile = part->node & ACDF_TILE_FLAG ? part->node & ~ACDF_TILE_FLAG : cut->hearts[part->entry];
        for (k = 0; k < 3; ++k) direction[k] = acdf_local_middle(local->tables, tile)[k];
        return tile;
    }
    for (k = 0; k < 2; ++k) {
        box[k][0] = part->high[k];
        box[k][1] = part->low[k];
    }
    while (!(node & ACDF_TILE_FLAG) && point->mix.count > 0) {
        const AcdfSplit* split = &local->blend.splits[node];
        const uint32_t upper = (uint32_t)(codebook[row[node]] < 32768u);
        box[split->place & 1u][upper] = split->place >> 3;
        node = split->child[upper];
    }
    acdf_box_middle(local, box, direction);
    return node & ACDF_TILE_FLAG ? node & ~ACDF_TILE_FLAG
                                 : part->tile; /* where only bright tiles shine, and not here */
}

/* Solid angle of a part, sr. */
ACDF_FN double acdf_cut_solid_angle(const AcdfLocal* local, const AcdfCutPart* part) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    int i;
    if (local->tables && local->tables->heights) {
        const double* z = acdf_local_heights(local->tables);
        return 2.0 * ACDF_PI * (double)(part->high[0] - part->low[0]) / (double)grid.columns *
               (z[part->low[1]] - z[part->high[1]]);
    }
    for (i = 0; i < 2; ++i) {
        range[i].low = part->low[i];
        range[i].high = part->high[i];
        range[i].tilt = 0.0;
    }
    return acdf_grid_solid_angle(&grid, range);
}

#ifdef __cplusplus
}
#endif
#endif
