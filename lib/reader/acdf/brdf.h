/* Sampling and evaluating BRDF files: for every view wo the reflected light rho(wo, wi) cos(theta_i), through the
 * half-vector (Lawrence et al. 2005, §6.2). One freestanding header over acdf/blend.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract: plain views into a checked file, no allocation, no errors (SPEC.md §6.8).
 *
 * Frame: the surface's own, z is its normal, x its tangent. wo and wi are unit vectors that point away from the
 * surface. Densities are per steradian of wi. A half-vector may reflect wo below the surface: wi is returned as it
 * is, with its density; the caller sees wi[2] <= 0 and counts the sample as 0.
 *
 * The density between stored views is the mixture of those around it, weighted by interpolation and by how much
 * each reflects. */
#ifndef ACDF_BRDF_H
#define ACDF_BRDF_H

#include <acdf/blend.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfBrdf {
    AcdfBlend blend;        /* blend.tiles is null where each bin has a tree of its own */
    const uint8_t* tree;    /* chunk TREE */
    const AcdfBin* bins;    /* theta_count x phi_count */
    const AcdfViews* views; /* chunk VIEW */
    const float* nodes;     /* theta_count, behind it */
    uint32_t columns;       /* axis 0, phi_h */
    uint32_t rows;          /* axis 1, cos_theta_h */
    double total;           /* sum of the bins' albedos */
} AcdfBrdf;

/* What serves a view: which rows or which tree, and the turn that brings wo into the plane of x and z. */
typedef struct AcdfBrdfView {
    double wo[3];
    double turn[2]; /* x and y of a vector to which that turn brings x: wo's own where the file is isotropic */
    uint32_t root;  /* of the tree, where there are no rows */
    AcdfMixture mix;
    double albedo;
} AcdfBrdfView;

/* A direction as a place in the table. */
typedef struct AcdfBrdfPlace {
    double position[2];
    double dot, length; /* |wo . (wo + wi)| and |wo + wi|: the cosine |wo . wh| is dot / length */
} AcdfBrdfPlace;

ACDF_FN int acdf_brdf_mirrored(const AcdfBrdf* brdf) { return (brdf->views->flags & ACDF_VIEWS_MIRRORED) != 0; }

/* sqrt(1 - cos(theta)): nearly proportional to the angle at normal incidence, and dense enough at grazing. */
ACDF_FN double acdf_view_coordinate(double cos_theta) { return cos_theta < 1.0 ? sqrt(1.0 - cos_theta) : 0.0; }

/* The nodes on both sides of x and how far x is from the lower to the upper one. */
ACDF_FN double acdf_view_nodes(const float* nodes, uint32_t count, double x, uint32_t node[2]) {
    const uint32_t last = count > 1 ? count - 2 : 0; /* that can be the lower one */
    uint32_t low = 0, high, i, more = 0;
    double t;
    /* How many of nodes 1 to `last` are <= x: every eighth, then those between. No load waits for a comparison but
     * once, and no branch depends on them. */
    for (i = 8; i <= last; i += 8) low += 8u & (0u - (uint32_t)((double)nodes[i] <= x));
    for (i = 1; i < 8; ++i) {
        const uint32_t at = low + i < last ? low + i : last;
        more += (uint32_t)((double)nodes[at] <= x) & (uint32_t)(low + i <= last);
    }
    low += more;
    high = count > 1 ? low + 1 : low;
    node[0] = low;
    node[1] = high;
    if (low == high) return 0.0;
    t = (x - (double)nodes[low]) / ((double)nodes[high] - (double)nodes[low]);
    return t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
}

ACDF_FN void acdf_brdf_add(const AcdfBrdf* brdf, AcdfBrdfView* view, uint32_t index, double weight,
                           double* largest) {
    const AcdfBin* bin = &brdf->bins[index];
    view->albedo += weight * (double)bin->share * brdf->total;
    if (brdf->blend.tiles) {
        acdf_mixture_add(&view->mix, &brdf->blend, bin->root, weight * (double)bin->share);
    } else if (weight > *largest) {
        *largest = weight;
        view->root = bin->root;
    }
}

/* Looks up the stored views around wo. Returns 0 for those that are not unit vectors above the surface. */
ACDF_FN int acdf_brdf_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view) {
    const double x = wo[0], y = wo[1], z = wo[2], sin2 = x * x + y * y, length2 = sin2 + z * z;
    const uint32_t columns = brdf->views->phi_count;
    uint32_t node[2], column[2];
    double t, s = 0.0, largest = 0.0;
    if (!acdf_are_finite(wo) || !(length2 > 0.999 && length2 < 1.001 && z > 0.0)) return 0;
    view->wo[0] = x;
    view->wo[1] = y;
    view->wo[2] = z;
    view->turn[0] = 1.0;
    view->turn[1] = 0.0;
    view->mix.count = 0;
    view->albedo = 0.0;
    view->root = 0;
    t = acdf_view_nodes(brdf->nodes, brdf->views->theta_count, acdf_view_coordinate(z), node);
    if (columns == 1) {
        if (sin2 > 0.0) {
            view->turn[0] = x;
            view->turn[1] = y;
        }
        acdf_brdf_add(brdf, view, node[0], 1.0 - t, &largest);
        acdf_brdf_add(brdf, view, node[1], t, &largest);
        return 1;
    }
    s = (double)columns * (0.5 + 0.5 * acdf_atan2pi(y, x)); /* column 0 is phi = -pi, which is +pi */
    column[0] = (uint32_t)s;
    s -= (double)column[0];
    column[0] %= columns;
    column[1] = column[0] + 1 < columns ? column[0] + 1 : 0;
    acdf_brdf_add(brdf, view, node[0] * columns + column[0], (1.0 - t) * (1.0 - s), &largest);
    acdf_brdf_add(brdf, view, node[0] * columns + column[1], (1.0 - t) * s, &largest);
    acdf_brdf_add(brdf, view, node[1] * columns + column[0], t * (1.0 - s), &largest);
    acdf_brdf_add(brdf, view, node[1] * columns + column[1], t * s, &largest);
    return 1;
}

ACDF_FN void acdf_brdf_whole(const AcdfBrdf* brdf, AcdfRange range[2]) {
    range[0].low = range[1].low = 0;
    range[0].high = brdf->columns;
    range[1].high = brdf->rows;
    range[0].tilt = range[1].tilt = 0.0;
}

/* wo + wi and its length. Returns 0 where wi is not of unit length or opposite to wo. */
ACDF_FN int acdf_brdf_half(const AcdfBrdfView* view, const float wi[3], double half[3], AcdfBrdfPlace* place) {
    const double x = wi[0], y = wi[1], z = wi[2], length2 = x * x + y * y + z * z;
    half[0] = view->wo[0] + x;
    half[1] = view->wo[1] + y;
    half[2] = view->wo[2] + z;
    place->length = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    place->dot = fabs(view->wo[0] * half[0] + view->wo[1] * half[1] + view->wo[2] * half[2]);
    return acdf_are_finite(wi) && length2 > 0.999 && length2 < 1.001 && place->length > 0.0;
}

/* atan2(y, x) / pi for y >= 0 as acdf_atan2pi has it, but for rounding and without branches: the octant of a
 * half-vector cannot be guessed. */
ACDF_FN double acdf_brdf_azimuth(double y, double x) {
    const double ax = fabs(x), high = ax > y ? ax : y, low = ax > y ? y : ax;
    const double wide = (double)(low > 0.41421356237309503 * high), steep = (double)(y > ax),
                 left = (double)(x < 0.0);
    const double w = high > 0.0 ? (low - wide * high) / (high + wide * low) : 0.0;
    const double q = w * w, q4 = (q * q) * (q * q);
    const double series =
        acdf_polynomial8(q, 0.31830988618379064, -0.10610329539458131, 0.063661977233113842, -0.045472840550007838,
                         0.035367749436769451, -0.028936829427649351, 0.024477882221680791, -0.0211365210662873) +
        q4 * q4 * (0.018106577949592299 + q * (-0.01384028005905886 + q * 0.0067275982242772812));
    return left + (1.0 - 2.0 * left) * (0.5 * steep + (1.0 - 2.0 * steep) * (0.25 * wide + w * series));
}

/* Place of the half-vector of wo and wi; `sign` is on which side of the mirror it lies. Returns 0 where wi is not
 * of unit length or opposite to wo. */
ACDF_FN int acdf_brdf_place(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3], AcdfBrdfPlace* place,
                            double* sign) {
    double half[3], hx, hy, phi, below;
    if (!acdf_brdf_half(view, wi, half, place)) return 0;
    below = 1.0 - 2.0 * (double)(half[2] < 0.0); /* a half-vector below the surface reflects as its opposite does */
    hx = below * (view->turn[0] * half[0] + view->turn[1] * half[1]);
    hy = below * (view->turn[0] * half[1] - view->turn[1] * half[0]);
    phi = acdf_brdf_azimuth(fabs(hy), hx);
    *sign = 1.0 - 2.0 * (double)(hy < 0.0);
    place->position[0] = (double)brdf->columns * (acdf_brdf_mirrored(brdf) ? phi : 0.5 + 0.5 * *sign * phi);
    place->position[1] = (double)brdf->rows * ((half[0] * half[0] + half[1] * half[1]) /
                                               (place->length * (place->length + fabs(half[2]))));
    return 1; /* 1 - cos(theta_h) without cancellation */
}

ACDF_FN uint32_t acdf_brdf_step(double position, uint32_t resolution) {
    return position < (double)resolution ? (uint32_t)position : resolution - 1;
}

/* Finds the cell of a place; `strata` may be null. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_brdf_find(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfBrdfPlace* place,
                              AcdfRange range[2], AcdfStratum* strata) {
    uint32_t square[2];
    square[0] = acdf_brdf_step(place->position[0], brdf->columns);
    square[1] = acdf_brdf_step(place->position[1], brdf->rows);
    acdf_brdf_whole(brdf, range);
    if (!brdf->blend.tiles) return acdf_tree_find(brdf->tree, view->root, square, range, strata);
    if (view->mix.count == 0) return 0.0;
    return acdf_blend_find(&brdf->blend, &view->mix, square, range, strata);
}

ACDF_FN double acdf_brdf_fraction(const AcdfRange* range, double position) {
    return acdf_clamp((position - (double)range->low) / (double)(range->high - range->low), 0.0, 1.0);
}

/* Density of wi: that of its place in a cell of probability p (0: none), and the cosine's share. */
ACDF_FN float acdf_brdf_density(const AcdfBrdf* brdf, double p, const AcdfRange range[2],
                                const AcdfBrdfPlace* place, const float wi[3]) {
    const double floor = (double)brdf->views->diffuse_share;
    double pdf = 0.0;
    int axis;
    if (p > 0.0) {
        const double area = (double)(range[0].high - range[0].low) * (double)(range[1].high - range[1].low);
        pdf = p * (double)brdf->columns * (double)brdf->rows * place->length / (8.0 * ACDF_PI * place->dot * area);
        for (axis = 0; axis < 2; ++axis)
            if (range[axis].tilt != 0.0)
                pdf *= acdf_tilt_density(range[axis].tilt, acdf_brdf_fraction(&range[axis], place->position[axis]));
    }
    if (floor > 0.0) pdf = (1.0 - floor) * pdf + (wi[2] > 0.0f ? floor / ACDF_PI * (double)wi[2] : 0.0);
    else if (!(p > 0.0)) return 0.0f;
    if (pdf >= 3.402823466e38) return 3.402823466e38f;
    return pdf > 1.17549435e-38 ? (float)pdf : p > 0.0 ? 1.17549435e-38f : 0.0f;
}

ACDF_FN float acdf_brdf_view_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]) {
    AcdfBrdfPlace place;
    AcdfRange range[2];
    double sign, p;
    if (!acdf_brdf_place(brdf, view, wi, &place, &sign)) return 0.0f;
    p = acdf_brdf_find(brdf, view, &place, range, 0);
    return acdf_brdf_density(brdf, p, range, &place, wi);
}

/* Density per steradian with which acdf_brdf_sample draws wi for wo. 0 where none falls, for wo below the surface
 * and for directions that are NaN or not of unit length. */
ACDF_FN float acdf_brdf_pdf(const AcdfBrdf* brdf, const float wo[3], const float wi[3]) {
    AcdfBrdfView view;
    if (!acdf_brdf_view(brdf, wo, &view)) return 0.0f;
    return acdf_brdf_view_pdf(brdf, &view, wi);
}

/* Share of light from wo that is reflected: of the stored views, interpolated. 0 for wo below the surface. */
ACDF_FN double acdf_brdf_albedo(const AcdfBrdf* brdf, const float wo[3]) {
    AcdfBrdfView view;
    return acdf_brdf_view(brdf, wo, &view) ? acdf_clamp(view.albedo, 0.0, 0x1.fffffffffffffp1023) : 0.0;
}

/* Reflects wo at the half-vector of a position. `reach`: rounding wi to float moves its position by less. A float
 * below 1 is off by 2^-25 at most, so wi by 0.87 * 2^-24 and the half-vector, since wo + wi is 2 |wo . wh| long, by
 * half of that over the cosine; here twice as much. Not finite or NaN at the pole. */
ACDF_FN void acdf_brdf_reflect(const AcdfBrdf* brdf, const AcdfBrdfView* view, const double position[2],
                               double sign, float wi[3], double reach[2]) {
    const double cap = position[1] / (double)brdf->rows; /* 1 - cos(theta_h) */
    const double hz = 1.0 - cap, radius = sqrt(cap * (2.0 - cap)), x = position[0] / (double)brdf->columns;
    const double scale = radius / sqrt(view->turn[0] * view->turn[0] + view->turn[1] * view->turn[1]);
    double sine, cosine, hx, hy, dot, turn, angle;
    acdf_sincospi(acdf_brdf_mirrored(brdf) ? sign * x : 2.0 * x - 1.0, &sine, &cosine);
    hx = scale * (view->turn[0] * cosine - view->turn[1] * sine);
    hy = scale * (view->turn[1] * cosine + view->turn[0] * sine);
    dot = 2.0 * (view->wo[0] * hx + view->wo[1] * hy + view->wo[2] * hz);
    wi[0] = (float)(dot * hx - view->wo[0]);
    wi[1] = (float)(dot * hy - view->wo[1]);
    wi[2] = (float)(dot * hz - view->wo[2]);
    turn = 0x1p-23 / (fabs(dot) * radius); /* of its azimuth: 0x1p-24 over the cosine and the radius */
    angle = turn * radius;
    reach[0] = (double)brdf->columns * turn; /* of a half or a whole turn: pi or more to spare */
    reach[1] = (double)brdf->rows * (angle * (radius + angle));
}

/* Whether a position is in a cell and farther than `reach` from its border. */
ACDF_FN int acdf_brdf_inside(const AcdfRange range[2], const double position[2], const double reach[2]) {
    return position[0] >= (double)range[0].low + reach[0] && position[0] < (double)range[0].high - reach[0] &&
           position[1] >= (double)range[1].low + reach[1] && position[1] < (double)range[1].high - reach[1];
}

/* Prepares the random numbers for the walk: u, and on which side of the mirror wi will lie. Returns 0 where there
 * is none to do: *out is the sample. */
ACDF_FN int acdf_brdf_begin(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1, double u[2],
                            double* sign, AcdfDirectionSample* out) {
    const double floor = (double)brdf->views->diffuse_share;
    out->direction[0] = out->direction[1] = out->direction[2] = out->pdf = 0.0f;
    *sign = 1.0;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    if (floor > 0.0) {
        if (u[1] < floor) {
            const double v = acdf_clamp(u[1] / floor, 0.0, 1.0 - 0x1p-40), radius = sqrt(v);
            double sine, cosine;
            acdf_sincospi(2.0 * u[0] - 1.0, &sine, &cosine);
            out->direction[0] = (float)(radius * cosine);
            out->direction[1] = (float)(radius * sine);
            out->direction[2] = (float)sqrt(1.0 - v);
            out->pdf = acdf_brdf_view_pdf(brdf, view, out->direction);
            return 0;
        }
        u[1] = (u[1] - floor) / (1.0 - floor);
    }
    if (acdf_brdf_mirrored(brdf)) { /* both halves of u0 run through the same table: strata stay strata */
        const double v = 2.0 * u[0] - 1.0;
        *sign = v < 0.0 ? -1.0 : 1.0;
        u[0] = fabs(v);
    }
    return !brdf->blend.tiles || view->mix.count > 0;
}

/* Places wi in a cell of probability p; u is what is left of the random numbers. */
ACDF_FN AcdfDirectionSample acdf_brdf_end(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfRange range[2],
                                          const double u[2], double sign, double p) {
    const double nothing[2] = {0.0, 0.0};
    AcdfDirectionSample out;
    AcdfBrdfPlace place;
    double t[2], position[2], reach[2], half[3];
    int axis, attempt;
    for (axis = 0; axis < 2; ++axis) {
        t[axis] = acdf_tilt_sample(range[axis].tilt, u[axis]);
        t[axis] = acdf_clamp(t[axis], 0x1p-30, 1.0 - 0x1p-30);
    }
    for (axis = 0; axis < 2; ++axis)
        position[axis] = (double)range[axis].low + t[axis] * (double)(range[axis].high - range[axis].low);
    acdf_brdf_reflect(brdf, view, position, sign, out.direction, reach);
    if (range[0].tilt == 0.0 && range[1].tilt == 0.0 && acdf_brdf_inside(range, position, reach) &&
        acdf_brdf_half(view, out.direction, half, &place)) {
        place.position[0] = position[0];
        place.position[1] = position[1];
        out.pdf = acdf_brdf_density(brdf, p, range, &place, out.direction);
        return out;
    }
    /* Near the border rounding wi to float may carry it over: then it moves towards the middle, so that pdf() finds
     * the cell that it was drawn in. */
    for (attempt = 0; attempt < 32; ++attempt) {
        double side;
        for (axis = 0; axis < 2; ++axis) {
            position[axis] = (double)range[axis].low + t[axis] * (double)(range[axis].high - range[axis].low);
            t[axis] = 0.5 + 0.75 * (t[axis] - 0.5);
        }
        acdf_brdf_reflect(brdf, view, position, sign, out.direction, reach);
        if (acdf_brdf_place(brdf, view, out.direction, &place, &side) &&
            acdf_brdf_inside(range, place.position, nothing)) {
            out.pdf = acdf_brdf_density(brdf, p, range, &place, out.direction);
            return out;
        }
    }
    /* wo and wi nearly opposite: their half-vector is lost in rounding. */
    out.pdf = acdf_brdf_view_pdf(brdf, view, out.direction);
    if (!(out.pdf > 0.0f)) out.pdf = 1.17549435e-38f;
    return out;
}

/* acdf_brdf_sample for a view that was looked up. */
ACDF_FN AcdfDirectionSample acdf_brdf_view_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0,
                                                  double u1) {
    AcdfDirectionSample out;
    AcdfRange range[2];
    double u[2], sign, p;
    if (!acdf_brdf_begin(brdf, view, u0, u1, u, &sign, &out)) return out;
    acdf_brdf_whole(brdf, range);
    p = brdf->blend.tiles ? acdf_blend_sample(&brdf->blend, &view->mix, u, range)
                          : acdf_tree_sample(brdf->tree, view->root, u, range);
    return acdf_brdf_end(brdf, view, range, u, sign, p);
}

/* Draws wi for wo; u0 (phi_h) and u1 (theta_h) in [0, 1]; values outside are clamped, NaN counts as 0. Monotone in
 * each of them within a cell. pdf 0 (and no direction) for wo that are not unit vectors above the surface. */
ACDF_FN AcdfDirectionSample acdf_brdf_sample(const AcdfBrdf* brdf, const float wo[3], double u0, double u1) {
    const AcdfDirectionSample nothing = {{0.0f, 0.0f, 0.0f}, 0.0f};
    AcdfBrdfView view;
    return acdf_brdf_view(brdf, wo, &view) ? acdf_brdf_view_sample(brdf, &view, u0, u1) : nothing;
}

/* The random numbers u[2] for which acdf_brdf_sample returns wi for wo, through the half-vector. Returns 1, or 0
 * (and u unset) where the table's density is 0. */
ACDF_FN int acdf_brdf_invert(const AcdfBrdf* brdf, const float wo[3], const float wi[3], double u[2]) {
    const double floor = (double)brdf->views->diffuse_share;
    AcdfBrdfView view;
    AcdfBrdfPlace place;
    AcdfRange range[2];
    AcdfStratum strata[2];
    double sign;
    int axis;
    strata[0].low = strata[1].low = 0.0;
    strata[0].width = strata[1].width = 1.0;
    if (!acdf_brdf_view(brdf, wo, &view) || !acdf_brdf_place(brdf, &view, wi, &place, &sign)) return 0;
    if (!(acdf_brdf_find(brdf, &view, &place, range, strata) > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis) {
        const double t = acdf_brdf_fraction(&range[axis], place.position[axis]);
        u[axis] = strata[axis].low + strata[axis].width * acdf_tilt_cdf(range[axis].tilt, t);
    }
    if (acdf_brdf_mirrored(brdf)) u[0] = 0.5 + 0.5 * sign * u[0];
    u[1] = floor + (1.0 - floor) * u[1];
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
