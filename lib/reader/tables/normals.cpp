#include "tables/normals.h"

#include "check/row_codes.h"
#include "memory.h"
#include "tables/top_tree.h"

namespace acdf {

namespace {

u64 to_row_line(u64 words) { return (words + 15) / 16 * 16; }

// The least power of two whose square is at least a number of tiles: about as many groups as tiles in each.
u32 most_of_group(u64 tiles) {
    u32 most = 1;
    while (u64{most} * most < tiles) most *= 2;
    return most;
}

class NormalRowsMaker {
public:
    NormalRowsMaker(const Parts& parts, RowCodes& codes, const double* heights, AcdfNormalRows* rows)
        : parts_(parts), tree_(parts, parts.normal_splits), codes_(codes), heights_(heights), rows_(rows),
          splits_(array<AcdfRowSplit>(rows->split)) {}

    void run() {
        u32* const first = array<u32>(rows_->first);
        take(tree_.root(), first, false);
        first[groups_] = tiles_;
        for (u32 r = 0; r < rows_->rows; ++r) make_row(r);
        fill_top_starts(
            rows_->bits, rows_->position_scale, array<u32>(rows_->starts),
            [&](u32 at, u32& axis, u32& middle) {
                axis = splits_[at].place & 1u;
                middle = splits_[at].place >> 1;
            },
            [&](u32 at, bool upper) { return splits_[at].child[upper]; });
    }

private:
    template <class T>
    T* array(u32 offset) const {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(rows_) + offset);
    }

    // Splits, tiles and groups, the largest parts of at most so many tiles, are numbered in preorder. Returns the
    // number of a split or tile.
    u32 take(u32 node, u32* first, bool grouped) {
        if (!grouped && tree_.tiles_below(node) <= most_of_group(rows_->splits + u64{1})) {
            first[groups_++] = tiles_;
            grouped = true;
        }
        if (!tree_.is_split(node)) {
            array<AcdfTopTile>(rows_->tiles)[tiles_] = tree_.tile(node, heights_);
            return ACDF_TOP_TILE | tiles_++;
        }
        const u32 number = split_count_++, axis = tree_.axis_of(node);
        AcdfRowSplit& split = splits_[number];
        split.place = axis | acdf_span_middle(&tree_.box[axis]) << 1;
        for (u32 upper = 0; upper < 2; ++upper) {
            split.tile = tiles_; // of the upper half at last
            tree_.narrowed(node, upper, [&](u32 half) { split.child[upper] = take(half, first, grouped); });
        }
        return number;
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
    TopTree tree_;
    RowCodes& codes_;
    const double* heights_;
    AcdfNormalRows* rows_;
    AcdfRowSplit* splits_;
    u32 split_count_ = 0, tiles_ = 0, groups_ = 0;
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
    out.stride = static_cast<u32>(stride);
    out.group_stride = static_cast<u32>(group_stride);
    out.words = static_cast<u32>(at);
    for (u32 axis = 0; axis < 2; ++axis)
        out.position_scale[axis] = position_scale(parts.axes[axis].resolution, out.bits);
    return at <= 0xFFFFFFFFu && at <= SIZE_MAX / 4;
}

} // namespace

AcdfNormalRows* make_normal_rows(const Parts& parts, bool lookup, const double* heights,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    RowCodes codes(parts.halvings, parts.normal_splits, parts.normals->code_bits);
    AcdfNormalRows out = {};
    out.rows = parts.normals->row_count;
    out.splits = parts.normals->split_count;
    const TopTree tree(parts, parts.normal_splits);
    tree.for_each_split(tree.root(), [&](u32 split, u32) {
        const bool parted = tree.tiles_below(split) > most_of_group(out.splits + u64{1});
        out.groups += parted;
        return parted;
    });
    ++out.groups;
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
