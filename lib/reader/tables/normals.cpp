#include "tables/normals.h"

#include "check/row_codes.h"
#include "memory.h"
#include "tables/top_lookup.h"

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr u64 kOddsCodes = 256;

u64 to_row_line(u64 words) { return (words + 15) / 16 * 16; }

// The least power of two whose square is at least a number of tiles: about as many groups as tiles in each.
u32 most_of_group(u64 tiles) {
    u32 most = 1;
    while (u64{most} * most < tiles) most *= 2;
    return most;
}

// Goes through the top of the tree in preorder: groups are its largest parts of at most so many tiles.
class TopWalk {
public:
    struct Open {
        u32 node;
        u32 parent; // and side: 2 split + upper
        bool grouped;
        AcdfSpan steps[2], box[2];
    };
    static constexpr u32 no_parent = 0xFFFFFFFFu;

    TopWalk(const Parts& parts, const RowCodes& codes)
        : parts_(parts), codes_(codes), most_(most_of_group(parts.normals->split_count + u64{1})) {}

    // Calls group(at) for each that begins one, then split(at) or tile(at).
    template <class Group, class Split, class Tile>
    void run(const Group& group, const Split& split, const Tile& tile) {
        u32 waiting = 0, splits = 0;
        open_[waiting++] = root();
        while (waiting > 0) {
            Open at = open_[--waiting];
            if (!at.grouped && tiles_below(at.node) <= most_) {
                group(at);
                at.grouped = true;
            }
            if (!is_split(at.node)) {
                tile(at);
                continue;
            }
            const AcdfHalving halving = parts_.halvings[at.node];
            const u32 axis = halving.link & 7u, middle = acdf_span_middle(&at.box[axis]);
            split(at, axis, middle);
            for (u32 upper = 2; upper-- > 0;) {
                Open half = at;
                half.node =
                    halving.link >> (3 + upper) & 1u ? ACDF_LEAF : at.node + (upper ? halving.link >> 5 : 1);
                half.parent = 2 * splits + upper;
                half.steps[axis].end[1 - upper] = halving.threshold;
                half.box[axis].end[1 - upper] = middle;
                open_[waiting++] = half;
            }
            ++splits;
        }
    }

private:
    bool is_split(u32 node) const { return node != ACDF_LEAF && codes_.has_codes(node); }

    Open root() const {
        Open out = {};
        out.node = parts_.halving_count ? 0 : ACDF_LEAF;
        out.parent = no_parent;
        for (u32 axis = 0; axis < 2; ++axis) {
            out.steps[axis] = {{0, ACDF_STEPS}};
            out.box[axis] = {{0, parts_.axes[axis].resolution}};
        }
        return out;
    }

    u64 tiles_below(u32 node) const {
        u32 open[most_open_halvings], waiting = 0;
        u64 count = 1;
        if (is_split(node)) open[waiting++] = node;
        for (; waiting > 0; ++count) {
            const u32 at = open[--waiting], link = parts_.halvings[at].link;
            if (!(link >> 3 & 1u) && codes_.has_codes(at + 1)) open[waiting++] = at + 1;
            if (!(link >> 4 & 1u) && codes_.has_codes(at + (link >> 5))) open[waiting++] = at + (link >> 5);
        }
        return count;
    }

    const Parts& parts_;
    const RowCodes& codes_;
    u32 most_;
    Open open_[most_open_halvings];
};

class NormalRowsMaker {
public:
    NormalRowsMaker(const Parts& parts, RowCodes& codes, const double* heights, AcdfNormalRows* rows)
        : parts_(parts), codes_(codes), heights_(heights), rows_(rows), splits_(array<AcdfRowSplit>(rows->split)) {}

    void run() {
        make_splits();
        for (u32 r = 0; r < rows_->rows; ++r) make_row(r);
        for (u32 code = 0; rows_->odds && code < kOddsCodes; ++code)
            array<double>(rows_->odds)[code] = acdf_halving_share(code, ACDF_ODDS_BITS) * 0x1p-31;
        fill_top_starts(
            rows_->bits, rows_->position_scale, array<u32>(rows_->starts),
            [&](u32 at, u32& axis, u32& middle) {
                axis = splits_[at].place & 1u;
                middle = splits_[at].place >> 1;
            },
            [&](u32 at, bool upper) { return splits_[at].child[upper]; });
    }

private:
    using Open = TopWalk::Open;

    template <class T>
    T* array(u32 offset) const {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(rows_) + offset);
    }

    // `tiles`: how many there are before.
    void link(const Open& at, u32 child, u32 tiles) {
        if (at.parent == TopWalk::no_parent) return;
        AcdfRowSplit& parent = splits_[at.parent >> 1];
        parent.child[at.parent & 1u] = child;
        if (at.parent & 1u) parent.tile = tiles;
    }

    // Splits, tiles and groups are numbered in preorder.
    void make_splits() {
        u32 splits = 0, tiles = 0, groups = 0;
        u32* const first = array<u32>(rows_->first);
        TopWalk(parts_, codes_)
            .run([&](const Open&) { first[groups++] = tiles; },
                 [&](const Open& at, u32 axis, u32 middle) {
                     link(at, splits, tiles);
                     splits_[splits++].place = axis | middle << 1;
                 },
                 [&](const Open& at) {
                     link(at, ACDF_TOP_TILE | tiles, tiles);
                     put_tile(at, tiles++);
                 });
        first[groups] = tiles;
    }

    void put_tile(const Open& at, u32 number) {
        const AcdfGrid grid = {parts_.axes[ACDF_AXIS_PHI].resolution, parts_.axes[ACDF_AXIS_THETA].resolution,
                               parts_.description->parameterization};
        const bool sphere = grid.parameterization != ACDF_PARAM_HALF_ANGLE; // else the pdf is not that of a cell
        array<AcdfTopTile>(rows_->tiles)[number] = {sphere ? acdf_box_scale(heights_, &grid, at.box) : 0.0,
                                                    at.node,
                                                    {at.steps[0], at.steps[1]},
                                                    {at.box[0], at.box[1]}};
    }

    // Each tile but the first is the first one of the upper half of a split.
    void make_row(u32 row) {
        u32 *const before = array<u32>(rows_->before) + u64{row} * rows_->stride,
                   *const ends = array<u32>(rows_->ends) + u64{row} * rows_->group_stride, split = 0;
        const u32* const first = array<u32>(rows_->first);
        before[0] = 0;
        before[rows_->splits + 1] = ACDF_STEPS;
        if (rows_->splits > 0)
            codes_.row(bits_,
                       [&](u32 steps_before, u32 lower) { before[splits_[split++].tile] = steps_before + lower; });
        for (u32 group = 0; group <= rows_->groups; ++group) ends[group] = before[first[group]];
    }

    const Parts& parts_;
    RowCodes& codes_;
    const double* heights_;
    AcdfNormalRows* rows_;
    AcdfRowSplit* splits_;
    const Payload payload_ = {parts_.normal_splits, parts_.normals_size, 0, false};
    Bits bits_{payload_, 4 * words_for(parts_.halving_count), parts_.normals_size};
};

// Offsets in words; false where there are too many.
bool lay_out(const Parts& parts, AcdfNormalRows& out) {
    const u64 count = out.rows, splits = out.splits;
    u64 at = to_row_line(sizeof out / 4);
    const auto place = [&at](u32& offset, u64 words) {
        offset = static_cast<u32>(at);
        at = to_row_line(at + words);
    };
    const u64 stride = to_row_line(splits + 2), group_stride = to_row_line(out.groups + u64{1});
    place(out.split, splits * (sizeof(AcdfRowSplit) / 4));
    place(out.tiles, (splits + 1) * (sizeof(AcdfTopTile) / 4));
    place(out.first, out.groups + u64{1});
    place(out.starts, out.bits ? u64{1} << 2 * out.bits : 0);
    place(out.ends, count * group_stride);
    place(out.before, count * stride);
    if (parts.visibility.header) place(out.odds, 2 * kOddsCodes);
    out.stride = static_cast<u32>(stride);
    out.group_stride = static_cast<u32>(group_stride);
    out.words = static_cast<u32>(at);
    for (u32 axis = 0; axis < 2; ++axis)
        out.position_scale[axis] = static_cast<u32>(position_scale(parts.axes[axis].resolution, out.bits));
    return at <= 0xFFFFFFFFu && at <= SIZE_MAX / 4;
}

} // namespace

AcdfNormalRows* make_normal_rows(const Parts& parts, bool lookup, const double* heights,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    RowCodes codes(parts.halvings, parts.normal_splits, parts.normals->code_bits);
    AcdfNormalRows out = {};
    out.rows = parts.normals->row_count;
    out.splits = parts.normals->split_count;
    TopWalk(parts, codes).run([&](const auto&) { ++out.groups; }, [](const auto&, u32, u32) {}, [](const auto&) {});
    if (lookup) out.bits = top_lookup_bits(parts, out.splits);
    if (!lay_out(parts, out)) return nullptr;
    block = take_block(allocator, 4 * std::size_t{out.words});
    if (!block.data) return nullptr;
    auto* rows = static_cast<AcdfNormalRows*>(block.data);
    *rows = out;
    NormalRowsMaker(parts, codes, heights, rows).run();
    return rows;
}

} // namespace acdf
