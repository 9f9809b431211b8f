// Sampling trees of curves, of BRDFs: each stored view has a tree, and the nearest one serves a view.
#include "curves/functions.h"

#include <acdf/curves/tree.h>

namespace acdf {
namespace {

/// A cell of the square of half-vectors.
struct HalfCell {
    AcdfTiltedRange tilted[2];
    AcdfRange range[2];

    explicit HalfCell(const AcdfBrdf& brdf) : tilted{acdf_whole_axis(brdf.columns), acdf_whole_axis(brdf.rows)} {}

    bool is_tilted() const { return tilted[0].tilt != 0.0 || tilted[1].tilt != 0.0; }
    double sample(const AcdfBrdf& brdf, const AcdfBrdfView& view, double* u) {
        return found(acdf_tree_sample(brdf.tree, view.root, u, tilted));
    }
    /// `strata` may be null.
    double find(const AcdfBrdf& brdf, const AcdfBrdfView& view, const AcdfBrdfPosition& place,
                AcdfStratum* strata) {
        const std::uint32_t square[2] = {acdf_brdf_step(place.position[0], brdf.columns),
                                         acdf_brdf_step(place.position[1], brdf.rows)};
        return found(acdf_tree_find(brdf.tree, view.root, square, tilted, strata));
    }
    /// The pdf of wi at a place in the cell, whose probability is p (0: none).
    float pdf(const AcdfBrdf& brdf, double p, const AcdfBrdfPosition& place, const float* wi) const {
        double pdf = 0.0;
        if (p > 0.0) {
            const double area = static_cast<double>(range[0].high - range[0].low) *
                                static_cast<double>(range[1].high - range[1].low);
            pdf = acdf_brdf_mean_pdf(&brdf, p, area, &place);
            for (int axis = 0; axis < 2; ++axis)
                if (tilted[axis].tilt != 0.0)
                    pdf *= acdf_tilt_pdf(tilted[axis].tilt, acdf_brdf_fraction(&range[axis], place.position[axis]));
        }
        return acdf_brdf_whole_pdf(&brdf, p, pdf, wi);
    }

private:
    double found(double probability) {
        for (int axis = 0; axis < 2; ++axis) range[axis] = acdf_untilted(&tilted[axis]);
        return probability;
    }
};

} // namespace

int curves_brdf_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view) {
    AcdfBrdfNear near;
    double largest = 0.0;
    if (!acdf_brdf_near(brdf, wo, view, &near)) return 0;
    for (int i = 0; i < near.count; ++i) {
        acdf_brdf_reflected(brdf, &near, i, view);
        if (!(near.weight[i] > largest)) continue;
        largest = near.weight[i];
        view->root = brdf->bins[near.bin[i]].root;
    }
    return 1;
}

double curves_brdf_find(const AcdfBrdf* brdf, const AcdfBrdfView* view, const AcdfBrdfPosition* place,
                        AcdfRange range[2], AcdfStratum* strata) {
    HalfCell cell(*brdf);
    const double p = cell.find(*brdf, *view, *place, strata);
    for (int axis = 0; axis < 2; ++axis) range[axis] = cell.range[axis];
    return p;
}

float curves_brdf_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3]) {
    HalfCell cell(*brdf);
    AcdfBrdfPosition place;
    double sign;
    if (!acdf_brdf_half_position(brdf, view, wi, &place, &sign)) return 0.0f;
    return cell.pdf(*brdf, cell.find(*brdf, *view, place, nullptr), place, wi);
}

AcdfDirectionSample curves_brdf_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, double u0, double u1) {
    const double nothing[2] = {0.0, 0.0};
    HalfCell cell(*brdf);
    AcdfDirectionSample out;
    AcdfBrdfPosition place;
    double u[2], sign;
    if (!acdf_brdf_begin(brdf, view, u0, u1, u, &sign, &out)) return out;
    const double p = cell.sample(*brdf, *view, u);
    for (int axis = 0; axis < 2; ++axis) u[axis] = acdf_tilt_sample(cell.tilted[axis].tilt, u[axis]);
    out = acdf_brdf_end(brdf, view, cell.range, u, sign, p);
    // Its pdf is that of a cell without tilts, or that of the direction where this left the cell.
    if (cell.is_tilted() && acdf_brdf_half_position(brdf, view, out.direction, &place, &sign) &&
        acdf_brdf_inside(cell.range, place.position, nothing))
        out.pdf = cell.pdf(*brdf, p, place, out.direction);
    return out;
}

int curves_brdf_invert(const AcdfBrdf* brdf, const float wo[3], const float wi[3], double u[2]) {
    HalfCell cell(*brdf);
    AcdfBrdfView view;
    AcdfBrdfPosition place;
    AcdfStratum strata[2] = {{0.0, 1.0}, {0.0, 1.0}};
    double sign, margin[2] = {0.0, 0.0}, t[2];
    if (!curves_brdf_view(brdf, wo, &view) || !acdf_brdf_half_position(brdf, &view, wi, &place, &sign)) return 0;
    if (!(cell.find(*brdf, view, place, strata) > 0.0)) return 0;
    acdf_brdf_refine(brdf, &view, cell.range, wi, place.position, &sign);
    if (!acdf_brdf_stays(brdf, &view, cell.range, place.position, sign, margin, t))
        acdf_brdf_stays(brdf, &view, cell.range, place.position, sign, margin, t);
    for (int axis = 0; axis < 2; ++axis)
        u[axis] = acdf_stratum_number(&strata[axis], acdf_tilt_cdf(cell.tilted[axis].tilt, t[axis]));
    acdf_brdf_unprepare(brdf, sign, u);
    return 1;
}

} // namespace acdf
