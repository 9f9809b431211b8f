// Which cells random numbers lead to half-way between two stored views.
#include "tables/brdf.h"

#include <algorithm>

namespace acdf {

namespace {

using u32 = std::uint32_t;

/// Cells of one pair of views.
class Guesses {
public:
    Guesses(const AcdfBrdf& brdf, u32 lower, u32 bits, std::uint16_t* out)
        : brdf_(brdf), entries_(1u << bits), out_(out) {
        const u32 upper = std::min(lower + 1, brdf.views->theta_count - 1);
        row_[0] = acdf_blend_row(&brdf.blend, brdf.bins[lower].root);
        row_[1] = acdf_blend_row(&brdf.blend, brdf.bins[upper].root);
        const double share[2] = {static_cast<double>(brdf.bins[lower].share),
                                 static_cast<double>(brdf.bins[upper].share)};
        Box whole = {{0.0, 0.0}, {1.0, 1.0}, {share[0], share[1]}};
        if (!(share[0] + share[1] > 0.0)) whole.weight[0] = whole.weight[1] = 1.0;
        fill(acdf_blend_root(&brdf.blend), whole);
    }

private:
    /// Random numbers that lead to a node, and what rows give to it.
    struct Box {
        double low[2], width[2], weight[2];
    };

    /// The first entry whose middle lies at or above u.
    u32 entry(double u) const {
        const double at = u * entries_ + 0.5;
        const u32 whole = static_cast<u32>(at);
        return std::min(whole, entries_);
    }

    // A path passes at most 48 splits. Boxes without an entry are left.
    void fill(u32 node, const Box& box) {
        u32 first[2], last[2];
        for (int axis = 0; axis < 2; ++axis) {
            first[axis] = entry(box.low[axis]);
            last[axis] = entry(box.low[axis] + box.width[axis]);
            if (first[axis] >= last[axis]) return;
        }
        if (node & ACDF_TILE_FLAG) {
            for (u32 line = first[1]; line < last[1]; ++line)
                std::fill(out_ + line * entries_ + first[0], out_ + line * entries_ + last[0],
                          static_cast<std::uint16_t>(node & ~ACDF_TILE_FLAG));
            return;
        }
        const AcdfSplit& split = brdf_.blend.splits[node];
        const u32 axis = split.place & 7u;
        Box lower = box, upper = box;
        for (int i = 0; i < 2; ++i) {
            lower.weight[i] = box.weight[i] * (brdf_.blend.tiles->codebook[row_[i][node]] / 65535.0);
            upper.weight[i] = box.weight[i] - lower.weight[i];
        }
        const double whole = box.weight[0] + box.weight[1];
        lower.width[axis] = whole > 0.0 ? box.width[axis] * ((lower.weight[0] + lower.weight[1]) / whole) : 0.0;
        upper.low[axis] = box.low[axis] + lower.width[axis];
        upper.width[axis] = box.width[axis] - lower.width[axis];
        fill(split.child[0], lower);
        fill(split.child[1], upper);
    }

    const AcdfBrdf& brdf_;
    u32 entries_; // a side
    std::uint16_t* out_;
    const std::uint8_t* row_[2];
};

} // namespace

void guess_brdf_cells(const AcdfBrdf& brdf, u32 bits, std::uint16_t* out) noexcept {
    const u32 last = brdf.views->theta_count > 1 ? brdf.views->theta_count - 2 : 0;
    for (u32 lower = 0; lower <= last; ++lower) {
        std::uint16_t* const guesses = out + (std::size_t{lower} << 2 * bits);
        std::fill_n(guesses, std::size_t{1} << 2 * bits, std::uint16_t{0});
        Guesses(brdf, lower, bits, guesses);
    }
}

} // namespace acdf
