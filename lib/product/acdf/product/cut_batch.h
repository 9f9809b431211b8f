/* Several samples from a cut side by side (acdf/product/cut_sample.h): what one of them waits for, memory and the
 * splits and curves on its way, the others use. Each is acdf_cut_sample's to the bit. `vectors` may be null. One
 * freestanding header, valid C99, C++17 and CUDA/HIP/SYCL; in kernels it makes single calls. */
#ifndef ACDF_CUT_BATCH_H
#define ACDF_CUT_BATCH_H

#include <acdf/product/cut_sample.h>
#include <acdf/product/vectors.h>

#ifdef __cplusplus
extern "C" {
#endif

/* As many as are on their way at once, and fewer than are worth vectors; rows are those of nearly all points. */
enum { ACDF_CUT_BATCH = 16, ACDF_CUT_FEWEST = 2, ACDF_FAST_CUT_FEWEST = 3, ACDF_CUT_BATCH_ROWS = 3 };

ACDF_INLINE int acdf_cut_by_vectors(const AcdfLocal* local, const AcdfLocalPoint* point) {
    return acdf_local_tabled(local) && point->mix.count == ACDF_CUT_BATCH_ROWS &&
           local->blend.tiles->tile_count > 1;
}

/* A sample on its way. */
typedef struct AcdfCutLane {
    double u[2];
    AcdfRange range[2];
    double probability;
    double given; /* what the part's mixture gives to the tile */
    const AcdfCutPart* part;
    uint32_t tile;
    uint32_t curve;
} AcdfCutLane;

/* Numbers of lanes. */
typedef struct AcdfCutLanes {
    uint32_t count;
    uint32_t lane[ACDF_CUT_BATCH];
} AcdfCutLanes;

/* Samples parts. */
ACDF_INLINE void acdf_cut_batch_parts(const AcdfCut* cut, const double (*u)[2], uint32_t count, AcdfCutLane* lane) {
    int guess[ACDF_CUT_BATCH];
    uint32_t i;
    for (i = 0; i < count; ++i) {
        lane[i].u[0] = acdf_cut_number(u[i][0]);
        lane[i].u[1] = acdf_cut_number(u[i][1]);
        guess[i] = acdf_cut_guess(cut, lane[i].u, 0);
        acdf_cut_part_ahead(cut, guess[i]);
    }
    for (i = 0; i < count; ++i) lane[i].part = acdf_cut_sample_guessed(cut, guess[i], lane[i].u);
}

/* Samples bright tiles, and returns which lanes sample from the mixture of their part. */
ACDF_INLINE void acdf_cut_batch_lights(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                       uint32_t count, AcdfCutLane* lane, AcdfCutLanes* mixed) {
    uint32_t i, k;
    mixed->count = 0;
    for (i = 0; i < count; ++i) {
        AcdfCutLane* one = &lane[i];
        const int lit = acdf_cut_samples_bright_tile(one->part, one->u[0]);
        acdf_cut_range(one->part, one->range);
        for (k = 0; k < ACDF_CUT_BATCH_ROWS; ++k)
            ACDF_PREFETCH(point->by.tabled.codes[k] + (one->part->entry & ~ACDF_TILE_FLAG));
        if (lit)
            one->tile = acdf_cut_sample_bright_tile(local, cut, one->part, one->u, one->range, &one->probability);
        mixed->lane[mixed->count] = i;
        mixed->count += (uint32_t)!lit;
    }
}

/* The weights of a part's mixture: rows are those of the point. */
ACDF_INLINE AcdfMixture acdf_cut_batch_mixture(const AcdfCutPart* part) {
    AcdfMixture mix;
    int i;
    mix.count = ACDF_CUT_BATCH_ROWS;
    for (i = 0; i < ACDF_NORMALS_MIXED; ++i) {
        mix.row[i] = 0;
        mix.weight[i] = i < ACDF_CUT_BATCH_ROWS ? part->weight[i] : 0.0;
    }
    return mix;
}

/* Samples tiles of mixtures. */
ACDF_INLINE void acdf_cut_batch_tiles(const AcdfLocal* local, const AcdfLocalPoint* point,
                                      const AcdfCutLanes* mixed, AcdfCutLane* lane) {
    const uint32_t* words = acdf_local_words(local->tables);
    const AcdfTileTables* tables = &local->tables->tiles;
    AcdfTileWalk walk[ACDF_CUT_BATCH];
    AcdfCutLanes on_way, walked;
    uint32_t k;
    walked.count = 0;
    for (k = 0; k < mixed->count; ++k) {
        const uint32_t number = mixed->lane[k];
        AcdfCutLane* one = &lane[number];
        const uint32_t node = one->part->entry;
        double from[2];
        const AcdfMixture mix = acdf_cut_batch_mixture(one->part);
        one->u[0] = acdf_cut_number_of_mixture(one->part, one->u[0]);
        one->given = acdf_cut_of_all(&mix, one->u, from);
        walk[number].node = node;
        if (node & ACDF_TILE_FLAG) {
            one->u[0] = acdf_unit_interval(from[0] / one->given);
            one->u[1] = acdf_unit_interval(from[1] / one->given);
            continue;
        }
        acdf_tile_walk_begin(words, tables, &mix, point->by.tabled.codes, ACDF_CUT_BATCH_ROWS, node, from,
                             &walk[number]);
        walked.lane[walked.count++] = number;
    }
    on_way = walked;
    while (on_way.count > 0) {
        uint32_t left = 0;
        for (k = 0; k < on_way.count; ++k) {
            const uint32_t number = on_way.lane[k];
            acdf_tile_walk_step(words, tables, point->by.tabled.codes, ACDF_CUT_BATCH_ROWS, &walk[number]);
            on_way.lane[left] = number;
            left += (uint32_t) !(walk[number].node & ACDF_TILE_FLAG);
        }
        on_way.count = left;
    }
    for (k = 0; k < walked.count; ++k) {
        const uint32_t number = walked.lane[k];
        const AcdfMixture mix = acdf_cut_batch_mixture(lane[number].part);
        acdf_tile_walk_end(&walk[number], &mix, ACDF_CUT_BATCH_ROWS, lane[number].u, &lane[number].given);
    }
    for (k = 0; k < mixed->count; ++k) {
        const uint32_t number = mixed->lane[k];
        AcdfCutLane* one = &lane[number];
        const AcdfMixture mix = acdf_cut_batch_mixture(one->part);
        one->tile = walk[number].node & ~ACDF_TILE_FLAG;
        ACDF_PREFETCH(acdf_tile_record(words, tables, one->tile));
        one->probability =
            acdf_cut_tile_probability(one->part, &mix, acdf_positive(one->given / acdf_mixture_sum(&mix)));
    }
}

/* Follows curves of tiles: to the cells that hold squares, or where there are none, to those that the lanes sample.
 */
ACDF_INLINE void acdf_cut_batch_curves(const AcdfLocal* local, uint32_t count, const uint32_t (*square)[2],
                                       AcdfCutLane* lane) {
    const uint8_t* tree = local->blend.tree;
    const uint32_t units = local->environment.tree_units;
    double inside[ACDF_CUT_BATCH];
    AcdfCutLanes on_way, curved;
    uint32_t i, k, in_curves;
    curved.count = 0;
    for (i = 0; i < count; ++i) {
        const uint32_t root = lane[i].probability > 0.0 ? acdf_local_tile_root(local, lane[i].tile) : ACDF_NO_ROOT;
        lane[i].curve = root;
        inside[i] = 1.0;
        curved.lane[curved.count] = i;
        curved.count += (uint32_t)(root != ACDF_NO_ROOT);
    }
    for (k = 0; k < curved.count; ++k) ACDF_PREFETCH(tree + 2 * (size_t)lane[curved.lane[k]].curve);
    on_way = curved;
    while ((in_curves = on_way.count) > 0) {
        on_way.count = 0;
        for (k = 0; k < in_curves; ++k) {
            const uint32_t number = on_way.lane[k];
            AcdfCutLane* one = &lane[number];
            const uint32_t link =
                square ? acdf_curve_locate(tree, units, one->curve, square[number], one->range, &inside[number])
                       : acdf_short_curve_sample(tree, units, one->curve, one->u, one->range, &inside[number]);
            one->curve += link;
            ACDF_PREFETCH(tree + 2 * (size_t)one->curve);
            on_way.lane[on_way.count] = number;
            on_way.count += (uint32_t)(link != 0);
        }
    }
    for (k = 0; k < curved.count; ++k) {
        AcdfCutLane* one = &lane[curved.lane[k]];
        const double found = inside[curved.lane[k]];
        one->probability = found > 0.0 ? acdf_positive(one->probability * acdf_positive(found)) : 0.0;
    }
}

/* acdf_cut_sample of u[i] into out[i], i < count. */
ACDF_FN void acdf_cut_sample_batch(const AcdfProductVectors* vectors, const AcdfLocal* local,
                                   const AcdfLocalPoint* point, const AcdfCut* cut, const double (*u)[2],
                                   size_t count, AcdfDirectionSample* out) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfCutLane lane[ACDF_CUT_BATCH];
    AcdfCutLanes mixed;
    size_t first, i;
    if (!ACDF_SIDE_BY_SIDE || cut->count == 0 || !acdf_local_tabled(local) ||
        point->mix.count != ACDF_CUT_BATCH_ROWS) {
        for (i = 0; i < count; ++i) out[i] = acdf_cut_sample(local, point, cut, u[i][0], u[i][1]);
        return;
    }
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_CUT_FEWEST && acdf_cut_by_vectors(local, point)) {
        vectors->cut_sample(local, point, cut, u, count, out);
        return;
    }
#endif
    for (first = 0; first < count; first += ACDF_CUT_BATCH) {
        const uint32_t some = count - first < ACDF_CUT_BATCH ? (uint32_t)(count - first) : (uint32_t)ACDF_CUT_BATCH;
        acdf_cut_batch_parts(cut, u + first, some, lane);
        acdf_cut_batch_lights(local, point, cut, some, lane, &mixed);
        acdf_cut_batch_tiles(local, point, &mixed, lane);
        for (i = 0; i < mixed.count; ++i) {
            AcdfCutLane* one = &lane[mixed.lane[i]];
            acdf_tile_range(acdf_local_tile(local->tables, one->tile), one->range);
        }
        acdf_cut_batch_curves(local, some, 0, lane);
        for (i = 0; i < some; ++i)
            out[first + i] =
                acdf_cut_direction_sample(local, point, cut, &grid, lane[i].range, lane[i].u, lane[i].probability);
    }
}

/* acdf_cut_pdf of directions[i] into out[i], i < count. */
ACDF_FN void acdf_cut_pdf_batch(const AcdfProductVectors* vectors, const AcdfLocal* local,
                                const AcdfLocalPoint* point, const AcdfCut* cut, const float (*directions)[3],
                                size_t count, float* out) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfCutLane lane[ACDF_CUT_BATCH];
    uint32_t square[ACDF_CUT_BATCH][2];
    size_t first, i;
    if (!ACDF_SIDE_BY_SIDE || cut->count == 0 || !acdf_local_tabled(local)) {
        for (i = 0; i < count; ++i) out[i] = acdf_cut_pdf(local, point, cut, directions[i]);
        return;
    }
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_CUT_FEWEST && acdf_cut_by_vectors(local, point)) {
        vectors->cut_pdf(local, point, cut, directions, count, out);
        return;
    }
#endif
    for (first = 0; first < count; first += ACDF_CUT_BATCH) {
        const size_t some = count - first < ACDF_CUT_BATCH ? count - first : (size_t)ACDF_CUT_BATCH;
        for (i = 0; i < some; ++i) {
            AcdfCutLane* one = &lane[i];
            one->part = 0;
            one->probability = 0.0;
            if (!acdf_local_square(&grid, directions[first + i], square[i])) continue;
            one->tile = acdf_tile_at(acdf_local_words(local->tables), &local->tables->tiles, square[i]);
            ACDF_PREFETCH(acdf_local_tile(local->tables, one->tile));
            one->part = acdf_cut_find(cut, square[i]);
            acdf_cut_part_ahead(cut, (int)(one->part - cut->part));
        }
        for (i = 0; i < some; ++i) {
            AcdfCutLane* one = &lane[i];
            AcdfMixture mix;
            if (!one->part) continue;
            mix = acdf_cut_mixture(point, one->part);
            acdf_cut_range(one->part, one->range);
            one->given = acdf_local_found_tile(local, point, &mix, one->tile, one->part->depth, one->range);
            one->probability = acdf_cut_found_probability(local, cut, one->part, &mix, one->tile, one->given);
        }
        acdf_cut_batch_curves(local, (uint32_t)some, (const uint32_t(*)[2])square, lane);
        for (i = 0; i < some; ++i) {
            const double p = lane[i].probability;
            out[first + i] =
                p > 0.0 ? acdf_local_cell_pdf(local, &grid, directions[first + i], lane[i].range, p) : 0.0f;
        }
    }
}

/* acdf_fast_cut_sample of u[i] into out[i], i < count; of cuts that are not empty. */
ACDF_FN void acdf_fast_cut_sample_batch(const AcdfProductVectors* vectors, const AcdfLocal* local,
                                        const AcdfLocalPoint* point, const AcdfFastCut* cut, const double (*u)[2],
                                        size_t count, AcdfDirectionSample* out) {
    size_t i;
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_FAST_CUT_FEWEST) {
        vectors->fast_cut_sample(local, point, cut, u, count, out);
        return;
    }
#endif
    for (i = 0; i < count; ++i) out[i] = acdf_fast_cut_sample(local, point, cut, u[i][0], u[i][1]);
}

/* acdf_fast_cut_pdf of directions[i] into out[i], i < count; of cuts that are not empty. */
ACDF_FN void acdf_fast_cut_pdf_batch(const AcdfProductVectors* vectors, const AcdfLocal* local,
                                     const AcdfLocalPoint* point, const AcdfFastCut* cut,
                                     const float (*directions)[3], size_t count, float* out) {
    size_t i;
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_FAST_CUT_FEWEST) {
        vectors->fast_cut_pdf(local, point, cut, directions, count, out);
        return;
    }
#endif
    for (i = 0; i < count; ++i) out[i] = acdf_fast_cut_pdf(local, point, cut, directions[i]);
}

#ifdef __cplusplus
}
#endif
#endif
