/* Portals: rectangles that light comes through, as a mixture sees them. One freestanding header over
 * acdf/visibility.h, valid C99, C++17 and CUDA/HIP/SYCL, with the same contract (SPEC.md §13).
 *
 * All portals that face the same way share a map of the light of their hemisphere. Its axes are tangents along the
 * sides of the portals, bent into a square, so that a portal is an upright rectangle of the map from wherever it is
 * seen: a *visible_portal* (Bitterli, Novak, Jarosz, "Portal-Masked Environment Map Sampling", EGSR 2015). A portal
 * is divided into pieces along its sides. Each is sampled as the light in it, times a cosine to the normal, times
 * how much of it the cells of the mixture see; then, in a piece, the map is followed. A share that the cells store
 * is sampled by the row of the mixture: it covers all other light, and a scene that has changed.
 *
 * The map is bent by t / (1 + |t|), not by the arc tangent of that paper: cells are about as even, and no machine
 * rounds it in another way. */
#ifndef ACDF_PORTALS_H
#define ACDF_PORTALS_H

#include <acdf/random.h>
#include <acdf/visibility.h>

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

/* A portal that a mixture sees; none of its tangents is larger than this, and none of its sides shorter in a map.
 */
#define ACDF_STEEPEST 0x1p12
#define ACDF_THINNEST 0x1p-12

typedef struct AcdfVisiblePortal {
    double low[2], high[2]; /* tangents of its sides, along the axes of its map */
    double weight;          /* of all pieces */
    uint32_t map;
    float piece[ACDF_MAX_PORTAL_PIECES][ACDF_MAX_PORTAL_PIECES];   /* weights, column by column */
    float density[ACDF_MAX_PORTAL_PIECES][ACDF_MAX_PORTAL_PIECES]; /* of weight, for 1 in the map */
} AcdfVisiblePortal;

typedef struct AcdfVisiblePortals {
    AcdfPortalTable table;
    int count;     /* 0: only the row is sampled, and the rest is not set */
    double of_row; /* the share that the row samples, in (0, 1) */
    double weight; /* of all visible_portals, > 0 */
    AcdfVisiblePortal visible_portal[ACDF_MAX_PORTALS];
} AcdfVisiblePortals;

/* The mixture of a tangent on an axis of a map of `size` cells, and back. */
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

/* The cell of a mixture on an axis: the last one where it lies on the upper end. */
ACDF_FN uint32_t acdf_map_cell(double at, uint32_t size) {
    const uint32_t cell = (uint32_t)at;
    return cell < size ? cell : size - 1;
}

/* The light of a map below and left of a mixture, linear within cells. */
ACDF_FN double acdf_map_sum(const uint32_t* sums, uint32_t size, double x, double y) {
    const uint32_t column = acdf_map_cell(x, size), row = acdf_map_cell(y, size);
    const uint32_t* at = sums + (size_t)row * (size + 1) + column;
    const double s = x - (double)column, t = y - (double)row;
    const double lower = (double)at[0] + s * ((double)at[1] - (double)at[0]);
    const double upper = (double)at[size + 1] + s * ((double)at[size + 2] - (double)at[size + 1]);
    return lower + t * (upper - lower);
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

/* The bytes of a cell of visibility. */
ACDF_FN const uint8_t* acdf_portal_row(const AcdfPortalTable* table, const AcdfVisibilityTable* visibility,
                                       const uint8_t* row) {
    const AcdfPortals* header = table->header;
    const size_t of_cell = (size_t)1 + visibility->bright_tile_count + visibility->header->column_count;
    const size_t own = (size_t)1 + (size_t)header->portal_count * header->pieces * header->pieces;
    return table->rows + (size_t)(row - visibility->rows) / of_cell * own;
}

/* Where a portal is seen from a point; 0 where it is not, or too thin. */
ACDF_FN int acdf_portal_bounds(const AcdfPortalTable* table, const AcdfPortal* portal, const double from[3],
                               AcdfVisiblePortal* out) {
    const AcdfPortalMap* map = &table->maps[portal->map];
    const double size = (double)table->header->size;
    double corner[3], distance;
    int k;
    for (k = 0; k < 3; ++k) corner[k] = (double)portal->corner[k] - from[k];
    distance = acdf_dot3(map->axis[2], corner);
    if (!(distance > 0.0)) return 0;
    for (k = 0; k < 2; ++k) {
        const double low = acdf_dot3(map->axis[k], corner), high = low + (double)portal->sides[k];
        out->low[k] = low / distance;
        out->high[k] = high / distance;
        if (!(out->low[k] > -ACDF_STEEPEST && out->high[k] < ACDF_STEEPEST &&
              acdf_bend(out->high[k], size) - acdf_bend(out->low[k], size) > ACDF_THINNEST))
            return 0;
    }
    out->map = portal->map;
    return 1;
}

/* The side of a piece: the tangent at `i` of `pieces` steps. */
ACDF_FN double acdf_piece_side(const AcdfVisiblePortal* visible_portal, int axis, uint32_t i, uint32_t pieces) {
    if (i == pieces) return visible_portal->high[axis];
    return visible_portal->low[axis] +
           (visible_portal->high[axis] - visible_portal->low[axis]) * ((double)i / (double)pieces);
}

/* What the cells of a mixture see of each piece of a portal, whose bytes begin at `first` of each row. */
ACDF_FN void acdf_portal_visibility(const AcdfVisibilityMixture* mixture, const uint8_t** rows, uint32_t first,
                                    uint32_t count, double* out) {
    uint32_t c;
    int i;
    for (c = 0; c < count; ++c) out[c] = 0.0;
    for (i = 0; i < mixture->count; ++i)
        for (c = 0; c < count; ++c) out[c] += mixture->weight[i] * acdf_visibility_of_code(rows[i][first + c]);
}

/* The light between interpolated sums is less than this part of the largest of them off: no more may be none. */
#define ACDF_LEAST_LIGHT 0x1p-48

/* Weighs the pieces of a visible_portal: its light, times the mean of the cosines at the corners, times what is
 * visible. */
ACDF_FN void acdf_visible_portal_weigh(const AcdfPortalTable* table, const double normal[3], const double* visible,
                                       AcdfVisiblePortal* visible_portal) {
    const AcdfPortalMap* map = &table->maps[visible_portal->map];
    const uint32_t* sums = acdf_portal_map_sums(table, visible_portal->map);
    const uint32_t size = table->header->size, pieces = table->header->pieces;
    double n[3], below[2][ACDF_MAX_PORTAL_PIECES + 1], cosine[2][ACDF_MAX_PORTAL_PIECES + 1];
    double side[ACDF_MAX_PORTAL_PIECES + 1], bent[ACDF_MAX_PORTAL_PIECES + 1];
    uint32_t i, j, k;
    visible_portal->weight = 0.0;
    for (k = 0; k < 3; ++k) n[k] = acdf_dot3(map->axis[k], normal);
    for (j = 0; j <= pieces; ++j) {
        side[j] = acdf_piece_side(visible_portal, 1, j, pieces);
        bent[j] = acdf_bend(side[j], (double)size);
    }
    for (i = 0; i <= pieces; ++i) { /* column by column of corners: those before, and these */
        const double x = acdf_piece_side(visible_portal, 0, i, pieces), at = acdf_bend(x, (double)size);
        const int now = (int)(i & 1u), before = 1 - now;
        for (j = 0; j <= pieces; ++j) {
            const double y = side[j];
            const double height = n[0] * x + n[1] * y + n[2];
            below[now][j] = acdf_map_sum(sums, size, at, bent[j]);
            cosine[now][j] = height > 0.0 ? height / sqrt(1.0 + x * x + y * y) : 0.0;
        }
        for (j = 0; i > 0 && j < pieces; ++j) {
            const double light = (below[now][j + 1] - below[now][j]) - (below[before][j + 1] - below[before][j]);
            const double density =
                (cosine[now][j + 1] + cosine[now][j] + (cosine[before][j + 1] + cosine[before][j])) *
                (0.25 * (double)map->unit) * visible[(i - 1) * pieces + j];
            const float weight = (float)(light > ACDF_LEAST_LIGHT * below[now][j + 1] ? density * light : 0.0);
            visible_portal->piece[i - 1][j] = weight;
            visible_portal->density[i - 1][j] = (float)(weight > 0.0f ? density : 0.0);
            visible_portal->weight += (double)weight;
        }
    }
}

/* The visible_portals of a mixture, which lies in cells, and a normal. */
ACDF_FN void acdf_visible_portals_at(const AcdfPortalTable* table, const AcdfVisibilityTable* visibility,
                                     const AcdfVisibilityMixture* mixture, const float position[3],
                                     const float normal[3], AcdfVisiblePortals* out) {
    const uint32_t pieces = table->header->pieces * table->header->pieces;
    const uint8_t* rows[ACDF_MAX_CELLS_MIXED];
    double x[6], visible[ACDF_MAX_PORTAL_PIECES * ACDF_MAX_PORTAL_PIECES];
    uint32_t k;
    int i;
    out->count = 0;
    out->of_row = out->weight = 0.0;
    for (i = 0; i < mixture->count; ++i) {
        rows[i] = acdf_portal_row(table, visibility, mixture->row[i]);
        out->of_row += mixture->weight[i] * ((double)rows[i][0] + 1.0) * (1.0 / 256.0);
    }
    if (!(out->of_row < 1.0) || !acdf_visibility_coordinates(visibility, position, normal, x)) return;
    out->table = *table;
    for (k = 0; k < table->header->portal_count; ++k) {
        AcdfVisiblePortal* visible_portal = &out->visible_portal[out->count];
        if (!acdf_portal_bounds(table, &table->portals[k], x, visible_portal)) continue;
        acdf_portal_visibility(mixture, rows, 1 + k * pieces, pieces, visible);
        acdf_visible_portal_weigh(table, x + 3, visible, visible_portal);
        if (!(visible_portal->weight > 0.0 && acdf_is_finite(visible_portal->weight))) continue;
        out->weight += visible_portal->weight;
        ++out->count;
    }
    if (!acdf_is_finite(out->weight)) out->count = 0;
}

/* Of the pdfs of visible_portals and row together. */
ACDF_FN float acdf_visible_portals_mixed(const AcdfVisiblePortals* visible_portals, double of_portals,
                                         float of_row) {
    const double pdf = visible_portals->of_row * (double)of_row + (1.0 - visible_portals->of_row) * of_portals;
    if (!(pdf > 0.0)) return 0.0f;
    return (float)acdf_clamp(pdf, 1.17549435e-38, 3.402823466e38);
}

/* The weight per steradian of a unit direction in a visible_portal. */
ACDF_FN double acdf_visible_portal_pdf(const AcdfPortalTable* table, const AcdfVisiblePortal* visible_portal,
                                       const double d[3]) {
    const AcdfPortalMap* map = &table->maps[visible_portal->map];
    const uint32_t size = table->header->size, pieces = table->header->pieces;
    const double z = acdf_dot3(map->axis[2], d);
    double along[2], slope;
    uint32_t cell[2], piece[2];
    int k;
    if (!(z > 0.0)) return 0.0;
    for (k = 0; k < 2; ++k) {
        double t;
        along[k] = acdf_dot3(map->axis[k], d);
        t = along[k] / z;
        if (!(t >= visible_portal->low[k] && t <= visible_portal->high[k])) return 0.0;
        piece[k] = acdf_map_cell((t - visible_portal->low[k]) / (visible_portal->high[k] - visible_portal->low[k]) *
                                     (double)pieces,
                                 pieces);
        cell[k] = acdf_map_cell(acdf_bend(t, (double)size), size);
    }
    slope = (z + fabs(along[0])) * (z + fabs(along[1]));
    return (double)visible_portal->density[piece[0]][piece[1]] *
           (double)acdf_map_light(acdf_portal_map_sums(table, visible_portal->map), size, cell[0], cell[1]) *
           (0.25 * (double)size * (double)size) * z / (slope * slope);
}

/* Pdf per steradian of row and visible_portals together; `row`: that of the row. */
ACDF_OUTLINE_ON_CPU float acdf_visible_portals_pdf(const AcdfVisiblePortals* visible_portals,
                                                   const float direction[3], float row) {
    double d[3], size, sum = 0.0;
    float given[3];
    int i;
    acdf_as_given(direction, given);
    for (i = 0; i < 3; ++i) d[i] = given[i];
    size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(size > 0.9995 && size < 1.0005)) return 0.0f;
    for (i = 0; i < visible_portals->count; ++i)
        sum += acdf_visible_portal_pdf(&visible_portals->table, &visible_portals->visible_portal[i], d);
    return acdf_visible_portals_mixed(visible_portals, sum / visible_portals->weight, row);
}

/* Whether u[0] samples through a visible_portal, not by the row; what is left of it takes its mixture. */
ACDF_FN int acdf_visible_portals_choose(const AcdfVisiblePortals* visible_portals, double* u) {
    if (u[0] < visible_portals->of_row) {
        u[0] = acdf_unit_interval(u[0] / visible_portals->of_row);
        return 0;
    }
    u[0] = acdf_unit_interval((u[0] - visible_portals->of_row) / (1.0 - visible_portals->of_row));
    return 1;
}

/* The one of `count` parts of weights, some > 0, that *u of all samples; what is left of it takes its mixture. */
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

/* The tangent of a mixture on an axis of a map that was sampled in a cell, inside of the cell where its borders lie
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
ACDF_FN void acdf_visible_portals_sample(const AcdfVisiblePortals* visible_portals, double* u, float direction[3]) {
    const uint32_t pieces = visible_portals->table.header->pieces;
    const AcdfVisiblePortal* visible_portal;
    double weight[ACDF_MAX_PORTALS];
    uint32_t piece[2], i, j;
    for (i = 0; i < (uint32_t)visible_portals->count; ++i) weight[i] = visible_portals->visible_portal[i].weight;
    visible_portal =
        &visible_portals->visible_portal[acdf_sample_part(weight, (uint32_t)visible_portals->count, &u[0])];
    for (i = 0; i < pieces; ++i)
        for (weight[i] = 0.0, j = 0; j < pieces; ++j) weight[i] += (double)visible_portal->piece[i][j];
    piece[0] = acdf_sample_part(weight, pieces, &u[0]);
    for (j = 0; j < pieces; ++j) weight[j] = (double)visible_portal->piece[piece[0]][j];
    piece[1] = acdf_sample_part(weight, pieces, &u[1]);
    acdf_piece_sample(&visible_portals->table, visible_portal, piece, u, direction);
}

#ifdef __cplusplus
}
#endif
#endif
