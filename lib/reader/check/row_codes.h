// The codes of the rows of normals, as they are read from NORM. Not installed.
#pragma once

#include "check/top.h"

namespace acdf {

/// Goes through the splits of the top for one row after the other, in preorder.
class RowCodes {
public:
    RowCodes(const AcdfHalving* nodes, const u8* splits, u32 code_bits)
        : nodes_(nodes), splits_(splits), code_bits_(code_bits) {
        for (u32 code = 0; code < 1u << code_bits; ++code) share_[code] = acdf_halving_share(code, code_bits);
    }

    /// Takes the codes of a row from `bits`. Calls visit(before, lower) for each split: the steps of all tiles
    /// before it, and of its lower half. False where codes are missing or
    /// wrong: `wrong` says which.
    template <class Visit>
    bool row(Bits& bits, const Visit& visit) {
        u32 waiting = 0;
        if (has_codes(0)) open_[waiting++] = {0, 0, ACDF_STEPS};
        while (waiting > 0) {
            const Open at = open_[--waiting];
            u32 lower = 0;
            if (at.steps > 0 && !take(bits, at.steps, lower)) return false;
            visit(at.before, lower);
            const u32 link = nodes_[at.node].link;
            const u32 half[2] = {at.node + 1, at.node + (link >> 5)};
            if (!(link >> 4 & 1u) && has_codes(half[1]))
                open_[waiting++] = {half[1], at.before + lower, at.steps - lower};
            if (!(link >> 3 & 1u) && has_codes(half[0])) open_[waiting++] = {half[0], at.before, lower};
        }
        return true;
    }

    bool has_codes(u32 node) const { return splits_[node / 8] >> node % 8 & 1u; }
    const char* wrong = "";

private:
    struct Open {
        u32 node, before, steps;
    };

    bool take(Bits& bits, u32 steps, u32& lower) {
        if (!bits.has(code_bits_)) {
            wrong = "codes are missing";
            return false;
        }
        const u32 last = (1u << code_bits_) - 1;
        const u32 code = bits.take(code_bits_);
        if (code != 0 && code != last && steps < 2) {
            wrong = "one step is divided";
            return false;
        }
        const AcdfSpan span = {{0, steps}};
        lower = acdf_halving_threshold(&span, code, code_bits_, share_[code]);
        return true;
    }

    const AcdfHalving* nodes_;
    const u8* splits_;
    u32 code_bits_;
    u32 share_[1u << ACDF_MOST_ROW_CODE_BITS];
    Open open_[most_open_halvings];
};

} // namespace acdf
