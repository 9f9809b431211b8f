/* Sampling and evaluating local environment maps: for every normal n the light that arrives above its horizon,
 * times the cosine (Lawrence et al. 2005, §7.1). One freestanding header over acdf/sample.h,
 * valid C99, C++17 and CUDA/HIP/SYCL, with the same contract.
 *
 * Frame and pdfs are those of acdf/sample.h. Normals need not be of unit length; a normal that is zero or NaN
 * gets pdf 0. A normal whose bins are not stored is served by the environment's own table: unbiased, noisier.
 */
#ifndef ACDF_LOCAL_H
#define ACDF_LOCAL_H

#include <acdf/normal_rows.h>
#include <acdf/normals.h>
#include <acdf/sample.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A local environment map in memory (SPEC.md §10). */
typedef struct AcdfLocal {
    AcdfEnvironment environment; /* the 2D table that is always there */
    const AcdfBin* bins;
    uint32_t subdivisions; /* of an octahedron's edge; 0: bins are cells of a lat-long grid, and have curves */
    uint32_t columns;      /* of that grid */
    uint32_t rows;
    double cosine_share;
    const AcdfPartner* partner;            /* null: to be used alone */
    const AcdfNormalRows* rows_of_normals; /* one tree of halvings; null: curves, each bin a tree of its own */
} AcdfLocal;

/* ---- shading points ---------------------------------------------------------------------------------------- */

/* What serves a normal: nothing, a tree of its own (or the environment's), or rows of a tree of halvings. Made once
 * for a shading point, it serves all samples there. It points into the memory of the AcdfLocal that made it: not
 * for one that was opened otherwise, or moved since. */
enum { ACDF_LOCAL_NOTHING, ACDF_LOCAL_TREE, ACDF_LOCAL_ROWS };

/* A shading point: its normal, and what serves it. */
typedef struct AcdfLocalPoint {
    uint8_t what;
    float surface[3];        /* the normal as given */
    double length;           /* of the weighted sum of the corners of its bins */
    double sum;              /* of all weights */
    union {                  /* what serves it has one of these */
        uint32_t root;       /* ACDF_LOCAL_TREE */
        AcdfRowMixture rows; /* ACDF_LOCAL_ROWS */
    } by;
} AcdfLocalPoint;
ACDF_STATIC_ASSERT(sizeof(AcdfLocalPoint) <= 120); /* renderers keep many */

/* The bins of a normal and their weights. Returns 0 for a normal that is zero or not finite. */
ACDF_FN int acdf_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    ACDF_RETURN_CURVES(&local->environment, local_bins(local, normal, out));
    return acdf_octahedral_bins(local->subdivisions, normal, out);
}

/* Begins a point: nothing serves it. */
ACDF_INLINE void acdf_local_nothing(const float normal[3], AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_NOTHING;
    acdf_as_given(normal, out->surface);
    out->length = out->sum = 0.0;
}

/* A tree serves a normal. */
ACDF_INLINE void acdf_local_by_tree(uint32_t root, AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_TREE;
    out->by.root = root;
}

/* The length of a normal in the scale of the weights of the corners of an octahedron. */
ACDF_INLINE double acdf_local_length(const AcdfLocal* local, const float normal[3]) {
    const double x = normal[0], y = normal[1], z = normal[2];
    return (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) * sqrt(x * x + y * y + z * z);
}

/* acdf_local_at of halvings: bins are corners of an octahedron. */
ACDF_INLINE void acdf_local_rows_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    double weight[ACDF_NORMALS_MIXED];
    uint32_t row[ACDF_NORMALS_MIXED];
    int i, count = 0;
    acdf_local_nothing(normal, out);
    if (!acdf_octahedral_bins(local->subdivisions, out->surface, &bins)) return;
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        if (bin->root == ACDF_NO_ROOT) {
            acdf_local_by_tree(local->environment.root, out);
            return;
        }
        if (!(bin->share > 0.0f)) continue;
        row[count] = bin->root;
        out->sum += weight[count++] = bins.weight[i] * (double)bin->share;
    }
    out->length = acdf_local_length(local, out->surface);
    if (!(out->sum > 0.0)) return;
    acdf_rows_mix(local->rows_of_normals, row, weight, count, &out->by.rows);
    out->what = ACDF_LOCAL_ROWS;
}

/* Finds what serves a normal. */
ACDF_FN void acdf_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    ACDF_RETURN_CURVES(&local->environment, local_at(local, normal, out));
    acdf_local_rows_at(local, normal, out);
}

/* ---- pdfs -------------------------------------------------------------------------------------------------- */

/* The tree that serves a point. */
ACDF_INLINE AcdfEnvironment acdf_local_tree(const AcdfLocal* local, const AcdfLocalPoint* point) {
    AcdfEnvironment tree = local->environment;
    tree.root = point->by.root;
    return tree;
}

/* The cell of a grid square that rows, or a tree, sample at a point, which becomes `range`, and its probability: 0
 * where no sample can fall. */
ACDF_FN double acdf_local_find_cell(const AcdfLocal* local, const AcdfLocalPoint* point, const uint32_t square[2],
                                    AcdfRange range[2]) {
    const AcdfEnvironment* env = &local->environment;
    acdf_sphere_ranges(env->columns, env->rows, range);
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0;
    if (point->what == ACDF_LOCAL_ROWS) {
        AcdfSpan box[2];
        const double p = acdf_rows_find(local->rows_of_normals, env->halved, &point->by.rows, square, box);
        acdf_halved_ranges(box, range);
        return p;
    }
    {
        const AcdfEnvironment tree = acdf_local_tree(local, point);
        AcdfStratum strata[2];
        return acdf_environment_find_square(&tree, square, range, strata);
    }
}

/* The pdf of what rows of halvings sample in a direction that lies at a spot. */
ACDF_INLINE float acdf_local_rows_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfGrid* grid,
                                      const AcdfRowSpot* given, const float direction[3]) {
    AcdfRowSpot spot = *given;
    AcdfRowCell cell;
    if (!acdf_rows_locate(local->rows_of_normals, local->environment.halved, grid, &spot, direction, &cell))
        return 0.0f;
    return acdf_float_pdf(acdf_rows_mass(&point->by.rows, spot.tile, spot.tile + 1u) * 0x1p-52 * cell.share *
                          cell.scale);
}

/* The part of the pdf that follows the light, of a point that something serves. */
ACDF_FN float acdf_local_light_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    AcdfEnvironment tree;
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(&local->environment);
        const AcdfRowSpot spot = acdf_rows_spot(local->rows_of_normals, &grid, direction);
        return acdf_local_rows_pdf(local, point, &grid, &spot, direction);
    }
    tree = acdf_local_tree(local, point);
    return acdf_environment_pdf(&tree, direction);
}

/* The pdf of the mixture of light and cosine: `light` is the pdf of the light's part. */
ACDF_FN float acdf_local_combined_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3],
                                      float light) {
    const double x = point->surface[0], y = point->surface[1], z = point->surface[2];
    const double share = local->cosine_share;
    double dx, dy, dz, size, cosine, pdf;
    float given[3];
    if (share == 0.0) return light;
    acdf_as_given(direction, given);
    dx = given[0];
    dy = given[1];
    dz = given[2];
    size = sqrt(dx * dx + dy * dy + dz * dz);
    if (!(size > 0.9995 && size < 1.0005)) return 0.0f;
    cosine = (x * dx + y * dy + z * dz) / sqrt(x * x + y * y + z * z);
    pdf = (1.0 - share) * (double)light + (cosine > 0.0 ? share * cosine * (1.0 / ACDF_PI) : 0.0);
    return pdf > 1.17549435e-38 || pdf == 0.0 ? (float)pdf : 1.17549435e-38f;
}

/* Pdf per steradian with which acdf_local_sample_at samples `direction` (unit). */
ACDF_OUTLINE_ON_CPU float acdf_local_pdf_at(const AcdfLocal* local, const AcdfLocalPoint* point,
                                            const float direction[3]) {
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0f;
    return acdf_local_combined_pdf(local, point, direction, acdf_local_light_pdf(local, point, direction));
}

/* Pdf per steradian with which acdf_local_sample samples `direction` (unit) for that normal. Rows are mixed while
 * the direction is on its way, which does not depend on the normal. */
ACDF_OUTLINE_ON_CPU float acdf_local_pdf(const AcdfLocal* local, const float normal[3], const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRowSpot spot;
    AcdfLocalPoint point;
#ifndef ACDF_ON_GPU
    if (!local->rows_of_normals) {
        local->environment.curves->local_at(local, normal, &point);
        return acdf_local_pdf_at(local, &point, direction);
    }
#endif
    spot = acdf_rows_spot(local->rows_of_normals, &grid, direction);
    acdf_local_rows_at(local, normal, &point);
    if (point.what == ACDF_LOCAL_ROWS)
        return acdf_local_combined_pdf(local, &point, direction,
                                       acdf_local_rows_pdf(local, &point, &grid, &spot, direction));
    return acdf_local_pdf_at(local, &point, direction);
}

/* ---- samples ----------------------------------------------------------------------------------------------- */

/* A direction around the normal with pdf cos / pi: the unit normal plus a point of the unit sphere. */
ACDF_FN void acdf_cosine_direction(const float normal[3], double u0, double u1, float direction[3]) {
    const double nx = normal[0], ny = normal[1], nz = normal[2], length = sqrt(nx * nx + ny * ny + nz * nz);
    /* Cosine to the normal, kept above what rounding to float could take below the horizon, and sine. */
    const double h = sqrt(u1 < 1.0 - 0x1p-40 ? 1.0 - u1 : 0x1p-40), r = sqrt(1.0 - h * h);
    const double n[3] = {nx / length, ny / length, nz / length};
    /* A frame around n without a branch on its size (Duff et al. 2017). */
    const double sign = n[2] < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + n[2]), b = n[0] * n[1] * a;
    const double s[3] = {1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
    const double t[3] = {b, sign + n[1] * n[1] * a, -n[1]};
    double sine, cosine;
    int i;
    acdf_sincospi(2.0 * u0 - 1.0, &sine, &cosine);
    for (i = 0; i < 3; ++i) direction[i] = (float)(r * (cosine * s[i] + sine * t[i]) + h * n[i]);
}

/* Whether u[0] samples the cosine, not the light; u become the random numbers of that part, in [0, 1]. */
ACDF_INLINE int acdf_local_choose_cosine(const AcdfLocal* local, double u0, double u1, double u[2]) {
    const double share = local->cosine_share;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (u[0] < share) {
        u[0] /= share;
        return 1;
    }
    if (share > 0.0) u[0] = (u[0] - share) / (1.0 - share);
    return 0;
}

/* Samples the light at a point that something serves; u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_local_light_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                        double u[2]) {
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(&local->environment);
        return acdf_rows_sample(local->rows_of_normals, local->environment.halved, &grid, &point->by.rows, u);
    } else {
        const AcdfEnvironment tree = acdf_local_tree(local, point);
        return acdf_environment_sample(&tree, u[0], u[1]);
    }
}

/* Samples a direction; u0 (phi) and u1 (theta) in [0, 1]. Values outside are clamped, NaN counts as 0. The pdf is
 * in sr^-1; it is 0, and the direction is unset, where the normal is not valid or no light reaches it. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_local_sample_at(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                             double u0, double u1) {
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    double u[2];
    if (point->what == ACDF_LOCAL_NOTHING) return out;
    if (acdf_local_choose_cosine(local, u0, u1, u)) {
        acdf_cosine_direction(point->surface, u[0], u[1], out.direction);
        out.pdf = acdf_local_light_pdf(local, point, out.direction);
    } else out = acdf_local_light_sample(local, point, u);
    out.pdf = acdf_local_combined_pdf(local, point, out.direction, out.pdf);
    return acdf_returned(&out);
}

/* Samples for a normal of a single call; as acdf_local_sample_at. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_local_sample(const AcdfLocal* local, const float normal[3], double u0,
                                                          double u1) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return acdf_local_sample_at(local, &point, u0, u1);
}

/* ---- energy ------------------------------------------------------------------------------------------------ */

/* Integral of the light above the horizon times the cosine (luminance times sr), interpolated between bins. Where
 * the bins of the normal are not stored, the integral of all light; 0 for normals that are not valid. */
ACDF_FN double acdf_local_irradiance(const AcdfLocal* local, const float normal[3]) {
    AcdfNormalBins bins;
    AcdfLocalPoint point;
    ACDF_RETURN_CURVES(&local->environment, local_irradiance(local, normal));
    acdf_local_at(local, normal, &point);
    if (point.what == ACDF_LOCAL_ROWS && acdf_partner_records(local->partner) &&
        acdf_local_bins(local, normal, &bins)) { /* shares hold the light that is left to the file */
        const AcdfPartnerRecord* records = acdf_partner_records(local->partner);
        double sum = 0.0;
        int i;
        for (i = 0; i < bins.count; ++i) sum += bins.weight[i] * (double)records[bins.bin[i]].flux;
        return acdf_clamp(local->environment.total * sum / point.length, 0.0, 0x1.fffffffffffffp1023);
    }
    if (point.what == ACDF_LOCAL_ROWS)
        return acdf_clamp(local->environment.total * point.sum / point.length, 0.0, 0x1.fffffffffffffp1023);
    return point.what == ACDF_LOCAL_NOTHING ? 0.0 : local->environment.total;
}

/* Which share of the samples to take from the file at a normal, in (0, 1]; interpolated between bins. */
ACDF_FN float acdf_local_recommended_share(const AcdfLocal* local, const float normal[3]) {
    AcdfNormalBins bins;
    double sum = 0.0, weight = 0.0;
    int i;
    if (!local->partner || !acdf_local_bins(local, normal, &bins)) return acdf_partner_share(local->partner);
    for (i = 0; i < bins.count; ++i) {
        sum += bins.weight[i] * (double)acdf_partner_bin_share(local->partner, bins.bin[i]);
        weight += bins.weight[i];
    }
    return (float)(sum / weight);
}

/* Whether the bins of a normal are stored. */
ACDF_FN int acdf_local_stored(const AcdfLocal* local, const float normal[3]) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return point.what == ACDF_LOCAL_ROWS ||
           (point.what == ACDF_LOCAL_TREE && point.by.root != local->environment.root);
}

#ifdef __cplusplus
}
#endif
#endif
