/* Environments of several maps, as of a day: one tree of halvings with a row of codes for each map (SPEC.md §15).
 * Between maps the pdf is the mixture that is linear in each indexed axis. Valid C99, C++17 and CUDA/HIP/SYCL; no
 * allocation, no errors. acdf/indexed/open.h makes the view of an open file, acdf/indexed/views.h has classes.
 *
 *   AcdfIndexed day;                                       // of acdf_indexed
 *   AcdfMixed sky;
 *   acdf_indexed_at(&day, coordinates, &sky);              // once a frame
 *   AcdfDirectionSample s = acdf_mixed_sample(&sky, u0, u1);
 *   float p = acdf_mixed_pdf(&sky, s.direction);           // exactly s.pdf
 *
 * The random numbers that lead a map to a node are whole numbers, out of 2^31, and so are weights of maps, out of
 * 2^21. Sums of their products are exact in doubles: every machine descends alike, and the probability of a cell is
 * the one that samples have. */
#ifndef ACDF_INDEXED_INDEXED_H
#define ACDF_INDEXED_INDEXED_H

#include <acdf/allocator.h>
#include <acdf/indexed/cone.h>
#include <acdf/top_tile.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_MOST_MIXED = 8 };  /* 2^ACDF_MOST_INDEXED_AXES */
#define ACDF_KEPT_SPLITS 127u  /* at most 256 */
#define ACDF_MIXED_SQUARES 16u /* of an axis of random numbers */

/* A split at the top of the tree, where each map has a code of its own. They stand level by level; 0 is the root.
 */
typedef struct AcdfTopSplit {
    uint32_t axis, middle;
    uint32_t child[2]; /* lower and upper half: a later split, or ACDF_TOP_TILE | a tile */
} AcdfTopSplit;

/* Tables of a view: flat words without pointers, offsets in words from the start of this. */
typedef struct AcdfTop {
    uint32_t words; /* of all */
    uint32_t maps, splits;
    uint32_t top;     /* AcdfTopSplit[splits] */
    uint32_t tiles;   /* AcdfTopTile[splits + 1] */
    uint32_t lower;   /* uint32[splits][maps]: the steps, out of 2^31, that lead to the lower half */
    uint32_t of_tile; /* uint32[splits + 1][maps]: those that lead to a tile */
    uint32_t bits;    /* the lookup grid has squares of 2^-bits of each axis, in rows of axis 0; 0: there is none */
    uint32_t starts;  /* uint32: of each square the deepest split that holds it, or ACDF_TOP_TILE | a tile */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
} AcdfTop;

/* A checked file of several maps. */
typedef struct AcdfIndexed {
    uint32_t columns, rows;
    uint32_t parameterization;    /* ACDF_PARAM_OCTAHEDRAL; all else is ACDF_PARAM_LATLONG */
    uint32_t axes;                /* indexed ones, 1 to ACDF_MOST_INDEXED_AXES */
    uint32_t counts[3];           /* of maps along each */
    uint32_t sun;                 /* 0: there is none; else roots of its cone, and one */
    double total;                 /* integral of all maps together */
    const double* coordinates;    /* those of the first axis, then of the next: each ascending */
    const AcdfMap* maps;          /* row-major, the last axis fastest */
    const AcdfHalvedTree* halved; /* the shared tree */
    const AcdfTop* top;
    AcdfBlock tables;        /* where `top` lies, for acdf_indexed_close: */
    AcdfAllocator allocator; /* the file's, which gave it */
} AcdfIndexed;

/* Where a descent begins: the probability of a split, and the random numbers that lead to it. */
typedef struct AcdfMixedStart {
    double here, low[2], width[2];
} AcdfMixedStart;

/* A mixture of up to eight maps, by value: an environment at some coordinates. */
typedef struct AcdfMixed {
    const AcdfHalvedTree* halved;
    const AcdfTop* top;
    AcdfGrid grid;
    uint32_t count; /* of maps that are mixed */
    uint32_t map[ACDF_MOST_MIXED];
    double weight[ACDF_MOST_MIXED]; /* whole numbers that add up to ACDF_WEIGHTS */
    double sun_share;               /* of samples in the cone */
    AcdfCone cone;
    double total;                  /* integral over the sphere, linear between maps */
    double kept[ACDF_KEPT_SPLITS]; /* probabilities of the lower halves of the first splits */
    AcdfMixedStart starts[ACDF_KEPT_SPLITS];
    uint8_t square[ACDF_MIXED_SQUARES * ACDF_MIXED_SQUARES]; /* of random numbers: the deepest of these splits */
} AcdfMixed;

/* Steps of the maps of a mixture, at an array of one a map: out of 2^52. */
ACDF_INLINE double acdf_mixed_steps(const AcdfMixed* sky, const uint32_t* of_maps) {
    double sum = sky->weight[0] * (double)of_maps[sky->map[0]];
    uint32_t k;
    for (k = 1; k < sky->count; ++k) sum += sky->weight[k] * (double)of_maps[sky->map[k]];
    return sum;
}

/* ---- where among the maps ----------------------------------------------------------------------------- */

/* The index before a coordinate, and how far it lies from there to the next. The ends stand for all beyond. */
ACDF_FN uint32_t acdf_index_before(const double* coordinates, uint32_t count, double at, double* between) {
    uint32_t low = 0, high = count - 1u;
    if (!(at > coordinates[0])) return *between = 0.0, 0;
    if (at >= coordinates[high]) return *between = 1.0, high - 1u;
    while (high - low > 1u) {
        const uint32_t middle = (low + high) >> 1;
        if (at >= coordinates[middle]) low = middle;
        else high = middle;
    }
    *between = (at - coordinates[low]) / (coordinates[low + 1u] - coordinates[low]);
    if (!(coordinates[low + 1u] - coordinates[low] < 1.7976931348623157e308)) /* doubles hold halves of them */
        *between = (0.5 * at - 0.5 * coordinates[low]) / (0.5 * coordinates[low + 1u] - 0.5 * coordinates[low]);
    return low;
}

/* The direction of a sun between two, along the great circle; where one is not known, the other. `out` may be `a`.
 */
ACDF_FN void acdf_between_suns(const double a[3], const double b[3], double t, double out[3]) {
    const double cosine = acdf_cone_dot(a, b);
    double cross[3], sine, angle, of_a, of_b, unused, length;
    int i;
    for (i = 0; i < 3; ++i) cross[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    sine = sqrt(acdf_cone_dot(cross, cross));
    angle = acdf_atan2pi(sine, cosine);
    if (sine < 1e-9) { /* alike, or opposite: nothing is between */
        const double* one = acdf_cone_dot(a, a) > 0.0 && (t < 0.5 || !(acdf_cone_dot(b, b) > 0.0)) ? a : b;
        for (i = 0; i < 3; ++i) out[i] = one[i];
        return;
    }
    acdf_sincospi((1.0 - t) * angle, &of_a, &unused);
    acdf_sincospi(t * angle, &of_b, &unused);
    for (i = 0; i < 3; ++i) out[i] = of_a * a[i] + of_b * b[i];
    length = sqrt(acdf_cone_dot(out, out));
    for (i = 0; i < 3; ++i) out[i] /= length;
}

/* Where descents begin: each square of random numbers at the deepest of the first splits that it leads to. */
ACDF_FN void acdf_mixed_begin(AcdfMixed* sky) {
    const AcdfTop* top = sky->top;
    const AcdfTopSplit* splits = ACDF_TOP_ARRAY(AcdfTopSplit, top, top->top);
    const uint32_t* rows = ACDF_TOP_ARRAY(uint32_t, top, top->lower);
    const uint32_t count = top->splits < ACDF_KEPT_SPLITS ? top->splits : ACDF_KEPT_SPLITS;
    double border[ACDF_KEPT_SPLITS];
    uint32_t at, x, y;
    sky->starts[0].here = sky->starts[0].width[0] = sky->starts[0].width[1] = 1.0;
    sky->starts[0].low[0] = sky->starts[0].low[1] = 0.0;
    for (at = 0; at < count; ++at) {
        const AcdfMixedStart* start = &sky->starts[at];
        const uint32_t axis = splits[at].axis;
        const double lower = sky->kept[at] = 0x1p-52 * acdf_mixed_steps(sky, rows + (size_t)at * top->maps);
        const double share = start->here > 0.0 ? lower / start->here : 0.0;
        border[at] = start->low[axis] + start->width[axis] * share;
        for (x = 0; x < 2u; ++x) {
            const uint32_t child = splits[at].child[x];
            if (child >= count) continue; /* or a tile */
            sky->starts[child] = *start;
            sky->starts[child].here = x ? start->here - lower : lower;
            sky->starts[child].width[axis] *= x ? 1.0 - share : share;
            if (x) sky->starts[child].low[axis] = border[at];
        }
    }
    for (y = 0; y < ACDF_MIXED_SQUARES; ++y)
        for (x = 0; x < ACDF_MIXED_SQUARES; ++x) {
            uint32_t next = 0;
            for (at = 0; next < count;) {
                const double low = (double)(splits[at = next].axis ? y : x) * (1.0 / ACDF_MIXED_SQUARES);
                if (low >= border[at]) next = splits[at].child[1];
                else if (low + 1.0 / ACDF_MIXED_SQUARES <= border[at]) next = splits[at].child[0];
                else break;
                if (next < count && !(sky->starts[next].here > 0.0)) break;
            }
            sky->square[y * ACDF_MIXED_SQUARES + x] = (uint8_t)at;
        }
}

/* The mixture of the maps around coordinates[axes]. The first and the last stand for all beyond, the first for
 * NaN, too. */
ACDF_FN void acdf_indexed_at(const AcdfIndexed* file, const double* coordinates, AcdfMixed* out) {
    double between[3], suns[ACDF_MOST_MIXED][3], radii[ACDF_MOST_MIXED], light = 0.0, in_cone = 0.0;
    uint32_t first[3], axis, corner, corners = 1u << file->axes, left, whole[ACDF_MOST_MIXED] = {0};
    const double* of_axis = file->coordinates;
    out->halved = file->halved;
    out->top = file->top;
    out->grid.columns = file->columns;
    out->grid.rows = file->rows;
    out->grid.parameterization = file->parameterization;
    out->count = 0;
    for (axis = 0; axis < file->axes; ++axis) {
        first[axis] = acdf_index_before(of_axis, file->counts[axis], coordinates[axis], &between[axis]);
        of_axis += file->counts[axis];
    }
    for (corner = 0; corner < corners; ++corner) {
        double weight = 1.0;
        uint32_t number = 0;
        const AcdfMap* map;
        int i;
        for (axis = 0; axis < file->axes; ++axis) {
            const uint32_t upper = corner >> axis & 1u;
            number = number * file->counts[axis] + first[axis] + upper;
            weight *= upper ? between[axis] : 1.0 - between[axis];
        }
        map = &file->maps[number];
        radii[corner] = map->radius;
        for (i = 0; i < 3; ++i) suns[corner][i] = map->sun[i];
        weight *= map->share;
        light += weight;
        in_cone += weight * map->sun_share;
        if (!(weight * (1.0 - map->sun_share) > 0.0)) continue;
        out->map[out->count] = number;
        out->weight[out->count++] = weight * (1.0 - map->sun_share);
    }
    acdf_whole_weights(out->weight, out->count, whole);
    for (corner = 0; corner < out->count; ++corner) out->weight[corner] = (double)whole[corner];
    out->total = light * file->total;
    out->sun_share = in_cone / light;
    out->cone.reach = 0.0;
    for (axis = file->axes, left = corners; left > 1u; left >>= 1) { /* the last axis first */
        const double t = between[--axis];
        for (corner = 0; corner < left >> 1; ++corner) {
            const double *a = suns[corner], *b = suns[corner + (left >> 1)];
            const double of_a = radii[corner], of_b = radii[corner + (left >> 1)];
            radii[corner] = !(of_a > 0.0) ? of_b : !(of_b > 0.0) ? of_a : of_a + (of_b - of_a) * t;
            acdf_between_suns(a, b, t, suns[corner]);
        }
    }
    if (out->sun_share > 0.0) acdf_cone_about(suns[0], radii[0], file->sun - 1u, &out->cone);
    acdf_mixed_begin(out);
}

/* ---- the tree ------------------------------------------------------------------------------------------- */
/* The square of a random number on its axis. */
ACDF_INLINE uint32_t acdf_mixed_square(double u) {
    const uint32_t square = (uint32_t)(u * ACDF_MIXED_SQUARES);
    return square < ACDF_MIXED_SQUARES ? square : ACDF_MIXED_SQUARES - 1u;
}

/* The cell that u[2] lead to; u is rescaled to [0, 1] in it. Returns its pdf. Until then u[axis] is kept as
 * x[axis] / of[axis], as a division at each level would be slow. */
ACDF_INLINE double acdf_mixed_descend(const AcdfMixed* sky, double u[2], AcdfSpan box[2]) {
    const AcdfTop* top = sky->top;
    const AcdfTopSplit* splits = ACDF_TOP_ARRAY(AcdfTopSplit, top, top->top);
    const uint32_t* rows = ACDF_TOP_ARRAY(uint32_t, top, top->lower);
    uint32_t at = top->splits ? 0 : ACDF_TOP_TILE;
    double here, share, x[2], of[2];
    const AcdfTopTile* tile;
    int axis;
    if (!(at & ACDF_TOP_TILE))
        at = sky->square[acdf_mixed_square(u[1]) * ACDF_MIXED_SQUARES + acdf_mixed_square(u[0])];
    here = sky->starts[at & ~ACDF_TOP_TILE].here;
    for (axis = 0; axis < 2; ++axis) {
        x[axis] = u[axis] - sky->starts[at & ~ACDF_TOP_TILE].low[axis];
        of[axis] = sky->starts[at & ~ACDF_TOP_TILE].width[axis];
    }
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfTopSplit* split = &splits[at];
        const double lower =
            at < ACDF_KEPT_SPLITS ? sky->kept[at] : acdf_mixed_steps(sky, rows + (size_t)at * top->maps) * 0x1p-52;
        const uint32_t a = split->axis;
        const double border = lower * of[a], place = x[a] * here;
        if (place >= border && here > lower) {
            here -= lower;
            x[a] = place - border;
            at = split->child[1];
        } else {
            here = lower;
            x[a] = place;
            at = split->child[0];
        }
        of[a] *= here;
        if (of[a] < 0x1p-800) { /* far from what doubles cannot hold */
            of[a] *= 0x1p800;
            x[a] *= 0x1p800;
        }
    }
    tile = ACDF_TOP_ARRAY(AcdfTopTile, top, top->tiles) + (at & ~ACDF_TOP_TILE);
    for (axis = 0; axis < 2; ++axis) {
        u[axis] = acdf_clamp(x[axis] / of[axis], 0.0, 1.0);
    }
    share = acdf_tile_sample(acdf_halvings_nodes(sky->halved), tile, u, box);
    return here * share * acdf_tile_scale(acdf_halved_heights(sky->halved), &sky->grid, tile, box);
}

/* The tile that holds a grid step of each axis. */
ACDF_INLINE uint32_t acdf_top_find(const AcdfTop* top, const uint32_t position[2]) {
    const AcdfTopSplit* splits = ACDF_TOP_ARRAY(AcdfTopSplit, top, top->top);
    uint32_t at = top->splits ? 0 : ACDF_TOP_TILE;
    if (top->bits) {
        const uint32_t x = (uint32_t)((uint64_t)position[0] * top->position_scale[0] >> 32);
        const uint32_t y = (uint32_t)((uint64_t)position[1] * top->position_scale[1] >> 32);
        at = ACDF_TOP_ARRAY(uint32_t, top, top->starts)[y << top->bits | x];
    }
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfTopSplit* split = &splits[at];
        at = split->child[position[split->axis] >= split->middle];
    }
    return at & ~ACDF_TOP_TILE;
}

/* The cell that holds a grid step of each axis. Returns its pdf. */
ACDF_INLINE double acdf_mixed_cell(const AcdfMixed* sky, const uint32_t position[2], AcdfSpan box[2]) {
    const AcdfTop* top = sky->top;
    const uint32_t at = acdf_top_find(top, position);
    const AcdfTopTile* tile = ACDF_TOP_ARRAY(AcdfTopTile, top, top->tiles) + at;
    const double here = acdf_mixed_steps(sky, ACDF_TOP_ARRAY(uint32_t, top, top->of_tile) + (size_t)at * top->maps);
    const double share = acdf_tile_find(acdf_halvings_nodes(sky->halved), tile, position, box);
    return here * 0x1p-52 * share * acdf_tile_scale(acdf_halved_heights(sky->halved), &sky->grid, tile, box);
}

/* ---- samples and pdfs ----------------------------------------------------------------------------------- */

/* The pdf of both parts, and that of the cone. */
ACDF_INLINE float acdf_mixed_both(const AcdfMixed* sky, const float direction[3], double of_tree, double* in_cone) {
    double pdf = (1.0 - sky->sun_share) * of_tree;
    *in_cone = 0.0;
    if (sky->cone.reach > 0.0) {
        *in_cone = sky->sun_share * acdf_cone_pdf(&sky->cone, acdf_cone_place(&sky->cone, direction));
        pdf += *in_cone;
    }
    return acdf_float_pdf(pdf);
}

/* The cell that holds a direction, in doubles: right at borders, too. Returns its pdf; below 0 for directions that
 * have none. */
ACDF_OUTLINE double acdf_mixed_at_border(const AcdfMixed* sky, const float direction[3], AcdfSpan box[2]) {
    uint32_t square[2];
    double position[2];
    if (!acdf_grid_square(&sky->grid, direction, square, position)) return -1.0;
    return acdf_mixed_cell(sky, square, box);
}

/* The pdf in sr^-1 with which acdf_mixed_sample returns a direction: exactly the sample's. 0 where no sample falls,
 * and for directions that are NaN or not of unit length. */
ACDF_INLINE float acdf_mixed_pdf(const AcdfMixed* sky, const float direction[3]) {
    float position[2], error[2];
    double of_tree = -1.0, unused;
    AcdfSpan box[2];
    if (sky->grid.parameterization != ACDF_PARAM_OCTAHEDRAL &&
        acdf_sphere_nearly(sky->grid.columns, sky->grid.rows, direction, position, error)) {
        uint32_t square[2];
        double p;
        square[0] = (uint32_t)position[0] < sky->grid.columns ? (uint32_t)position[0] : sky->grid.columns - 1u;
        square[1] = (uint32_t)position[1] < sky->grid.rows ? (uint32_t)position[1] : sky->grid.rows - 1u;
        p = acdf_mixed_cell(sky, square, box);
        if (acdf_is_surely_in(position, error, box[0].end[0], box[0].end[1], box[1].end[0], box[1].end[1]))
            of_tree = p;
    }
    if (of_tree < 0.0) of_tree = acdf_mixed_at_border(sky, direction, box);
    return of_tree < 0.0 ? 0.0f : acdf_mixed_both(sky, direction, of_tree, &unused);
}

/* Samples a direction; u0 and u1 in [0, 1]. Values outside are clamped, NaN counts as 0. */
ACDF_INLINE AcdfDirectionSample acdf_mixed_sample(const AcdfMixed* sky, double u0, double u1) {
    double u[2], p, unused;
    AcdfDirectionSample out;
    AcdfSpan box[2];
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (u[1] < sky->sun_share) {
        u[1] /= sky->sun_share;
        acdf_cone_sample(&sky->cone, u, out.direction);
        out.pdf = acdf_mixed_pdf(sky, out.direction);
        return out;
    }
    u[1] = (u[1] - sky->sun_share) / (1.0 - sky->sun_share);
    p = acdf_mixed_descend(sky, u, box);
    acdf_box_direction(acdf_halved_heights(sky->halved), &sky->grid, box, u, out.direction);
    out.pdf = acdf_mixed_both(sky, out.direction, p, &unused);
    return out;
}

/* Where on the axes of random numbers a cell lies: the descent to a box, by its lowest step. */
ACDF_FN void acdf_mixed_strata(const AcdfMixed* sky, const uint32_t position[2], AcdfStratum strata[2]) {
    const AcdfTop* top = sky->top;
    const AcdfTopSplit* splits = ACDF_TOP_ARRAY(AcdfTopSplit, top, top->top);
    const uint32_t* rows = ACDF_TOP_ARRAY(uint32_t, top, top->lower);
    uint32_t at = top->splits ? 0 : ACDF_TOP_TILE;
    double here = ACDF_WEIGHTS * 0x1p31;
    const AcdfTopTile* tile;
    AcdfSpan box[2], steps[2];
    int axis;
    for (axis = 0; axis < 2; ++axis) strata[axis].low = 0.0, strata[axis].width = 1.0;
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfTopSplit split = splits[at];
        const uint32_t upper = position[split.axis] >= split.middle;
        const double lower = acdf_mixed_steps(sky, rows + (size_t)at * top->maps),
                     of_half = upper ? here - lower : lower;
        AcdfStratum* stratum = &strata[split.axis];
        if (upper) stratum->low += stratum->width * (lower / here);
        stratum->width *= of_half / here;
        here = of_half;
        at = split.child[upper];
    }
    tile = ACDF_TOP_ARRAY(AcdfTopTile, top, top->tiles) + (at & ~ACDF_TOP_TILE);
    if (tile->node == ACDF_LEAF) return;
    for (axis = 0; axis < 2; ++axis) steps[axis] = tile->steps[axis], box[axis] = tile->box[axis];
    acdf_halvings_find(acdf_halvings_nodes(sky->halved), tile->node, position, steps, box);
    for (axis = 0; axis < 2; ++axis) {
        const double wide = (double)(tile->steps[axis].end[1] - tile->steps[axis].end[0]);
        strata[axis].low += strata[axis].width * ((double)(steps[axis].end[0] - tile->steps[axis].end[0]) / wide);
        strata[axis].width *= (double)(steps[axis].end[1] - steps[axis].end[0]) / wide;
    }
}

/* Random numbers u[2] for which acdf_mixed_sample returns `direction`: in the cone those of the part that samples
 * it more often. Returns 1, or 0 (and u unset) where the pdf is 0. */
ACDF_FN int acdf_mixed_invert(const AcdfMixed* sky, const float direction[3], double u[2]) {
    AcdfSpan box[2];
    AcdfRange range[2];
    AcdfStratum strata[2];
    uint32_t square[2], lowest[2];
    double position[2], t[2], in_cone, of_tree;
    int axis;
    of_tree = acdf_mixed_at_border(sky, direction, box);
    if (of_tree < 0.0 || !(acdf_mixed_both(sky, direction, of_tree, &in_cone) > 0.0f)) return 0;
    if (in_cone > (1.0 - sky->sun_share) * of_tree) {
        acdf_cone_invert(&sky->cone, direction, acdf_cone_place(&sky->cone, direction), u);
        u[1] *= sky->sun_share;
        return 1;
    }
    acdf_grid_square(&sky->grid, direction, square, position);
    acdf_halved_ranges(box, range);
    acdf_grid_fractions(&sky->grid, direction, position, range, t);
    for (axis = 0; axis < 2; ++axis) lowest[axis] = range[axis].low;
    acdf_mixed_strata(sky, lowest, strata);
    for (axis = 0; axis < 2; ++axis) u[axis] = acdf_stratum_number(&strata[axis], t[axis]);
    u[1] = sky->sun_share + (1.0 - sky->sun_share) * u[1];
    if (u[1] > 1.0) u[1] = 1.0;
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
