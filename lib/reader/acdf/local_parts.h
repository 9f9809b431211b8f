/* A local environment map in memory, and a shading point in it (SPEC.md §10). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_PARTS_H
#define ACDF_LOCAL_PARTS_H

#include <acdf/normal_rows.h>
#include <acdf/normals.h>
#include <acdf/portals.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfLocal {
    AcdfEnvironment environment; /* the 2D table that is always there */
    const AcdfBin* bins;
    uint32_t subdivisions; /* of an octahedron's edge; 0: bins are cells of a lat-long grid, and have curves */
    uint32_t columns;      /* of that grid */
    uint32_t rows;
    double cosine_share;
    const AcdfPartner* partner;            /* null: to be used alone */
    AcdfVisibilityTable visibility;        /* its header is null where there are no visibility cells */
    AcdfPortalTable portals;               /* its header is null where there are none */
    const AcdfNormalRows* rows_of_normals; /* one tree of halvings; null: curves, a tree for each bin */
} AcdfLocal;

ACDF_FN int acdf_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    ACDF_RETURN_CURVES(&local->environment, local_bins(local, normal, out));
    return acdf_octahedral_bins(local->subdivisions, normal, out);
}

/* What serves a normal: nothing, a tree of its own (or the environment's), or rows of a tree of halvings. Made once
 * for a shading point, it serves all samples there. It points into the memory of the AcdfLocal that made it: not
 * for one that was opened otherwise, or moved since. */
enum { ACDF_LOCAL_NOTHING, ACDF_LOCAL_TREE, ACDF_LOCAL_ROWS };

/* Where a position lies: by these numbers all else that it needs is found in the file again. */
typedef struct AcdfLocalPlace {
    uint32_t cell;              /* of visibility: the number of its row */
    AcdfVisiblePortals portals; /* where it sees any */
} AcdfLocalPlace;

typedef struct AcdfLocalPoint {
    uint8_t what;
    uint8_t in_cell;         /* of visibility; 0: the position is not known, or does not matter */
    uint8_t portals;         /* that the position sees */
    float surface[3];        /* the normal as given */
    double length;           /* of the weighted sum of the corners of its bins */
    double sum;              /* of all weights */
    union {                  /* what serves it has one of these */
        uint32_t root;       /* ACDF_LOCAL_TREE */
        AcdfRowMixture rows; /* ACDF_LOCAL_ROWS */
    } by;
    AcdfLocalPlace place; /* of ACDF_LOCAL_ROWS in a visibility cell */
} AcdfLocalPoint;
ACDF_STATIC_ASSERT(sizeof(AcdfLocalPoint) <= 216); /* renderers keep many */

#ifdef __cplusplus
}
#endif
#endif
