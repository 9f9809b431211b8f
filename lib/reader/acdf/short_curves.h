/* Walks of trees whose curves are mostly short: eight segments at most, in bytes. Three loads of eight bytes hold
 * such a curve, and a segment is found among them without a loop or a branch on the data: which is where a walk of
 * acdf/tree.h waits. Cells, numbers and probabilities are those of that walk to the bit. */
#ifndef ACDF_SHORT_CURVES_H
#define ACDF_SHORT_CURVES_H

#include <acdf/tree.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A short curve: its bytes and, behind them, those of whatever follows. */
typedef struct AcdfShortCurve {
    uint64_t cumulative, positions, links;
    uint32_t axis, inner; /* how many of the first two are its own: segments - 1 */
    uint32_t link_mask;   /* 0: all segments end */
} AcdfShortCurve;

ACDF_FN uint64_t acdf_eight_bytes(const uint8_t* at) {
#ifdef ACDF_ON_GPU /* which has no loads at odd places: two or three words instead of eight bytes */
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

/* The bytes before and at a place; 0 before the first. */
ACDF_FN uint32_t acdf_byte_before(uint64_t bytes, uint32_t shift) {
    return (uint32_t)(bytes << 8 >> shift) & 0xFFu;
}
ACDF_FN uint32_t acdf_byte_at(uint64_t bytes, uint32_t shift) { return (uint32_t)(bytes >> shift) & 0xFFu; }

/* Narrows a range to the segment at a place. Returns the distance to its child, 0 where it ends. */
ACDF_INLINE uint32_t acdf_short_curve_narrow(const AcdfShortCurve* curve, uint32_t shift, AcdfRange* range) {
    const uint32_t origin = range->low, last = (uint32_t)(shift >= 8 * curve->inner);
    const uint32_t high = origin + acdf_byte_at(curve->positions, shift);
    range->low = origin + acdf_byte_before(curve->positions, shift);
    range->high = high ^ ((high ^ range->high) & (0u - last));
    return acdf_byte_at(curve->links, shift) & curve->link_mask;
}

/* acdf_tree_sample of a tree of `units`; 0: how many is not known. */
ACDF_INLINE double acdf_tree_draw(const uint8_t* tree, uint32_t units, uint32_t root, double* u, AcdfRange* range) {
    double probability = 1.0;
    AcdfShortCurve curve;
    uint32_t at = root, link = 0;
    do {
        uint32_t shift, low, width;
        double scaled;
        at += link;
        if (!acdf_short_curve(tree, units, at, &curve)) return acdf_tree_sample_on(tree, at, u, range, probability);
        scaled = u[curve.axis] * 255.0;
        if (scaled >= 255.0) scaled = 255.0 * (1.0 - 0x1p-53);
        shift = acdf_first_above(curve.cumulative, (uint32_t)scaled, curve.inner);
        low = acdf_byte_before(curve.cumulative, shift);
        width = acdf_byte_at(curve.cumulative, shift) - low;
        u[curve.axis] = (scaled - (double)low) / (double)width;
        probability *= (double)width / 255.0;
        link = acdf_short_curve_narrow(&curve, shift, &range[curve.axis]);
    } while (link != 0);
    return acdf_positive(probability);
}

/* acdf_tree_find, without strata, of a tree of `units`; 0: how many is not known. */
ACDF_INLINE double acdf_tree_locate(const uint8_t* tree, uint32_t units, uint32_t root, const uint32_t* square,
                                    AcdfRange* range) {
    double probability = 1.0;
    AcdfShortCurve curve;
    uint32_t at = root, link = 0;
    do {
        uint32_t shift, width, step;
        at += link;
        if (!acdf_short_curve(tree, units, at, &curve))
            return acdf_tree_find_on(tree, at, square, range, 0, probability);
        step = square[curve.axis] - range[curve.axis].low;
        shift = acdf_first_above(curve.positions, step < 255u ? step : 255u, curve.inner);
        width = acdf_byte_at(curve.cumulative, shift) - acdf_byte_before(curve.cumulative, shift);
        probability *= (double)width / 255.0;
        link = acdf_short_curve_narrow(&curve, shift, &range[curve.axis]);
    } while (link != 0);
    return probability > 0.0 ? acdf_positive(probability) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
