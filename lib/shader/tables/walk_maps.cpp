#include "shader/tables/walk_maps.h"

#include "shader/tables/walk_cells.h"

#include <initializer_list>

namespace acdf {

namespace {

using u32 = std::uint32_t;

} // namespace

bool WalkMaps::make(const AcdfIndexed& maps) noexcept {
    if (!words_.add(ACDF_MAPS_WORDS, 0)) return false;
    words_[ACDF_MAPS_COUNT] = maps.top->maps;
    words_[ACDF_MAPS_ROOTS] = maps.sun > 0 ? maps.sun - 1 : 0;
    words_[ACDF_MAPS_TOTAL] = float_bits(maps.total);
    add_coordinates(maps);
    add_maps(maps);
    return !words_.failed() && add_shares(*maps.top) && !words_.failed();
}

void WalkMaps::add_coordinates(const AcdfIndexed& maps) noexcept {
    const double* coordinates = maps.coordinates;
    u32 step = 1;
    for (u32 axis = maps.axes; axis-- > 0; step *= maps.counts[axis]) words_[ACDF_MAPS_STEPS + axis] = step;
    for (u32 axis = 0; axis < 3; ++axis) {
        const bool is_there = axis < maps.axes;
        words_[ACDF_MAPS_COUNTS + axis] = is_there ? maps.counts[axis] : 1;
        words_[ACDF_MAPS_COORDINATES + axis] = static_cast<u32>(words_.size());
        for (u32 i = 0; is_there && i < maps.counts[axis]; ++i) words_.add(float_bits(*coordinates++));
    }
}

void WalkMaps::add_maps(const AcdfIndexed& maps) noexcept {
    words_[ACDF_MAPS_MAPS] = static_cast<u32>(words_.size());
    for (u32 i = 0; i < maps.top->maps; ++i) {
        const AcdfMap& map = maps.maps[i];
        for (const float number : {map.share, map.sun_share, map.radius, map.sun[0], map.sun[1], map.sun[2]})
            words_.add(acdf_float_bits(number));
    }
}

// Splits stand level by level, so that what leads to one is known before it.
bool WalkMaps::add_shares(const AcdfTop& top) noexcept {
    const auto* splits = ACDF_TOP_ARRAY(AcdfTopSplit, &top, top.top);
    const u32* lower = ACDF_TOP_ARRAY(u32, &top, top.lower);
    const std::size_t maps = top.maps, all = maps * top.splits;
    Growable<u32> steps; // that lead to each split, of each map
    words_[ACDF_MAPS_SHARES] = static_cast<u32>(words_.size());
    if (all == 0) return true;
    if (!steps.add(all, ACDF_STEPS) || !words_.reserve(words_.size() + all)) return false;
    for (std::size_t split = 0; split < top.splits; ++split)
        for (std::size_t map = 0; map < maps; ++map) {
            const u32 below = lower[split * maps + map], above = steps[split * maps + map] - below;
            for (u32 upper = 0; upper < 2; ++upper)
                if (const u32 child = splits[split].child[upper]; !(child & ACDF_TOP_TILE))
                    steps[child * maps + map] = upper ? above : below;
            words_.add(below + above > 0 ? chance_of(below, above) : 0);
        }
    return true;
}

void WalkMaps::place(u32* words, std::size_t at) const noexcept {
    u32* const out = words + at;
    std::memcpy(out, words_.data(), words_.bytes());
    words[ACDF_WALK_MAPS] = static_cast<u32>(at);
    for (const u32 offset : {ACDF_MAPS_COORDINATES, ACDF_MAPS_COORDINATES + 1, ACDF_MAPS_COORDINATES + 2,
                             ACDF_MAPS_MAPS, ACDF_MAPS_SHARES})
        out[offset] += static_cast<u32>(at);
}

} // namespace acdf
