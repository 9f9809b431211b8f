// Four boxes at a time: those of each half are moved together in a register, as a table tells.
#if ACDF_WAVEFRONT_X86
#include "box_lists.h"

#include <immintrin.h>

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

struct HalvingFour {
    __m256i low_mask, low_middle, high_mask, high_middle;

    explicit HalvingFour(const acdf::Halving& by)
        : low_mask(_mm256_set1_epi64x(static_cast<long long>(by.low_mask))),
          low_middle(_mm256_set1_epi64x(static_cast<long long>(by.low_middle))),
          high_mask(_mm256_set1_epi64x(static_cast<long long>(by.high_mask))),
          high_middle(_mm256_set1_epi64x(static_cast<long long>(by.high_middle))) {}
    unsigned begin_below(__m256i boxes) const {
        return bits(_mm256_cmpgt_epi64(low_middle, _mm256_and_si256(boxes, low_mask)));
    }
    unsigned end_below(__m256i boxes) const {
        return bits(_mm256_cmpgt_epi64(high_middle, _mm256_and_si256(boxes, high_mask)));
    }
    static unsigned bits(__m256i boxes) {
        return static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(boxes)));
    }
};

std::size_t set_bits(unsigned mask) { return static_cast<std::size_t>(__builtin_popcount(mask)); }

unsigned first_four(std::size_t count) { return count < 4 ? (1u << count) - 1 : 0xFu; }

void put_packed(acdf::ListedBox* out, unsigned mask, __m256i boxes) {
    const __m256i which = _mm256_load_si256(reinterpret_cast<const __m256i*>(kPackedHalves.of[mask]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(boxes, which));
}

acdf::HalvedCounts halve_four(acdf::ListedBox* list, std::size_t count, const acdf::Halving& across,
                              acdf::ListedBox* upper) noexcept {
    const HalvingFour by(across);
    acdf::HalvedCounts counts = {0, 0};
    for (std::size_t i = 0; i < count; i += 4) {
        const __m256i boxes = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(list + i));
        const unsigned there = first_four(count - i), below = by.begin_below(boxes) & there,
                       above = ~by.end_below(boxes) & there;
        put_packed(list + counts.lower, below, boxes);
        put_packed(upper + counts.upper, above, boxes);
        counts.lower += set_bits(below);
        counts.upper += set_bits(above);
    }
    return counts;
}

void count_cuts_of_four(const acdf::ListedBox* list, std::size_t count, std::size_t step,
                        const acdf::Halving across[2], std::size_t cut[2]) noexcept {
    const HalvingFour by[2] = {HalvingFour(across[0]), HalvingFour(across[1])};
    cut[0] = cut[1] = 0;
    for (std::size_t i = 0; i < count; i += 4 * step) {
        const std::size_t left = (count - i + step - 1) / step;
        const acdf::ListedBox* const box = list + i;
        const auto at = [&](std::size_t k) { return static_cast<long long>(box[k < left ? k * step : 0]); };
        const __m256i boxes = step == 1 ? _mm256_loadu_si256(reinterpret_cast<const __m256i*>(box))
                                        : _mm256_set_epi64x(at(3), at(2), at(1), at(0));
        for (int axis = 0; axis < 2; ++axis)
            cut[axis] += set_bits(by[axis].begin_below(boxes) & ~by[axis].end_below(boxes) & first_four(left));
    }
}

} // namespace

const acdf::BoxLists acdf::box_lists_avx2 = {halve_four, count_cuts_of_four};
#endif
