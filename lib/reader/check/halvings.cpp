// Chunk HALV: the bits of its trees become flat nodes in the pass that checks them.
#include "check/bits.h"
#include "memory.h"

namespace acdf {

namespace {

// One tree, or one for each bin with a share.
class HalvingsChecker {
public:
    HalvingsChecker(const Payload& payload, Report& report, Parts& parts)
        : payload_(payload), header_(*reinterpret_cast<const AcdfHalvingsHeader*>(payload.data)), report_(report),
          parts_(parts) {
        for (u32 axis = 0; axis < parts.description->axis_count; ++axis)
            if (parts.axes[axis].role == ACDF_AXIS_SAMPLED) {
                steps_[axes_] = {{0, ACDF_STEPS}};
                box_[axes_++] = {{0, parts.axes[axis].resolution}};
            }
        while (1u << axis_bits_ < axes_) ++axis_bits_;
    }

    // False where rule 5012 or 5014 is broken.
    bool has_axes() const {
        for (u32 axis = 0; axis < axes_; ++axis)
            if (box_[axis].end[1] == 0 || box_[axis].end[1] > most_steps) return false;
        return axes_ > 0;
    }
    u32 axes() const { return axes_; }

    // Only whole trees become part of `parts`: other chunks go through them. `bins`: BINS, where each has a tree.
    void run(const AcdfAllocator& allocator, const Payload* bins) {
        if (payload_.size < sizeof header_) return report_.add(6030, payload_.at(0), "HALV ends early");
        u64 trees = bins ? 0 : 1;
        for (u32 bin = 0; bins && bin < parts_.description->bin_count; ++bin)
            trees += parts_.bins[bin].share > 0.0f;
        const u64 count = header_.halving_count,
                  codes_at = sizeof header_ + 4 * words_for(2 * count + trees + count * axis_bits_);
        if (!header_is_right(codes_at)) return;
        const std::size_t bytes = (header_.halving_count + std::size_t{1}) * sizeof(AcdfHalving);
        parts_.halvings_block = take_block(allocator, bytes);
        nodes_ = static_cast<AcdfHalving*>(parts_.halvings_block.data);
        if (!nodes_) return report_.add(1003, payload_.at(0), "%llu bytes for nodes", static_cast<ull>(bytes));
        structure_ = Bits(payload_, sizeof header_, codes_at);
        codes_ = Bits(payload_, codes_at, payload_.size);
        for (u32 code = 0; code < 1u << header_.code_bits; ++code)
            share_[code] = acdf_halving_share(code, header_.code_bits);
#ifndef ACDF_ENVIRONMENT_ONLY
        if (bins && !take_trees(*bins)) return;
#endif
        if (!bins && !take_tree()) return;
        parts_.halvings = nodes_;
        parts_.halving_count = made_;
        check_zero(structure_, "structure");
        check_zero(codes_, "codes");
    }

private:
    bool header_is_right(u64 codes_at) {
        const u32 bits = header_.code_bits;
        const u64 size = codes_at + 4 * words_for(u64{header_.halving_count} * bits);
        if (bits < ACDF_LEAST_CODE_BITS || bits > ACDF_MOST_CODE_BITS ||
            header_.halving_count > ACDF_MOST_HALVINGS || header_.reserved[0] != 0 || header_.reserved[1] != 0)
            report_.add(6030, payload_.at(0),
                        "HALV has %u halvings, codes of %u bits, or reserved fields that are not zero",
                        header_.halving_count, bits);
        else if (payload_.size != size)
            report_.add(6030, payload_.at(0), "HALV has %llu bytes instead of %llu",
                        static_cast<ull>(payload_.size), static_cast<ull>(size));
        else return true;
        return false;
    }

    bool take_tree() { return take_node(ACDF_LEAF, false, false) && has_all(); }

    bool has_all() {
        if (made_ != header_.halving_count)
            report_.add(6031, structure_.place(), "%u nodes of HALV are halved, not %u", made_,
                        header_.halving_count);
        return made_ == header_.halving_count;
    }

#ifndef ACDF_ENVIRONMENT_ONLY
    bool take_trees(const Payload& payload) {
        constexpr u32 none = 0xFFFFFFFFu;
        u32 wrong = none, right_root = 0; // the first bin whose root is wrong
        for (u32 bin = 0; bin < parts_.description->bin_count; ++bin) {
            const u32 first = made_;
            if (parts_.bins[bin].share > 0.0f && !take_node(ACDF_LEAF, false, false)) return false;
            const u32 root = made_ > first ? first : ACDF_NO_ROOT;
            if (parts_.bins[bin].root == root || wrong != none) continue;
            wrong = bin;
            right_root = root;
        }
        if (!has_all()) return false;
        if (wrong != none)
            report_.add(9007, payload.at(0) + u64{wrong} * sizeof(AcdfBin), "bin %u has the root %u instead of %u",
                        wrong, parts_.bins[wrong].root, right_root);
        return wrong == none;
    }
#endif

    void check_zero(Bits& bits, const char* what) {
        const u64 at = bits.place();
        while (bits.has(1))
            if (bits.take(1)) return report_.add(6034, at, "padding behind the %s of HALV is not zero", what);
    }

    // The node that comes next, in steps_ and box_, with all below it: at most 31 deep for each axis, whose steps
    // each halving halves. `parent`: ACDF_LEAF of a root; `dark`: no random number leads to it.
    bool take_node(u32 parent, bool upper, bool dark) {
        const u64 at = structure_.place();
        const bool halved = structure_.has(1) && structure_.take(1);
        if (parent != ACDF_LEAF) {
            if (!halved) nodes_[parent].link |= upper ? 16u : 8u;
            if (upper) nodes_[parent].link |= (made_ - parent) << 5;
        }
        if (!halved) return true;
        if (made_ == header_.halving_count || !structure_.has(axis_bits_)) {
            report_.add(6031, at, "more than %u nodes of HALV are halved, or halves are missing",
                        header_.halving_count);
            return false;
        }
        const u32 axis = axis_bits_ > 0 ? structure_.take(axis_bits_) : 0;
        if (axis >= axes_ || box_[axis].end[1] - box_[axis].end[0] < 2) {
            report_.add(6032, at, "node %u is halved on axis %u, which is not sampled or has one step left", made_,
                        axis);
            return false;
        }
        const u32 code = codes_.take(header_.code_bits), last = (1u << header_.code_bits) - 1;
        if (dark || (code != 0 && code != last && steps_[axis].end[1] - steps_[axis].end[0] < 2)) {
            report_.add(6033, at, "node %u is halved, but has too few random numbers", made_);
            return false;
        }
        return divide(axis, code);
    }

    bool divide(u32 axis, u32 code) {
        const AcdfSpan steps = steps_[axis], box = box_[axis];
        const u32 threshold = acdf_halving_threshold(&steps, code, header_.code_bits, share_[code]),
                  middle = acdf_span_middle(&box), own = made_++;
        nodes_[own] = {threshold, axis};
        steps_[axis].end[1] = threshold;
        box_[axis].end[1] = middle;
        if (!take_node(own, false, code == 0)) return false;
        steps_[axis] = {{threshold, steps.end[1]}};
        box_[axis] = {{middle, box.end[1]}};
        if (!take_node(own, true, code == (1u << header_.code_bits) - 1)) return false;
        steps_[axis] = steps;
        box_[axis] = box;
        return true;
    }

    const Payload& payload_;
    const AcdfHalvingsHeader& header_;
    Report& report_;
    Parts& parts_;
    AcdfHalving* nodes_ = nullptr;
    Bits structure_{payload_, 0, 0}, codes_{payload_, 0, 0};
    u32 axes_ = 0, axis_bits_ = 0, made_ = 0; // axes_: that are sampled
    AcdfSpan steps_[ACDF_MAX_AXES], box_[ACDF_MAX_AXES];
    u32 share_[1u << ACDF_MOST_CODE_BITS];
};

} // namespace

void check_halvings(const Payload& payload, const Payload* bins, Report& report, const AcdfAllocator& allocator,
                    Parts& parts) noexcept {
    HalvingsChecker checker(payload, report, parts);
    if (checker.has_axes() && (bins || checker.axes() == 2))
        checker.run(allocator, bins); // else reported elsewhere
}

} // namespace acdf
