/* Curves and trees of curves (SPEC.md §7): sampling a cell, and finding the one that holds a point. Valid C99 and
 * C++17. */
#ifndef ACDF_CURVES_TREE_H
#define ACDF_CURVES_TREE_H

#include <acdf/layout.h>
#include <acdf/range.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The part of one axis that a cell covers, and the slope of the pdf across it. */
typedef struct AcdfTiltedRange {
    uint32_t low, high; /* positions on the axis, low < high */
    double tilt;        /* s: the pdf varies as 1 + s (2t - 1) for t in [0, 1] across the range */
} AcdfTiltedRange;

/* The same without the slope. */
ACDF_FN AcdfRange acdf_untilted(const AcdfTiltedRange* tilted) {
    AcdfRange range;
    range.low = tilted->low;
    range.high = tilted->high;
    return range;
}

/* All `resolution` steps of an axis. */
ACDF_FN AcdfTiltedRange acdf_whole_axis(uint32_t resolution) {
    AcdfTiltedRange range;
    range.low = 0;
    range.high = resolution;
    range.tilt = 0.0;
    return range;
}

/* Where in [0, 1] a tilted pdf puts u: solves t + s (t^2 - t) = u without cancellation. */
ACDF_FN double acdf_tilt_sample(double tilt, double u) {
    const double a = 1.0 - tilt;
    return tilt == 0.0 ? u : 2.0 * u / (a + sqrt(a * a + 4.0 * tilt * u));
}
ACDF_FN double acdf_tilt_cdf(double tilt, double t) { return t + tilt * (t * t - t); }
ACDF_FN double acdf_tilt_pdf(double tilt, double t) { return 1.0 + tilt * (2.0 * t - 1.0); }

/* One curve where it lies in its tree. */
typedef struct AcdfCurve {
    uint32_t header;
    uint32_t segments;
    const uint8_t* cumulative; /* segments - 1 interior values; 0 and the maximum are implied */
    const uint8_t* positions;  /* segments - 1 interior knots; the ends are those of the range so far */
    const uint8_t* links;      /* distance to each child; 0: the segment ends */
    const uint8_t* tilts;
} AcdfCurve;

/* The axis that it divides. */
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

/* The curve at offset `at`. */
ACDF_FN AcdfCurve acdf_curve_at(const uint8_t* tree, uint32_t at) {
    AcdfCurve curve;
    acdf_curve_decode(tree, at, &curve);
    return curve;
}

/* Element `index` of an array whose size code is `code`. */
ACDF_FN uint32_t acdf_load(const uint8_t* array, uint32_t index, uint32_t code) {
    if (code == 0) return array[index];
    return code == 1 ? ((const uint16_t*)(const void*)array)[index] : ((const uint32_t*)(const void*)array)[index];
}

/* How many of `count` nondecreasing values are <= key. Long arrays are halved without branches on the data. Few
 * values are passed one by one: a branch that is guessed lets the loads of the child start before the comparison is
 * done. Most curves are short, and their time is that of loads that wait for each other. */
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
ACDF_FN void acdf_curve_narrow(const AcdfCurve* curve, uint32_t i, AcdfTiltedRange* range) {
    const uint32_t code = ACDF_CURVE_POSITION_CODE(curve->header);
    const uint32_t origin = code == 0 ? range->low : 0;
    if (i > 0) range->low = origin + acdf_load(curve->positions, i - 1, code);
    if (i + 1 < curve->segments) range->high = origin + acdf_load(curve->positions, i, code);
    if (curve->tilts) range->tilt = ((const int16_t*)(const void*)curve->tilts)[i] / 32768.0;
}

/* Which segment holds a grid step of the curve's axis. */
ACDF_FN uint32_t acdf_curve_segment(const AcdfCurve* curve, uint32_t step, const AcdfTiltedRange* range) {
    const uint32_t code = ACDF_CURVE_POSITION_CODE(curve->header);
    return acdf_upper_bound(curve->positions, curve->segments - 1, code, code == 0 ? step - range->low : step);
}

/* Distance, in units of two bytes, to the child of segment i; 0 where it ends. */
ACDF_FN uint32_t acdf_curve_link(const AcdfCurve* curve, uint32_t i) {
    return curve->links ? acdf_load(curve->links, i, ACDF_CURVE_LINK_CODE(curve->header) - 1) : 0;
}

/* Samples a segment of a curve, as acdf_tree_sample does on its way. Returns the distance to its child, 0 where it
 * ends. */
ACDF_FN uint32_t acdf_curve_sample(const uint8_t* tree, uint32_t at, double* u, AcdfTiltedRange* range,
                                   double* probability) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    const uint32_t axis = acdf_curve_axis(&curve);
    const double maximum = (double)acdf_curve_maximum(&curve);
    double scaled = u[axis] * maximum;
    uint32_t i, low, width;
    if (scaled >= maximum) scaled = maximum * (1.0 - 0x1p-53);
    /* Segments of probability 0 are never entered: the bound lies above all equal values. */
    i = acdf_upper_bound(curve.cumulative, curve.segments - 1, ACDF_CURVE_CUMULATIVE_CODE(curve.header),
                         (uint32_t)scaled);
    low = acdf_curve_cumulative(&curve, i);
    width = acdf_curve_cumulative(&curve, i + 1) - low;
    u[axis] = (scaled - (double)low) / (double)width;
    *probability *= (double)width / maximum;
    acdf_curve_narrow(&curve, i, &range[axis]);
    return acdf_curve_link(&curve, i);
}

/* Samples a cell. In: u[axis] in [0, 1] and range[axis] = the whole axis with tilt 0, for each sampled axis.
 * Out: u[axis] in [0, 1] is what is left of the random number, uniform within the cell; range[axis] is the
 * cell. Returns the cell's probability, > 0. */
ACDF_FN double acdf_tree_sample(const uint8_t* tree, uint32_t root, double* u, AcdfTiltedRange* range) {
    double probability = 1.0;
    uint32_t link;
    do {
        link = acdf_curve_sample(tree, root, u, range, &probability);
        root += link;
    } while (link != 0);
    return acdf_positive(probability);
}

/* Finds the segment that holds a grid square, as acdf_tree_find does on its way. Returns the distance to its child,
 * 0 where it ends or has no probability. */
ACDF_FN uint32_t acdf_curve_find(const uint8_t* tree, uint32_t at, const uint32_t* square, AcdfTiltedRange* range,
                                 AcdfStratum* strata, double* probability) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    const uint32_t axis = acdf_curve_axis(&curve);
    const double maximum = (double)acdf_curve_maximum(&curve);
    const uint32_t i = acdf_curve_segment(&curve, square[axis], &range[axis]);
    const uint32_t low = acdf_curve_cumulative(&curve, i);
    const uint32_t width = acdf_curve_cumulative(&curve, i + 1) - low;
    *probability = *probability > 0.0 && width > 0 ? acdf_positive(*probability * ((double)width / maximum)) : 0.0;
    acdf_curve_narrow(&curve, i, &range[axis]);
    if (strata) {
        strata[axis].low += strata[axis].width * ((double)low / maximum);
        strata[axis].width *= (double)width / maximum;
    }
    return width == 0 ? 0 : acdf_curve_link(&curve, i);
}

/* Finds the cell that holds the unit grid square at[axis], at[axis] in [0, resolution). `range` as in
 * acdf_tree_sample; `strata` may be null, else strata[axis] = {0, 1} becomes the random numbers that lead
 * here. Returns the cell's probability, 0 where no sample can fall. */
ACDF_FN double acdf_tree_find(const uint8_t* tree, uint32_t root, const uint32_t* square, AcdfTiltedRange* range,
                              AcdfStratum* strata) {
    double probability = 1.0;
    uint32_t link;
    do {
        link = acdf_curve_find(tree, root, square, range, strata, &probability);
        root += link;
    } while (link != 0);
    return probability;
}

#ifdef __cplusplus
}
#endif
#endif
