// What kernels share: acdf/elementary.h, and directions and pdfs of cells (acdf/grid.h), of as many calls at once
// as the vectors of a processor hold. Each function gives the bits of the one that it is named after. Compiled once
// for each set of instructions (hwy/foreach_target.h); functions instead of operators, which not all of them have.
#if defined(ACDF_BATCH_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ACDF_BATCH_VECTORS_INL_H
#undef ACDF_BATCH_VECTORS_INL_H
#else
#define ACDF_BATCH_VECTORS_INL_H
#endif

#include <acdf/sample.h>

#include <hwy/highway.h>

#include <cstdint>

// Where vectors are emulated, or have no doubles, the loop over single calls is as fast.
#undef ACDF_BATCH_SINGLY
#if HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR || !HWY_HAVE_FLOAT64
#define ACDF_BATCH_SINGLY 1
#else
#define ACDF_BATCH_SINGLY 0
#endif

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 16>; // at most: blocks hold whole vectors
using Floats = hn::Rebind<float, Doubles>;
using Words = hn::Rebind<std::uint32_t, Doubles>;
using Integers = hn::Rebind<std::int32_t, Doubles>;
using Double = hn::Vec<Doubles>;
using Word = hn::Vec<Words>;

HWY_INLINE Double set(double x) { return hn::Set(Doubles(), x); }

// Vectors of three floats.
HWY_INLINE void load_vectors(const float* given, Double& x, Double& y, Double& z) {
    hn::Vec<Floats> given_x, given_y, given_z;
    hn::LoadInterleaved3(Floats(), given, given_x, given_y, given_z);
    x = hn::PromoteTo(Doubles(), given_x);
    y = hn::PromoteTo(Doubles(), given_y);
    z = hn::PromoteTo(Doubles(), given_z);
}

// Integers below 2^31.
HWY_INLINE Double to_double(Word x) { return hn::PromoteTo(Doubles(), hn::BitCast(Integers(), x)); }
// high - low, from 0 to 2^31.
HWY_INLINE Double width(Word low, Word high) {
    return hn::Add(to_double(hn::Sub(hn::Sub(high, low), hn::Set(Words(), 1u))), set(1.0));
}

// ---- acdf/random.h ----

HWY_INLINE Double unit_interval(Double u) {
    const auto valid = hn::And(hn::Gt(u, set(0.0)), hn::Lt(u, hn::Inf(Doubles())));
    return hn::IfThenElseZero(valid, hn::Min(u, set(1.0)));
}

// Pairs of random numbers, in [0, 1].
HWY_INLINE void load_numbers(const double* u, Double& u0, Double& u1) {
    hn::LoadInterleaved2(Doubles(), u, u0, u1);
    u0 = unit_interval(u0);
    u1 = unit_interval(u1);
}

// acdf_step_of.
HWY_INLINE hn::Vec<Words> step_of(Double u) {
    const Double step = hn::Min(hn::Mul(u, set(2147483648.0)), set(2147483647.0));
    return hn::BitCast(Words(), hn::DemoteTo(Integers(), step));
}

// ---- acdf/elementary.h ----

HWY_INLINE Double clamp(Double x, Double low, Double high) {
    return hn::IfThenElse(hn::Lt(x, low), low, hn::IfThenElse(hn::Gt(x, high), high, x));
}

// acdf_sign(x + 0.0): 1 or -1.
HWY_INLINE Double sign(Double x) { return hn::IfThenElse(hn::Lt(x, set(0.0)), set(-1.0), set(1.0)); }

HWY_INLINE Double polynomial4(Double q, double c0, double c1, double c2, double c3) {
    const Double low = hn::Add(set(c0), hn::Mul(q, set(c1))), high = hn::Add(set(c2), hn::Mul(q, set(c3)));
    return hn::Add(low, hn::Mul(hn::Mul(q, q), high));
}
HWY_INLINE Double polynomial8(Double q, double c0, double c1, double c2, double c3, double c4, double c5, double c6,
                              double c7) {
    const Double q2 = hn::Mul(q, q);
    return hn::Add(polynomial4(q, c0, c1, c2, c3), hn::Mul(hn::Mul(q2, q2), polynomial4(q, c4, c5, c6, c7)));
}
HWY_INLINE Double sine(Double y) { return hn::Mul(y, polynomial8(hn::Mul(y, y), ACDF_SINE_SERIES)); }
HWY_INLINE Double cosine(Double y) {
    const Double q = hn::Mul(y, y);
    return hn::Add(set(1.0), hn::Mul(q, polynomial8(q, ACDF_COSINE_SERIES)));
}

HWY_INLINE void sincospi(Double x, Double& sine_out, Double& cosine_out) {
    const hn::RebindToUnsigned<Doubles> bits;
    const Double turned = hn::Floor(hn::Add(hn::Mul(set(2.0), x), set(4.5)));
    const Double y = hn::Mul(hn::Sub(x, hn::Mul(set(0.5), hn::Sub(turned, set(4.0)))), set(ACDF_PI));
    const auto s = hn::BitCast(bits, sine(y)), c = hn::BitCast(bits, cosine(y));
    const auto quadrant = hn::BitCast(bits, hn::Add(turned, set(0x1p52))); // its last bits
    const auto one = hn::Set(bits, 1u), two = hn::Set(bits, 2u);
    const auto swapped = hn::And(hn::Xor(s, c), hn::Sub(hn::Zero(bits), hn::And(quadrant, one)));
    const auto sine_sign = hn::ShiftLeft<62>(hn::And(quadrant, two));
    const auto cosine_sign = hn::ShiftLeft<62>(hn::And(hn::Add(quadrant, one), two));
    sine_out = hn::BitCast(Doubles(), hn::Xor(hn::Xor(s, swapped), sine_sign));
    cosine_out = hn::BitCast(Doubles(), hn::Xor(hn::Xor(c, swapped), cosine_sign));
}

HWY_INLINE Double narrow_atanpi(Double w) {
    const Double q = hn::Mul(w, w), q2 = hn::Mul(q, q), q4 = hn::Mul(q2, q2);
    const Double low =
        polynomial8(q, 0.31830988618379064, -0.10610329539458131, 0.063661977233113842, -0.045472840550007838,
                    0.035367749436769451, -0.028936829427649351, 0.024477882221680791, -0.0211365210662873);
    const Double high =
        hn::Add(set(0.018106577949592299),
                hn::Mul(q, hn::Add(set(-0.01384028005905886), hn::Mul(q, set(0.0067275982242772812)))));
    return hn::Mul(w, hn::Add(low, hn::Mul(hn::Mul(q4, q4), high)));
}

HWY_INLINE Double atan2pi(Double y, Double x) {
    const Double ax = hn::Abs(x), ay = hn::Abs(y), high = hn::Max(ax, ay), low = hn::Min(ax, ay), east = sign(x);
    const Double narrow = sign(hn::Sub(hn::Mul(set(0.41421356237309503), high), low));
    const Double wide = hn::Sub(set(0.5), hn::Mul(set(0.5), narrow)), level = sign(hn::Sub(ax, ay));
    const Double w = hn::IfThenElseZero(
        hn::Gt(high, set(0.0)), hn::Div(hn::Sub(low, hn::Mul(wide, high)), hn::Add(high, hn::Mul(wide, low))));
    const Double narrow_turn = hn::Add(narrow_atanpi(w), hn::Mul(set(0.25), wide));
    const Double turn = hn::Add(hn::Sub(set(0.25), hn::Mul(set(0.25), level)), hn::Mul(level, narrow_turn));
    return hn::Mul(sign(y), hn::Add(hn::Sub(set(0.5), hn::Mul(set(0.5), east)), hn::Mul(east, turn)));
}

HWY_INLINE hn::Mask<Doubles> is_unit_square(Double length2) {
    return hn::And(hn::Gt(length2, set(0.999)), hn::Lt(length2, set(1.001)));
}

// acdf_atan_float.
template <class F, class V = hn::Vec<F>>
HWY_INLINE V atan_float(F f, V t) {
    const auto pair = [f](V q, float c0, float c1) { return hn::Add(hn::Set(f, c0), hn::Mul(q, hn::Set(f, c1))); };
    const V q = hn::Mul(t, t), q2 = hn::Mul(q, q);
    const V low = hn::Add(pair(q, 0.99999988f, -0.33331813f), hn::Mul(q2, pair(q, 0.19966962f, -0.14003290f)));
    const V high =
        hn::Add(pair(q, 0.098688655f, -0.058829753f), hn::Mul(q2, pair(q, 0.023780519f, -0.0045597920f)));
    return hn::Mul(t, hn::Add(low, hn::Mul(hn::Mul(q2, q2), high)));
}

// ---- acdf/halvings.h ----

// acdf_span_fraction.
HWY_INLINE Double span_fraction(Word low, Double wide, Double u) {
    return hn::Min(hn::Div(hn::Sub(hn::Mul(u, set(2147483648.0)), to_double(low)), wide), set(1.0));
}

// ---- acdf/sphere.h and acdf/octahedral.h ----

// Cells: where they begin on both axes, how wide they are, and the heights of their rows (lat-long grids).
struct Grid {
    double columns, rows;
    bool octahedral;

    explicit Grid(const AcdfEnvironment& env)
        : columns(env.columns), rows(env.rows), octahedral(env.parameterization == ACDF_PARAM_OCTAHEDRAL) {}
};

// The direction of acdf_sphere_position_between, at fractions t of a cell.
HWY_INLINE void sphere_direction(const Grid& grid, Word low, Word high, Double t0, Double z0, Double z1, Double t1,
                                 float* out) {
    const Double west = to_double(low), east = to_double(high), one = set(1.0);
    const Double beside = set(grid.columns * (ACDF_BORDER / (2.0 * ACDF_PI)));
    const Double x =
        clamp(hn::Add(west, hn::Mul(t0, hn::Sub(east, west))), hn::Add(west, beside), hn::Sub(east, beside));
    Double z = hn::Add(z0, hn::Mul(t1, hn::Sub(z1, z0)));
    Double radius = hn::Sqrt(hn::Mul(hn::Sub(one, z), hn::Add(one, z)));
    const Double border = hn::Mul(set(ACDF_BORDER), radius);
    const Double kept =
        clamp(clamp(z, hn::Add(z1, border), hn::Sub(z0, border)), set(-1.0 + 0.5 * ACDF_BORDER * ACDF_BORDER),
              set(1.0 - 0.5 * ACDF_BORDER * ACDF_BORDER));
    if (!hn::AllTrue(Doubles(), hn::Eq(kept, z))) { // rarely
        z = kept;
        radius = hn::Sqrt(hn::Mul(hn::Sub(one, z), hn::Add(one, z)));
    }
    Double s, c;
    sincospi(hn::Sub(one, hn::Div(hn::Mul(set(2.0), x), set(grid.columns))), s, c);
    hn::StoreInterleaved3(hn::DemoteTo(Floats(), hn::Mul(radius, c)), hn::DemoteTo(Floats(), hn::Mul(radius, s)),
                          hn::DemoteTo(Floats(), z), Floats(), out);
}

// acdf_octahedral_position_on.
HWY_INLINE Double octahedral_position_on(double resolution, Word low, Word high, Double t) {
    const Double begin = to_double(low), end = to_double(high), border = set(resolution * (0.5 * ACDF_BORDER));
    return hn::Div(
        clamp(hn::Add(begin, hn::Mul(t, hn::Sub(end, begin))), hn::Add(begin, border), hn::Sub(end, border)),
        set(resolution));
}

// acdf_octahedral_direction.
HWY_INLINE void octahedral_direction(Double u, Double v, float* out) {
    const Double one = set(1.0), two = set(2.0), half = set(0.5);
    const Double a = hn::Abs(hn::Sub(hn::Mul(two, u), one)), b = hn::Abs(hn::Sub(hn::Mul(two, v), one));
    const Double beyond = hn::Sub(hn::Add(a, b), one), r = hn::Sub(one, hn::Abs(beyond));
    const Double radius = hn::Mul(r, hn::Sqrt(hn::Sub(one, hn::Mul(hn::Mul(half, r), r))));
    const Double turn =
        hn::IfThenElseZero(hn::Gt(r, set(0.0)), hn::Mul(hn::Div(hn::Sub(b, a), r), set(0.25 * ACDF_PI)));
    const Double s = sine(turn), c = cosine(turn);
    const Double x = hn::Mul(radius, hn::Sub(c, s)), y = hn::Mul(radius, hn::Add(c, s));
    hn::StoreInterleaved3(hn::DemoteTo(Floats(), hn::IfThenElse(hn::Gt(u, half), hn::Neg(x), x)),
                          hn::DemoteTo(Floats(), hn::IfThenElse(hn::Lt(v, half), hn::Neg(y), y)),
                          hn::DemoteTo(Floats(), hn::Mul(hn::Neg(beyond), hn::Add(one, r))), Floats(), out);
}

// acdf_octahedral_point of directions of any length; z may be negative.
HWY_INLINE void octahedral_point(Double dx, Double dy, Double dz, Double& u, Double& v) {
    const Double x = hn::Abs(dx), y = hn::Abs(dy), z = hn::Abs(dz), zero = set(0.0), one = set(1.0),
                 half = set(0.5);
    const Double sin2 = hn::Add(hn::Mul(x, x), hn::Mul(y, y)), length = hn::Sqrt(hn::Add(sin2, hn::Mul(z, z)));
    const Double r = hn::Sqrt(hn::Div(sin2, hn::Mul(length, hn::Add(length, z))));
    const Double inner_b = hn::Mul(hn::Mul(set(2.0), atan2pi(y, x)), r), inner_a = hn::Sub(r, inner_b);
    const auto folded = hn::Lt(dz, zero);
    const Double a = hn::IfThenElse(folded, hn::Sub(one, inner_b), inner_a);
    const Double b = hn::IfThenElse(folded, hn::Sub(one, inner_a), inner_b);
    const Double half_a = hn::Mul(half, a), half_b = hn::Mul(half, b);
    u = clamp(hn::IfThenElse(hn::Gt(dx, zero), hn::Sub(half, half_a), hn::Add(half, half_a)), zero, one);
    v = clamp(hn::IfThenElse(hn::Lt(dy, zero), hn::Sub(half, half_b), hn::Add(half, half_b)), zero, one);
}

// A pdf in the range of float: 0 stays 0.
HWY_INLINE hn::Vec<Floats> float_pdf(Double pdf) {
    const Double in_range = hn::Max(hn::Min(pdf, set(static_cast<double>(3.402823466e38f))), set(0x1p-126));
    return hn::DemoteTo(Floats(), hn::IfThenElseZero(hn::Gt(pdf, set(0.0)), in_range));
}

// The solid angle of cells, in columns.
HWY_INLINE Double area_of(Double wide, Double height) { return hn::Mul(hn::Mul(set(2.0 * ACDF_PI), wide), height); }

#endif
} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#endif
