#include "tables/table_lookup.h"

#include "lookup_walk.h"
#include "memory.h"

#include <cstring>
#include <initializer_list>

namespace acdf {

namespace {

constexpr u32 nodes_a_square = 2; // at least
constexpr u32 least_nodes = 16;   // of a bin that has grids

// Fills the grids of bins with the numbers of starts, or counts these alone.
class GridMaker {
public:
    explicit GridMaker(const AcdfTable& table)
        : table_(table), axes_(acdf_table_sampled_count(&table)), walk_(table.nodes, axes_) {
        for (u32 axis = 0; axis < axes_; ++axis) resolution_[axis] = acdf_table_axis(&table, axis)->resolution;
    }

    u32 starts = 0;

    // `lookup` is null to count alone.
    void make(const AcdfTableGrid& grid, u32 root, AcdfTableLookup* lookup) {
        u32* const words = reinterpret_cast<u32*>(lookup);
        for (const bool by_position : {false, true}) {
            Squares squares[ACDF_MAX_AXES];
            for (u32 axis = 0; axis < axes_; ++axis)
                squares[axis] = by_position ? squares_of_positions(grid.scale[axis], grid.bits[axis])
                                            : squares_of_numbers(grid.bits[axis]);
            walk_.run(root, resolution_, squares, by_position, [&](u32 node) {
                if (words) {
                    put(node, words + lookup->starts + std::size_t{starts} * lookup->start_words);
                    fill(grid, words + (by_position ? grid.positions : grid.numbers));
                }
                ++starts;
            });
        }
    }

private:
    void put(u32 node, u32* words) const {
        auto& start = *reinterpret_cast<AcdfTableStart*>(words);
        auto* const spans = reinterpret_cast<AcdfSpan*>(&start + 1);
        AcdfTablePosition place;
        for (u32 axis = 0; axis < axes_; ++axis) {
            place.steps[axis] = spans[axis] = walk_.steps[axis];
            place.box[axis] = spans[axes_ + axis] = walk_.box[axis];
        }
        start = {node, 0, 0.0};
        if (const double p = acdf_table_probability(&table_, &place); node == ACDF_LEAF && p > 0.0)
            start.pdf = acdf_table_cell_pdf(&table_, p, &place);
    }

    void fill(const AcdfTableGrid& grid, u32* squares) const {
        u32 at[ACDF_MAX_AXES], axis = 0;
        for (; axis < axes_; ++axis) at[axis] = walk_.squares[axis].end[0];
        while (axis > 0) {
            u32 square = 0;
            for (axis = 0; axis < axes_; ++axis) square = square << grid.bits[axis] | at[axis];
            squares[square] = starts;
            while (axis > 0 && ++at[axis - 1] == walk_.squares[axis - 1].end[1]) { // the next one
                --axis;
                at[axis] = walk_.squares[axis].end[0];
            }
        }
    }

    const AcdfTable& table_;
    u32 axes_;
    u32 resolution_[ACDF_MAX_AXES];
    LookupWalk walk_;
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
        grid.scale[axis] = position_scale(acdf_table_axis(&table, axis)->resolution, grid.bits[axis]);
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

} // namespace

void make_table_lookup(AcdfTable& table, u32 bins, u32 count, std::size_t most_bytes,
                       const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    GridMaker maker(table);
    const u32 start_words = 4 + 4 * acdf_table_sampled_count(&table);
    std::size_t squares = 0;
    for_each_tree(table, bins, count, [&](u32 bin, u32 nodes) {
        const AcdfTableGrid grid = grid_for(table, nodes);
        if (grid.all_bits == 0) return;
        squares += std::size_t{2} << grid.all_bits;
        maker.make(grid, table.bins[bin].root, nullptr);
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
        maker.make(grid, table.bins[bin].root, lookup);
    });
}

} // namespace acdf
