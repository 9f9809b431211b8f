/* A local environment map in memory, and a shading point in it (SPEC.md §10). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_PARTS_H
#define ACDF_LOCAL_PARTS_H

#include <acdf/fast_rows.h>
#include <acdf/local_tables.h>
#include <acdf/normal_rows.h>
#include <acdf/normals.h>
#include <acdf/portals.h>

#ifdef __cplusplus
extern "C" {
#endif

struct AcdfLocalVectors;

typedef struct AcdfLocal {
    AcdfBlend blend;             /* blend.tiles is null where each bin has a tree of its own */
    AcdfEnvironment environment; /* the 2D table that is always there */
    const AcdfBin* bins;
    const AcdfBrightTile* bright_tiles; /* of the blend */
    uint32_t bright_tile_count;
    uint32_t subdivisions; /* of an octahedron's edge; 0: bins are cells of a lat-long grid */
    uint32_t columns;      /* of that grid */
    uint32_t rows;
    double cosine_share;
    const AcdfLocalTables* tables;         /* runtime tables; null: splits are traversed */
    const AcdfPartner* partner;            /* null: to be used alone */
    AcdfVisibilityTable visibility;        /* its header is null where there are no visibility cells */
    AcdfPortalTable portals;               /* its header is null where there are none */
    AcdfFast fast;                         /* the fast shape: the blend has no rows then, and roots are of grids */
    const AcdfNormalRows* rows_of_normals; /* one tree of halvings; null: curves or the fast shape */
} AcdfLocal;

/* Runtime tables of the fast shape: what they have of its rows. */
ACDF_FN void acdf_local_use_upper(AcdfLocal* local) {
    local->fast.upper = (const uint16_t*)(const void*)(acdf_local_words(local->tables) + local->tables->upper);
    local->fast.upper_ends = acdf_fast_upper_ends(local->fast.ends);
}

ACDF_FN int acdf_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    if (local->subdivisions > 0) return acdf_octahedral_bins(local->subdivisions, normal, out);
    return acdf_latlong_bins(local->columns, local->rows, normal, out);
}

/* What serves a normal: nothing, a tree of its own (or the environment's), bright tiles and what bins share, in
 * either shape, or rows of a tree of halvings. Made once for a shading point, it serves all samples there. It
 * points into the memory of the AcdfLocal that made it: not for one that was opened otherwise, or moved since. */
enum { ACDF_LOCAL_NOTHING, ACDF_LOCAL_TREE, ACDF_LOCAL_BLEND, ACDF_LOCAL_FAST, ACDF_LOCAL_ROWS };

typedef struct AcdfLocalPoint {
    int what;
    uint32_t root;    /* of the tree */
    float surface[3]; /* the normal as given */
    double normal[3]; /* with the weights of the mixture: the weighted sum of its bins' corners */
    double length;    /* of that */
    AcdfMixture mix;  /* of the blend; the weights are those that reach the position */
    const uint8_t* codes[ACDF_MAX_ROWS_MIXED]; /* the rows in the runtime tables, where there are such */
    const double* parts[ACDF_MAX_ROWS_MIXED];  /* what they give to each tile, where there are such */
    const AcdfFacet* facet;                    /* that of the normal in the runtime tables; null: they have none */
    AcdfRowMixture rows;                       /* of one tree of halvings */
    double bright_tiles;                       /* sum of the weights of the bright tiles */
    double sum;                                /* of all weights */
    AcdfVisibilityMixture visibility;          /* empty: the position is not known, or does not matter */
    AcdfVisiblePortals visible_portals;        /* as the position sees them; its count is 0 where there are none */
    AcdfFastMixture fast;                      /* of the fast shape; `mix` has the weights, too */
    double step;                               /* of the fast shape: 32767 times the mixture's whole a weight */
    double unit;                               /* of the fast shape: that of acdf_fast_share, of `sum` */
    uint32_t lit; /* of the fast shape: how many bright tiles the normal may see, by twos; */
    uint8_t pair[ACDF_MAX_BRIGHT_TILES / 2]; /* the number of each two, */
    double light[ACDF_MAX_BRIGHT_TILES];     /* their weights, */
    double light_end[ACDF_MAX_BRIGHT_TILES]; /* and the sums of these from the first one to each */
} AcdfLocalPoint;

#ifdef __cplusplus
}
#endif
#endif
