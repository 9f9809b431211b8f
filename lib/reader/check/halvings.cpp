// Chunk HALV: its bits become flat nodes in the pass that checks them.
#include "check/bits.h"
#include "memory.h"

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

// Axes of an environment.
constexpr u32 kAxes = 2;

// The open ends of a tree are at most one a level of each axis, and one more.
constexpr u32 most_open_nodes = 31 * kAxes + 1;

class HalvingsChecker {
public:
    HalvingsChecker(const Payload& payload, Report& report, const Parts& parts)
        : payload_(payload), header_(*reinterpret_cast<const AcdfHalvingsHeader*>(payload.data)), report_(report) {
        for (u32 axis = 0; axis < parts.description->axis_count; ++axis)
            if (parts.axes[axis].role == ACDF_AXIS_SAMPLED) resolution_[axes_++] = parts.axes[axis].resolution;
        while (1u << axis_bits_ < axes_) ++axis_bits_;
    }

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
        Open root = {};
        root.parent = ACDF_LEAF;
        for (u32 axis = 0; axis < axes_; ++axis) {
            root.steps[axis] = {{0, ACDF_STEPS}};
            root.box[axis] = {{0, resolution_[axis]}};
        }
        open_[0] = root;
        open_count_ = 1;
        while (open_count_ > 0)
            if (!take_node(structure, codes, nodes)) return;
        if (made_ != header_.halving_count)
            return report_.add(6031, structure.place(), "%u nodes are halved, not %u", made_,
                               header_.halving_count);
        parts.halvings = nodes;
        parts.halving_count = made_;
        check_zero(structure, "structure");
        check_zero(codes, "codes");
    }

private:
    struct Open {
        AcdfSpan steps[kAxes], box[kAxes];
        u32 parent; // ACDF_LEAF: the root
        bool upper, dark;
    };

    u64 structure_words() const {
        const u64 count = header_.halving_count;
        return words_for(2 * count + 1 + count * axis_bits_);
    }

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
        const u32 axis = structure.take(axis_bits_);
        if (axis >= axes_ || node.box[axis].end[1] - node.box[axis].end[0] < 2) {
            report_.add(6032, at, axis >= axes_ ? "axis %u of %u" : "axis %u: one step is left", axis, axes_);
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
    u32 axes_ = 0, axis_bits_ = 0, made_ = 0, open_count_ = 0;
    u32 resolution_[kAxes] = {};
    u32 share_[1u << ACDF_MOST_CODE_BITS];
    Open open_[most_open_nodes];
};

} // namespace

void check_halvings(const Payload& payload, Report& report, const AcdfAllocator& allocator, Parts& parts) noexcept {
    if (payload.size < sizeof(AcdfHalvingsHeader)) {
        report.add(6030, payload.at(0), "%llu bytes", static_cast<ull>(payload.size));
        return;
    }
    u32 sampled = 0;
    for (u32 axis = 0; axis < parts.description->axis_count; ++axis)
        sampled += parts.axes[axis].role == ACDF_AXIS_SAMPLED;
    if (sampled != kAxes) return; // check_environment_axes reports it
    HalvingsChecker checker(payload, report, parts);
    if (!checker.header_is_right()) return;
    const u32 count = reinterpret_cast<const AcdfHalvingsHeader*>(payload.data)->halving_count;
    const std::size_t bytes = (count + std::size_t{1}) * sizeof(AcdfHalving);
    parts.halvings_block = take_block(allocator, bytes);
    if (!parts.halvings_block.data)
        return report.add(1003, payload.at(0), "%llu bytes for nodes", static_cast<ull>(bytes));
    checker.make_nodes(static_cast<AcdfHalving*>(parts.halvings_block.data), parts);
}

} // namespace acdf
