#include "tables/indexed.h"

#include "check/bits.h"
#include "memory.h"

#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr u32 most_open_tops = 128; // nodes: a level of each axis, and one

u64 to_top_line(u64 words) { return (words + 15) / 16 * 16; }

// Offsets in words.
struct TopLayout {
    u64 nodes, heights, top, tiles, lower, of_tile, words;

    TopLayout(const Parts& parts, bool latlong) {
        const u64 splits = parts.maps->split_count, maps = parts.maps->map_count;
        nodes = to_top_line(words_for(8 * sizeof(AcdfTop)));
        heights = to_top_line(nodes + 2 * u64{parts.halving_count});
        top = to_top_line(heights + (latlong ? 2 * (u64{parts.axes[ACDF_AXIS_THETA].resolution} + 1) : 0));
        tiles = to_top_line(top + splits * (sizeof(AcdfTopSplit) / 4));
        lower = to_top_line(tiles + (splits + 1) * (sizeof(AcdfTopTile) / 4));
        of_tile = to_top_line(lower + splits * maps);
        words = of_tile + (splits + 1) * maps;
    }
};

class TopMaker {
public:
    TopMaker(const Parts& parts, AcdfTop* top)
        : parts_(parts), maps_(*parts.maps), top_(top), splits_(array<AcdfTopSplit>(top->top)),
          tiles_(array<AcdfTopTile>(top->tiles)) {}

    void run() {
        number_nodes();
        add_rows();
    }

private:
    template <class T>
    T* array(u32 offset) const {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(top_) + offset);
    }
    bool has_codes(u32 halving) const { return parts_.map_splits[halving / 8] >> halving % 8 & 1u; }

    // Splits and tiles in preorder.
    void number_nodes() {
        struct Open {
            u32 node, parent, upper;
            AcdfSpan steps[2];
        } open[most_open_tops];
        u32 waiting = 0, splits = 0, tiles = 0;
        Open& root = open[waiting++] = {};
        root.node = parts_.halving_count ? 0 : ACDF_LEAF;
        root.parent = ACDF_LEAF;
        root.steps[0] = root.steps[1] = {{0, ACDF_STEPS}};
        while (waiting > 0) {
            const Open at = open[--waiting];
            const bool split = at.node != ACDF_LEAF && has_codes(at.node);
            if (at.parent != ACDF_LEAF) splits_[at.parent].child[at.upper] = split ? splits : ACDF_TOP_TILE | tiles;
            if (!split) {
                tiles_[tiles++] = {at.node, {at.steps[0], at.steps[1]}};
                continue;
            }
            const AcdfHalving halving = parts_.halvings[at.node];
            const u32 axis = halving.link & 7u;
            splits_[splits].axis = axis;
            for (u32 upper = 2; upper-- > 0;) {
                Open& half = open[waiting++] = at;
                half.node =
                    halving.link >> (3 + upper) & 1u ? ACDF_LEAF : at.node + (upper ? halving.link >> 5 : 1);
                half.parent = splits;
                half.upper = upper;
                half.steps[axis].end[1 - upper] = halving.threshold;
            }
            ++splits;
        }
    }

    u32* row(u32 child) const {
        const u64 number = child & ~ACDF_TOP_TILE;
        return array<u32>(child & ACDF_TOP_TILE ? top_->of_tile : top_->lower) + number * maps_.map_count;
    }

    // Codes become steps. Until its turn comes the row of a split holds the steps that lead to it.
    void add_rows() {
        for (u32 map = 0; map < maps_.map_count; ++map)
            row(maps_.split_count ? 0 : ACDF_TOP_TILE)[map] = ACDF_STEPS;
        u32 share[1u << ACDF_MOST_CODE_BITS];
        for (u32 code = 0; code < 1u << maps_.code_bits; ++code)
            share[code] = acdf_halving_share(code, maps_.code_bits);
        for (u32 split = 0; split < maps_.split_count; ++split)
            for (u32 map = 0; map < maps_.map_count; ++map) {
                const u32 code = code_of(map, split), here = row(split)[map];
                const AcdfSpan steps = {{0, here}};
                const u32 lower = here > 0 ? acdf_halving_threshold(&steps, code, maps_.code_bits, share[code]) : 0;
                row(splits_[split].child[0])[map] = lower;
                row(splits_[split].child[1])[map] = here - lower;
                row(split)[map] = lower;
            }
    }

    u32 code_of(u32 map, u32 split) const {
        const auto* codes = parts_.map_splits + 4 * words_for(parts_.halving_count);
        const u64 at = (u64{map} * maps_.split_count + split) * maps_.code_bits;
        const u64 word = at / 32, end = words_for(u64{maps_.map_count} * maps_.split_count * maps_.code_bits);
        u64 held = load_u32(codes + 4 * word);
        if (word + 1 < end) held |= u64{load_u32(codes + 4 * word + 4)} << 32;
        return static_cast<u32>(held >> at % 32) & ((1u << maps_.code_bits) - 1);
    }

    const Parts& parts_;
    const AcdfMapsHeader& maps_;
    AcdfTop* top_;
    AcdfTopSplit* splits_;
    AcdfTopTile* tiles_;
};

AcdfTop* make_top(const Parts& parts, const AcdfAllocator& allocator, AcdfBlock& block) {
    const bool latlong = parts.description->parameterization == ACDF_PARAM_LATLONG;
    const TopLayout layout(parts, latlong);
    if (layout.words > 0xFFFFFFFFu || layout.words > SIZE_MAX / 4) return nullptr;
    block = take_block(allocator, static_cast<std::size_t>(4 * layout.words));
    if (!block.data) return nullptr;
    auto* top = static_cast<AcdfTop*>(block.data);
    *top = {static_cast<u32>(layout.words),
            parts.maps->map_count,
            parts.maps->split_count,
            static_cast<u32>(layout.nodes),
            latlong ? static_cast<u32>(layout.heights) : 0,
            static_cast<u32>(layout.top),
            static_cast<u32>(layout.tiles),
            static_cast<u32>(layout.lower),
            static_cast<u32>(layout.of_tile)};
    u32* words = static_cast<u32*>(block.data);
    if (parts.halving_count)
        std::memcpy(words + top->nodes, parts.halvings, parts.halving_count * sizeof(AcdfHalving));
    const u32 rows = parts.axes[ACDF_AXIS_THETA].resolution;
    if (latlong)
        for (u32 row = 0; row <= rows; ++row)
            reinterpret_cast<double*>(words + top->heights)[row] = acdf_row_z(row, rows);
    TopMaker(parts, top).run();
    return top;
}

} // namespace

AcdfIndexed make_indexed(const Parts& parts, const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    AcdfIndexed out = {};
    out.columns = parts.axes[ACDF_AXIS_PHI].resolution;
    out.rows = parts.axes[ACDF_AXIS_THETA].resolution;
    out.parameterization = parts.description->parameterization;
    out.axes = parts.description->axis_count - 2;
    for (u32 axis = 0; axis < out.axes; ++axis) out.counts[axis] = parts.axes[2 + axis].resolution;
    out.sun = parts.maps->sun;
    out.total = parts.description->total;
    out.coordinates = parts.coordinates;
    out.maps = parts.of_map;
    out.top = make_top(parts, allocator, block);
    return out;
}

} // namespace acdf
