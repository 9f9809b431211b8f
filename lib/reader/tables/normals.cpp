#include "tables/normals.h"

#include "check/row_codes.h"
#include "memory.h"
#include "tables/top_lookup.h"

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

u64 to_row_line(u64 words) { return (words + 15) / 16 * 16; }

class NormalRowsMaker {
public:
    NormalRowsMaker(const Parts& parts, const double* heights, AcdfNormalRows* rows)
        : parts_(parts), heights_(heights), rows_(rows), splits_(array<AcdfRowSplit>(rows->split)),
          tiles_(array<AcdfTopTile>(rows->tiles)),
          codes_(parts.halvings, parts.normal_splits, parts.normals->code_bits) {}

    void run() {
        make_splits();
        make_steps();
        fill_top_starts(
            rows_->bits, rows_->position_scale, array<u32>(rows_->starts),
            [&](u32 at, u32& axis, u32& middle) { axis = splits_[at].place & 1u, middle = splits_[at].place >> 1; },
            [&](u32 at, bool upper) { return splits_[at].child[upper]; });
    }

private:
    struct Open {
        u32 node;
        u32 parent; // and side: 2 split + upper
        AcdfSpan steps[2], box[2];
    };
    static constexpr u32 no_parent = 0xFFFFFFFFu;

    template <class T>
    T* array(u32 offset) const {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(rows_) + offset);
    }

    // In preorder, in which splits and tiles are numbered.
    void make_splits() {
        u32 waiting = 0, split_count = 0, tile_count = 0;
        Open root = {};
        root.node = parts_.halving_count ? 0 : ACDF_LEAF;
        root.parent = no_parent;
        for (u32 axis = 0; axis < 2; ++axis) {
            root.steps[axis] = {{0, ACDF_STEPS}};
            root.box[axis] = {{0, parts_.axes[axis].resolution}};
        }
        open_[waiting++] = root;
        while (waiting > 0) {
            const Open at = open_[--waiting];
            const bool is_split = at.node != ACDF_LEAF && codes_.has_codes(at.node);
            if (at.parent != no_parent) {
                AcdfRowSplit& parent = splits_[at.parent >> 1];
                parent.child[at.parent & 1u] = is_split ? split_count : ACDF_TOP_TILE | tile_count;
                if (at.parent & 1u) parent.tile = tile_count;
            }
            if (!is_split) {
                put_tile(at, tile_count++);
                continue;
            }
            const AcdfHalving halving = parts_.halvings[at.node];
            const u32 axis = halving.link & 7u, middle = acdf_span_middle(&at.box[axis]);
            splits_[split_count].place = axis | middle << 1;
            for (u32 upper = 2; upper-- > 0;) {
                Open half = at;
                half.node =
                    halving.link >> (3 + upper) & 1u ? ACDF_LEAF : at.node + (upper ? halving.link >> 5 : 1);
                half.parent = 2 * split_count + upper;
                half.steps[axis].end[1 - upper] = halving.threshold;
                half.box[axis].end[1 - upper] = middle;
                open_[waiting++] = half;
            }
            ++split_count;
        }
    }

    void put_tile(const Open& at, u32 number) {
        const AcdfGrid grid = {parts_.axes[ACDF_AXIS_PHI].resolution, parts_.axes[ACDF_AXIS_THETA].resolution,
                               parts_.description->parameterization};
        tiles_[number] = {
            acdf_box_scale(heights_, &grid, at.box), at.node, {at.steps[0], at.steps[1]}, {at.box[0], at.box[1]}};
    }

    void make_steps() {
        const u64 begin = 4 * words_for(parts_.halving_count);
        const Payload codes = {parts_.normal_splits, parts_.normals_size, 0, false};
        Bits bits(codes, begin, codes.size);
        for (u32 r = 0; r < rows_->rows; ++r) {
            u32* const row = array<u32>(rows_->steps) + u64{r} * rows_->stride;
            u32 split = 0;
            row[0] = 0;
            row[rows_->splits + 1] = ACDF_STEPS;
            if (rows_->splits == 0) continue;
            codes_.row(bits, [&](u32 before, u32 lower) { row[splits_[split++].tile] = before + lower; });
        }
        for (u32 r = 0; r < rows_->rows; ++r) {
            const u32* const row = array<u32>(rows_->steps) + u64{r} * rows_->stride;
            u32* const ends = array<u32>(rows_->ends) + u64{r} * rows_->group_stride;
            for (u32 group = 0; group < rows_->groups; ++group) ends[group] = row[group << rows_->group_bits];
            ends[rows_->groups] = ACDF_STEPS;
        }
    }

    const Parts& parts_;
    const double* heights_;
    AcdfNormalRows* rows_;
    AcdfRowSplit* splits_;
    AcdfTopTile* tiles_;
    RowCodes codes_;
    Open open_[most_open_halvings];
};

} // namespace

AcdfNormalRows* make_normal_rows(const Parts& parts, bool lookup, const double* heights,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    const u64 count = parts.normals->row_count, splits = parts.normals->split_count;
    AcdfNormalRows out = {};
    out.rows = parts.normals->row_count;
    out.splits = parts.normals->split_count;
    if (lookup) out.bits = top_lookup_bits(parts, out.splits);
    const u64 split = to_row_line(sizeof out / 4), tiles = to_row_line(split + splits * (sizeof(AcdfRowSplit) / 4)),
              starts = to_row_line(tiles + (splits + 1) * (sizeof(AcdfTopTile) / 4)),
              steps = to_row_line(starts + (out.bits ? u64{1} << 2 * out.bits : 0)),
              stride = to_row_line(splits + 2), ends = steps + count * stride;
    while (u64{1} << 2 * out.group_bits < splits + 1) ++out.group_bits; // as many groups as tiles in each, about
    out.groups = static_cast<u32>((splits >> out.group_bits) + 1);
    const u64 group_stride = to_row_line(u64{out.groups} + 1), words = ends + count * group_stride;
    if (words > 0xFFFFFFFFu || words > SIZE_MAX / 4) return nullptr;
    block = take_block(allocator, static_cast<std::size_t>(4 * words));
    if (!block.data) return nullptr;
    out.words = static_cast<u32>(words);
    out.split = static_cast<u32>(split);
    out.tiles = static_cast<u32>(tiles);
    out.starts = static_cast<u32>(starts);
    out.steps = static_cast<u32>(steps);
    out.stride = static_cast<u32>(stride);
    out.ends = static_cast<u32>(ends);
    out.group_stride = static_cast<u32>(group_stride);
    for (u32 axis = 0; axis < 2; ++axis)
        out.position_scale[axis] = top_position_scale(parts.axes[axis].resolution, out.bits);
    auto* rows = static_cast<AcdfNormalRows*>(block.data);
    *rows = out;
    NormalRowsMaker(parts, heights, rows).run();
    return rows;
}

} // namespace acdf
