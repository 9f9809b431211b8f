// Which rows of a local file serve normals, and with which weights: acdf_local_at, as many as vectors hold.
// Compiled once for each set of instructions, as vectors-inl.h.
#if defined(ACDF_BATCH_NORMALS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ACDF_BATCH_NORMALS_INL_H
#undef ACDF_BATCH_NORMALS_INL_H
#else
#define ACDF_BATCH_NORMALS_INL_H
#endif

#include "batch/mixtures-inl.h"

#include <acdf/local.h>

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

// acdf_octahedral_corner: whole numbers, of which `west`, `back` and `south` are below 0.
HWY_INLINE Double corner(Double n, Double ax, Double ay, Double az, hn::Mask<Doubles> west, hn::Mask<Doubles> back,
                         hn::Mask<Doubles> south) {
    const Double one = set(1.0), two = set(2.0), r = hn::Sub(n, az);
    const Double any = hn::Min(r, one), of_west = hn::IfThenElseZero(west, one);
    const Double upper = hn::Add(any, hn::Mul(hn::Mul(two, r), hn::Sub(r, any)));
    const Double lower =
        hn::Sub(hn::Add(hn::Mul(hn::Mul(set(4.0), n), n), one), hn::Mul(hn::Mul(two, r), hn::Add(r, one)));
    const Double quarter = hn::IfThenElse(back, hn::Sub(set(3.0), of_west), of_west);
    const Double along = hn::IfThenElse(hn::Xor(west, back), ax, ay);
    return hn::Add(hn::Add(hn::IfThenElse(south, lower, upper), hn::Mul(quarter, r)), along);
}

// acdf_octahedral_bins.
inline void find_corners(std::uint32_t subdivisions, std::size_t count, Mixtures& mixtures) {
    const Double n = set(static_cast<double>(subdivisions)), zero = set(0.0), one = set(1.0);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double x, y, z;
        load_vectors(mixtures.vectors + 3 * i, x, y, z);
        const Double sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
        const auto valid = hn::And(hn::Gt(sum, zero), hn::Lt(sum, hn::Inf(Doubles())));
        const auto scaled = [&](Double a) {
            return hn::IfThenElseZero(valid, hn::Mul(hn::Div(hn::Abs(a), sum), n));
        };
        const Double ax = scaled(x), ay = scaled(y), az = scaled(z);
        Double bx = hn::Floor(ax), by = hn::Floor(ay), bz = hn::Floor(az);
        const Double fx = hn::Sub(ax, bx), fy = hn::Sub(ay, by), fz = hn::Sub(az, bz);
        Double over = hn::Sub(hn::Sub(hn::Sub(n, bx), by), bz);
        const Double carry = hn::IfThenElseZero(hn::Gt(over, set(2.0)), one);
        bx = hn::Add(bx, carry);
        by = hn::Add(by, carry);
        bz = hn::Add(bz, carry);
        over = hn::IfThenElseZero(hn::Le(over, set(2.0)), over);
        // At a corner all stay; else one is added to this axis, or to both others in a triangle that points down.
        const auto between = hn::Gt(over, zero);
        const Double down = hn::IfThenElseZero(hn::Gt(over, one), one);
        const Double own = hn::IfThenElseZero(between, hn::Sub(one, down)), other = down;
        const auto put = [&](int k, Double fraction, Double cx, Double cy, Double cz) {
            const Double part = hn::Abs(hn::Sub(down, fraction)), alone = set(k == 0 ? 1.0 : 0.0);
            const Double length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(cx, cx), hn::Mul(cy, cy)), hn::Mul(cz, cz)));
            const Double weight = hn::IfThenElseZero(valid, hn::Mul(hn::IfThenElse(between, part, alone), length));
            const auto negative = [&](Double given, Double c) {
                return hn::And(hn::Lt(given, zero), hn::Gt(c, zero));
            };
            const Double bin = corner(n, cx, cy, cz, negative(x, cx), negative(y, cy), negative(z, cz));
            hn::Store(weight, Doubles(), mixtures.weight[k] + i);
            hn::Store(hn::BitCast(Words(), hn::DemoteTo(Integers(), hn::IfThenElseZero(valid, bin))), Words(),
                      mixtures.row[k] + i);
        };
        put(0, fx, hn::Add(bx, own), hn::Add(by, other), hn::Add(bz, other));
        put(1, fy, hn::Add(bx, other), hn::Add(by, own), hn::Add(bz, other));
        put(2, fz, hn::Add(bx, other), hn::Add(by, other), hn::Add(bz, own));
    }
}

inline void mix_normals(const AcdfLocal& local, std::size_t count, Mixtures& mixtures) {
    find_corners(local.subdivisions, count, mixtures);
    for (std::size_t i = 0; i < count; ++i) mixtures.take_rows<ACDF_NORMALS_MIXED>(local.bins, i, true);
    make_whole<ACDF_NORMALS_MIXED>(count, mixtures);
}

#endif
} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#endif
