#include "halved_tree.h"

#include "memory.h"

#include <acdf/sample.h>
#ifndef ACDF_ENVIRONMENT_ONLY
#include <acdf/brdf_half.h>
#endif

#include <cstring>

namespace acdf {

namespace {

using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

constexpr u32 most_bits = 7;      // of the lookup grid's axes
constexpr u32 most_waiting = 128; // nodes that wait: a level of each axis, and one

// The squares of an axis: `step` lies in square step * scale / 2^shift.
struct Squares {
    u64 scale;
    u32 shift;

    u32 of(u32 step) const { return static_cast<u32>(step * scale >> shift); }
};

template <class T>
T* at_word(AcdfHalvedTree* tree, std::size_t word) {
    return reinterpret_cast<T*>(reinterpret_cast<u32*>(tree) + word);
}

// Finds the deepest node that holds each square of a grid of random numbers or of positions.
class LookupMaker {
public:
    LookupMaker(const HalvedSource& source, u32 bits) : source_(source), bits_(bits) {}

    u32 count = 0; // of starts

    // `tree`, whose heights are there, gets the starts of `squares`; both are null to count alone.
    void make(const Squares axes[2], bool by_position, AcdfHalvedTree* tree, u16* squares) {
        axes_ = axes;
        by_position_ = by_position;
        tree_ = tree;
        squares_ = squares;
        Open root = {};
        root.node = source_.count ? 0 : ACDF_LEAF;
        for (int axis = 0; axis < 2; ++axis) {
            root.steps[axis] = {{0, ACDF_STEPS}};
            root.box[axis] = {{0, source_.resolution[axis]}};
            root.squares[axis] = {{0, 1u << bits_}};
        }
        open_[0] = root;
        open_count_ = 1;
        while (open_count_ > 0) visit();
    }

private:
    struct Open {
        u32 node;
        AcdfSpan steps[2], box[2], squares[2]; // squares: those that lie in the node
    };

    void visit() {
        const Open node = open_[--open_count_];
        if (node.node == ACDF_LEAF) return put(node, node.squares);
        const AcdfHalving halving = source_.nodes[node.node];
        const u32 axis = halving.link & 7u;
        Open half[2] = {node, node};
        for (u32 upper = 0; upper < 2; ++upper) {
            half[upper].node =
                halving.link >> (3 + upper) & 1u ? ACDF_LEAF : node.node + (upper ? halving.link >> 5 : 1);
            half[upper].steps[axis].end[1 - upper] = halving.threshold;
            half[upper].box[axis].end[1 - upper] = acdf_span_middle(&node.box[axis]);
        }
        const u32 border = by_position_ ? acdf_span_middle(&node.box[axis]) : halving.threshold;
        // Squares that end below the border, and those that begin below it: one more, where it lies within one.
        const AcdfSpan all = node.squares[axis];
        const u32 below = within(all, axes_[axis].of(border));
        const u32 above = border > 0 ? within(all, axes_[axis].of(border - 1) + 1) : below;
        half[0].squares[axis].end[1] = below;
        half[1].squares[axis].end[0] = above;
        AcdfSpan across[2] = {node.squares[0], node.squares[1]};
        across[axis] = {{below, above}};
        put(node, across);
        for (u32 upper = 2; upper-- > 0;)
            if (has_any(half[upper].squares)) open_[open_count_++] = half[upper];
    }

    static u32 within(const AcdfSpan& span, u32 square) {
        return square < span.end[0] ? span.end[0] : square > span.end[1] ? span.end[1] : square;
    }

    static bool has_any(const AcdfSpan squares[2]) {
        return squares[0].end[0] < squares[0].end[1] && squares[1].end[0] < squares[1].end[1];
    }

    void put(const Open& node, const AcdfSpan at[2]) {
        if (!has_any(at)) return;
        if (squares_) {
            AcdfStart& start = at_word<AcdfStart>(tree_, tree_->starts)[count];
            start.node = node.node;
            start.pdf = node.node == ACDF_LEAF ? leaf_pdf(node) : 0.0f;
            for (int axis = 0; axis < 2; ++axis) {
                start.steps[axis] = node.steps[axis];
                for (int end = 0; end < 2; ++end) start.box[axis][end] = static_cast<u16>(node.box[axis].end[end]);
            }
            for (u32 y = at[1].end[0]; y < at[1].end[1]; ++y)
                for (u32 x = at[0].end[0]; x < at[0].end[1]; ++x)
                    squares_[(std::size_t{y} << bits_) + x] = static_cast<u16>(count);
        }
        ++count;
    }

    // As acdf_environment_pdf computes it.
    float leaf_pdf(const Open& leaf) const {
        AcdfEnvironment environment = {};
        environment.columns = source_.resolution[0];
        environment.rows = source_.resolution[1];
        environment.parameterization = source_.parameterization;
        environment.halved = tree_;
        AcdfRange range[2];
        acdf_halved_ranges(leaf.box, range);
        return acdf_halved_pdf(&environment, range,
                               acdf_span_share(&leaf.steps[0]) * acdf_span_share(&leaf.steps[1]));
    }

    const HalvedSource& source_;
    u32 bits_;
    const Squares* axes_ = nullptr;
    bool by_position_ = false;
    AcdfHalvedTree* tree_ = nullptr;
    u16* squares_ = nullptr;
    u32 open_count_ = 0;
    Open open_[most_waiting];
};

u32 position_scale(u32 resolution, u32 bits) { return static_cast<u32>((u64{1} << (32 + bits)) / resolution); }

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
    Squares by_number[2], by_position[2];
    LookupMaker maker(source, bits);
    if (bits) {
        for (int axis = 0; axis < 2; ++axis) {
            by_number[axis] = {1, 31 - bits};
            by_position[axis] = {position_scale(source.resolution[axis], bits), 32};
        }
        maker.make(by_number, false, nullptr, nullptr);
        maker.make(by_position, true, nullptr, nullptr);
    }
    Layout layout = layout_of(source, bits, maker.count);
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
    maker.count = 0;
    maker.make(by_number, false, tree, at_word<u16>(tree, layout.numbers));
    maker.make(by_position, true, tree, at_word<u16>(tree, layout.positions));
    return tree;
}

} // namespace acdf
