/* Sampling and evaluating .acdf trees: one freestanding header, valid C99, C++17 and CUDA/HIP/SYCL.
 *
 * It works on plain views into the bytes of a *checked* file (acdf/reader.h checks once, at load; nothing
 * is checked here). Functions are pure: no allocation, no globals, no errors. To call them in a GPU kernel
 * define ACDF_FN before including, for example `#define ACDF_FN static inline __host__ __device__`.
 *
 * The trade-off: a table of N cells as large as the image is sampled in one lookup per axis but misses the
 * cache at every step; an adaptive tree needs a few more comparisons and stays in the cache. Arithmetic is
 * double because a random number is rescaled once a curve: in float it would run out of bits.
 *
 * Frame: right-handed, z up. theta is measured from +z, phi from +x towards +y. Densities are per
 * steradian. docs/conventions.md maps this frame to that of other programs. */
#ifndef ACDF_SAMPLE_H
#define ACDF_SAMPLE_H

#include <acdf/layout.h>
#include <math.h>
#include <string.h>

#ifndef ACDF_FN
#define ACDF_FN static inline
#endif

#if defined(__BYTE_ORDER__) && defined(__ORDER_BIG_ENDIAN__)
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#error "acdf files are little-endian and are read in place"
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- curves (SPEC.md §5.4) -------------------------------------------------------------------------- */

typedef struct AcdfCurve {
    uint32_t header;
    uint32_t segments;
    const uint8_t* cumulative; /* segments - 1 interior values; 0 and the maximum are implied */
    const uint8_t* positions;  /* segments - 1 interior knots; the ends are those of the range so far */
    const uint8_t* links;      /* distance to each child; 0: the segment ends */
    const uint8_t* tilts;
} AcdfCurve;

/* The part of one axis that a cell covers, and the slope of the density across it. */
typedef struct AcdfRange {
    uint32_t low, high; /* positions on the axis, low < high */
    double tilt;        /* s: the density varies as 1 + s (2t - 1) for t in [0, 1] across the range */
} AcdfRange;

/* The random numbers of one axis that lead into a cell: u_low + u_width * [0, 1]. */
typedef struct AcdfStratum {
    double low, width;
} AcdfStratum;

ACDF_FN uint32_t acdf_curve_axis(const AcdfCurve* curve) { return curve->header & ACDF_CURVE_AXIS_MASK; }

/* Bytes of an element whose size code is `code`: 1, 2 or 4. */
ACDF_FN uint32_t acdf_element_size(uint32_t code) { return 1u << code; }

/* `size` is a power of two. */
ACDF_FN size_t acdf_align(size_t offset, uint32_t size) { return (offset + (size - 1)) & ~(size_t)(size - 1); }

/* Decodes the curve at offset `at`, counted like all offsets in a tree in units of two bytes. Returns the offset
 * of the curve that follows in the file. */
ACDF_FN size_t acdf_curve_decode(const uint8_t* tree, uint32_t at, AcdfCurve* curve) {
    size_t offset = 2 * (size_t)at;
    const uint16_t* units = (const uint16_t*)(const void*)(tree + offset);
    const uint32_t header = units[0];
    uint32_t size;
    curve->header = header;
    curve->segments = header >> ACDF_CURVE_SEGMENTS_SHIFT;
    offset += 2;
    if (curve->segments == 0) {
        curve->segments = units[1] | (uint32_t)units[2] << 16;
        offset += 4;
    }
    size = acdf_element_size(ACDF_CURVE_CUMULATIVE_CODE(header));
    offset = acdf_align(offset, size);
    curve->cumulative = tree + offset;
    offset += (size_t)(curve->segments - 1) * size;
    size = acdf_element_size(ACDF_CURVE_POSITION_CODE(header));
    offset = acdf_align(offset, size);
    curve->positions = tree + offset;
    offset += (size_t)(curve->segments - 1) * size;
    curve->links = 0;
    if (ACDF_CURVE_LINK_CODE(header) != 0) {
        size = acdf_element_size(ACDF_CURVE_LINK_CODE(header) - 1);
        offset = acdf_align(offset, size);
        curve->links = tree + offset;
        offset += (size_t)curve->segments * size;
    }
    offset = acdf_align(offset, 2);
    curve->tilts = 0;
    if (header & ACDF_CURVE_TILTED) {
        curve->tilts = tree + offset;
        offset += (size_t)curve->segments * 2;
    }
    return offset / 2;
}

ACDF_FN AcdfCurve acdf_curve_at(const uint8_t* tree, uint32_t at) {
    AcdfCurve curve;
    acdf_curve_decode(tree, at, &curve);
    return curve;
}

ACDF_FN uint32_t acdf_load(const uint8_t* array, uint32_t index, uint32_t code) {
    if (code == 0) return array[index];
    return code == 1 ? ((const uint16_t*)(const void*)array)[index] : ((const uint32_t*)(const void*)array)[index];
}

/* How many of `count` nondecreasing values are <= key. Long arrays are halved without branches on the data; few
 * values are passed one by one, since a branch that is guessed lets the loads of the child start before the
 * comparison is done: most curves are short, and their time is that of loads that wait for each other. */
#define ACDF_UPPER_BOUND(name, type)                                                                               \
    ACDF_FN uint32_t name(const type* array, uint32_t count, uint32_t key) {                                       \
        uint32_t base = 0, end;                                                                                    \
        while (count > 16) {                                                                                       \
            const uint32_t half = count / 2;                                                                       \
            base += array[base + half - 1] <= key ? half : 0;                                                      \
            count -= half;                                                                                         \
        }                                                                                                          \
        for (end = base + count; base < end && array[base] <= key; ++base) continue;                               \
        return base;                                                                                               \
    }
ACDF_UPPER_BOUND(acdf_upper_bound8, uint8_t)
ACDF_UPPER_BOUND(acdf_upper_bound16, uint16_t)
ACDF_UPPER_BOUND(acdf_upper_bound32, uint32_t)
#undef ACDF_UPPER_BOUND
ACDF_FN uint32_t acdf_upper_bound(const uint8_t* array, uint32_t count, uint32_t code, uint32_t key) {
    if (code == 0) return acdf_upper_bound8(array, count, key);
    return code == 1 ? acdf_upper_bound16((const uint16_t*)(const void*)array, count, key)
                     : acdf_upper_bound32((const uint32_t*)(const void*)array, count, key);
}

/* The largest cumulative value: probability 1. All ones, not a power of two, so that every value from 0 to 1
 * can be stored: a segment of probability 0 may stand first or last. 0 and the maximum themselves are implied
 * at the ends of a curve. */
ACDF_FN uint32_t acdf_curve_maximum(const AcdfCurve* curve) {
    return 0xFFFFFFFFu >> (32 - 8 * acdf_element_size(ACDF_CURVE_CUMULATIVE_CODE(curve->header)));
}

/* Cumulative value at knot i in [0, segments]. */
ACDF_FN uint32_t acdf_curve_cumulative(const AcdfCurve* curve, uint32_t i) {
    if (i == 0) return 0;
    if (i == curve->segments) return acdf_curve_maximum(curve);
    return acdf_load(curve->cumulative, i - 1, ACDF_CURVE_CUMULATIVE_CODE(curve->header));
}

/* Narrows the range of the curve's axis to segment i. Positions of one byte count from the range's low end. */
ACDF_FN void acdf_curve_narrow(const AcdfCurve* curve, uint32_t i, AcdfRange* range) {
    const uint32_t code = ACDF_CURVE_POSITION_CODE(curve->header);
    const uint32_t origin = code == 0 ? range->low : 0;
    if (i > 0) range->low = origin + acdf_load(curve->positions, i - 1, code);
    if (i + 1 < curve->segments) range->high = origin + acdf_load(curve->positions, i, code);
    if (curve->tilts) range->tilt = ((const int16_t*)(const void*)curve->tilts)[i] / 32768.0;
}

/* Which segment holds a grid step of the curve's axis. */
ACDF_FN uint32_t acdf_curve_segment(const AcdfCurve* curve, uint32_t step, const AcdfRange* range) {
    const uint32_t code = ACDF_CURVE_POSITION_CODE(curve->header);
    return acdf_upper_bound(curve->positions, curve->segments - 1, code, code == 0 ? step - range->low : step);
}

/* Distance, in units of two bytes, to the child of segment i; 0 where it ends. */
ACDF_FN uint32_t acdf_curve_link(const AcdfCurve* curve, uint32_t i) {
    return curve->links ? acdf_load(curve->links, i, ACDF_CURVE_LINK_CODE(curve->header) - 1) : 0;
}

/* ---- trees ------------------------------------------------------------------------------------------ */

/* A product of 64 probabilities may underflow; what can be drawn keeps a positive one. */
ACDF_FN double acdf_positive(double probability) { return probability > 0x1p-1000 ? probability : 0x1p-1000; }

/* Draws a cell. In: u[axis] in [0, 1] and range[axis] = the whole axis with tilt 0, for each sampled axis.
 * Out: u[axis] in [0, 1] is what is left of the random number, uniform within the cell; range[axis] is the
 * cell. Returns the cell's probability, > 0. */
ACDF_FN double acdf_tree_sample(const uint8_t* tree, uint32_t root, double* u, AcdfRange* range) {
    double probability = 1.0;
    uint32_t at = root;
    for (;;) {
        const AcdfCurve curve = acdf_curve_at(tree, at);
        const uint32_t axis = acdf_curve_axis(&curve);
        const double maximum = (double)acdf_curve_maximum(&curve);
        double scaled = u[axis] * maximum;
        uint32_t i, low, width, link;
        if (scaled >= maximum) scaled = maximum * (1.0 - 0x1p-53);
        /* Segments of probability 0 are never entered: the bound lies above all equal values. */
        i = acdf_upper_bound(curve.cumulative, curve.segments - 1, ACDF_CURVE_CUMULATIVE_CODE(curve.header),
                             (uint32_t)scaled);
        low = acdf_curve_cumulative(&curve, i);
        width = acdf_curve_cumulative(&curve, i + 1) - low;
        u[axis] = (scaled - (double)low) / (double)width;
        probability *= (double)width / maximum;
        acdf_curve_narrow(&curve, i, &range[axis]);
        link = acdf_curve_link(&curve, i);
        if (link == 0) return acdf_positive(probability);
        at += link;
    }
}

/* Finds the cell that holds the unit grid square at[axis], at[axis] in [0, resolution). `range` as in
 * acdf_tree_sample; `strata` may be null, else strata[axis] = {0, 1} becomes the random numbers that lead
 * here. Returns the cell's probability, 0 where no sample can fall. */
ACDF_FN double acdf_tree_find(const uint8_t* tree, uint32_t root, const uint32_t* square, AcdfRange* range,
                              AcdfStratum* strata) {
    double probability = 1.0;
    uint32_t at = root;
    for (;;) {
        const AcdfCurve curve = acdf_curve_at(tree, at);
        const uint32_t axis = acdf_curve_axis(&curve);
        const double maximum = (double)acdf_curve_maximum(&curve);
        const uint32_t i = acdf_curve_segment(&curve, square[axis], &range[axis]);
        const uint32_t low = acdf_curve_cumulative(&curve, i);
        const uint32_t width = acdf_curve_cumulative(&curve, i + 1) - low;
        uint32_t link;
        probability *= (double)width / maximum;
        acdf_curve_narrow(&curve, i, &range[axis]);
        if (strata) {
            strata[axis].low += strata[axis].width * ((double)low / maximum);
            strata[axis].width *= (double)width / maximum;
        }
        if (width == 0) return 0.0;
        link = acdf_curve_link(&curve, i);
        if (link == 0) return acdf_positive(probability);
        at += link;
    }
}

/* Where in [0, 1] a tilted density puts u: solves t + s (t^2 - t) = u without cancellation. */
ACDF_FN double acdf_tilt_sample(double tilt, double u) {
    const double a = 1.0 - tilt;
    return tilt == 0.0 ? u : 2.0 * u / (a + sqrt(a * a + 4.0 * tilt * u));
}
ACDF_FN double acdf_tilt_cdf(double tilt, double t) { return t + tilt * (t * t - t); }
ACDF_FN double acdf_tilt_density(double tilt, double t) { return 1.0 + tilt * (2.0 * t - 1.0); }

/* ---- elementary functions ---------------------------------------------------------------------------
 * Written out so that every machine draws the same directions and finds the same cells, which its libm would
 * not grant, and because two atan2 calls would cost more than the rest. */

#define ACDF_PI 3.14159265358979323846

/* Polynomials of degree 7 and 3 in q, summed as a tree: short chains of dependent operations. */
ACDF_FN double acdf_polynomial4(double q, double c0, double c1, double c2, double c3) {
    return (c0 + q * c1) + q * q * (c2 + q * c3);
}
ACDF_FN double acdf_polynomial8(double q, double c0, double c1, double c2, double c3, double c4, double c5,
                                double c6, double c7) {
    const double q2 = q * q;
    return acdf_polynomial4(q, c0, c1, c2, c3) + q2 * q2 * acdf_polynomial4(q, c4, c5, c6, c7);
}

/* Taylor series for |y| <= pi/4, error below 2e-16. */
ACDF_FN double acdf_sine(double y) {
    return y * acdf_polynomial8(y * y, 1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800,
                                1.0 / 6227020800.0, -1.0 / 1307674368000.0);
}
ACDF_FN double acdf_cosine(double y) {
    const double q = y * y;
    return 1.0 + q * acdf_polynomial8(q, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800,
                                      1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0);
}

/* sin(pi x) and cos(pi x) for x in [-2, 2]. */
ACDF_FN void acdf_sincospi(double x, double* sine, double* cosine) {
    const int quadrant = (int)(2.0 * x + 4.5) - 4; /* the nearest multiple of 1/2 */
    const double y = (x - 0.5 * quadrant) * ACDF_PI;
    const double s = acdf_sine(y), c = acdf_cosine(y);
    *sine = (quadrant & 1) ? c : s;
    *cosine = (quadrant & 1) ? s : c;
    if (quadrant & 2) *sine = -*sine;
    if ((quadrant + 1) & 2) *cosine = -*cosine;
}

/* atan2(y, x) / pi, error below 2e-16; 0 for y = x = 0. The series in q = w^2 of atan(w) / (pi w) was
 * interpolated at the Chebyshev nodes of [0, tan(pi/8)^2]. */
ACDF_FN double acdf_atan2pi(double y, double x) {
    const double ax = fabs(x), ay = fabs(y);
    const double high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
    const int wide = low > 0.41421356237309503 * high; /* beyond tan(pi/8): measure from pi/4 */
    const double w = high > 0.0 ? (wide ? low - high : low) / (wide ? low + high : high) : 0.0;
    const double q = w * w, q4 = (q * q) * (q * q);
    const double series =
        acdf_polynomial8(q, 0.31830988618379064, -0.10610329539458131, 0.063661977233113842, -0.045472840550007838,
                         0.035367749436769451, -0.028936829427649351, 0.024477882221680791, -0.0211365210662873) +
        q4 * q4 * (0.018106577949592299 + q * (-0.01384028005905886 + q * 0.0067275982242772812));
    double turn = w * series + (wide ? 0.25 : 0.0);
    if (ay > ax) turn = 0.5 - turn;
    if (x < 0.0) turn = 1.0 - turn;
    return y < 0.0 ? -turn : turn;
}

/* ---- the sphere (SPEC.md §6.1) ---------------------------------------------------------------------- */

typedef struct AcdfEnvironment {
    const uint8_t* tree; /* chunk TREE */
    uint32_t root;
    uint32_t columns; /* axis 0: position 0 is phi = +pi, `columns` is phi = -pi */
    uint32_t rows;    /* axis 1: position 0 is theta = 0 (+z), `rows` is theta = pi */
    double total;     /* integral of the target over the sphere */
} AcdfEnvironment;

typedef struct AcdfDirectionSample {
    float direction[3]; /* unit, towards the light */
    float pdf;          /* sr^-1, finite and > 0 */
} AcdfDirectionSample;

enum { ACDF_AXIS_PHI = 0, ACDF_AXIS_THETA = 1 };

/* A sample stays this angle (radians) inside its cell: rounding the direction to float, and normalising it
 * again, then cannot carry it over the border, and pdf() agrees with sample(). */
#define ACDF_BORDER 0x1p-22

/* z = cos(theta) at a row position in [0, rows]: 1 - 2 sin(theta/2)^2, exact at the poles. */
ACDF_FN double acdf_row_z(uint32_t row, uint32_t rows) {
    const int south = 2 * (uint64_t)row > rows;
    const double s = acdf_sine((double)(south ? rows - row : row) / (double)rows * (0.5 * ACDF_PI));
    const double z = 1.0 - 2.0 * s * s;
    return south ? -z : z;
}

/* Density per steradian of a cell of probability p over `width` columns and a difference dz of cosines;
 * `shape` is the product of its tilt densities. */
ACDF_FN float acdf_cell_pdf(double p, uint32_t width, uint32_t columns, double dz, double shape) {
    const double pdf = p * (double)columns / (2.0 * ACDF_PI * (double)width * dz) * shape;
    if (pdf >= 3.402823466e38) return 3.402823466e38f;
    return pdf > 1.17549435e-38 ? (float)pdf : 1.17549435e-38f;
}

ACDF_FN double acdf_clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* The whole sphere, before a tree narrows it. */
ACDF_FN void acdf_sphere_ranges(uint32_t columns, uint32_t rows, AcdfRange range[2]) {
    range[0].low = range[1].low = 0;
    range[0].high = columns;
    range[1].high = rows;
    range[0].tilt = range[1].tilt = 0.0;
}

/* Whether numbers are neither NaN nor infinite, by their bits: compilers that are told that there are no such
 * numbers
 * (-ffast-math) leave out comparisons that tell. */
ACDF_FN int acdf_is_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits >> 52 & 0x7FFu) != 0x7FFu;
}
ACDF_FN int acdf_are_finite(const float v[3]) {
    const uint32_t exponent = 0x7F800000u;
    uint32_t bits[3];
    memcpy(bits, v, sizeof bits);
    return (bits[0] & exponent) != exponent && (bits[1] & exponent) != exponent && (bits[2] & exponent) != exponent;
}

/* A random number in [0, 1]; values outside are clamped, what is not finite counts as 0. */
ACDF_FN double acdf_unit_interval(double u) {
    if (!acdf_is_finite(u)) return 0.0;
    return u > 0.0 ? (u < 1.0 ? u : 1.0) : 0.0;
}

/* The 24 lowest bits of k in reverse order. */
ACDF_FN uint32_t acdf_reverse24(uint32_t k) {
    k = (k & 0x55555555u) << 1 | (k >> 1 & 0x55555555u);
    k = (k & 0x33333333u) << 2 | (k >> 2 & 0x33333333u);
    k = (k & 0x0F0F0F0Fu) << 4 | (k >> 4 & 0x0F0F0F0Fu);
    k = (k & 0x00FF00FFu) << 8 | (k >> 8 & 0x00FF00FFu);
    return (k << 16 | k >> 16) >> 8;
}

/* For random numbers of 24 bits, which is all that floats in [0, 1) hold: u[i] becomes a double in the same step of
 * 2^-24, whose lower bits are the other number's in reverse order. All 2^48 pairs then lead to different places,
 * and a cell that only one step of one axis leads to is met as often as it should be. Within a step nothing else
 * changes: strata and sequences stay what they are. Numbers that are finer than a step keep their own bits. */
ACDF_FN void acdf_widen(float u0, float u1, double u[2]) {
    double x[2];
    uint32_t step[2];
    int i;
    x[0] = u0 > 0.0f ? (u0 < 1.0f ? (double)u0 * 0x1p24 : 0x1p24 - 1.0) : 0.0;
    x[1] = u1 > 0.0f ? (u1 < 1.0f ? (double)u1 * 0x1p24 : 0x1p24 - 1.0) : 0.0;
    for (i = 0; i < 2; ++i) step[i] = (uint32_t)x[i];
    for (i = 0; i < 2; ++i) {
        const double fraction = x[i] - (double)step[i];
        u[i] = ((double)step[i] + (fraction > 0.0 ? fraction : (double)acdf_reverse24(step[1 - i]) * 0x1p-24)) *
               0x1p-24;
    }
}

/* The direction that what is left of the random numbers picks in a cell of probability p. */
ACDF_FN AcdfDirectionSample acdf_sphere_place(uint32_t columns, uint32_t rows, const AcdfRange range[2],
                                              const double u[2], double p) {
    AcdfDirectionSample out;
    double tx, tz, x, z, z0, z1, sin_theta, sine, cosine, border;
    tx = acdf_tilt_sample(range[0].tilt, u[0]);
    border = (double)columns * (ACDF_BORDER / (2.0 * ACDF_PI));
    x = (double)range[0].low + tx * (double)(range[0].high - range[0].low);
    x = acdf_clamp(x, (double)range[0].low + border, (double)range[0].high - border);

    tz = acdf_tilt_sample(range[1].tilt, u[1]);
    z0 = acdf_row_z(range[1].low, rows);
    z1 = acdf_row_z(range[1].high, rows);
    z = z0 + tz * (z1 - z0);
    sin_theta = sqrt((1.0 - z) * (1.0 + z));
    border = ACDF_BORDER * sin_theta;
    z = acdf_clamp(z, z1 + border, z0 - border);
    z = acdf_clamp(z, -1.0 + 0.5 * ACDF_BORDER * ACDF_BORDER, 1.0 - 0.5 * ACDF_BORDER * ACDF_BORDER);
    sin_theta = sqrt((1.0 - z) * (1.0 + z));

    acdf_sincospi(1.0 - 2.0 * x / (double)columns, &sine, &cosine);
    out.direction[0] = (float)(sin_theta * cosine);
    out.direction[1] = (float)(sin_theta * sine);
    out.direction[2] = (float)z;
    out.pdf = acdf_cell_pdf(p, range[0].high - range[0].low, columns, z0 - z1,
                            acdf_tilt_density(range[0].tilt, tx) * acdf_tilt_density(range[1].tilt, tz));
    return out;
}

/* The grid square of a direction, and where on the columns axis it lies. Returns 0 for directions that are NaN or
 * whose length differs from 1 by more than about 5e-4. */
ACDF_FN int acdf_sphere_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2],
                               double* column) {
    const double x = direction[0], y = direction[1], z = direction[2];
    const double sin2 = x * x + y * y;
    const double length = sqrt(sin2 + z * z);
    if (!acdf_are_finite(direction) || !(length > 0.9995 && length < 1.0005)) return 0;
    *column = (double)columns * (0.5 - 0.5 * acdf_atan2pi(y, x));
    if (*column >= (double)columns) *column = 0.0; /* phi = -pi is phi = +pi */
    if (*column < 0.0) *column = 0.0;
    square[0] = (uint32_t)*column;
    square[1] = (uint32_t)((double)rows * acdf_atan2pi(sqrt(sin2), z));
    if (square[1] >= rows) square[1] = rows - 1;
    return 1;
}

/* The fractions t[axis] at which a direction lies across its cell (t[1] in z, from z0 down by dz). */
ACDF_FN void acdf_sphere_fractions(const float direction[3], double column, const AcdfRange range[2], double z0,
                                   double dz, double t[2]) {
    const double x = direction[0], y = direction[1], z = direction[2];
    const double sin2 = x * x + y * y;
    const double length = sqrt(sin2 + z * z);
    const double cap =
        sin2 / (length * (length + fabs(z))); /* 1 - |cos(theta)|, exact near the poles where z is not */
    t[0] = acdf_clamp((column - (double)range[0].low) / (double)(range[0].high - range[0].low), 0.0, 1.0);
    t[1] = acdf_clamp((z0 - (z < 0.0 ? cap - 1.0 : 1.0 - cap)) / dz, 0.0, 1.0);
}

/* Draws a direction. u0 (phi) and u1 (theta) in [0, 1]; values outside are clamped, NaN counts as 0.
 * Monotone in each of them within a segment: strata of random numbers stay strata of directions. */
ACDF_FN AcdfDirectionSample acdf_environment_sample(const AcdfEnvironment* env, double u0, double u1) {
    double u[2], p;
    AcdfRange range[2];
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = acdf_tree_sample(env->tree, env->root, u, range);
    return acdf_sphere_place(env->columns, env->rows, range, u, p);
}

/* Where a direction falls: its cell and, if `strata` is not null, the random numbers that lead there; if that
 * or a tilt asks for them, also the fractions t[axis] across the cell (t[1] in z). Returns the cell's
 * probability; 0 for directions that are NaN or whose length differs from 1 by more than about 5e-4. */
ACDF_FN double acdf_environment_find(const AcdfEnvironment* env, const float direction[3], AcdfRange range[2],
                                     double t[2], double dz[1], AcdfStratum* strata) {
    double column, p, z0;
    uint32_t square[2];
    if (!acdf_sphere_square(env->columns, env->rows, direction, square, &column)) return 0.0;
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = acdf_tree_find(env->tree, env->root, square, range, strata);
    z0 = acdf_row_z(range[1].low, env->rows);
    dz[0] = z0 - acdf_row_z(range[1].high, env->rows);
    t[0] = t[1] = 0.5;
    if (strata || range[0].tilt != 0.0 || range[1].tilt != 0.0)
        acdf_sphere_fractions(direction, column, range, z0, dz[0], t);
    return p;
}

/* Density per steradian with which acdf_environment_sample draws `direction` (unit). 0 where none falls,
 * and for directions that are NaN or not of unit length. */
ACDF_FN float acdf_environment_pdf(const AcdfEnvironment* env, const float direction[3]) {
    AcdfRange range[2];
    double t[2], dz[1];
    const double p = acdf_environment_find(env, direction, range, t, dz, 0);
    if (!(p > 0.0)) return 0.0f;
    return acdf_cell_pdf(p, range[0].high - range[0].low, env->columns, dz[0],
                         acdf_tilt_density(range[0].tilt, t[0]) * acdf_tilt_density(range[1].tilt, t[1]));
}

/* The random numbers u[2] for which acdf_environment_sample returns `direction`. Returns 1, or 0 (and u
 * unset) where the density is 0. */
ACDF_FN int acdf_environment_invert(const AcdfEnvironment* env, const float direction[3], double u[2]) {
    AcdfRange range[2];
    AcdfStratum strata[2];
    double t[2], dz[1];
    int axis;
    strata[0].low = strata[1].low = 0.0;
    strata[0].width = strata[1].width = 1.0;
    if (!(acdf_environment_find(env, direction, range, t, dz, strata) > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis)
        u[axis] = strata[axis].low + strata[axis].width * acdf_tilt_cdf(range[axis].tilt, t[axis]);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
