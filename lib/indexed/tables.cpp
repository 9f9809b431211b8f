#include "indexed/tables.h"

#include "reader/check/bits.h"
#include "reader/memory.h"
#include "reader/tables/top_tree.h"

namespace acdf {

namespace {

constexpr u32 most_levels = 64;

u64 to_top_line(u64 words) { return (words + 15) / 16 * 16; }

// Offsets in words.
struct TopLayout {
    u32 bits = 0;
    u64 top, tiles, lower, of_tile, starts, words;

    TopLayout(const Parts& parts, const AcdfMapsHeader& header) {
        const u64 splits = header.split_count, maps = header.map_count;
        bits = top_lookup_bits(parts, header.split_count);
        top = to_top_line(words_for(8 * sizeof(AcdfTop)));
        tiles = to_top_line(top + splits * (sizeof(AcdfTopSplit) / 4));
        lower = to_top_line(tiles + (splits + 1) * (sizeof(AcdfTopTile) / 4));
        of_tile = to_top_line(lower + splits * maps);
        starts = to_top_line(of_tile + (splits + 1) * maps);
        words = starts + (bits ? u64{1} << 2 * bits : 0);
    }
};

class TopMaker {
public:
    TopMaker(const Parts& parts, const Maps& maps, const double* heights, AcdfTop* top)
        : tree_(parts, maps.splits), maps_(*maps.header), heights_(heights),
          codes_(maps.splits + 4 * words_for(parts.halving_count)), top_(top),
          splits_(array<AcdfTopSplit>(top->top)), tiles_(array<AcdfTopTile>(top->tiles)) {
        for (u32 code = 0; code < 1u << maps_.code_bits; ++code)
            share_[code] = acdf_halving_share(code, maps_.code_bits);
    }

    void run() {
        tree_.for_each_split(tree_.root(), [&](u32, u32 level) { return ++first_[level + 1], true; });
        for (u32 level = 1; level <= most_levels; ++level) first_[level] += first_[level - 1];
        const u32 child = take(tree_.root(), 0);
        for (u32 map = 0; map < maps_.map_count; ++map) row(child)[map] = ACDF_STEPS;
        if (!(child & ACDF_TOP_TILE)) make_split(tree_.root(), child, 0);
        fill_top_starts(
            top_->bits, top_->position_scale, array<u32>(top_->starts),
            [&](u32 at, u32& axis, u32& middle) { axis = splits_[at].axis, middle = splits_[at].middle; },
            [&](u32 at, bool upper) { return splits_[at].child[upper]; });
    }

private:
    template <class T>
    T* array(u32 offset) const {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(top_) + offset);
    }
    // The number of the node that is visited, which is a split or becomes a tile.
    u32 take(u32 node, u32 level) {
        if (tree_.is_split(node)) return first_[level]++;
        tiles_[tile_count_] = tree_.tile(node, heights_);
        return ACDF_TOP_TILE | tile_count_++;
    }

    // In preorder, in which codes stand, and what is below. A split whose row is not made yet has there what leads
    // to it.
    void make_split(u32 node, u32 number, u32 level) {
        AcdfTopSplit& split = splits_[number];
        split.axis = tree_.axis_of(node);
        split.middle = acdf_span_middle(&tree_.box[split.axis]);
        for (u32 upper = 2; upper-- > 0;)
            tree_.narrowed(node, upper, [&](u32 half) { split.child[upper] = take(half, level + 1); });
        add_rows(split, number, rank_++);
        for (u32 upper = 0; upper < 2; ++upper)
            if (!(split.child[upper] & ACDF_TOP_TILE))
                tree_.narrowed(node, upper, [&](u32 half) { make_split(half, split.child[upper], level + 1); });
    }

    u32* row(u32 child) const {
        const u64 number = child & ~ACDF_TOP_TILE;
        return array<u32>(child & ACDF_TOP_TILE ? top_->of_tile : top_->lower) + number * maps_.map_count;
    }

    void add_rows(const AcdfTopSplit& split, u32 number, u32 rank) {
        u32 *const own = row(number), *const lower = row(split.child[0]), *const upper = row(split.child[1]);
        for (u32 map = 0; map < maps_.map_count; ++map) {
            const u32 code = code_of(map, rank);
            const AcdfSpan steps = {{0, own[map]}};
            const u32 below =
                own[map] > 0 ? acdf_halving_threshold(&steps, code, maps_.code_bits, share_[code]) : 0;
            lower[map] = below;
            upper[map] = own[map] - below;
            own[map] = below;
        }
    }

    u32 code_of(u32 map, u32 rank) const {
        const u64 at = (u64{map} * maps_.split_count + rank) * maps_.code_bits;
        const u64 word = at / 32, end = words_for(u64{maps_.map_count} * maps_.split_count * maps_.code_bits);
        u64 held = load_u32(codes_ + 4 * word);
        if (word + 1 < end) held |= u64{load_u32(codes_ + 4 * word + 4)} << 32;
        return static_cast<u32>(held >> at % 32) & ((1u << maps_.code_bits) - 1);
    }

    TopTree tree_;
    const AcdfMapsHeader& maps_;
    const double* heights_;
    const u8* codes_;
    AcdfTop* top_;
    AcdfTopSplit* splits_;
    AcdfTopTile* tiles_;
    u32 tile_count_ = 0, rank_ = 0;
    u32 first_[most_levels + 1] = {}; // the number of the next split of each level
    u32 share_[1u << ACDF_MOST_CODE_BITS];
};

} // namespace

AcdfTop* make_top(const Parts& parts, const Maps& maps, const double* heights, const AcdfAllocator& allocator,
                  AcdfBlock& block) noexcept {
    const TopLayout layout(parts, *maps.header);
    if (layout.words > 0xFFFFFFFFu || layout.words > SIZE_MAX / 4) return nullptr;
    block = take_block(allocator, static_cast<std::size_t>(4 * layout.words));
    if (!block.data) return nullptr;
    auto* top = static_cast<AcdfTop*>(block.data);
    *top = {};
    top->words = static_cast<u32>(layout.words);
    top->maps = maps.header->map_count;
    top->splits = maps.header->split_count;
    top->top = static_cast<u32>(layout.top);
    top->tiles = static_cast<u32>(layout.tiles);
    top->lower = static_cast<u32>(layout.lower);
    top->of_tile = static_cast<u32>(layout.of_tile);
    top->bits = layout.bits;
    top->starts = static_cast<u32>(layout.starts);
    for (u32 axis = 0; axis < 2; ++axis)
        top->position_scale[axis] = position_scale(parts.axes[axis].resolution, layout.bits);
    TopMaker(parts, maps, heights, top).run();
    return top;
}

} // namespace acdf
