// Chunk HALV: the bits of its trees become flat nodes in the pass that checks them.
#include "check/bits.h"
#include "memory.h"
#ifndef ACDF_ENVIRONMENT_ONLY
#include "check/kinds.h"

#include <new>
#endif

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

// The trees of a chunk, one after the other.
struct Trees {
    u32 count = 1, axes = 0;            // axes: that are sampled
    u32 resolution[ACDF_MAX_AXES] = {}; // of those
#ifndef ACDF_ENVIRONMENT_ONLY
    const AcdfBin* bins = nullptr; // each with a share has a tree; null: there is one tree
    u32 bin_count = 0;
    u64 bins_at = 0; // where BINS is
#endif
};

// `MostAxes`: the most that are sampled.
template <u32 MostAxes>
class HalvingsChecker {
public:
    HalvingsChecker(const Payload& payload, Report& report, const Trees& trees)
        : payload_(payload), header_(*reinterpret_cast<const AcdfHalvingsHeader*>(payload.data)), report_(report),
          trees_(trees) {
        while (1u << axis_bits_ < trees_.axes) ++axis_bits_;
    }

    void run(const AcdfAllocator& allocator, Parts& parts) {
        if (payload_.size < sizeof header_)
            return report_.add(6030, payload_.at(0), "%llu bytes", static_cast<ull>(payload_.size));
        if (!header_is_right()) return;
        const std::size_t bytes = (header_.halving_count + std::size_t{1}) * sizeof(AcdfHalving);
        parts.halvings_block = take_block(allocator, bytes);
        if (parts.halvings_block.data)
            return make_nodes(static_cast<AcdfHalving*>(parts.halvings_block.data), parts);
        report_.add(1003, payload_.at(0), "%llu bytes for nodes", static_cast<ull>(bytes));
    }

private:
    bool header_is_right() {
        const u32 bits = header_.code_bits;
        if (bits < ACDF_LEAST_CODE_BITS || bits > ACDF_MOST_CODE_BITS ||
            header_.halving_count > ACDF_MOST_HALVINGS || header_.reserved[0] != 0 || header_.reserved[1] != 0) {
            report_.add(6030, payload_.at(0), "%u halvings, codes of %u bits", header_.halving_count, bits);
            return false;
        }
        const u64 count = header_.halving_count,
                  size = sizeof header_ + 4 * (structure_words() + words_for(count * bits));
        if (payload_.size != size)
            report_.add(6030, payload_.at(0), "%llu bytes instead of %llu", static_cast<ull>(payload_.size),
                        static_cast<ull>(size));
        return payload_.size == size;
    }

    // `nodes` has room for all halvings. Only a whole tree becomes part of `parts`: other chunks go through it.
    void make_nodes(AcdfHalving* nodes, Parts& parts) {
        const u64 codes_begin = sizeof header_ + 4 * structure_words();
        Bits structure(payload_, sizeof header_, codes_begin), codes(payload_, codes_begin, payload_.size);
        for (u32 code = 0; code < 1u << header_.code_bits; ++code)
            share_[code] = acdf_halving_share(code, header_.code_bits);
#ifdef ACDF_ENVIRONMENT_ONLY
        if (!take_tree(structure, codes, nodes)) return;
#else
        if (!take_trees(structure, codes, nodes)) return;
#endif
        if (made_ != header_.halving_count)
            return report_.add(6031, structure.place(), "%u nodes are halved, not %u", made_,
                               header_.halving_count);
#ifndef ACDF_ENVIRONMENT_ONLY
        if (wrong_bin_ != kNone)
            return report_.add(9007, trees_.bins_at + u64{wrong_bin_} * sizeof(AcdfBin), "bin %u: %u instead of %u",
                               wrong_bin_, trees_.bins[wrong_bin_].root, right_root_);
#endif
        parts.halvings = nodes;
        parts.halving_count = made_;
        check_zero(structure, "structure");
        check_zero(codes, "codes");
    }

    struct Open {
        AcdfSpan steps[MostAxes], box[MostAxes];
        u32 parent; // ACDF_LEAF: the root
        bool upper, dark;
    };

    // The open ends of a tree are at most one a level of each axis, and one more.
    static constexpr u32 kMostOpen = 31 * MostAxes + 1;

    u64 structure_words() const {
        const u64 count = header_.halving_count;
        return words_for(2 * count + trees_.count + count * axis_bits_);
    }

    bool take_tree(Bits& structure, Bits& codes, AcdfHalving* nodes) {
        open_[0] = {};
        open_[0].parent = ACDF_LEAF;
        for (u32 axis = 0; axis < trees_.axes; ++axis) {
            open_[0].steps[axis] = {{0, ACDF_STEPS}};
            open_[0].box[axis] = {{0, trees_.resolution[axis]}};
        }
        open_count_ = 1;
        while (open_count_ > 0)
            if (!take_node(structure, codes, nodes)) return false;
        return true;
    }

#ifndef ACDF_ENVIRONMENT_ONLY
    bool take_trees(Bits& structure, Bits& codes, AcdfHalving* nodes) {
        if (!trees_.bins) return take_tree(structure, codes, nodes);
        for (u32 bin = 0; bin < trees_.bin_count; ++bin) {
            const u32 first = made_;
            if (trees_.bins[bin].share > 0.0f && !take_tree(structure, codes, nodes)) return false;
            const u32 root = made_ > first ? first : ACDF_NO_ROOT;
            if (trees_.bins[bin].root == root || wrong_bin_ != kNone) continue;
            wrong_bin_ = bin;
            right_root_ = root;
        }
        return true;
    }
#endif

    void check_zero(Bits& bits, const char* what) {
        const u64 at = bits.place();
        while (bits.has(1))
            if (bits.take(1)) return report_.add(6034, at, "behind the %s", what);
    }

    bool take_node(Bits& structure, Bits& codes, AcdfHalving* nodes) {
        Open& node = open_[--open_count_];
        const u64 at = structure.place();
        const bool halved = structure.has(1) && structure.take(1);
        if (node.parent != ACDF_LEAF) {
            AcdfHalving& parent = nodes[node.parent];
            if (!halved) parent.link |= node.upper ? 16u : 8u;
            if (node.upper) parent.link |= (made_ - node.parent) << 5;
        }
        if (!halved) return true;
        if (made_ == header_.halving_count || !structure.has(axis_bits_)) {
            report_.add(6031, at, "more than %u nodes are halved", header_.halving_count);
            return false;
        }
        const u32 axis = axis_bits_ > 0 ? structure.take(axis_bits_) : 0;
        if (axis >= trees_.axes || node.box[axis].end[1] - node.box[axis].end[0] < 2) {
            report_.add(6032, at, axis >= trees_.axes ? "axis %u of %u" : "axis %u: one step is left", axis,
                        trees_.axes);
            return false;
        }
        return divide(node, axis, at, codes, nodes);
    }

    // `node` is overwritten by its upper half.
    bool divide(Open& node, u32 axis, u64 at, Bits& codes, AcdfHalving* nodes) {
        const u32 code = codes.take(header_.code_bits), last = (1u << header_.code_bits) - 1;
        const u32 wide = node.steps[axis].end[1] - node.steps[axis].end[0];
        if (node.dark || (code != 0 && code != last && wide < 2)) {
            report_.add(6033, at, node.dark ? "node %u has none" : "node %u has one", made_);
            return false;
        }
        const u32 threshold = acdf_halving_threshold(&node.steps[axis], code, header_.code_bits, share_[code]);
        const u32 middle = acdf_span_middle(&node.box[axis]);
        nodes[made_] = {threshold, axis};
        Open& lower = open_[open_count_ + 1] = node;
        lower.parent = node.parent = made_++;
        lower.upper = false;
        node.upper = true;
        lower.dark = code == 0;
        node.dark = code == last;
        lower.steps[axis].end[1] = node.steps[axis].end[0] = threshold;
        lower.box[axis].end[1] = node.box[axis].end[0] = middle;
        open_count_ += 2;
        return true;
    }

    const Payload& payload_;
    const AcdfHalvingsHeader& header_;
    Report& report_;
    const Trees& trees_;
    u32 axis_bits_ = 0, made_ = 0, open_count_ = 0;
#ifndef ACDF_ENVIRONMENT_ONLY
    static constexpr u32 kNone = 0xFFFFFFFFu;
    u32 wrong_bin_ = kNone, right_root_ = 0; // the first bin whose root is wrong
#endif
    u32 share_[1u << ACDF_MOST_CODE_BITS];
    Open open_[kMostOpen];
};

// False where rule 5014 is broken.
bool find_axes(const Parts& parts, Trees& trees) {
    for (u32 axis = 0; axis < parts.description->axis_count; ++axis)
        if (parts.axes[axis].role == ACDF_AXIS_SAMPLED) {
            const u32 steps = trees.resolution[trees.axes++] = parts.axes[axis].resolution;
            if (steps == 0 || steps > most_steps) return false;
        }
    return true;
}

} // namespace

void check_halvings(const Payload& payload, Report& report, const AcdfAllocator& allocator, Parts& parts) noexcept {
    Trees trees;
    if (!find_axes(parts, trees) || trees.axes != 2) return; // reported elsewhere
    HalvingsChecker<2>(payload, report, trees).run(allocator, parts);
}

#ifndef ACDF_ENVIRONMENT_ONLY
void check_table_halvings(const Payload& payload, const Payload& bins, Report& report,
                          const AcdfAllocator& allocator, Parts& parts) noexcept {
    Trees trees;
    if (!find_axes(parts, trees) || trees.axes == 0) return; // reported elsewhere
    trees.bins = parts.bins;
    trees.bins_at = bins.at(0);
    trees.bin_count = parts.description->bin_count;
    trees.count = 0;
    for (u32 bin = 0; bin < trees.bin_count; ++bin) trees.count += parts.bins[bin].share > 0.0f;
    using Checker = HalvingsChecker<ACDF_MAX_AXES>;
    AcdfBlock block = take_block({}, sizeof(Checker)); // too much for the small stacks of WebAssembly
    if (!block.data)
        return report.add(1003, payload.at(0), "%llu bytes to check nodes", static_cast<ull>(sizeof(Checker)));
    (new (block.data) Checker(payload, report, trees))->run(allocator, parts);
    give_block({}, block);
}
#endif

} // namespace acdf
