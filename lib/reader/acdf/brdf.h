/* Sampling and evaluating BRDF files: for every view wo the reflected light rho(wo, wi) cos(theta_i), through the
 * half-vector (Lawrence et al. 2005, §6.2). One freestanding header over acdf/normal_rows.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract: plain views into a checked file, no allocation, no errors (SPEC.md §11).
 *
 * Frame: the surface's own, z is its normal, x its tangent. wo and wi are unit vectors that point away from the
 * surface. Pdfs are per steradian of wi. A half-vector may reflect wo below the surface: wi is returned as it
 * is, with its pdf; the caller sees wi[2] <= 0 and counts the sample as 0.
 *
 * The pdf between stored views is the mixture of those around it, weighted by interpolation and by how much
 * each reflects. */
#ifndef ACDF_BRDF_H
#define ACDF_BRDF_H

#include <acdf/brdf_half.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A cell of a tree of halvings as a range of positions. */
ACDF_FN void acdf_brdf_halved_range(const AcdfBrdf* brdf, const AcdfSpan box[2], AcdfRange range[2]) {
    const double* begins = acdf_halved_heights(brdf->halved);
    acdf_halved_ranges(box, range);
    range[1].low = (uint32_t)begins[range[1].low];
    range[1].high = (uint32_t)begins[range[1].high];
}

/* Finds the cell of a position; `strata` may be null. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_brdf_find(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfBrdfPosition* place,
                              AcdfRange range[2], AcdfStratum* strata) {
    uint32_t square[2];
    AcdfSpan box[2];
    double p;
    ACDF_RETURN_CURVES(brdf, brdf_find(brdf, view, place, range, strata));
    square[0] = acdf_brdf_step(place->position[0], brdf->columns);
    if (view->mix.count == 0) return 0.0;
    square[1] = acdf_half_row_of(acdf_halved_heights(brdf->halved), place->position[1]);
    p = strata ? acdf_rows_strata(brdf->rows_of_views, brdf->halved, &view->mix, square, box, strata)
               : acdf_rows_find(brdf->rows_of_views, brdf->halved, &view->mix, square, box);
    acdf_brdf_halved_range(brdf, box, range);
    return p;
}

/* Fraction across a cell, of a position in it, in [0, 1]. */
ACDF_FN double acdf_brdf_fraction(const AcdfRange* range, double position) {
    return acdf_clamp((position - (double)range->low) / (double)(range->high - range->low), 0.0, 1.0);
}

/* The pdf of wi with the cosine's share: `pdf` is that of the table, in a cell of probability p (0: none). */
ACDF_INLINE float acdf_brdf_whole_pdf(const AcdfBrdf* brdf, double p, double pdf, const float wi[3]) {
    const double floor = (double)brdf->views->diffuse_share;
    if (floor > 0.0) pdf = (1.0 - floor) * pdf + (wi[2] > 0.0f ? floor / ACDF_PI * (double)wi[2] : 0.0);
    else if (!(p > 0.0)) return 0.0f;
    return p > 0.0 || pdf > 1.17549435e-38 ? acdf_positive_pdf(pdf) : 0.0f;
}

/* The pdf of wi, whose position lies in a cell of probability p (0: none). */
ACDF_FN float acdf_brdf_cell_pdf(const AcdfBrdf* brdf, double p, const AcdfRange range[2],
                                 const AcdfBrdfPosition* place, const float wi[3]) {
    double pdf = 0.0;
    if (p > 0.0) {
        const double area = (double)(range[0].high - range[0].low) * (double)(range[1].high - range[1].low);
        pdf = acdf_brdf_mean_pdf(brdf, p, area, place);
    }
    return acdf_brdf_whole_pdf(brdf, p, pdf, wi);
}

/* acdf_brdf_pdf for a view that serves several directions. */
ACDF_FN float acdf_brdf_view_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]) {
    AcdfBrdfPosition place;
    AcdfRange range[2];
    double sign, p;
    ACDF_RETURN_CURVES(brdf, brdf_pdf(brdf, view, wi));
    if (!acdf_brdf_half_position(brdf, view, wi, &place, &sign)) return 0.0f;
    p = acdf_brdf_find(brdf, view, &place, range, 0);
    return acdf_brdf_cell_pdf(brdf, p, range, &place, wi);
}

/* The pdf, per steradian, with which acdf_brdf_sample samples wi for wo. 0 where none falls, for wo below the
 * surface and for directions that are NaN or not of unit length. */
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

/* Prepares the random numbers for the traversal: u, and on which side of the mirror wi will lie. Returns 0 where no
 * traversal is needed: *out is the sample. */
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
    if (acdf_brdf_mirrored(brdf)) *sign = acdf_brdf_mirror(&u[0]);
    return 1;
}

/* The random numbers that acdf_brdf_begin makes `u` of. */
ACDF_INLINE void acdf_brdf_unprepare(const AcdfBrdf* brdf, double sign, double u[2]) {
    const double floor = (double)brdf->views->diffuse_share;
    if (acdf_brdf_mirrored(brdf)) u[0] = 0.5 + 0.5 * sign * u[0];
    u[1] = floor + (1.0 - floor) * u[1];
}

/* Samples wi in a cell of probability p; u: the random numbers, rescaled to [0, 1] in the cell. */
ACDF_FN AcdfDirectionSample acdf_brdf_end(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfRange range[2],
                                          const double u[2], double sign, double p) {
    const double nothing[2] = {0.0, 0.0};
    AcdfDirectionSample out;
    AcdfBrdfPosition place;
    double t[2], position[2], reach[2], half[3];
    int axis, attempt;
    for (axis = 0; axis < 2; ++axis) t[axis] = acdf_clamp(u[axis], 0x1p-30, 1.0 - 0x1p-30);
    for (axis = 0; axis < 2; ++axis)
        position[axis] = (double)range[axis].low + t[axis] * (double)(range[axis].high - range[axis].low);
    acdf_brdf_reflect(brdf, view, position, sign, out.direction, reach);
    if (acdf_brdf_inside(range, position, reach) && acdf_brdf_half(view, out.direction, half, &place)) {
        place.position[0] = position[0];
        place.position[1] = position[1];
        out.pdf = acdf_brdf_cell_pdf(brdf, p, range, &place, out.direction);
        return out;
    }
    /* Near the border rounding wi to float may carry it over: then it moves towards the middle, so that pdf() finds
     * the cell that it was sampled in. */
    for (attempt = 0; attempt < 32; ++attempt) {
        double side;
        for (axis = 0; axis < 2; ++axis) {
            position[axis] = (double)range[axis].low + t[axis] * (double)(range[axis].high - range[axis].low);
            t[axis] = 0.5 + 0.75 * (t[axis] - 0.5);
        }
        acdf_brdf_reflect(brdf, view, position, sign, out.direction, reach);
        if (acdf_brdf_half_position(brdf, view, out.direction, &place, &side) &&
            acdf_brdf_inside(range, place.position, nothing)) {
            out.pdf = acdf_brdf_cell_pdf(brdf, p, range, &place, out.direction);
            return out;
        }
    }
    /* wo and wi nearly opposite: their half-vector is lost in rounding. */
    out.pdf = acdf_brdf_view_pdf(brdf, view, out.direction);
    if (!(out.pdf > 0.0f)) out.pdf = 1.17549435e-38f;
    return out;
}

/* The cell that random numbers lead to; they are rescaled to [0, 1] in it. Returns its probability. */
ACDF_FN double acdf_brdf_choose(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u[2], AcdfRange range[2]) {
    AcdfSpan box[2];
    const double p = acdf_rows_choose(brdf->rows_of_views, brdf->halved, &view->mix, u, box);
    acdf_brdf_halved_range(brdf, box, range);
    return p;
}

/* acdf_brdf_sample for a view that was looked up. */
ACDF_FN AcdfDirectionSample acdf_brdf_view_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0,
                                                  double u1) {
    AcdfDirectionSample out;
    AcdfRange range[2];
    double u[2], sign, p;
    ACDF_RETURN_CURVES(brdf, brdf_sample(brdf, view, u0, u1));
    if (!acdf_brdf_begin(brdf, view, u0, u1, u, &sign, &out) || view->mix.count == 0) return out;
    p = acdf_brdf_choose(brdf, view, u, range);
    return acdf_brdf_end(brdf, view, range, u, sign, p);
}

/* Samples wi for wo; u0 and u1 in [0, 1]; values outside are clamped, NaN counts as 0. Monotone in each of them
 * within a cell, u0 in phi_h and u1 in theta_h. pdf 0 (and no direction) for wo that are not unit vectors above the
 * surface. */
ACDF_FN AcdfDirectionSample acdf_brdf_sample(const AcdfBrdf* brdf, const float wo[3], double u0, double u1) {
    const AcdfDirectionSample nothing = {{0.0f, 0.0f, 0.0f}, 0.0f};
    AcdfBrdfView view;
    return acdf_brdf_view(brdf, wo, &view) ? acdf_brdf_view_sample(brdf, &view, u0, u1) : nothing;
}

/* Moves a position in a cell to the half-vector that reflects wo into the direction of wi, if the cell holds that
 * half-vector. The direction wi is taken to be as long as wo, since vectors of floats have unit length but for
 * rounding. A difference of their lengths would turn the half-vector where wo and wi are nearly opposite. */
ACDF_FN void acdf_brdf_refine(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfRange range[2],
                              const float wi[3], double position[2], double* sign) {
    const double nothing[2] = {0.0, 0.0};
    double half[3], at[2], side, wo2 = 0.0, wi2 = 0.0, length2 = 0.0;
    int k;
    for (k = 0; k < 3; ++k) {
        wo2 += view->wo[k] * view->wo[k];
        wi2 += (double)wi[k] * (double)wi[k];
    }
    for (k = 0; k < 3; ++k) {
        half[k] = view->wo[k] + sqrt(wo2 / wi2) * (double)wi[k];
        length2 += half[k] * half[k];
    }
    if (!(length2 > 0.0)) return;
    acdf_brdf_position(brdf, view, half, sqrt(length2), at, &side);
    if (!acdf_brdf_inside(range, at, nothing)) return;
    position[0] = at[0];
    position[1] = at[1];
    *sign = side;
}

/* The fraction t of a cell that a sample takes for a position, `margin` away from the borders where there is room
 * for it, else in the middle. Returns whether it is in the cell when it is rounded to floats; `margin` becomes what
 * that may move it by, the reach of acdf_brdf_reflect. */
ACDF_FN int acdf_brdf_stays(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfRange range[2],
                            const double position[2], double sign, double margin[2], double t[2]) {
    const double nothing[2] = {0.0, 0.0};
    AcdfBrdfPosition place;
    double at[2], side;
    float wi[3];
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        const double wide = (double)(range[axis].high - range[axis].low);
        const double part = acdf_clamp(margin[axis] / wide, 0x1p-30, 0.5);
        t[axis] = acdf_clamp(acdf_brdf_fraction(&range[axis], position[axis]), part, 1.0 - part);
        at[axis] = (double)range[axis].low + t[axis] * wide;
    }
    acdf_brdf_reflect(brdf, view, at, sign, wi, margin);
    return acdf_brdf_half_position(brdf, view, wi, &place, &side) &&
           acdf_brdf_inside(range, place.position, nothing);
}

/* The random numbers u[2] for which acdf_brdf_sample returns wi for wo, through the half-vector. Returns 1, or 0
 * (and u unset) where the table's pdf is 0. The sample lies in the cell that acdf_brdf_pdf finds, and is wi but for
 * rounding: a coordinate is off by 2^-23 at most. Where wi is nearer to a border of the cell than samples come, it
 * is off by 2^-19 / |wo + wi| + 2^-29 / sin(theta_h), in cells that are wider. The function acdf_brdf_sample moves
 * samples that rounding would carry over a border into their cell, by an eighth of it or more. For those, u may
 * differ from the numbers that sampled them, and samples them as well. */
ACDF_FN int acdf_brdf_invert(const AcdfBrdf* brdf, const float wo[3], const float wi[3], double u[2]) {
    AcdfBrdfView view;
    AcdfBrdfPosition place;
    AcdfRange range[2];
    AcdfStratum strata[2];
    double sign, margin[2] = {0.0, 0.0}, t[2];
    int axis;
    ACDF_RETURN_CURVES(brdf, brdf_invert(brdf, wo, wi, u));
    strata[0].low = strata[1].low = 0.0;
    strata[0].width = strata[1].width = 1.0;
    if (!acdf_brdf_view(brdf, wo, &view) || !acdf_brdf_half_position(brdf, &view, wi, &place, &sign)) return 0;
    if (!(acdf_brdf_find(brdf, &view, &place, range, strata) > 0.0)) return 0;
    acdf_brdf_refine(brdf, &view, range, wi, place.position, &sign);
    if (!acdf_brdf_stays(brdf, &view, range, place.position, sign, margin, t))
        acdf_brdf_stays(brdf, &view, range, place.position, sign, margin, t);
    for (axis = 0; axis < 2; ++axis) u[axis] = acdf_stratum_number(&strata[axis], t[axis]);
    acdf_brdf_unprepare(brdf, sign, u);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
