/* Portals: rectangles that light comes through, as a position sees them. One freestanding header over
 * acdf/visibility/cells.h, valid C99, C++17 and CUDA/HIP/SYCL, with the same contract (SPEC.md §13).
 *
 * All portals that face the same way share a map of the light of their hemisphere. Its axes are tangents along the
 * sides of the portals, bent into a square, so that a portal is an upright rectangle of the map from wherever it is
 * seen: a *visible_portal* (Bitterli, Novak, Jarosz, "Portal-Masked Environment Map Sampling", EGSR 2015). A portal
 * is divided into pieces along its sides. Each is sampled as the light in it, times a cosine to the normal, times
 * how much of it the cell of the position sees; then, in a piece, the map is followed. A share that the cell stores
 * is sampled by its row: it covers all other light, and a scene that has changed.
 *
 * The map is bent by t / (1 + |t|), not by the arc tangent of that paper: cells are about as even, and no machine
 * rounds it in another way. */
#ifndef ACDF_VISIBILITY_PORTALS_H
#define ACDF_VISIBILITY_PORTALS_H

#include <acdf/random.h>
#include <acdf/visibility/cells.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfPortalTable {
    const AcdfPortals* header; /* chunk PORT; null where there is none */
    const AcdfPortal* portals; /* behind it */
    const AcdfPortalMap* maps;
    const uint32_t* sums; /* of all maps */
    const uint8_t* rows;  /* one a row of visibility cells */
} AcdfPortalTable;

/* A portal that a position sees; none of its tangents is larger than this, and none of its sides shorter in a map.
 */
#define ACDF_STEEPEST 0x1p12
#define ACDF_THINNEST 0x1p-12

/* A portal as a position sees it, and those of its pieces that have been weighed. */
typedef struct AcdfVisiblePortal {
    double low[2], high[2]; /* tangents of its sides, along the axes of its map */
    double weight;          /* of these pieces */
    uint32_t map;
    float piece[ACDF_MAX_PORTAL_PIECES][ACDF_MAX_PORTAL_PIECES];   /* weights, column by column */
    float density[ACDF_MAX_PORTAL_PIECES][ACDF_MAX_PORTAL_PIECES]; /* of weight, for 1 in the map */
} AcdfVisiblePortal;

/* What a shading point keeps of portals: pieces are weighed again when one is sampled, or a direction meets it. */
typedef struct AcdfVisiblePortals {
    double of_row;                   /* the share that the row samples, in (0, 1) */
    double weight[ACDF_MAX_PORTALS]; /* of each portal of the file; 0: it is not seen */
    float position[3];
} AcdfVisiblePortals;

/* Where portals are seen from. */
typedef struct AcdfPortalEye {
    const AcdfPortalTable* table;
    const uint8_t* row; /* of the visibility cell there; null: nothing hides a portal */
    double x[6];        /* position and unit normal among the cells */
    uint32_t weighed;   /* the portal whose pieces are all weighed in `seen`; ACDF_MAX_PORTALS: none */
    AcdfVisiblePortal seen;
} AcdfPortalEye;

/* Where a tangent lies on an axis of a map of `size` cells, and back. */
ACDF_FN double acdf_bend(double tangent, double size) {
    return 0.5 * size * (1.0 + tangent / (1.0 + fabs(tangent)));
}
ACDF_FN double acdf_unbend(double at, double size) {
    const double x = 2.0 * at / size - 1.0;
    return x / (1.0 - fabs(x));
}

ACDF_FN double acdf_dot3(const float a[3], const double b[3]) {
    return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

/* The cell of a place on an axis: the last one where it lies on the upper end. */
ACDF_FN uint32_t acdf_map_cell(double at, uint32_t size) {
    const uint32_t cell = (uint32_t)at;
    return cell < size ? cell : size - 1;
}

/* A place on an axis of a map: a cell, and where it lies in that. */
typedef struct AcdfMapPlace {
    uint32_t cell;
    double part;
} AcdfMapPlace;

ACDF_INLINE AcdfMapPlace acdf_map_place(double at, uint32_t size) {
    AcdfMapPlace out;
    out.cell = acdf_map_cell(at, size);
    out.part = at - (double)out.cell;
    return out;
}

/* The light of a map below and left of places, linear within cells. */
ACDF_INLINE double acdf_map_below_places(const uint32_t* sums, uint32_t size, AcdfMapPlace x, AcdfMapPlace y) {
    const uint32_t* at = sums + (size_t)y.cell * (size + 1) + x.cell;
    const double lower = (double)at[0] + x.part * ((double)at[1] - (double)at[0]);
    const double upper = (double)at[size + 1] + x.part * ((double)at[size + 2] - (double)at[size + 1]);
    return lower + y.part * (upper - lower);
}
ACDF_FN double acdf_map_sum(const uint32_t* sums, uint32_t size, double x, double y) {
    return acdf_map_below_places(sums, size, acdf_map_place(x, size), acdf_map_place(y, size));
}

/* The light of a cell, exactly. */
ACDF_FN uint32_t acdf_map_light(const uint32_t* sums, uint32_t size, uint32_t column, uint32_t row) {
    const uint32_t* at = sums + (size_t)row * (size + 1) + column;
    return (at[size + 2] - at[size + 1]) - (at[1] - at[0]);
}

ACDF_FN const uint32_t* acdf_portal_map_sums(const AcdfPortalTable* table, uint32_t map) {
    const size_t side = (size_t)table->header->size + 1;
    return table->sums + map * side * side;
}

/* The bytes of a row of visibility cells. */
ACDF_FN const uint8_t* acdf_portal_row(const AcdfPortalTable* table, uint32_t number) {
    const AcdfPortals* header = table->header;
    return table->rows + (size_t)number * (1 + header->portal_count * header->pieces * header->pieces);
}

/* Where a portal is seen from a point in front of it; 0 where that lies behind. */
ACDF_FN int acdf_portal_sides(const AcdfPortalTable* table, const AcdfPortal* portal, const double from[3],
                              AcdfVisiblePortal* out) {
    const AcdfPortalMap* map = &table->maps[portal->map];
    double corner[3], distance;
    int k;
    for (k = 0; k < 3; ++k) corner[k] = (double)portal->corner[k] - from[k];
    distance = acdf_dot3(map->axis[2], corner);
    for (k = 0; k < 2; ++k) {
        const double low = acdf_dot3(map->axis[k], corner), high = low + (double)portal->sides[k];
        out->low[k] = low / distance;
        out->high[k] = high / distance;
    }
    out->map = portal->map;
    return distance > 0.0;
}

/* The same; 0 also where it is too thin. */
ACDF_FN int acdf_portal_bounds(const AcdfPortalTable* table, const AcdfPortal* portal, const double from[3],
                               AcdfVisiblePortal* out) {
    const double size = (double)table->header->size;
    int k;
    if (!acdf_portal_sides(table, portal, from, out)) return 0;
    for (k = 0; k < 2; ++k)
        if (!(out->low[k] > -ACDF_STEEPEST && out->high[k] < ACDF_STEEPEST &&
              acdf_bend(out->high[k], size) - acdf_bend(out->low[k], size) > ACDF_THINNEST))
            return 0;
    return 1;
}

/* The side of a piece: the tangent at `i` of `pieces` steps. */
ACDF_FN double acdf_piece_side(const AcdfVisiblePortal* visible_portal, int axis, uint32_t i, uint32_t pieces) {
    if (i == pieces) return visible_portal->high[axis];
    return visible_portal->low[axis] +
           (visible_portal->high[axis] - visible_portal->low[axis]) * ((double)i / (double)pieces);
}

/* What the cell sees of a piece of a portal. */
ACDF_FN double acdf_portal_visibility(const AcdfPortalEye* eye, uint32_t portal, uint32_t piece) {
    const AcdfPortals* header = eye->table->header;
    const uint32_t index = 1 + portal * header->pieces * header->pieces + piece;
    return eye->row ? acdf_visibility_of_code(eye->row[index]) : 1.0;
}

/* The light between interpolated sums is less than this part of the largest of them off: no more may be none. */
#define ACDF_LEAST_LIGHT 0x1p-48

/* Pieces of a portal, from `first` up to `end` along either axis. */
typedef struct AcdfPortalPieces {
    uint32_t first[2], end[2];
} AcdfPortalPieces;

ACDF_FN AcdfPortalPieces acdf_all_pieces(const AcdfPortalTable* table) {
    AcdfPortalPieces out;
    out.first[0] = out.first[1] = 0;
    out.end[0] = out.end[1] = table->header->pieces;
    return out;
}

/* Weighs pieces of a portal whose sides are known: its light, times the mean of the cosines at the corners, times
 * what is visible. */
ACDF_FN void acdf_portal_weigh(const AcdfPortalEye* eye, uint32_t portal, const AcdfPortalPieces* some,
                               AcdfVisiblePortal* visible_portal) {
    const AcdfPortalTable* table = eye->table;
    const AcdfPortalMap* map = &table->maps[visible_portal->map];
    const uint32_t* sums = acdf_portal_map_sums(table, visible_portal->map);
    const uint32_t size = table->header->size, pieces = table->header->pieces;
    double n[3], below[2][ACDF_MAX_PORTAL_PIECES + 1], cosine[2][ACDF_MAX_PORTAL_PIECES + 1];
    double side[ACDF_MAX_PORTAL_PIECES + 1];
    AcdfMapPlace place[ACDF_MAX_PORTAL_PIECES + 1];
    uint32_t i, j, k;
    visible_portal->weight = 0.0;
    for (k = 0; k < 3; ++k) n[k] = acdf_dot3(map->axis[k], eye->x + 3);
    for (j = some->first[1]; j <= some->end[1]; ++j) {
        side[j] = acdf_piece_side(visible_portal, 1, j, pieces);
        place[j] = acdf_map_place(acdf_bend(side[j], (double)size), size);
    }
    for (i = some->first[0]; i <= some->end[0]; ++i) { /* column by column of corners: those before, and these */
        const double x = acdf_piece_side(visible_portal, 0, i, pieces);
        const AcdfMapPlace at = acdf_map_place(acdf_bend(x, (double)size), size);
        const int now = (int)(i & 1u), before = 1 - now;
        for (j = some->first[1]; j <= some->end[1]; ++j) {
            const double y = side[j];
            const double height = n[0] * x + n[1] * y + n[2];
            below[now][j] = acdf_map_below_places(sums, size, at, place[j]);
            cosine[now][j] = (height > 0.0 ? height : 0.0) / sqrt(1.0 + x * x + y * y);
        }
        for (j = some->first[1]; i > some->first[0] && j < some->end[1]; ++j) {
            const double light = (below[now][j + 1] - below[now][j]) - (below[before][j + 1] - below[before][j]);
            const double density =
                (cosine[now][j + 1] + cosine[now][j] + (cosine[before][j + 1] + cosine[before][j])) *
                (0.25 * (double)map->unit) * acdf_portal_visibility(eye, portal, (i - 1) * pieces + j);
            const float weight = (float)(light > ACDF_LEAST_LIGHT * below[now][j + 1] ? density * light : 0.0);
            visible_portal->piece[i - 1][j] = weight;
            visible_portal->density[i - 1][j] = (float)(weight > 0.0f ? density : 0.0);
            visible_portal->weight += (double)weight;
        }
    }
}

/* Looks from a position and a normal of a cell. Returns 0 outside of all cells. */
ACDF_FN int acdf_portal_eye(const AcdfPortalTable* table, const AcdfVisibilityTable* visibility, uint32_t cell,
                            const float position[3], const float normal[3], AcdfPortalEye* out) {
    out->table = table;
    out->weighed = ACDF_MAX_PORTALS;
    out->row = acdf_portal_row(table, cell);
    return acdf_visibility_coordinates(visibility, position, normal, out->x);
}

/* Weighs all pieces of a portal whose sides are known in `seen`. */
ACDF_FN void acdf_portal_weigh_all(AcdfPortalEye* eye, uint32_t portal) {
    const AcdfPortalPieces all = acdf_all_pieces(eye->table);
    acdf_portal_weigh(eye, portal, &all, &eye->seen);
    eye->weighed = portal;
}

/* The weight of a portal; 0 where it is not seen. */
ACDF_FN double acdf_portal_weight(AcdfPortalEye* eye, uint32_t portal) {
    if (!acdf_portal_bounds(eye->table, &eye->table->portals[portal], eye->x, &eye->seen)) return 0.0;
    acdf_portal_weigh_all(eye, portal);
    return eye->seen.weight > 0.0 && acdf_is_finite(eye->seen.weight) ? eye->seen.weight : 0.0;
}

/* The share of the row. */
ACDF_FN double acdf_portals_of_row(const AcdfPortalEye* eye) { return ((double)eye->row[0] + 1.0) * (1.0 / 256.0); }

/* The sum of the weights of all portals. */
ACDF_FN double acdf_visible_portals_weight(const AcdfPortalTable* table,
                                           const AcdfVisiblePortals* visible_portals) {
    double sum = 0.0;
    uint32_t k;
    for (k = 0; k < table->header->portal_count; ++k) sum += visible_portals->weight[k];
    return sum;
}

/* The portals that a position and a normal of a cell see. Returns how many; where it is none, only the
 * row is sampled. */
ACDF_FN uint32_t acdf_visible_portals_at(const AcdfPortalTable* table, const AcdfVisibilityTable* visibility,
                                         uint32_t cell, const float position[3], const float normal[3],
                                         AcdfVisiblePortals* out) {
    AcdfPortalEye eye;
    uint32_t k, count = 0;
    if (!acdf_portal_eye(table, visibility, cell, position, normal, &eye)) return 0;
    out->of_row = acdf_portals_of_row(&eye);
    if (!(out->of_row < 1.0)) return 0;
    for (k = 0; k < 3; ++k) out->position[k] = position[k];
    for (k = 0; k < table->header->portal_count; ++k) {
        out->weight[k] = acdf_portal_weight(&eye, k);
        count += (uint32_t)(out->weight[k] > 0.0);
    }
    return acdf_is_finite(acdf_visible_portals_weight(table, out)) ? count : 0;
}

/* Of the pdfs of visible_portals and row together. */
ACDF_FN float acdf_visible_portals_mixed(const AcdfVisiblePortals* visible_portals, double of_portals,
                                         float of_row) {
    const double pdf = visible_portals->of_row * (double)of_row + (1.0 - visible_portals->of_row) * of_portals;
    return acdf_float_pdf(pdf);
}

/* Where a unit direction meets a visible_portal: its piece, and the weight per steradian there for a density of 1.
 */
typedef struct AcdfPortalSpot {
    uint32_t piece[2];
    double light, z, slope;
} AcdfPortalSpot;

/* Returns 0 where it does not. */
ACDF_FN int acdf_visible_portal_find(const AcdfPortalTable* table, const AcdfVisiblePortal* visible_portal,
                                     const double d[3], AcdfPortalSpot* out) {
    const AcdfPortalMap* map = &table->maps[visible_portal->map];
    const uint32_t size = table->header->size, pieces = table->header->pieces;
    const double z = acdf_dot3(map->axis[2], d);
    double along[2];
    uint32_t cell[2];
    int k;
    if (!(z > 0.0)) return 0;
    for (k = 0; k < 2; ++k) {
        double t;
        along[k] = acdf_dot3(map->axis[k], d);
        t = along[k] / z;
        if (!(t >= visible_portal->low[k] && t <= visible_portal->high[k])) return 0;
        out->piece[k] = acdf_map_cell((t - visible_portal->low[k]) /
                                          (visible_portal->high[k] - visible_portal->low[k]) * (double)pieces,
                                      pieces);
        cell[k] = acdf_map_cell(acdf_bend(t, (double)size), size);
    }
    out->light = (double)acdf_map_light(acdf_portal_map_sums(table, visible_portal->map), size, cell[0], cell[1]);
    out->z = z;
    out->slope = (z + fabs(along[0])) * (z + fabs(along[1]));
    return 1;
}

/* The weight per steradian of a direction in a visible_portal whose piece there has been weighed. */
ACDF_FN double acdf_portal_spot_pdf(const AcdfPortalTable* table, const AcdfVisiblePortal* visible_portal,
                                    const AcdfPortalSpot* spot) {
    const double size = (double)table->header->size;
    return (double)visible_portal->density[spot->piece[0]][spot->piece[1]] * spot->light * (0.25 * size * size) *
           spot->z / (spot->slope * spot->slope);
}

/* The weight per steradian of a unit direction in a portal that is seen. */
ACDF_FN double acdf_portal_pdf(const AcdfPortalEye* eye, uint32_t portal, const double d[3]) {
    AcdfVisiblePortal seen;
    AcdfPortalPieces one;
    AcdfPortalSpot spot;
    int k;
    if (eye->weighed == portal)
        return acdf_visible_portal_find(eye->table, &eye->seen, d, &spot)
                   ? acdf_portal_spot_pdf(eye->table, &eye->seen, &spot)
                   : 0.0;
    if (!acdf_portal_sides(eye->table, &eye->table->portals[portal], eye->x, &seen) ||
        !acdf_visible_portal_find(eye->table, &seen, d, &spot))
        return 0.0;
    for (k = 0; k < 2; ++k) {
        one.first[k] = spot.piece[k];
        one.end[k] = spot.piece[k] + 1;
    }
    acdf_portal_weigh(eye, portal, &one, &seen);
    return acdf_portal_spot_pdf(eye->table, &seen, &spot);
}

/* Pdf per steradian of row and visible_portals together; `row`: that of the row. */
ACDF_OUTLINE_ON_CPU float acdf_visible_portals_pdf(const AcdfPortalEye* eye,
                                                   const AcdfVisiblePortals* visible_portals,
                                                   const float direction[3], float row) {
    double d[3], size, sum = 0.0;
    float given[3];
    uint32_t k;
    acdf_as_given(direction, given);
    for (k = 0; k < 3; ++k) d[k] = given[k];
    size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(size > 0.9995 && size < 1.0005)) return 0.0f;
    for (k = 0; k < eye->table->header->portal_count; ++k)
        if (visible_portals->weight[k] > 0.0) sum += acdf_portal_pdf(eye, k, d);
    return acdf_visible_portals_mixed(visible_portals,
                                      sum / acdf_visible_portals_weight(eye->table, visible_portals), row);
}

/* Returns 1 where u[0] samples through a portal, 0 where it samples by the row; rescales u[0] to [0, 1] in that
 * part. */
ACDF_FN int acdf_visible_portals_choose(const AcdfVisiblePortals* visible_portals, double* u) {
    if (u[0] < visible_portals->of_row) {
        u[0] = acdf_unit_interval(u[0] / visible_portals->of_row);
        return 0;
    }
    u[0] = acdf_unit_interval((u[0] - visible_portals->of_row) / (1.0 - visible_portals->of_row));
    return 1;
}

/* Samples one of `count` parts in proportion to their weights, some of which are > 0; rescales *u to [0, 1] in it.
 */
ACDF_FN uint32_t acdf_sample_part(const double* weight, uint32_t count, double* u) {
    double x = 0.0;
    uint32_t i, last = 0;
    for (i = 0; i < count; ++i) x += weight[i];
    x *= *u;
    for (i = 0; i < count; ++i) {
        if (!(weight[i] > 0.0)) continue;
        last = i;
        if (x < weight[i]) break;
        x -= weight[i];
    }
    *u = i < count ? acdf_unit_interval(x / weight[last]) : 1.0;
    return last;
}

/* Where, from `low` to `high` on axis 0 of a map, u of the light between two visibility on axis 1 lies before; on
 * axis 1 the same of the cells of one column. *cell becomes the one it lies in or ends at, which has light. */
ACDF_FN double acdf_map_column(const uint32_t* sums, uint32_t size, const double low[2], const double high[2],
                               double u, uint32_t* cell) {
    const double from = acdf_map_sum(sums, size, low[0], high[1]) - acdf_map_sum(sums, size, low[0], low[1]);
    const double most = acdf_map_sum(sums, size, high[0], high[1]);
    const double to = most - acdf_map_sum(sums, size, high[0], low[1]);
    const double sought = from + u * (to - from);
    uint32_t first = acdf_map_cell(low[0], size), last = acdf_map_cell(high[0], size);
    double a, b, at_a, at_b;
    while (first < last) { /* the last column that begins with no more, but for those at the end without light */
        const uint32_t middle = first + (last - first + 1) / 2;
        const double x = (double)middle;
        const double begin = acdf_map_sum(sums, size, x, high[1]) - acdf_map_sum(sums, size, x, low[1]);
        if (begin <= sought && begin < to - ACDF_LEAST_LIGHT * most) first = middle;
        else last = middle - 1;
    }
    *cell = first;
    a = low[0] > (double)first ? low[0] : (double)first;
    b = high[0] < (double)first + 1.0 ? high[0] : (double)first + 1.0;
    at_a = acdf_map_sum(sums, size, a, high[1]) - acdf_map_sum(sums, size, a, low[1]);
    at_b = acdf_map_sum(sums, size, b, high[1]) - acdf_map_sum(sums, size, b, low[1]);
    return at_b > at_a ? a + (b - a) * acdf_clamp((sought - at_a) / (at_b - at_a), 0.0, 1.0) : a;
}
ACDF_FN double acdf_map_below(const uint32_t* sums, uint32_t size, uint32_t column, double y) {
    const uint32_t row = acdf_map_cell(y, size);
    const uint32_t* at = sums + (size_t)row * (size + 1) + column;
    const double lower = (double)(at[1] - at[0]), upper = (double)(at[size + 2] - at[size + 1]);
    return lower + (y - (double)row) * (upper - lower);
}
ACDF_FN double acdf_map_row(const uint32_t* sums, uint32_t size, uint32_t column, double low, double high, double u,
                            uint32_t* cell) {
    const double from = acdf_map_below(sums, size, column, low), to = acdf_map_below(sums, size, column, high);
    const double sought = from + u * (to - from);
    uint32_t first = acdf_map_cell(low, size), last = acdf_map_cell(high, size);
    double a, b, at_a, at_b;
    while (first < last) {
        const uint32_t middle = first + (last - first + 1) / 2;
        const double begin = acdf_map_below(sums, size, column, (double)middle);
        if (begin <= sought && begin < to) first = middle;
        else last = middle - 1;
    }
    *cell = first;
    a = low > (double)first ? low : (double)first;
    b = high < (double)first + 1.0 ? high : (double)first + 1.0;
    at_a = acdf_map_below(sums, size, column, a);
    at_b = acdf_map_below(sums, size, column, b);
    return at_b > at_a ? a + (b - a) * acdf_clamp((sought - at_a) / (at_b - at_a), 0.0, 1.0) : a;
}

/* How far from a tangent a direction stays, so that rounding does not carry it across. */
ACDF_FN double acdf_tangent_border(double t) { return 0x1p-22 * (1.0 + t * t); }

/* The tangent of a place on an axis of a map that was sampled in a cell, inside of the cell where its borders lie
 * between `low` and `high`. */
ACDF_FN double acdf_inside_cell(double at, double size, uint32_t cell, double low, double high) {
    const double begin = (double)cell, end = begin + 1.0;
    double t = acdf_unbend(at, size);
    if (begin > low) {
        const double side = acdf_unbend(begin, size), least = side + acdf_tangent_border(side);
        if (t < least) t = least;
    }
    if (end < high) {
        const double side = acdf_unbend(end, size), most = side - acdf_tangent_border(side);
        if (t > most) t = most;
    }
    return t;
}

/* A tangent that was sampled between two sides, inside of them. */
ACDF_FN double acdf_inside_piece(double t, double low, double high) {
    const double border = acdf_tangent_border(fabs(low) > fabs(high) ? low : high);
    if (!(high - low > 2.0 * border)) return 0.5 * (low + high);
    return acdf_clamp(t, low + border, high - border);
}

/* Samples a direction in a piece of a visible_portal: a column of the map, then a row. */
ACDF_FN void acdf_piece_sample(const AcdfPortalTable* table, const AcdfVisiblePortal* visible_portal,
                               const uint32_t piece[2], const double u[2], float direction[3]) {
    const AcdfPortalMap* map = &table->maps[visible_portal->map];
    const uint32_t* sums = acdf_portal_map_sums(table, visible_portal->map);
    const uint32_t size = table->header->size, pieces = table->header->pieces;
    double low[2], high[2], side[2][2], t[2], d[3], at, length;
    uint32_t column, row;
    int i;
    for (i = 0; i < 2; ++i) {
        side[i][0] = acdf_piece_side(visible_portal, i, piece[i], pieces);
        side[i][1] = acdf_piece_side(visible_portal, i, piece[i] + 1, pieces);
        low[i] = acdf_bend(side[i][0], (double)size);
        high[i] = acdf_bend(side[i][1], (double)size);
    }
    at = acdf_map_column(sums, size, low, high, u[0], &column);
    at = acdf_inside_cell(at, (double)size, column, low[0], high[0]);
    t[0] = acdf_inside_piece(at, side[0][0], side[0][1]);
    at = acdf_map_row(sums, size, column, low[1], high[1], u[1], &row);
    at = acdf_inside_cell(at, (double)size, row, low[1], high[1]);
    t[1] = acdf_inside_piece(at, side[1][0], side[1][1]);
    for (i = 0; i < 3; ++i)
        d[i] = t[0] * (double)map->axis[0][i] + t[1] * (double)map->axis[1][i] + (double)map->axis[2][i];
    length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (i = 0; i < 3; ++i) direction[i] = (float)(d[i] / length);
}

/* Samples a direction through a visible_portal: it, a column and a row of its pieces, then in the piece. */
ACDF_FN void acdf_visible_portals_sample(AcdfPortalEye* eye, const AcdfVisiblePortals* visible_portals, double* u,
                                         float direction[3]) {
    const AcdfPortalTable* table = eye->table;
    const uint32_t portal = acdf_sample_part(visible_portals->weight, table->header->portal_count, &u[0]);
    const uint32_t pieces = table->header->pieces;
    const AcdfVisiblePortal* seen = &eye->seen;
    double weight[ACDF_MAX_PORTAL_PIECES];
    uint32_t piece[2], i, j;
    acdf_portal_sides(table, &table->portals[portal], eye->x, &eye->seen);
    acdf_portal_weigh_all(eye, portal);
    for (i = 0; i < pieces; ++i)
        for (weight[i] = 0.0, j = 0; j < pieces; ++j) weight[i] += (double)seen->piece[i][j];
    piece[0] = acdf_sample_part(weight, pieces, &u[0]);
    for (j = 0; j < pieces; ++j) weight[j] = (double)seen->piece[piece[0]][j];
    piece[1] = acdf_sample_part(weight, pieces, &u[1]);
    acdf_piece_sample(table, seen, piece, u, direction);
}

#ifdef __cplusplus
}
#endif
#endif
