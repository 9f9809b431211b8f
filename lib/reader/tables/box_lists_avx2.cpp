// Four boxes at a time, moved together as a table tells.
#if ACDF_WAVEFRONT_X86
#include "tables/box_lists_kernel.h"

namespace {

// Which halves of boxes come next to each other, for each set of four boxes.
struct PackedHalves {
    alignas(32) std::int32_t of[16][8];

    constexpr PackedHalves() : of() {
        for (int mask = 0; mask < 16; ++mask) {
            int count = 0;
            for (int box = 0; box < 4; ++box)
                for (int half = 0; half < 2; ++half)
                    if (mask >> box & 1) of[mask][count++] = 2 * box + half;
        }
    }
};
constexpr PackedHalves kPackedHalves;

struct FourBoxes {
    static constexpr std::size_t kCount = 4;
    __m256i boxes;

    static FourBoxes all(acdf::ListedBox box) { return {_mm256_set1_epi64x(static_cast<long long>(box))}; }
    static FourBoxes load(const acdf::ListedBox* list) {
        return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(list))};
    }
    static FourBoxes gather(const acdf::ListedBox* list, std::size_t step, std::size_t count) {
        const auto at = [&](std::size_t k) { return static_cast<long long>(list[k < count ? k * step : 0]); };
        return {_mm256_set_epi64x(at(3), at(2), at(1), at(0))};
    }
    unsigned above(FourBoxes others, FourBoxes mask) const {
        const __m256i is_above = _mm256_cmpgt_epi64(boxes, _mm256_and_si256(others.boxes, mask.boxes));
        return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(is_above)));
    }
    void put_packed(acdf::ListedBox* out, unsigned of) const {
        const __m256i which = _mm256_load_si256(reinterpret_cast<const __m256i*>(kPackedHalves.of[of]));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(boxes, which));
    }
};

} // namespace

const acdf::BoxLists acdf::box_lists_avx2 = kListsOf<FourBoxes>;
#endif
