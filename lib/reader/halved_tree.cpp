#include "halved_tree.h"

#include "memory.h"

#include <acdf/sample.h>
#ifndef ACDF_ENVIRONMENT_ONLY
#include <acdf/brdf_half.h>
#endif

#include <cstring>
#include <initializer_list>

namespace acdf {

namespace {

constexpr u32 most_bits = 7; // of the lookup grid's axes

template <class T>
T* at_word(AcdfHalvedTree* tree, std::size_t word) {
    return reinterpret_cast<T*>(reinterpret_cast<u32*>(tree) + word);
}

// As acdf_environment_pdf computes it.
float leaf_pdf(const HalvedSource& source, const AcdfHalvedTree* tree, const AcdfSpan* steps, const AcdfSpan* box) {
    AcdfEnvironment environment = {};
    environment.columns = source.resolution[0];
    environment.rows = source.resolution[1];
    environment.parameterization = source.parameterization;
    environment.halved = tree;
    AcdfRange range[2];
    acdf_halved_ranges(box, range);
    return acdf_halved_pdf(&environment, range, acdf_span_share(&steps[0]) * acdf_span_share(&steps[1]));
}

/// Finds the deepest node that holds each square of a grid over random numbers, or over positions.
class LookupWalk {
public:
    LookupWalk(const HalvedSource& source, u32 bits, bool by_position)
        : nodes_(source.nodes), by_position_(by_position), shift_(by_position ? 32 : 31 - bits) {
        for (u32 axis = 0; axis < 2; ++axis) {
            steps[axis] = {{0, ACDF_STEPS}};
            box[axis] = {{0, source.resolution[axis]}};
            squares[axis] = {{0, 1u << bits}};
            scale_[axis] = by_position ? position_scale(source.resolution[axis], bits) : 1;
        }
    }

    AcdfSpan steps[2], box[2]; ///< of the node that put() gets
    AcdfSpan squares[2];       ///< whose deepest node it is

    /// Calls put(node) for `node` and those below it that are the deepest ones of a square, or more. At most 31
    /// deep for each axis.
    template <class Put>
    void visit(u32 node, const Put& put) {
        for (const AcdfSpan& span : squares)
            if (span.end[0] >= span.end[1]) return;
        if (node == ACDF_LEAF) return put(node);
        const AcdfHalving halving = nodes_[node];
        const u32 axis = halving.link & 7u, middle = acdf_span_middle(&box[axis]);
        const u32 border = by_position_ ? middle : halving.threshold;
        const AcdfSpan own_steps = steps[axis], own_box = box[axis], all = squares[axis];
        // Squares that end below the border, and those that begin below it: one more, where it lies within one.
        const u32 below = within(all, square_of(axis, border));
        const u32 above = border > 0 ? within(all, square_of(axis, border - 1) + 1) : below;
        squares[axis] = {{below, above}};
        if (below < above) put(node);
        for (u32 upper = 0; upper < 2; ++upper) {
            steps[axis] = own_steps;
            box[axis] = own_box;
            steps[axis].end[1 - upper] = halving.threshold;
            box[axis].end[1 - upper] = middle;
            squares[axis] = upper ? AcdfSpan{{above, all.end[1]}} : AcdfSpan{{all.end[0], below}};
            visit(halving.link >> (3 + upper) & 1u ? ACDF_LEAF : node + (upper ? halving.link >> 5 : 1), put);
        }
        steps[axis] = own_steps;
        box[axis] = own_box;
        squares[axis] = all;
    }

private:
    u32 square_of(u32 axis, u32 step) const { return static_cast<u32>(step * u64{scale_[axis]} >> shift_); }
    static u32 within(const AcdfSpan& span, u32 square) {
        return square < span.end[0] ? span.end[0] : square > span.end[1] ? span.end[1] : square;
    }

    const AcdfHalving* nodes_;
    bool by_position_;
    u32 shift_, scale_[2];
};

// Fills the grids of `tree`, whose heights are there, or, where it is null, counts their starts alone.
u32 make_starts(const HalvedSource& source, u32 bits, AcdfHalvedTree* tree) {
    u32 count = 0;
    for (const bool by_position : {false, true}) {
        LookupWalk walk(source, bits, by_position);
        walk.visit(source.count ? 0 : ACDF_LEAF, [&](u32 node) {
            if (tree) {
                AcdfStart& start = at_word<AcdfStart>(tree, tree->starts)[count];
                start.node = node;
                start.pdf = node == ACDF_LEAF ? leaf_pdf(source, tree, walk.steps, walk.box) : 0.0f;
                for (int axis = 0; axis < 2; ++axis) {
                    start.steps[axis] = walk.steps[axis];
                    for (int end = 0; end < 2; ++end)
                        start.box[axis][end] = static_cast<u16>(walk.box[axis].end[end]);
                }
                u16* const squares = at_word<u16>(tree, by_position ? tree->positions : tree->numbers);
                for (u32 y = walk.squares[1].end[0]; y < walk.squares[1].end[1]; ++y)
                    for (u32 x = walk.squares[0].end[0]; x < walk.squares[0].end[1]; ++x)
                        squares[(std::size_t{y} << bits) + x] = static_cast<u16>(count);
            }
            ++count;
        });
    }
    return count;
}

// Whether rows begin elsewhere than at equal steps.
bool has_heights(const HalvedSource& source) { return source.parameterization != ACDF_PARAM_OCTAHEDRAL; }

// A square for one to four cells.
u32 lookup_bits(const HalvedSource& source) {
    u32 bits = 0;
    if (!source.lookup || source.axes != 2) return 0;
    for (int axis = 0; axis < 2; ++axis)
        if (source.resolution[axis] > 0xFFFF) return 0;
    while (bits < most_bits && source.count >> (2 * bits + 2) > 0) ++bits;
    return bits;
}

struct Layout {
    std::size_t nodes, heights, numbers, positions, starts, words;
};

std::size_t words_in(std::size_t bytes) { return (bytes + 3) / 4; }

Layout layout_of(const HalvedSource& source, u32 bits, u32 starts) {
    constexpr std::size_t line = 16;
    const auto to_line = [](std::size_t words) { return (words + line - 1) / line * line; };
    const std::size_t grid = bits ? words_in(sizeof(u16) << 2 * bits) : 0;
    Layout out;
    out.nodes = to_line(words_in(sizeof(AcdfHalvedTree)));
    out.heights = to_line(out.nodes + words_in(source.count * sizeof(AcdfHalving)));
    out.numbers =
        to_line(out.heights + (has_heights(source) ? words_in((source.resolution[1] + std::size_t{1}) * 8) : 0));
    out.positions = out.numbers + grid;
    out.starts = to_line(out.positions + grid);
    out.words = out.starts + words_in(starts * sizeof(AcdfStart));
    return out;
}

void make_heights(AcdfHalvedTree* tree, const HalvedSource& source) {
    double* heights = at_word<double>(tree, tree->heights);
#ifndef ACDF_ENVIRONMENT_ONLY
    if (source.parameterization == ACDF_PARAM_HALF_ANGLE) {
        for (u32 row = 0; row <= source.resolution[1]; ++row) heights[row] = acdf_half_row(row);
        return;
    }
#endif
    for (u32 row = 0; row <= source.resolution[1]; ++row) heights[row] = acdf_row_z(row, source.resolution[1]);
}

} // namespace

AcdfHalvedTree* make_halved_tree(const HalvedSource& source, const AcdfAllocator& allocator,
                                 AcdfBlock& block) noexcept {
    u32 bits = lookup_bits(source);
    Layout layout = layout_of(source, bits, bits ? make_starts(source, bits, nullptr) : 0);
    block = take_block(allocator, 4 * layout.words);
    if (!block.data && bits) {
        layout = layout_of(source, bits = 0, 0);
        block = take_block(allocator, 4 * layout.words);
    }
    if (!block.data) return nullptr;
    auto* tree = static_cast<AcdfHalvedTree*>(block.data);
    *tree = {};
    tree->words = static_cast<u32>(layout.words);
    tree->count = source.count;
    tree->nodes = static_cast<u32>(layout.nodes);
    if (source.count)
        std::memcpy(at_word<AcdfHalving>(tree, layout.nodes), source.nodes, source.count * sizeof(AcdfHalving));
    if (has_heights(source)) {
        tree->heights = static_cast<u32>(layout.heights);
        make_heights(tree, source);
    }
    if (!bits) return tree;
    tree->bits = bits;
    tree->numbers = static_cast<u32>(layout.numbers);
    tree->positions = static_cast<u32>(layout.positions);
    tree->starts = static_cast<u32>(layout.starts);
    for (int axis = 0; axis < 2; ++axis) tree->position_scale[axis] = position_scale(source.resolution[axis], bits);
    make_starts(source, bits, tree);
    return tree;
}

} // namespace acdf
