/* A cut through the tiles of a local environment map: boxes that cover the sphere, each a split of the file's rows
 * with all below it, each with a probability of its own. What product sampling weighs at a shading point
 * (acdf/product/product.h). One freestanding header over
 * acdf/visibility/visible_local.h, valid C99, C++17 and CUDA/HIP/SYCL, with the
 * same contract.
 *
 * Within a part the pdf is that of the local map, light times cosine; how much each part gets is up to whoever
 * made the cut. */
#ifndef ACDF_CUT_H
#define ACDF_CUT_H

#include <acdf/product/box_bytes.h>
#include <acdf/product/box_middle.h>
#include <acdf/visibility/visible_local.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_CUT_MAX_PARTS = 96, ACDF_CUT_BLOCKS = ACDF_CUT_MAX_PARTS / ACDF_BLOCK_BOXES };

/* A box: what lies below a split or in a tile. What samples and pdfs read stands first. */
typedef struct AcdfCutPart {
    double numbers[2][2]; /* random numbers that sample it: from low to high of axis 0, of axis 1 */
    double sum;           /* what of all samples at the point it has */
    double probability;   /* of the cut, for its maker to set */
    uint32_t first, end;  /* its tiles, which are numbered in the order of the traversal */
    uint32_t node;        /* the split, or ACDF_TOP_TILE | the tile */
    uint32_t low[2], high[2];
    uint32_t owner; /* 2 * split of the cut + side; of the whole: not used */
} AcdfCutPart;

typedef struct AcdfCutSplit {
    uint32_t place;   /* as in AcdfRowSplit */
    int16_t child[2]; /* another split; or the complement of a part's number */
} AcdfCutSplit;

typedef struct AcdfCut {
    int count;   /* of parts; 0: there is nothing to sample */
    int nearest; /* which of the rows weighs most */
    AcdfCutPart part[ACDF_CUT_MAX_PARTS];
    AcdfCutSplit split[ACDF_CUT_MAX_PARTS - 1];
    uint32_t boxes[ACDF_CUT_BLOCKS][16]; /* `numbers` of 16 parts each, as blocks of acdf/product/box_bytes.h */
} AcdfCut;

/* The whole as one part, of probability 1. For points that rows serve (ACDF_LOCAL_ROWS). */
ACDF_FN void acdf_cut_begin(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point, AcdfCut* cut) {
    const AcdfRowMixture* mix = &point->local.by.rows;
    AcdfCutPart* whole = &cut->part[0];
    int k;
    memset(whole, 0, sizeof *whole);
    cut->count = 1;
    cut->nearest = 0;
    for (k = 1; k < mix->count; ++k)
        if (mix->weight[k] > mix->weight[cut->nearest]) cut->nearest = k;
    whole->node = light->local.rows_of_normals->splits ? 0 : ACDF_TOP_TILE;
    whole->end = light->local.rows_of_normals->splits + 1u;
    whole->high[0] = light->local.environment.columns;
    whole->high[1] = light->local.environment.rows;
    whole->sum = 1.0;
    whole->probability = 1.0;
}

/* Whether a part can be divided: it is no tile, and there is room. */
ACDF_FN int acdf_cut_divisible(const AcdfCut* cut, int part) {
    return !(cut->part[part].node & ACDF_TOP_TILE) && cut->count < ACDF_CUT_MAX_PARTS;
}

/* Adds a split of a part. Returns the upper half, a copy of the part, which is the last one. */
ACDF_INLINE AcdfCutPart* acdf_cut_add_split(AcdfCut* cut, int number, uint32_t place) {
    const int count = cut->count - 1;
    AcdfCutPart *part = &cut->part[number], *upper = &cut->part[cut->count];
    cut->split[count].place = place;
    cut->split[count].child[0] = (int16_t)~number;
    cut->split[count].child[1] = (int16_t)~cut->count;
    if (count > 0) cut->split[part->owner >> 1].child[part->owner & 1u] = (int16_t)count;
    ++cut->count;
    *upper = *part;
    part->owner = 2u * (uint32_t)count;
    upper->owner = 2u * (uint32_t)count + 1u;
    return upper;
}

/* What of all samples the lower half of a part has: a whole number, out of 2^52, but for points in a visibility
 * cell. */
ACDF_INLINE double acdf_cut_lower(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point,
                                  const AcdfCutPart* part, const AcdfRowSplit* split) {
    AcdfVisibilityCell cell;
    AcdfVisibleRows in;
    if (!point->in_cell) return acdf_rows_mass(&point->local.by.rows, part->first, split->tile) * 0x1p-52;
    in = acdf_visible_rows(light, point, &cell);
    return acdf_clamp(acdf_visible_before(&in, split->tile) - acdf_visible_before(&in, part->first), 0.0,
                      part->sum);
}

/* Divides a part at its split: it becomes the lower half, and the last part is the upper one. */
ACDF_CALLED void acdf_cut_divide(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point, AcdfCut* cut,
                                 int number) {
    AcdfCutPart* part = &cut->part[number];
    const AcdfRowSplit* split = &acdf_row_splits(light->local.rows_of_normals)[part->node];
    const uint32_t axis = split->place & 1u;
    const double lower = acdf_cut_lower(light, point, part, split);
    AcdfCutPart* upper = acdf_cut_add_split(cut, number, split->place);
    upper->sum -= lower;
    part->sum = lower;
    part->high[axis] = upper->low[axis] = split->place >> 1;
    part->end = upper->first = split->tile;
    part->node = split->child[0];
    upper->node = split->child[1];
}

/* A direction from which a part is lit much: the middle of the tile that is reached where the traversal always
 * takes the half to which the row of most weight gives more. Returns the tile's number. */
ACDF_CALLED uint32_t acdf_cut_heart(const AcdfVisibleLocal* light, const AcdfVisiblePoint* point,
                                    const AcdfCut* cut, int number, float direction[3]) {
    const AcdfNormalRows* rows = light->local.rows_of_normals;
    const uint32_t* before = point->local.by.rows.before[cut->nearest];
    uint32_t first = cut->part[number].first, end = cut->part[number].end, node = cut->part[number].node;
    const AcdfTopTile* tile;
    uint32_t box[2][2], k;
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &acdf_row_splits(rows)[node];
        const uint32_t upper = (uint32_t)(before[split->tile] - before[first] < before[end] - before[split->tile]);
        if (upper) first = split->tile;
        else end = split->tile;
        node = split->child[upper];
    }
    tile = acdf_row_tile(rows, first);
    for (k = 0; k < 2; ++k) {
        box[k][0] = tile->box[k].end[0];
        box[k][1] = tile->box[k].end[1];
    }
    acdf_box_middle(&light->local, (const uint32_t(*)[2])box, direction);
    return first;
}

/* Solid angle of a part, sr. */
ACDF_FN double acdf_cut_solid_angle(const AcdfVisibleLocal* light, const AcdfCutPart* part) {
    const AcdfGrid grid = acdf_environment_grid(&light->local.environment);
    AcdfSpan box[2];
    int i;
    for (i = 0; i < 2; ++i) {
        box[i].end[0] = part->low[i];
        box[i].end[1] = part->high[i];
    }
    return 1.0 / acdf_box_scale(acdf_halved_heights(light->local.environment.halved), &grid, box);
}

#ifdef __cplusplus
}
#endif
#endif
