// Eight boxes at a time.
#if ACDF_WAVEFRONT_X86
#include "tables/box_lists_kernel.h"

namespace {

struct EightBoxes {
    static constexpr std::size_t kCount = 8;
    __m512i boxes;

    static EightBoxes all(acdf::ListedBox box) { return {_mm512_set1_epi64(static_cast<long long>(box))}; }
    static EightBoxes load(const acdf::ListedBox* list) { return {_mm512_loadu_si512(list)}; }
    static EightBoxes gather(const acdf::ListedBox* list, std::size_t step, std::size_t count) {
        const __m512i at = _mm512_mullo_epi64(_mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0),
                                              _mm512_set1_epi64(static_cast<long long>(step)));
        const auto there = static_cast<__mmask8>(count < kCount ? (1u << count) - 1 : 0xFFu);
        return {_mm512_mask_i64gather_epi64(_mm512_setzero_si512(), there, at, list, 8)};
    }
    unsigned above(EightBoxes others, EightBoxes mask) const {
        return _mm512_cmpgt_epi64_mask(boxes, _mm512_and_si512(others.boxes, mask.boxes));
    }
    void put_packed(acdf::ListedBox* out, unsigned of) const {
        _mm512_storeu_si512(out, _mm512_maskz_compress_epi64(static_cast<__mmask8>(of), boxes));
    }
};

} // namespace

const acdf::BoxLists acdf::box_lists_avx512 = kListsOf<EightBoxes>;
#endif
