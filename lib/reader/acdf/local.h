/* Sampling and evaluating local environment maps: for every normal n the light that arrives above its horizon,
 * times the cosine (Lawrence et al. 2005, §7.1). One freestanding header over acdf/blend.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract.
 *
 * Frame and densities are those of acdf/sample.h. Normals need not be of unit length; a normal that is zero or NaN
 * gets density 0. A normal whose bins are not stored is served by the environment's own table: unbiased, noisier.
 */
#ifndef ACDF_LOCAL_H
#define ACDF_LOCAL_H

#include <acdf/blend.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfLocal {
    AcdfBlend blend;             /* blend.tiles is null where each bin has a tree of its own */
    AcdfEnvironment environment; /* the 2D table that is always there */
    const AcdfBin* bins;
    const AcdfLight* lights; /* of the blend */
    uint32_t light_count;
    uint32_t subdivisions; /* of an octahedron's edge; 0: bins are cells of a lat-long grid */
    uint32_t columns;      /* of that grid */
    uint32_t rows;
    double cosine_share;
    const AcdfCompany* company; /* null: to be used alone */
} AcdfLocal;

/* Up to three bins that surround a normal, and weights whose sum with the bins' corners is the normal itself, times
 * a positive number. */
typedef struct AcdfNormalBins {
    uint32_t bin[3];
    double weight[3];
    int count;
} AcdfNormalBins;

/* Number of the corner (x, y, z), |x| + |y| + |z| = n, of an octahedron whose edges are divided by n: levels from
 * z = n down, each once around from +x towards +y. There are 4 n^2 + 2. */
ACDF_FN uint32_t acdf_octahedral_corner(uint32_t n, int32_t x, int32_t y, int32_t z) {
    const uint32_t r = n - (uint32_t)(z < 0 ? -z : z); /* 4 r corners on this level, one at a pole */
    const uint32_t before = z >= 0 ? (r == 0 ? 0 : 1 + 2 * r * (r - 1)) : 4 * n * n + 1 - 2 * r * (r + 1);
    const int32_t s = (int32_t)r;
    if (r == 0) return before;
    if (x > 0 && y >= 0) return before + (uint32_t)y;
    if (y > 0) return before + (uint32_t)(s - x);
    if (x < 0) return before + (uint32_t)(2 * s - y);
    return before + (uint32_t)(3 * s + x);
}

/* The corners of the triangle that holds a normal. On the faces |x| + |y| + |z| = 1 the normal is the weighted mean
 * of the corners. Returns 0 for normals that are zero, NaN or infinite. */
ACDF_FN int acdf_octahedral_bins(uint32_t n, const float normal[3], AcdfNormalBins* out) {
    const double ax = fabs((double)normal[0]), ay = fabs((double)normal[1]), az = fabs((double)normal[2]);
    const double sum = ax + ay + az;
    double a[3], f[3], rest;
    int32_t base[3], sign[3];
    int i, k, down;
    if (!acdf_are_finite(normal) || !(sum > 0.0)) return 0;
    a[0] = ax / sum * n;
    a[1] = ay / sum * n;
    a[2] = az / sum * n;
    rest = (double)n;
    for (i = 0; i < 3; ++i) {
        sign[i] = normal[i] < 0.0f ? -1 : 1;
        base[i] = (int32_t)a[i];
        f[i] = a[i] - base[i];
        rest -= base[i];
    }
    /* The fractions add up to 0, 1 or 2 but for rounding: at a corner, or in a triangle that points up or down. */
    if (rest > 2.5) /* at a corner too, all three rounded down */
        for (i = 0; i < 3; ++i, rest -= 1.0) ++base[i];
    down = rest > 1.5;
    out->count = 0;
    for (i = 0; i < 3; ++i) {
        int32_t c[3];
        double weight = down ? 1.0 - f[i] : f[i];
        if (rest < 0.5) weight = i == 0 ? 1.0 : 0.0;
        if (!(weight > 0.0)) continue;
        for (k = 0; k < 3; ++k) c[k] = base[k] + (rest < 0.5 ? 0 : (k == i) != down);
        /* The corner lies at |c| / n from the centre: times that, its unit vector is the point on the face. */
        weight *= sqrt((double)(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
        out->bin[out->count] = acdf_octahedral_corner(n, sign[0] * c[0], sign[1] * c[1], sign[2] * c[2]);
        out->weight[out->count++] = weight;
    }
    return out->count > 0;
}

/* The cell of a lat-long grid of normals: columns in phi, rows in theta, as those of a probe. */
ACDF_FN int acdf_latlong_bins(uint32_t columns, uint32_t rows, const float normal[3], AcdfNormalBins* out) {
    const double x = normal[0], y = normal[1], z = normal[2];
    uint32_t column, row;
    if (!acdf_are_finite(normal) || !(fabs(x) + fabs(y) + fabs(z) > 0.0)) return 0;
    column = (uint32_t)((double)columns * (0.5 - 0.5 * acdf_atan2pi(y, x)));
    row = (uint32_t)((double)rows * acdf_atan2pi(sqrt(x * x + y * y), z));
    if (column >= columns) column = 0;
    if (row >= rows) row = rows - 1;
    out->count = 1;
    out->bin[0] = row * columns + column;
    out->weight[0] = 1.0;
    return 1;
}

ACDF_FN int acdf_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    if (local->subdivisions > 0) return acdf_octahedral_bins(local->subdivisions, normal, out);
    return acdf_latlong_bins(local->columns, local->rows, normal, out);
}

/* What serves a normal: nothing, a tree of its own (or the environment's), or lights and what bins share. Made once
 * for a shading point, it serves all samples there. */
enum { ACDF_LOCAL_NOTHING, ACDF_LOCAL_TREE, ACDF_LOCAL_BLEND };

typedef struct AcdfLocalPoint {
    int what;
    uint32_t root;    /* of the tree */
    float surface[3]; /* the normal as given */
    double normal[3]; /* with the weights of the mixture: the weighted sum of its bins' corners */
    double length;    /* of that */
    AcdfMixture mix;  /* of the blend */
    double lights;    /* sum of the weights of the lights */
    double sum;       /* of all weights */
} AcdfLocalPoint;

/* Weight of a light: its share times the mean over it of the cosine above the horizon. It is taken as spread evenly
 * from -radius to radius around its middle, so that no weight is 0 where any of it can be seen. */
ACDF_FN double acdf_light_weight(const AcdfLight* light, const AcdfLocalPoint* point) {
    const double radius = (double)light->radius * point->length;
    const double height = point->normal[0] * (double)light->direction[0] +
                          point->normal[1] * (double)light->direction[1] +
                          point->normal[2] * (double)light->direction[2];
    if (height >= radius) return (double)light->share * height;
    if (height <= -radius) return 0.0;
    return (double)light->share * ((height + radius) * (height + radius) / (4.0 * radius));
}

/* The bin of the largest weight. */
ACDF_FN uint32_t acdf_nearest_bin(const AcdfNormalBins* bins) {
    int i, nearest = 0;
    for (i = 1; i < bins->count; ++i)
        if (bins->weight[i] > bins->weight[nearest]) nearest = i;
    return bins->bin[nearest];
}

/* Sets the normal in the scale of the weights of its bins. */
ACDF_FN void acdf_local_normal(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const double x = normal[0], y = normal[1], z = normal[2], length = sqrt(x * x + y * y + z * z);
    const double scale =
        local->subdivisions > 0 ? (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) : 1.0 / length;
    out->normal[0] = scale * x;
    out->normal[1] = scale * y;
    out->normal[2] = scale * z;
    out->length = scale * length;
}

/* Finds what serves a normal. */
ACDF_FN void acdf_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    uint32_t k;
    int i;
    out->what = ACDF_LOCAL_NOTHING;
    out->root = 0;
    for (i = 0; i < 3; ++i) out->surface[i] = normal[i];
    out->normal[0] = out->normal[1] = out->normal[2] = out->length = out->lights = out->sum = 0.0;
    out->mix.count = 0;
    for (i = 0; i < ACDF_MAX_ROWS_MIXED; ++i) {
        out->mix.row[i] = 0;
        out->mix.weight[i] = 0.0;
    }
    if (!acdf_local_bins(local, normal, &bins)) return;
    if (!local->blend.tiles) {
        const AcdfBin* bin = &local->bins[acdf_nearest_bin(&bins)];
        out->root = bin->root != ACDF_NO_ROOT ? bin->root : local->environment.root;
        if (bin->root == ACDF_NO_ROOT || bin->share > 0.0f) out->what = ACDF_LOCAL_TREE;
        return;
    }
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        if (bin->root == ACDF_NO_ROOT) {
            out->what = ACDF_LOCAL_TREE;
            out->root = local->environment.root;
            return;
        }
        acdf_mixture_add(&out->mix, &local->blend, bin->root, bins.weight[i] * (double)bin->share);
    }
    acdf_local_normal(local, normal, out);
    for (k = 0; k < local->light_count; ++k) out->lights += acdf_light_weight(&local->lights[k], out);
    out->sum = out->lights + acdf_mixture_sum(&out->mix);
    if (out->sum > 0.0) out->what = ACDF_LOCAL_BLEND;
}

/* Draws a cell of lights and mixture; u and range as in acdf_tree_sample. Returns its probability, > 0. */
ACDF_FN double acdf_local_blend_sample(const AcdfLocal* local, const AcdfLocalPoint* point, double* u,
                                       AcdfRange* range) {
    double x = u[0] * point->sum, probability;
    uint32_t tile, root;
    if (x < point->lights || point->mix.count == 0) {
        const AcdfLight* light = 0;
        double weight = 0.0;
        uint32_t k, axis;
        for (k = 0; k < local->light_count; ++k) {
            const double w = acdf_light_weight(&local->lights[k], point);
            if (!(w > 0.0)) continue;
            if (light) x -= weight;
            light = &local->lights[k];
            weight = w;
            if (x < w) break;
        }
        u[0] = acdf_unit_interval(x / weight);
        for (axis = 0; axis < 2; ++axis) {
            range[axis].low = light->low[axis];
            range[axis].high = light->high[axis];
        }
        probability = acdf_positive(weight / point->sum);
        root = local->blend.roots ? local->blend.roots[light->tile] : ACDF_NO_ROOT;
        if (root == ACDF_NO_ROOT) return probability;
        return acdf_positive(probability * acdf_tree_sample(local->blend.tree, root, u, range));
    }
    u[0] = acdf_unit_interval((x - point->lights) / (point->sum - point->lights));
    tile = acdf_blend_sample_tile(&local->blend, &point->mix, u, range, &probability);
    probability = acdf_positive(acdf_mixture_sum(&point->mix) / point->sum * probability);
    root = local->blend.roots ? local->blend.roots[tile] : ACDF_NO_ROOT;
    if (root == ACDF_NO_ROOT) return probability;
    return acdf_positive(probability * acdf_tree_sample(local->blend.tree, root, u, range));
}

/* Finds the cell of a grid square, as acdf_tree_find does. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_local_blend_find(const AcdfLocal* local, const AcdfLocalPoint* point, const uint32_t* square,
                                     AcdfRange* range) {
    double probability, inside;
    uint32_t low = 0, high = local->light_count, root;
    const uint32_t tile = acdf_blend_find_tile(&local->blend, &point->mix, square, range, 0, &probability);
    root = local->blend.roots ? local->blend.roots[tile] : ACDF_NO_ROOT;
    if (probability > 0.0) {
        probability = acdf_mixture_sum(&point->mix) / point->sum * probability;
    } else { /* no row gives a light any probability */
        while (low < high) {
            const uint32_t middle = (low + high) / 2;
            if (local->lights[middle].tile < tile) low = middle + 1;
            else high = middle;
        }
        if (low == local->light_count || local->lights[low].tile != tile) return 0.0;
        probability = acdf_light_weight(&local->lights[low], point) / point->sum;
        if (!(probability > 0.0)) return 0.0;
    }
    if (root == ACDF_NO_ROOT) return acdf_positive(probability);
    inside = acdf_tree_find(local->blend.tree, root, square, range, 0);
    return inside > 0.0 ? acdf_positive(acdf_positive(probability) * inside) : 0.0;
}

/* The part of the density that follows the light. */
ACDF_FN float acdf_local_light_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    double t[2] = {0.5, 0.5}, position[2], p;
    uint32_t square[2];
    if (point->what == ACDF_LOCAL_NOTHING || !acdf_grid_square(&grid, direction, square, position)) return 0.0f;
    acdf_sphere_ranges(grid.columns, grid.rows, range);
    p = point->what == ACDF_LOCAL_BLEND ? acdf_local_blend_find(local, point, square, range)
                                        : acdf_tree_find(local->environment.tree, point->root, square, range, 0);
    if (!(p > 0.0)) return 0.0f;
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) acdf_grid_fractions(&grid, direction, position, range, t);
    return acdf_grid_pdf(&grid, range, t, p);
}

/* Both parts together: `light` is that of the light, the other one is that of the cosine to the normal. */
ACDF_FN float acdf_local_density(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3],
                                 float light) {
    const double x = point->surface[0], y = point->surface[1], z = point->surface[2];
    const double share = local->cosine_share;
    const double dx = direction[0], dy = direction[1], dz = direction[2], size = sqrt(dx * dx + dy * dy + dz * dz);
    double cosine, pdf;
    if (share == 0.0) return light;
    if (!(size > 0.9995 && size < 1.0005)) return 0.0f;
    cosine = (x * dx + y * dy + z * dz) / sqrt(x * x + y * y + z * z);
    pdf = (1.0 - share) * (double)light + (cosine > 0.0 ? share * cosine * (1.0 / ACDF_PI) : 0.0);
    return pdf > 1.17549435e-38 || pdf == 0.0 ? (float)pdf : 1.17549435e-38f;
}

/* A direction around the normal with density cos / pi: the unit normal plus a point of the unit sphere. */
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

/* Density per steradian with which acdf_local_sample_at draws `direction` (unit). */
ACDF_FN float acdf_local_pdf_at(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0f;
    return acdf_local_density(local, point, direction, acdf_local_light_pdf(local, point, direction));
}

/* Draws a direction; u0 (phi) and u1 (theta) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0 (and no
 * direction) where the normal is not valid or nothing shines on it. */
ACDF_FN AcdfDirectionSample acdf_local_sample_at(const AcdfLocal* local, const AcdfLocalPoint* point, double u0,
                                                 double u1) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    AcdfRange range[2];
    double u[2], p;
    if (point->what == ACDF_LOCAL_NOTHING) return out;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (u[0] < local->cosine_share) {
        acdf_cosine_direction(point->surface, u[0] / local->cosine_share, u[1], out.direction);
        out.pdf = acdf_local_light_pdf(local, point, out.direction);
    } else {
        if (local->cosine_share > 0.0) u[0] = (u[0] - local->cosine_share) / (1.0 - local->cosine_share);
        acdf_sphere_ranges(grid.columns, grid.rows, range);
        p = point->what == ACDF_LOCAL_BLEND ? acdf_local_blend_sample(local, point, u, range)
                                            : acdf_tree_sample(local->environment.tree, point->root, u, range);
        out = acdf_grid_place(&grid, range, u, p);
    }
    out.pdf = acdf_local_density(local, point, out.direction, out.pdf);
    return out;
}

/* The same for a normal that serves once. */
ACDF_FN float acdf_local_pdf(const AcdfLocal* local, const float normal[3], const float direction[3]) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return acdf_local_pdf_at(local, &point, direction);
}
ACDF_FN AcdfDirectionSample acdf_local_sample(const AcdfLocal* local, const float normal[3], double u0, double u1) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return acdf_local_sample_at(local, &point, u0, u1);
}

/* Integral of the light above the horizon times the cosine, interpolated between bins; where those of the normal
 * are not stored that of all light; 0 for normals that are not valid. */
ACDF_FN double acdf_local_irradiance(const AcdfLocal* local, const float normal[3]) {
    AcdfNormalBins bins;
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    if (point.what == ACDF_LOCAL_BLEND && acdf_company_records(local->company) &&
        acdf_local_bins(local, normal, &bins)) { /* shares tell what is left to the file */
        const AcdfCompanyRecord* records = acdf_company_records(local->company);
        double sum = 0.0;
        int i;
        for (i = 0; i < bins.count; ++i) sum += bins.weight[i] * (double)records[bins.bin[i]].flux;
        return acdf_clamp(local->environment.total * sum / point.length, 0.0, 0x1.fffffffffffffp1023);
    }
    if (point.what == ACDF_LOCAL_BLEND)
        return acdf_clamp(local->environment.total * point.sum / point.length, 0.0, 0x1.fffffffffffffp1023);
    if (point.what == ACDF_LOCAL_NOTHING || !acdf_local_bins(local, normal, &bins)) return 0.0;
    if (point.root == local->environment.root) return local->environment.total;
    return acdf_clamp(local->environment.total * (double)local->bins[acdf_nearest_bin(&bins)].share, 0.0,
                      0x1.fffffffffffffp1023); /* a file may have a total and a share whose product is too large */
}

/* Which share of the samples to draw from the file at a normal, in (0, 1]; interpolated between bins. */
ACDF_FN float acdf_local_recommended_share(const AcdfLocal* local, const float normal[3]) {
    AcdfNormalBins bins;
    double sum = 0.0, weight = 0.0;
    int i;
    if (!local->company || !acdf_local_bins(local, normal, &bins)) return acdf_company_share(local->company);
    for (i = 0; i < bins.count; ++i) {
        sum += bins.weight[i] * (double)acdf_company_bin_share(local->company, bins.bin[i]);
        weight += bins.weight[i];
    }
    return (float)(sum / weight);
}

/* Whether the bins of a normal are stored. */
ACDF_FN int acdf_local_stored(const AcdfLocal* local, const float normal[3]) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return point.what == ACDF_LOCAL_BLEND ||
           (point.what == ACDF_LOCAL_TREE && point.root != local->environment.root);
}

#ifdef __cplusplus
}
#endif
#endif
