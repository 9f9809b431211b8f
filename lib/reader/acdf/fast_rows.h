/* Tiles of the fast shape by rows that a point mixes (acdf/fast.h): what each tile gets, and which one a number
 * samples. By vectors of SSE2, whose results do not pass through memory in pieces, and without: the same integers.
 */
#ifndef ACDF_FAST_ROWS_H
#define ACDF_FAST_ROWS_H

#include <acdf/fast.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Rows within a group. */
typedef struct AcdfFastGroup {
#ifdef ACDF_SSE2
    __m128i weight; /* 16 bits each: b[k] of SPEC.md, at most 2^14, and 0 */
#else
    int32_t weight[ACDF_FAST_ROWS];
#endif
    double whole; /* their sum; 0: no row gives anything to the group */
    double mass;  /* s: of 32767 times the whole of the mixture, below 2^30 */
    double below; /* that of the groups before it */
} AcdfFastGroup;

/* A tile in its group. */
typedef struct AcdfFastTile {
    uint32_t number;
    double mass, below; /* t, and that of those before it */
} AcdfFastTile;

#ifdef ACDF_SSE2
/* The sum of four numbers, as a double. */
ACDF_INLINE double acdf_fast_sum(__m128i of) {
    const __m128i two = _mm_add_epi32(of, _mm_shuffle_epi32(of, 0x4E));
    return _mm_cvtsd_f64(_mm_cvtepi32_pd(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0xB1))));
}
ACDF_INLINE __m128i acdf_fast_weights(const AcdfFastMixture* mix) {
    return _mm_loadu_si128((const __m128i*)(const void*)mix->weight);
}

/* Sets the weights of a mixture whose rows are set: `rows` of them are positive, those behind 0. */
ACDF_INLINE void acdf_fast_mix(const double weight[ACDF_FAST_ROWS], const int rows, AcdfFastMixture* out) {
    const __m128d scale = _mm_set1_pd(acdf_fast_scale(weight[0] + weight[1] + weight[2]));
    const __m128i low = _mm_cvttpd_epi32(_mm_mul_pd(_mm_set_pd(weight[1], weight[0]), scale));
    const __m128i high = _mm_cvttpd_epi32(_mm_mul_pd(_mm_set_sd(weight[2]), scale));
    const __m128i whole =
        _mm_add_epi32(_mm_unpacklo_epi64(low, high), _mm_set_epi32(0, rows > 2, rows > 1, rows > 0));
    _mm_storeu_si128((__m128i*)(void*)out->weight, whole);
    out->whole = acdf_fast_sum(whole);
}

/* Four bytes of two cumulative values. */
ACDF_INLINE __m128i acdf_fast_two_ends(const uint16_t* ends) {
    int32_t both;
    memcpy(&both, ends, sizeof both);
    return _mm_cvtsi32_si128(both);
}

/* What the rows of a mixture give to a group. */
ACDF_INLINE AcdfFastGroup acdf_fast_find_group(const AcdfFastMixture* mix, uint32_t group) {
    const uint32_t inner = (uint32_t)(group > 0), at = group - inner;
    const __m128i low = _mm_set1_epi32(0xFFFF);
    /* Of the first group its end and the next one. */
    const __m128i ends = _mm_unpacklo_epi64(
        _mm_unpacklo_epi32(acdf_fast_two_ends(mix->group[0] + at), acdf_fast_two_ends(mix->group[1] + at)),
        acdf_fast_two_ends(mix->group[2] + at));
    const __m128i before = _mm_and_si128(ends, _mm_set1_epi32((int32_t)(0u - inner) & 0xFFFF));
    const __m128i end = _mm_and_si128(_mm_srl_epi32(ends, _mm_cvtsi32_si128((int32_t)(16u * inner))), low);
    const __m128i weights = acdf_fast_weights(mix), part = _mm_madd_epi16(_mm_sub_epi32(end, before), weights);
    AcdfFastGroup out;
    __m128i length, shift, most, weight;
    out.mass = acdf_fast_sum(part);
    out.below = acdf_fast_sum(_mm_madd_epi16(before, weights));
    /* Of the mass, 2^(length - 1) and more, weights of 14 bits leave out the lowest. */
    length = _mm_srli_epi64(_mm_castpd_si128(_mm_set_sd(out.mass)), 52);
    shift = _mm_subs_epu16(length, _mm_cvtsi32_si128(1023 + 13));
    most = _mm_sub_epi32(_mm_sll_epi32(_mm_set1_epi32(1), shift), _mm_set1_epi32(1));
    weight = _mm_srl_epi32(_mm_add_epi32(part, most), shift);
    out.whole = acdf_fast_sum(weight);
    out.weight = _mm_packs_epi32(weight, _mm_setzero_si128());
    return out;
}

/* t of tile i of a group; `first` is that of the group's first one. */
ACDF_INLINE double acdf_fast_find_tile(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                       uint32_t i) {
    /* What stands before the first row of tiles is of groups. */
    const uint8_t *row0 = mix->tile[0] + first + i - 1, *row1 = mix->tile[1] + first + i - 1,
                  *row2 = mix->tile[2] + first + i - 1;
    uint16_t both[3];
    __m128i ends, before;
    memcpy(&both[0], row0, sizeof both[0]);
    memcpy(&both[1], row1, sizeof both[1]);
    memcpy(&both[2], row2, sizeof both[2]);
    ends = _mm_insert_epi16(_mm_insert_epi16(_mm_cvtsi32_si128(both[0]), (int16_t)both[1], 1), (int16_t)both[2], 2);
    before = _mm_and_si128(ends, _mm_set1_epi16((int16_t)(0xFF & (0 - (int)(i > 0)))));
    return acdf_fast_sum(_mm_madd_epi16(_mm_sub_epi16(_mm_srli_epi16(ends, 8), before), group->weight));
}

/* The whole part of a number, four times: without a way through the other registers. */
ACDF_INLINE __m128i acdf_fast_floor(double x) { return _mm_shuffle_epi32(_mm_cvttpd_epi32(_mm_set_sd(x)), 0); }

/* Eight mixed ends (16 bits, of three rows). */
ACDF_INLINE void acdf_fast_mixed(const __m128i end[3], __m128i weight01, __m128i weight2, __m128i out[2]) {
    const __m128i zero = _mm_setzero_si128();
    out[0] = _mm_add_epi32(_mm_madd_epi16(_mm_unpacklo_epi16(end[0], end[1]), weight01),
                           _mm_madd_epi16(_mm_unpacklo_epi16(end[2], zero), weight2));
    out[1] = _mm_add_epi32(_mm_madd_epi16(_mm_unpackhi_epi16(end[0], end[1]), weight01),
                           _mm_madd_epi16(_mm_unpackhi_epi16(end[2], zero), weight2));
}

/* Bit i: whether number i of sixteen is above x. */
ACDF_INLINE uint32_t acdf_fast_above(const __m128i number[4], __m128i x) {
    return (uint32_t)_mm_movemask_epi8(
        _mm_packs_epi16(_mm_packs_epi32(_mm_cmpgt_epi32(number[0], x), _mm_cmpgt_epi32(number[1], x)),
                        _mm_packs_epi32(_mm_cmpgt_epi32(number[2], x), _mm_cmpgt_epi32(number[3], x))));
}

/* Sixteen mixed ends; weights of 16 bits, as acdf_fast_mix has them. */
ACDF_INLINE void acdf_fast_mixed_sixteen(const __m128i low[3], const __m128i high[3], __m128i weight,
                                         __m128i out[4]) {
    const __m128i pair01 = _mm_shuffle_epi32(weight, 0), pair2 = _mm_shuffle_epi32(weight, 0x55);
    acdf_fast_mixed(low, pair01, pair2, out);
    acdf_fast_mixed(high, pair01, pair2, out + 2);
}

/* Bit i: whether number i of sixteen mixed ends is above x. */
ACDF_INLINE uint32_t acdf_fast_sixteen(const __m128i low[3], const __m128i high[3], __m128i weight, __m128i x,
                                       __m128i sum[4]) {
    acdf_fast_mixed_sixteen(low, high, weight, sum);
    return acdf_fast_above(sum, x);
}

/* The first of mixed ends that is above x, in lists as long as a multiple of 16, from number `first` on, which is
 * one. */
ACDF_INLINE uint32_t acdf_fast_search(const uint16_t* const* list, uint32_t first, __m128i weight, __m128i x) {
    for (;; first += 16) {
        __m128i low[3], high[3], sum[4];
        uint32_t mask;
        int k;
        for (k = 0; k < 3; ++k) {
            low[k] = _mm_loadu_si128((const __m128i*)(const void*)(list[k] + first));
            high[k] = _mm_loadu_si128((const __m128i*)(const void*)(list[k] + first + 8));
        }
        mask = acdf_fast_sixteen(low, high, weight, x, sum);
        if (mask) return first + acdf_lowest_bit(mask);
    }
}

/* The first group whose end is above x, which is below the last one. */
ACDF_INLINE uint32_t acdf_fast_group_of(const AcdfFast* fast, const AcdfFastMixture* mix, double x) {
    const __m128i at = acdf_fast_floor(x), weight = _mm_packs_epi32(acdf_fast_weights(mix), _mm_setzero_si128());
    const uint32_t first = fast->upper ? 16 * acdf_fast_search(mix->upper, 0, weight, at) : 0;
    return acdf_fast_search(mix->group, first, weight, at);
}

/* The ends of the tiles of a group, which begin at `first`, in each row. */
ACDF_INLINE void acdf_fast_tile_rows(const AcdfFastMixture* mix, uint32_t first, __m128i low[3], __m128i high[3]) {
    const __m128i zero = _mm_setzero_si128();
    int k;
    for (k = 0; k < 3; ++k) {
        const __m128i bytes = _mm_loadu_si128((const __m128i*)(const void*)(mix->tile[k] + first));
        low[k] = _mm_unpacklo_epi8(bytes, zero);
        high[k] = _mm_unpackhi_epi8(bytes, zero);
    }
}

/* The same among the tiles of a group, which begin at `first`. */
ACDF_INLINE AcdfFastTile acdf_fast_tile_of(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                           double y) {
    __m128i low[3], high[3], sum[4];
    AcdfFastTile out;
    int32_t ends[20];
    uint32_t i;
    int k;
    acdf_fast_tile_rows(mix, first, low, high);
    i = acdf_lowest_bit(acdf_fast_sixteen(low, high, group->weight, acdf_fast_floor(y), sum));
    ends[3] = 0;
    for (k = 0; k < 4; ++k) _mm_storeu_si128((__m128i*)(void*)(ends + 4 + 4 * k), sum[k]);
    out.number = first + i;
    out.below = (double)ends[3 + i];
    out.mass = (double)(ends[4 + i] - ends[3 + i]);
    return out;
}
#else
ACDF_INLINE void acdf_fast_mix(const double weight[ACDF_FAST_ROWS], const int rows, AcdfFastMixture* out) {
    const double scale = acdf_fast_scale(weight[0] + weight[1] + weight[2]);
    int i;
    out->whole = 0.0;
    out->weight[ACDF_FAST_ROWS] = 0;
    for (i = 0; i < ACDF_FAST_ROWS; ++i) {
        out->weight[i] = (int32_t)(weight[i] * scale) + (int32_t)(i < rows);
        out->whole += (double)out->weight[i];
    }
}

/* How many lower bits of a mass, below 2^30, weights of 14 bits leave out. */
ACDF_INLINE uint32_t acdf_fast_shift(uint32_t mass) {
#if defined(ACDF_ON_GPU) && defined(__NVCC__)
    const uint32_t length = 32u - (uint32_t)__clz((int)(mass | 0x3FFFu));
#elif defined(__GNUC__)
    const uint32_t length = 32u - (uint32_t)__builtin_clz(mass | 0x3FFFu);
#else
    uint32_t length = 14;
    while (mass >> length) ++length;
#endif
    return length - 14;
}

ACDF_INLINE AcdfFastGroup acdf_fast_find_group(const AcdfFastMixture* mix, uint32_t group) {
    int32_t part[ACDF_FAST_ROWS], mass = 0, below = 0, whole = 0;
    AcdfFastGroup out;
    uint32_t shift;
    int k;
    for (k = 0; k < ACDF_FAST_ROWS; ++k) {
        const int32_t before = group > 0 ? mix->group[k][group - 1] : 0;
        below += mix->weight[k] * before;
        part[k] = mix->weight[k] * (mix->group[k][group] - before);
        mass += part[k];
    }
    shift = acdf_fast_shift((uint32_t)mass);
    for (k = 0; k < ACDF_FAST_ROWS; ++k) {
        out.weight[k] = (part[k] + (int32_t)((1u << shift) - 1u)) >> shift;
        whole += out.weight[k];
    }
    out.mass = (double)mass;
    out.below = (double)below;
    out.whole = (double)whole;
    return out;
}

/* The sum of the ends before tile i of a group that begins at `first`. */
ACDF_INLINE int32_t acdf_fast_tile_begin(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                         uint32_t i) {
    int32_t sum = 0;
    int k;
    for (k = 0; k < ACDF_FAST_ROWS && i > 0; ++k) sum += group->weight[k] * (int32_t)mix->tile[k][first + i - 1];
    return sum;
}
ACDF_INLINE double acdf_fast_find_tile(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                       uint32_t i) {
    return (double)(acdf_fast_tile_begin(mix, group, first, i + 1) - acdf_fast_tile_begin(mix, group, first, i));
}

ACDF_INLINE uint32_t acdf_fast_group_of(const AcdfFast* fast, const AcdfFastMixture* mix, double x) {
    uint32_t low = 0, high = fast->ends - 1;
    const int32_t at = (int32_t)x;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        int32_t sum = 0;
        int k;
        for (k = 0; k < ACDF_FAST_ROWS; ++k) sum += mix->weight[k] * (int32_t)mix->group[k][middle];
        if (sum > at) high = middle;
        else low = middle + 1;
    }
    return low;
}
ACDF_INLINE AcdfFastTile acdf_fast_tile_of(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                           double y) {
    uint32_t low = 0, high = ACDF_FAST_GROUP - 1;
    const int32_t at = (int32_t)y;
    AcdfFastTile out;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (acdf_fast_tile_begin(mix, group, first, middle + 1) > at) high = middle;
        else low = middle + 1;
    }
    out.number = first + low;
    out.below = (double)acdf_fast_tile_begin(mix, group, first, low);
    out.mass = acdf_fast_find_tile(mix, group, first, low);
    return out;
}
#endif

/* What the mixture gives to a tile, in units of 1 / (32767 * 255 * whole) of it. */
ACDF_INLINE AcdfFastShare acdf_fast_share(const AcdfFastMixture* mix, uint32_t tile) {
    const AcdfFastGroup group = acdf_fast_find_group(mix, tile / ACDF_FAST_GROUP);
    AcdfFastShare out;
    out.of = group.mass * acdf_fast_find_tile(mix, &group, tile & ~(ACDF_FAST_GROUP - 1u), tile % ACDF_FAST_GROUP);
    out.all = group.whole > 1.0 ? group.whole : 1.0; /* of dark groups all masses are 0 */
    return out;
}

/* Samples a tile by x, below 32767 times the whole of the mixture, and u[1] in [0, 1]; u becomes what is left of
 * the random numbers. *share becomes that of acdf_fast_share. */
ACDF_INLINE uint32_t acdf_fast_sample_tile(const AcdfFast* fast, const AcdfFastMixture* mix, double x, double* u,
                                           AcdfFastShare* share) {
    const uint32_t number = acdf_fast_group_of(fast, mix, x);
    const AcdfFastGroup group = acdf_fast_find_group(mix, number);
    const double y = acdf_fast_scaled(u[1], 255.0 * group.whole);
    const AcdfFastTile tile = acdf_fast_tile_of(mix, &group, ACDF_FAST_GROUP * number, y);
    u[0] = (x - group.below) / group.mass;
    u[1] = (y - tile.below) / tile.mass;
    share->of = group.mass * tile.mass;
    share->all = group.whole;
    return tile.number;
}

#ifdef __cplusplus
}
#endif
#endif
