// Eight boxes at a time: those of each half are moved together in a register.
#if ACDF_WAVEFRONT_X86
#include "box_lists.h"

#include <immintrin.h>

namespace {

struct HalvingEight {
    __m512i low_mask, low_middle, high_mask, high_middle;

    explicit HalvingEight(const acdf::Halving& by)
        : low_mask(_mm512_set1_epi64(static_cast<long long>(by.low_mask))),
          low_middle(_mm512_set1_epi64(static_cast<long long>(by.low_middle))),
          high_mask(_mm512_set1_epi64(static_cast<long long>(by.high_mask))),
          high_middle(_mm512_set1_epi64(static_cast<long long>(by.high_middle))) {}
    unsigned begin_below(__mmask8 of, __m512i boxes) const {
        return _mm512_mask_cmplt_epi64_mask(of, _mm512_and_si512(boxes, low_mask), low_middle);
    }
    unsigned reach(__mmask8 of, __m512i boxes) const {
        return _mm512_mask_cmpge_epi64_mask(of, _mm512_and_si512(boxes, high_mask), high_middle);
    }
};

std::size_t bits_in(unsigned mask) { return static_cast<std::size_t>(__builtin_popcount(mask)); }

__mmask8 first_eight(std::size_t count) { return static_cast<__mmask8>(count < 8 ? (1u << count) - 1 : 0xFFu); }

void put_boxes(acdf::ListedBox* out, unsigned mask, __m512i boxes) {
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi64(static_cast<__mmask8>(mask), boxes));
}

acdf::HalvedCounts halve_eight(acdf::ListedBox* list, std::size_t count, const acdf::Halving& across,
                               acdf::ListedBox* upper) noexcept {
    const HalvingEight by(across);
    acdf::HalvedCounts counts = {0, 0};
    for (std::size_t i = 0; i < count; i += 8) {
        const __m512i boxes = _mm512_loadu_si512(list + i);
        const __mmask8 there = first_eight(count - i);
        const unsigned below = by.begin_below(there, boxes), above = by.reach(there, boxes);
        put_boxes(list + counts.lower, below, boxes);
        put_boxes(upper + counts.upper, above, boxes);
        counts.lower += bits_in(below);
        counts.upper += bits_in(above);
    }
    return counts;
}

void count_cuts_of_eight(const acdf::ListedBox* list, std::size_t count, std::size_t step,
                         const acdf::Halving across[2], std::size_t cut[2]) noexcept {
    const HalvingEight by[2] = {HalvingEight(across[0]), HalvingEight(across[1])};
    const __m512i at = _mm512_mullo_epi64(_mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0),
                                          _mm512_set1_epi64(static_cast<long long>(step)));
    cut[0] = cut[1] = 0;
    for (std::size_t i = 0; i < count; i += 8 * step) {
        const __mmask8 there = first_eight((count - i + step - 1) / step);
        const __m512i boxes = step == 1
                                  ? _mm512_maskz_loadu_epi64(there, list + i)
                                  : _mm512_mask_i64gather_epi64(_mm512_setzero_si512(), there, at, list + i, 8);
        for (int axis = 0; axis < 2; ++axis)
            cut[axis] += bits_in(by[axis].begin_below(there, boxes) & by[axis].reach(there, boxes));
    }
}

} // namespace

const acdf::BoxLists acdf::box_lists_avx512 = {halve_eight, count_cuts_of_eight};
#endif
