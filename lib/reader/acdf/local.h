/* Sampling and evaluating local environment maps: for every normal n the light that arrives above its horizon,
 * times the cosine (Lawrence et al. 2005, §7.1). One freestanding header over acdf/sample.h,
 * valid C99, C++17 and CUDA/HIP/SYCL, with the same contract.
 *
 * Frame and pdfs are those of acdf/sample.h. Normals need not be of unit length; a normal that is zero or NaN
 * gets pdf 0. A normal whose bins are not stored is served by the environment's own table: unbiased, noisier.
 */
#ifndef ACDF_LOCAL_H
#define ACDF_LOCAL_H

#include <acdf/local_pdf.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Samples by rows of halvings; u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_local_rows_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                       const AcdfGrid* grid, double u[2]) {
    const AcdfHalvedTree* tree = local->environment.halved;
    AcdfVisibilityCell cell;
    AcdfVisibleRows in;
    const AcdfTopTile* tile;
    double share;
    if (!point->in_cell) tile = acdf_rows_sample_tile(local->rows_of_normals, &point->by.rows, u, &share);
    else {
        in = acdf_local_visible_rows(local, point, &cell);
        tile = acdf_visible_sample_tile(&in, u, &share);
    }
    return acdf_rows_direction(tree, grid, tile, share, u);
}

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

/* Samples by rows, or a tree; u[0] and u[1] in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_local_row_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                      double* u) {
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(&local->environment);
        return acdf_local_rows_sample(local, point, &grid, u);
    } else {
        const AcdfEnvironment tree = acdf_local_tree(local, point);
        return acdf_environment_sample(&tree, u[0], u[1]);
    }
}

/* Samples through the portals of a position. The pdf is that of the direction as it was rounded. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_local_portal_sample(const AcdfLocal* local,
                                                                 const AcdfLocalPoint* point, double* u) {
    const AcdfVisiblePortals* portals = &point->place.portals;
    AcdfPortalEye eye;
    AcdfDirectionSample out;
    acdf_local_eye(local, point, &eye);
    acdf_visible_portals_sample(&eye, portals, u, out.direction);
    out.pdf =
        acdf_visible_portals_pdf(&eye, portals, out.direction, acdf_local_row_pdf(local, point, out.direction));
    return out;
}

/* Samples a direction; u0 (phi) and u1 (theta) in [0, 1]. Values outside are clamped, NaN counts as 0. The pdf is
 * in sr^-1; it is 0, and the direction is unset, where the normal is not valid or no light reaches it. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_local_sample_at(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                             double u0, double u1) {
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    double u[2];
    if (point->what == ACDF_LOCAL_NOTHING) return out;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (u[0] < local->cosine_share) {
        acdf_cosine_direction(point->surface, u[0] / local->cosine_share, u[1], out.direction);
        out.pdf = acdf_local_light_pdf(local, point, out.direction);
    } else {
        if (local->cosine_share > 0.0) u[0] = (u[0] - local->cosine_share) / (1.0 - local->cosine_share);
        if (point->portals > 0 && acdf_visible_portals_choose(&point->place.portals, u))
            out = acdf_local_portal_sample(local, point, u);
        else {
            out = acdf_local_row_sample(local, point, u);
            if (point->portals > 0) out.pdf = acdf_local_light_pdf(local, point, out.direction);
        }
    }
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
