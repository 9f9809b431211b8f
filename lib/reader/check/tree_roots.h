// A tree that is being checked, and where it begins. Not installed.
#pragma once

#include "check/kinds.h"

#include <acdf/sample.h>

namespace acdf {

struct CheckedTree {
    const Payload& payload;
    const Payload& bins;
    const Parts& parts;
    std::uint32_t kind;
    std::uint32_t units;

    const std::uint8_t* data() const { return payload.data; }
    bool sampled(std::uint32_t axis) const {
        return axis < parts.description->axis_count && parts.axes[axis].role == ACDF_AXIS_SAMPLED;
    }
    std::uint32_t unit(std::uint32_t at) const { return reinterpret_cast<const std::uint16_t*>(payload.data)[at]; }
};

/// Where a tree begins.
struct TreeRoot {
    std::uint32_t unit;
    std::uint64_t at; ///< the offset in the file that says so
    std::uint32_t bin;
};

/// The trees of each bin, one after the other. Unit 0 is one too in local environments, whose bins need not be
/// stored; nor need those of BRDFs.
class TreeRoots {
public:
    explicit TreeRoots(const CheckedTree& tree)
        : tree_(tree), indexed_(tree.kind == ACDF_KIND_LOCAL || tree.kind == ACDF_KIND_BRDF),
          whole_(tree.kind == ACDF_KIND_LOCAL), count_(tree.parts.description->bin_count) {}

    /// False behind the last one.
    bool next(TreeRoot& root) {
        if (whole_) {
            whole_ = false;
            root = {0, tree_.payload.at(0), 0};
            return true;
        }
        while (next_ < count_) {
            const std::uint32_t bin = next_++;
            root = {tree_.parts.bins[bin].root, tree_.bins.at(std::uint64_t{bin} * sizeof(AcdfBin)), bin};
            if (!indexed_ || root.unit != ACDF_NO_ROOT) return true;
        }
        return false;
    }

private:
    const CheckedTree& tree_;
    bool indexed_, whole_; ///< whether some may have none; whether unit 0 is still to come
    std::uint32_t count_, next_ = 0;
};

/// Codes of sizes that there are.
inline bool header_is_legal(std::uint32_t header) {
    return ACDF_CURVE_CUMULATIVE_CODE(header) <= 2 && ACDF_CURVE_POSITION_CODE(header) <= 2;
}

/// The number of segments of a curve, 0 where it is missing, too large or written in the wrong form.
inline std::uint32_t segments_of(const CheckedTree& tree, std::uint32_t unit) {
    const std::uint32_t few = tree.unit(unit) >> ACDF_CURVE_SEGMENTS_SHIFT;
    if (few != 0) return few;
    if (tree.units - unit < 3) return 0;
    const std::uint32_t many = tree.unit(unit + 1) | tree.unit(unit + 2) << 16;
    return many > ACDF_CURVE_SHORT_SEGMENTS && many <= ACDF_MAX_SEGMENTS ? many : 0;
}

/// Whether all is right with a tree that lies as most do: behind each curve what is below it, each curve below one
/// segment, roots in their order, those inside other trees where all axes are whole. In one pass and without
/// memory; where it is false, the tree may be right nevertheless, and what is wrong remains to be found.
bool is_right_in_preorder(const CheckedTree& tree) noexcept;

} // namespace acdf
