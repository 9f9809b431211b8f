/* Where a cell lies on an axis, and which random numbers lead to it. */
#ifndef ACDF_RANGE_H
#define ACDF_RANGE_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The part of one axis that a cell covers, and the slope of the pdf across it. */
typedef struct AcdfRange {
    uint32_t low, high; /* positions on the axis, low < high */
    double tilt;        /* s: the pdf varies as 1 + s (2t - 1) for t in [0, 1] across the range */
} AcdfRange;

/* The random numbers of one axis that lead into a cell: u_low + u_width * [0, 1]. */
typedef struct AcdfStratum {
    double low, width;
} AcdfStratum;

/* Where in [0, 1] a tilted pdf puts u: solves t + s (t^2 - t) = u without cancellation. */
ACDF_FN double acdf_tilt_sample(double tilt, double u) {
    const double a = 1.0 - tilt;
    return tilt == 0.0 ? u : 2.0 * u / (a + sqrt(a * a + 4.0 * tilt * u));
}
ACDF_FN double acdf_tilt_cdf(double tilt, double t) { return t + tilt * (t * t - t); }
ACDF_FN double acdf_tilt_pdf(double tilt, double t) { return 1.0 + tilt * (2.0 * t - 1.0); }

/* The random number in [0, 1] that a cell's stratum has at t of the cell: never more than 1 by rounding. */
ACDF_FN double acdf_stratum_number(const AcdfStratum* stratum, const AcdfRange* range, double t) {
    const double u = stratum->low + stratum->width * acdf_tilt_cdf(range->tilt, t);
    return u < 1.0 ? u : 1.0;
}

#ifdef __cplusplus
}
#endif
#endif
