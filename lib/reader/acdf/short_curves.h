/* Traversals of trees whose curves are mostly short: eight segments at most, with positions and links in bytes. A
 * segment of such a curve is found without a loop or a branch on the data: which is where a traversal of
 * acdf/tree.h waits. Cells, numbers and probabilities are those of that traversal to the bit. */
#ifndef ACDF_SHORT_CURVES_H
#define ACDF_SHORT_CURVES_H

#include <acdf/squares.h>
#include <acdf/tree.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifdef ACDF_SSE2

/* A short curve, cumulative values in one or two bytes. The functions below number its segments from 0. */
typedef struct AcdfShortCurve {
    const uint8_t* bytes; /* cumulative values; behind them positions, then links */
    uint32_t axis, inner; /* how many there are of the first two: segments - 1 */
    uint32_t wide;        /* cumulative values have 1 << wide bytes */
    uint32_t maximum;     /* the largest one */
    uint32_t link_mask;   /* 0: all segments end */
} AcdfShortCurve;

/* Returns 0 where the curve is none, or stands so near to the end of the tree (of `units` of two bytes) that what
 * is loaded from it is not all there. */
ACDF_INLINE int acdf_short_curve(const uint8_t* tree, uint32_t units, uint32_t at, AcdfShortCurve* curve) {
    const uint8_t* bytes = tree + 2 * (size_t)at;
    const uint32_t header = ((const uint16_t*)(const void*)bytes)[0];
    /* At most 2 + 14 + 7 + 8 bytes. Codes: all 0, but those of cumulative values and of links may be 1. */
    if (((header - (1u << ACDF_CURVE_SEGMENTS_SHIFT)) & 0xFFFFE370u) != 0 || (uint64_t)at + 16 > units) return 0;
    curve->bytes = bytes + 2;
    curve->axis = header & ACDF_CURVE_AXIS_MASK;
    curve->inner = (header >> ACDF_CURVE_SEGMENTS_SHIFT) - 1;
    curve->wide = header >> 3 & 1u;
    curve->maximum = 0xFFu | ((0u - curve->wide) & 0xFF00u);
    curve->link_mask = (0u - (header >> 7 & 1u)) & 0xFFu;
    return 1;
}

/* All ones for what is none of a curve's own numbers: those behind its inner ones. */
static const uint16_t acdf_beyond_curve[16] = {0,      0,      0,      0,      0,      0,      0,      0,
                                               0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF};

/* The inner ones of eight numbers, and all ones behind them. */
ACDF_INLINE __m128i acdf_inner_numbers(__m128i numbers, uint32_t inner) {
    return _mm_or_si128(numbers, _mm_loadu_si128((const __m128i*)(const void*)(acdf_beyond_curve + 8 - inner)));
}

/* Which of them is the first above a key, which is below 0xFFFF. */
ACDF_INLINE uint32_t acdf_first_above(__m128i numbers, uint32_t key) {
    const __m128i over = _mm_subs_epu16(numbers, _mm_set1_epi16((int16_t)key)); /* 0 where not above */
    return acdf_lowest_bit(~(uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi16(over, _mm_setzero_si128()))) >> 1;
}

/* Cumulative values as numbers of two bytes. */
ACDF_INLINE __m128i acdf_short_curve_values(const AcdfShortCurve* curve) {
    const __m128i pairs = _mm_loadu_si128((const __m128i*)(const void*)curve->bytes);
    const __m128i bytes = _mm_unpacklo_epi8(pairs, _mm_setzero_si128());
    const __m128i wide = _mm_set1_epi32(0 - (int32_t)curve->wide);
    return acdf_inner_numbers(_mm_or_si128(_mm_and_si128(wide, pairs), _mm_andnot_si128(wide, bytes)),
                              curve->inner);
}

/* The segment that a number below `maximum` samples; *low and *width as in acdf_short_curve_width. */
ACDF_INLINE uint32_t acdf_short_curve_sampled(const AcdfShortCurve* curve, uint32_t number, uint32_t* low,
                                              uint32_t* width) {
    const __m128i values = acdf_short_curve_values(curve);
    const uint32_t segment = acdf_first_above(values, number);
    uint16_t bound[9];
    bound[0] = 0;
    _mm_storeu_si128((__m128i*)(void*)(bound + 1), values);
    *low = bound[segment];
    *width = (bound[segment + 1] & curve->maximum) - *low;
    return segment;
}

/* The segment that holds a step, counted from the low end of the range. */
ACDF_INLINE uint32_t acdf_short_curve_found(const AcdfShortCurve* curve, uint32_t step) {
    const uint8_t* positions = curve->bytes + (curve->inner << curve->wide);
    const __m128i bytes = _mm_loadl_epi64((const __m128i*)(const void*)positions);
    return acdf_first_above(acdf_inner_numbers(_mm_unpacklo_epi8(bytes, _mm_setzero_si128()), curve->inner),
                            step < 255u ? step : 255u);
}

/* Cumulative values of a segment: *low, and how far the upper one is from it. */
ACDF_INLINE uint32_t acdf_short_curve_width(const AcdfShortCurve* curve, uint32_t segment, uint32_t* low) {
    uint16_t below, above;
    memcpy(&below, curve->bytes + (((int32_t)segment - 1) * (1 << curve->wide)), 2);
    memcpy(&above, curve->bytes + (segment << curve->wide), 2);
    *low = below & curve->maximum & (0u - (uint32_t)(segment > 0));
    return ((above | (0u - (uint32_t)(segment == curve->inner))) & curve->maximum) - *low;
}

/* Narrows a range to a segment. Returns the distance to its child, 0 where it ends. */
ACDF_INLINE uint32_t acdf_short_curve_narrow(const AcdfShortCurve* curve, uint32_t segment, AcdfRange* range) {
    const uint8_t* positions = curve->bytes + (curve->inner << curve->wide);
    const uint32_t origin = range->low, last = 0u - (uint32_t)(segment == curve->inner);
    const uint32_t high = origin + positions[segment];
    range->low = origin + (positions[(int32_t)segment - 1] & (0u - (uint32_t)(segment > 0)));
    range->high = high ^ ((high ^ range->high) & last);
    return positions[curve->inner + segment] & curve->link_mask;
}

#else

/* A short curve, cumulative values in bytes: three loads of eight bytes hold it, and behind its own those of
 * whatever follows. The functions below name a segment by eight times its number from 0. */
typedef struct AcdfShortCurve {
    uint64_t cumulative, positions, links;
    uint32_t axis, inner; /* how many of the first two are its own: segments - 1 */
    uint32_t maximum;     /* the largest cumulative value */
    uint32_t link_mask;   /* 0: all segments end */
} AcdfShortCurve;

ACDF_FN uint64_t acdf_eight_bytes(const uint8_t* at) {
#ifdef ACDF_ON_GPU /* which has no loads at odd addresses: two or three words instead of eight bytes */
    const uint32_t* words = (const uint32_t*)(const void*)((uintptr_t)at & ~(uintptr_t)3);
    const uint32_t shift = 8u * (uint32_t)((uintptr_t)at & 3u);
    const uint64_t low = words[0] | (uint64_t)words[1] << 32, high = words[shift ? 2 : 1];
    return shift ? low >> shift | high << (64u - shift) : low;
#else
    uint64_t bytes;
    memcpy(&bytes, at, sizeof bytes);
    return bytes;
#endif
}

/* Returns 0 where the curve is none, or stands so near to the end of the tree (of `units` of two bytes) that eight
 * bytes from within it are not all there. */
ACDF_INLINE int acdf_short_curve(const uint8_t* tree, uint32_t units, uint32_t at, AcdfShortCurve* curve) {
    const uint8_t* bytes = tree + 2 * (size_t)at;
    const uint32_t header = ((const uint16_t*)(const void*)bytes)[0];
    const uint32_t inner = (header >> ACDF_CURVE_SEGMENTS_SHIFT) - 1;
    /* At most 2 + 7 + 7 + 8 bytes. Codes: all 0, but that of links may be 1. */
    if (inner > 7 || (header & 0x0378u) != 0 || (uint64_t)at + 12 > units) return 0;
    curve->cumulative = acdf_eight_bytes(bytes + 2) | ~(uint64_t)0 << 8 * inner; /* the last one is 255 */
    curve->positions = acdf_eight_bytes(bytes + 2 + inner);
    curve->links = acdf_eight_bytes(bytes + 2 + 2 * inner);
    curve->axis = header & ACDF_CURVE_AXIS_MASK;
    curve->inner = inner;
    curve->maximum = 255;
    curve->link_mask = (0u - (header >> 7 & 1u)) & 0xFFu;
    return 1;
}

/* 8 times the number of the first of eight bytes that is above a key up to 255, or of byte `last`. */
ACDF_INLINE uint32_t acdf_first_above(uint64_t bytes, uint32_t key, uint32_t last) {
    const uint64_t high = 0x8080808080808080u, keys = key * (uint64_t)0x0101010101010101u;
    const uint64_t difference = (keys | high) - (bytes & ~high); /* bit 7: of the lower seven bits */
    const uint64_t not_above = (keys & ~bytes) | (~(keys ^ bytes) & difference);
    const uint64_t above = (~not_above & high) | (uint64_t)0x80 << 8 * last;
#if defined(ACDF_ON_GPU) && defined(__NVCC__)
    return ((uint32_t)__ffsll((long long)above) - 1u) & 56u;
#elif defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(above) & 56u;
#else
    uint32_t shift = 0;
    while (!(above >> shift & 0x80u)) shift += 8;
    return shift;
#endif
}

/* The bytes before and at a position; 0 before the first. */
ACDF_FN uint32_t acdf_byte_before(uint64_t bytes, uint32_t shift) {
    return (uint32_t)(bytes << 8 >> shift) & 0xFFu;
}
ACDF_FN uint32_t acdf_byte_at(uint64_t bytes, uint32_t shift) { return (uint32_t)(bytes >> shift) & 0xFFu; }

/* The segment that holds a step, counted from the low end of the range. */
ACDF_INLINE uint32_t acdf_short_curve_found(const AcdfShortCurve* curve, uint32_t step) {
    return acdf_first_above(curve->positions, step < 255u ? step : 255u, curve->inner);
}

/* Cumulative values of a segment: *low, and how far the upper one is from it. */
ACDF_INLINE uint32_t acdf_short_curve_width(const AcdfShortCurve* curve, uint32_t segment, uint32_t* low) {
    *low = acdf_byte_before(curve->cumulative, segment);
    return acdf_byte_at(curve->cumulative, segment) - *low;
}

/* The segment that a number below `maximum` samples; *low and *width as in acdf_short_curve_width. */
ACDF_INLINE uint32_t acdf_short_curve_sampled(const AcdfShortCurve* curve, uint32_t number, uint32_t* low,
                                              uint32_t* width) {
    const uint32_t segment = acdf_first_above(curve->cumulative, number, curve->inner);
    *width = acdf_short_curve_width(curve, segment, low);
    return segment;
}

/* Narrows a range to a segment. Returns the distance to its child, 0 where it ends. */
ACDF_INLINE uint32_t acdf_short_curve_narrow(const AcdfShortCurve* curve, uint32_t shift, AcdfRange* range) {
    const uint32_t origin = range->low, last = (uint32_t)(shift >= 8 * curve->inner);
    const uint32_t high = origin + acdf_byte_at(curve->positions, shift);
    range->low = origin + acdf_byte_before(curve->positions, shift);
    range->high = high ^ ((high ^ range->high) & (0u - last));
    return acdf_byte_at(curve->links, shift) & curve->link_mask;
}

#endif

/* Samples one segment, of whatever curve: as acdf_tree_sample does. Returns the distance to its child, 0 where it
 * ends. */
ACDF_INLINE uint32_t acdf_short_curve_sample(const uint8_t* tree, uint32_t units, uint32_t at, double* u,
                                             AcdfRange* range, double* probability) {
    AcdfShortCurve curve;
    uint32_t segment, low, width;
    double scaled, maximum;
    if (!acdf_short_curve(tree, units, at, &curve)) return acdf_curve_sample(tree, at, u, range, probability);
    maximum = (double)(int32_t)curve.maximum;
    scaled = u[curve.axis] * maximum;
    if (scaled >= maximum) scaled = maximum * (1.0 - 0x1p-53);
    segment = acdf_short_curve_sampled(&curve, (uint32_t)(int32_t)scaled, &low, &width);
    u[curve.axis] = (scaled - (double)(int32_t)low) / (double)(int32_t)width;
    *probability *= (double)(int32_t)width / maximum;
    return acdf_short_curve_narrow(&curve, segment, &range[curve.axis]);
}

/* acdf_tree_sample of a tree of `units`; 0: how many is not known. */
ACDF_INLINE double acdf_short_tree_sample(const uint8_t* tree, uint32_t units, uint32_t root, double* u,
                                          AcdfRange* range) {
    double probability = 1.0;
    uint32_t link;
    do {
        link = acdf_short_curve_sample(tree, units, root, u, range, &probability);
        root += link;
    } while (link != 0);
    return acdf_positive(probability);
}

/* Finds one segment, of whatever curve: as acdf_tree_find does. Returns the distance to its child, 0 where it ends.
 */
ACDF_INLINE uint32_t acdf_curve_locate(const uint8_t* tree, uint32_t units, uint32_t at, const uint32_t* square,
                                       AcdfRange* range, double* probability) {
    AcdfShortCurve curve;
    uint32_t segment, low, width;
    if (!acdf_short_curve(tree, units, at, &curve)) return acdf_curve_find(tree, at, square, range, 0, probability);
    segment = acdf_short_curve_found(&curve, square[curve.axis] - range[curve.axis].low);
    width = acdf_short_curve_width(&curve, segment, &low);
    *probability *= (double)(int32_t)width / (double)(int32_t)curve.maximum;
    return acdf_short_curve_narrow(&curve, segment, &range[curve.axis]);
}

/* acdf_tree_find, without strata, of such a tree. */
ACDF_INLINE double acdf_tree_locate(const uint8_t* tree, uint32_t units, uint32_t root, const uint32_t* square,
                                    AcdfRange* range) {
    double probability = 1.0;
    uint32_t link;
    do {
        link = acdf_curve_locate(tree, units, root, square, range, &probability);
        root += link;
    } while (link != 0);
    return probability > 0.0 ? acdf_positive(probability) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
