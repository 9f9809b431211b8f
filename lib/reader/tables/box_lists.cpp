#include "tables/box_lists.h"

namespace acdf {

HalvedCounts halve_boxes(ListedBox* list, std::size_t count, const Halving& across, ListedBox* upper) noexcept {
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

void count_cut_boxes(const ListedBox* list, std::size_t count, std::size_t step, const Halving across[2],
                     std::size_t cut[2]) noexcept {
    cut[0] = cut[1] = 0;
    for (std::size_t i = 0; i < count; i += step)
        for (int axis = 0; axis < 2; ++axis) { // begins below and does not end there
            const Halving& by = across[axis];
            cut[axis] += (list[i] & by.low_mask) < by.low_middle;
            cut[axis] -= (list[i] & by.high_mask) < by.high_middle;
        }
}

} // namespace acdf
