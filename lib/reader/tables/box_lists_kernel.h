// Lists of boxes that are halved some boxes at a time, those of each half moved together in a register. One source
// a set of instructions, compiled for it; internal linkage: no linker mixes what was compiled for others.
#pragma once

#include "tables/box_lists.h"

#include <immintrin.h>

namespace {

/// Halves boxes as an acdf::Halving tells. `Boxes` is a vector of them, whose functions tell of each box as a bit.
template <class Boxes>
struct Halver {
    Boxes low_mask, low_middle, high_mask, high_middle;

    explicit Halver(const acdf::Halving& by)
        : low_mask(Boxes::all(by.low_mask)), low_middle(Boxes::all(by.low_middle)),
          high_mask(Boxes::all(by.high_mask)), high_middle(Boxes::all(by.high_middle)) {}
    unsigned begin_below(Boxes boxes) const { return low_middle.above(boxes, low_mask); }
    unsigned reach(Boxes boxes) const { return ~high_middle.above(boxes, high_mask); }
};

/// The first `count` boxes of a vector.
template <class Boxes>
unsigned first_boxes(std::size_t count) {
    return (1u << (count < Boxes::kCount ? count : Boxes::kCount)) - 1;
}

std::size_t boxes_in(unsigned mask) { return static_cast<std::size_t>(__builtin_popcount(mask)); }

template <class Boxes>
acdf::HalvedCounts halve_boxes(acdf::ListedBox* list, std::size_t count, const acdf::Halving& across,
                               acdf::ListedBox* upper) noexcept {
    const Halver<Boxes> by(across);
    acdf::HalvedCounts counts = {0, 0};
    for (std::size_t i = 0; i < count; i += Boxes::kCount) {
        const Boxes boxes = Boxes::load(list + i);
        const unsigned there = first_boxes<Boxes>(count - i), below = by.begin_below(boxes) & there,
                       above = by.reach(boxes) & there;
        boxes.put_packed(list + counts.lower, below);
        boxes.put_packed(upper + counts.upper, above);
        counts.lower += boxes_in(below);
        counts.upper += boxes_in(above);
    }
    return counts;
}

template <class Boxes>
void count_cut_boxes(const acdf::ListedBox* list, std::size_t count, std::size_t step,
                     const acdf::Halving across[2], std::size_t cut[2]) noexcept {
    const Halver<Boxes> by[2] = {Halver<Boxes>(across[0]), Halver<Boxes>(across[1])};
    cut[0] = cut[1] = 0;
    for (std::size_t i = 0; i < count; i += Boxes::kCount * step) {
        const std::size_t left = (count - i + step - 1) / step;
        const unsigned there = first_boxes<Boxes>(left);
        const Boxes boxes = step == 1 ? Boxes::load(list + i) : Boxes::gather(list + i, step, left);
        for (int axis = 0; axis < 2; ++axis)
            cut[axis] += boxes_in(by[axis].begin_below(boxes) & by[axis].reach(boxes) & there);
    }
}

template <class Boxes>
constexpr acdf::BoxLists kListsOf = {halve_boxes<Boxes>, count_cut_boxes<Boxes>};

} // namespace
