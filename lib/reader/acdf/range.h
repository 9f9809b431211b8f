/* Where a cell lies on an axis, and which random numbers lead to it. */
#ifndef ACDF_RANGE_H
#define ACDF_RANGE_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The part of one axis that a cell covers. */
typedef struct AcdfRange {
    uint32_t low, high; /* positions on the axis, low < high */
} AcdfRange;

/* The random numbers of one axis that lead into a cell: u_low + u_width * [0, 1]. */
typedef struct AcdfStratum {
    double low, width;
} AcdfStratum;

/* A product of many probabilities may underflow; what can be sampled keeps a positive one. */
ACDF_FN double acdf_positive(double probability) { return probability > 0x1p-1000 ? probability : 0x1p-1000; }

/* The random number in [0, 1] that a cell's stratum has at t of the cell: never more than 1 by rounding. */
ACDF_FN double acdf_stratum_number(const AcdfStratum* stratum, double t) {
    const double u = stratum->low + stratum->width * t;
    return u < 1.0 ? u : 1.0;
}

#ifdef __cplusplus
}
#endif
#endif
