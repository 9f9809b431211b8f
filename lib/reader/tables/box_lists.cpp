#include "tables/box_lists.h"

#include "instructions.h"

namespace acdf {

namespace {

HalvedCounts halve_one_by_one(ListedBox* list, std::size_t count, const Halving& across,
                              ListedBox* upper) noexcept {
    HalvedCounts counts = {0, 0};
    const Halving by = across; // not to be read again after each store
    for (std::size_t i = 0; i < count; ++i) {
        const ListedBox box = list[i];
        list[counts.lower] = upper[counts.upper] = box;
        counts.lower += (box & by.low_mask) < by.low_middle;
        counts.upper += (box & by.high_mask) >= by.high_middle;
    }
    return counts;
}

void count_cuts_one_by_one(const ListedBox* list, std::size_t count, std::size_t step, const Halving across[2],
                           std::size_t cut[2]) noexcept {
    cut[0] = cut[1] = 0;
    for (std::size_t i = 0; i < count; i += step)
        for (int axis = 0; axis < 2; ++axis) { // begins below and does not end there
            const Halving& by = across[axis];
            cut[axis] += (list[i] & by.low_mask) < by.low_middle;
            cut[axis] -= (list[i] & by.high_mask) < by.high_middle;
        }
}

constexpr BoxLists kOneByOne = {halve_one_by_one, count_cuts_one_by_one};

} // namespace

const BoxLists& box_lists(Instructions most) noexcept {
    return *ACDF_BEST_OF(most, &kOneByOne, &box_lists_avx2, &box_lists_avx512);
}

} // namespace acdf
