#include "tables/table_lookup.h"

#include "memory.h"

#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr u32 nodes_a_square = 2; // at least
constexpr u32 least_nodes = 16;   // of a bin that has grids

// Finds the deepest node that holds each square of the grids of a bin.
class GridMaker {
public:
    explicit GridMaker(const AcdfTable& table) : table_(table), axes_(acdf_table_sampled_count(&table)) {}

    u32 starts = 0;

    // `lookup` gets the starts of `squares`; both are null to count alone.
    void make(const AcdfTableGrid& grid, u32 root, bool by_position, AcdfTableLookup* lookup, u32* squares) {
        grid_ = &grid;
        by_position_ = by_position;
        lookup_ = lookup;
        squares_ = squares;
        open_[0].node = root;
        acdf_table_whole(&table_, &open_[0].place);
        for (u32 axis = 0; axis < axes_; ++axis) open_[0].squares[axis] = {{0, 1u << grid.bits[axis]}};
        open_count_ = 1;
        while (open_count_ > 0) visit();
    }

private:
    struct Open {
        u32 node;
        AcdfTablePosition place;
        AcdfSpan squares[ACDF_MAX_AXES]; // those that lie in the node
    };

    void visit() {
        const Open node = open_[--open_count_];
        if (node.node == ACDF_LEAF) return put(node, node.squares);
        const AcdfHalving halving = table_.nodes[node.node];
        const u32 axis = halving.link & 7u, middle = acdf_span_middle(&node.place.box[axis]);
        const u32 border = by_position_ ? middle : halving.threshold;
        // Squares that end below the border, and those that begin below it: one more, where it lies within one.
        const AcdfSpan all = node.squares[axis];
        const u32 below = within(all, square_of(axis, border));
        const u32 above = border > 0 ? within(all, square_of(axis, border - 1) + 1) : below;
        Open across = node;
        across.squares[axis] = {{below, above}};
        put(node, across.squares);
        for (u32 upper = 2; upper-- > 0;) {
            Open& half = open_[open_count_];
            half = node;
            half.node = halving.link >> (3 + upper) & 1u ? ACDF_LEAF : node.node + (upper ? halving.link >> 5 : 1);
            half.place.steps[axis].end[1 - upper] = halving.threshold;
            half.place.box[axis].end[1 - upper] = middle;
            half.squares[axis].end[1 - upper] = upper ? above : below;
            open_count_ += has_any(half.squares);
        }
    }

    u32 square_of(u32 axis, u32 step) const {
        return by_position_ ? acdf_table_square(grid_, axis, step)
                            : static_cast<u32>(u64{step} >> (31 - grid_->bits[axis]));
    }
    static u32 within(const AcdfSpan& span, u32 square) {
        return square < span.end[0] ? span.end[0] : square > span.end[1] ? span.end[1] : square;
    }
    bool has_any(const AcdfSpan* squares) const {
        for (u32 axis = 0; axis < axes_; ++axis)
            if (squares[axis].end[0] >= squares[axis].end[1]) return false;
        return true;
    }

    void put(const Open& node, const AcdfSpan* at) {
        if (!has_any(at)) return;
        if (squares_) {
            u32* const words = reinterpret_cast<u32*>(lookup_) + lookup_->starts + starts * lookup_->start_words;
            auto& start = *reinterpret_cast<AcdfTableStart*>(words);
            start = {node.node, 0, 0.0};
            if (const double p = acdf_table_probability(&table_, &node.place); node.node == ACDF_LEAF && p > 0.0)
                start.pdf = acdf_table_cell_pdf(&table_, p, &node.place);
            auto* const spans = reinterpret_cast<AcdfSpan*>(&start + 1);
            std::memcpy(spans, node.place.steps, axes_ * sizeof(AcdfSpan));
            std::memcpy(spans + axes_, node.place.box, axes_ * sizeof(AcdfSpan));
            fill(at, 0, 0);
        }
        ++starts;
    }
    void fill(const AcdfSpan* at, u32 axis, u32 square) {
        if (axis == axes_) {
            squares_[square] = starts;
            return;
        }
        for (u32 i = at[axis].end[0]; i < at[axis].end[1]; ++i) fill(at, axis + 1, square << grid_->bits[axis] | i);
    }

    const AcdfTable& table_;
    u32 axes_;
    const AcdfTableGrid* grid_ = nullptr;
    bool by_position_ = false;
    AcdfTableLookup* lookup_ = nullptr;
    u32* squares_ = nullptr;
    u32 open_count_ = 0;
    Open open_[31 * ACDF_MAX_AXES + 1]; // a level of each axis, and one
};

// Grids over the axes that are longest for their squares; without any for small trees.
AcdfTableGrid grid_for(const AcdfTable& table, u32 nodes) {
    AcdfTableGrid grid = {};
    const u32 axes = acdf_table_sampled_count(&table);
    for (u32 squares = nodes / nodes_a_square; nodes >= least_nodes && squares > 1; squares /= 2) {
        u32 longest = 0;
        for (u32 axis = 1; axis < axes; ++axis)
            if (acdf_table_axis(&table, axis)->resolution >> grid.bits[axis] >
                acdf_table_axis(&table, longest)->resolution >> grid.bits[longest])
                longest = axis;
        if (acdf_table_axis(&table, longest)->resolution >> grid.bits[longest] < 2) break;
        ++grid.bits[longest];
        ++grid.all_bits;
    }
    for (u32 axis = 0; axis < axes; ++axis)
        grid.scale[axis] = (u64{1} << (32 + grid.bits[axis])) / acdf_table_axis(&table, axis)->resolution;
    return grid;
}

// Calls visit(bin, halvings of its tree) for each bin that is halved.
template <class Visit>
void for_each_tree(const AcdfTable& table, u32 bins, u32 count, const Visit& visit) {
    for (u32 bin = bins, end = count; bin-- > 0;) {
        if (table.bins[bin].root == ACDF_NO_ROOT) continue;
        visit(bin, end - table.bins[bin].root);
        end = table.bins[bin].root;
    }
}

std::size_t to_cache_line(std::size_t words) { return (words + 15) / 16 * 16; }

void make_grids(AcdfTable& table, u32 bins, u32 count, std::size_t most_bytes, const AcdfAllocator& allocator,
                GridMaker& maker, AcdfBlock& block) {
    const u32 start_words = 4 + 4 * acdf_table_sampled_count(&table);
    std::size_t squares = 0;
    for_each_tree(table, bins, count, [&](u32 bin, u32 nodes) {
        const AcdfTableGrid grid = grid_for(table, nodes);
        if (grid.all_bits == 0) return;
        squares += std::size_t{2} << grid.all_bits;
        maker.make(grid, table.bins[bin].root, false, nullptr, nullptr);
        maker.make(grid, table.bins[bin].root, true, nullptr, nullptr);
    });
    const std::size_t nodes_at = to_cache_line(sizeof(AcdfTableLookup) / 4);
    const std::size_t grids_at = to_cache_line(nodes_at + std::size_t{2} * count);
    const std::size_t squares_at = to_cache_line(grids_at + std::size_t{bins} * (sizeof(AcdfTableGrid) / 4));
    const std::size_t starts_at = to_cache_line(squares_at + squares);
    const u64 words = starts_at + u64{maker.starts} * start_words;
    if (squares == 0 || 4 * words - 8 * u64{count} > most_bytes || 4 * words > SIZE_MAX / 2 || words >> 32 != 0)
        return;
    block = take_block(allocator, 4 * static_cast<std::size_t>(words));
    if (!block.data) return;
    auto* const lookup = static_cast<AcdfTableLookup*>(block.data);
    *lookup = {static_cast<u32>(words), static_cast<u32>(grids_at), static_cast<u32>(starts_at), start_words};
    auto* const at = static_cast<u32*>(block.data);
    std::memcpy(at + nodes_at, table.nodes, count * sizeof(AcdfHalving));
    table.nodes = reinterpret_cast<const AcdfHalving*>(at + nodes_at);
    table.lookup = lookup;
    auto* const grids = reinterpret_cast<AcdfTableGrid*>(at + grids_at);
    std::memset(grids, 0, bins * sizeof(AcdfTableGrid));
    maker.starts = 0;
    u32 next = static_cast<u32>(squares_at);
    for_each_tree(table, bins, count, [&](u32 bin, u32 nodes) {
        AcdfTableGrid& grid = grids[bin] = grid_for(table, nodes);
        if (grid.all_bits == 0) return;
        grid.numbers = next;
        grid.positions = next + (1u << grid.all_bits);
        next += 2u << grid.all_bits;
        maker.make(grid, table.bins[bin].root, false, lookup, at + grid.numbers);
        maker.make(grid, table.bins[bin].root, true, lookup, at + grid.positions);
    });
}

} // namespace

void make_table_lookup(AcdfTable& table, u32 bins, u32 count, std::size_t most_bytes,
                       const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    AcdfBlock scratch = take_block({}, sizeof(GridMaker)); // too much for the small stacks of WebAssembly
    if (!scratch.data) return;
    make_grids(table, bins, count, most_bytes, allocator, *new (scratch.data) GridMaker(table), block);
    give_block({}, scratch);
}

} // namespace acdf
