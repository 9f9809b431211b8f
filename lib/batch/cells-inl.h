// Cells and directions of a block of calls on a grid (acdf/grid.h): what environments and local environments share.
// Compiled once for each set of instructions, as vectors-inl.h.
#if defined(ACDF_BATCH_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ACDF_BATCH_CELLS_INL_H
#undef ACDF_BATCH_CELLS_INL_H
#else
#define ACDF_BATCH_CELLS_INL_H
#endif

#include "batch/descents.h"
#include "batch/rows.h"
#include "batch/vectors-inl.h"

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

using ManyFloats = hn::CappedTag<float, 16>;

struct Places {
    HWY_ALIGN float position[2][kBlock]; // of directions on the grid; NaN: single calls find them
    HWY_ALIGN double height[2][kBlock];  // of the rows of cells
};

// ---- cells ----

// The heights of the rows of cells that were found.
inline void look_up_heights(const AcdfEnvironment& env, const Descents& descents, std::size_t count,
                            Places& places) {
    if (env.parameterization == ACDF_PARAM_OCTAHEDRAL) return;
    const double* heights = acdf_halved_heights(env.halved);
    for (std::size_t i = 0; i < count; ++i)
        for (int end = 0; end < 2; ++end) places.height[end][i] = heights[descents.box[i][1].end[end]];
}

// The part of a cell's solid angle that its rows make.
HWY_INLINE Double height_of(const Grid& grid, Word low, Word high, const Places& places, std::size_t i) {
    if (grid.octahedral)
        return hn::Div(hn::Mul(set(2.0), hn::Sub(to_double(high), to_double(low))), set(grid.rows));
    return hn::Sub(hn::Load(Doubles(), places.height[0] + i), hn::Load(Doubles(), places.height[1] + i));
}

// The direction at fractions t of a cell.
HWY_INLINE void put_direction(const Grid& grid, Word b00, Word b01, Word b10, Word b11, Double t0, Double t1,
                              const Places& places, std::size_t i, float* out) {
    if (grid.octahedral)
        octahedral_direction(octahedral_position_on(grid.columns, b00, b01, t0),
                             octahedral_position_on(grid.rows, b10, b11, t1), out);
    else
        sphere_direction(grid, b00, b01, t0, hn::Load(Doubles(), places.height[0] + i),
                         hn::Load(Doubles(), places.height[1] + i), t1, out);
}

// How far across its cell a call lies in a tile, by the first steps of both.
HWY_INLINE Double tile_fraction(const Tiles& tiles, int axis, std::size_t i, Word low, Word tile_low, Double wide) {
    const Double step = hn::Mul(hn::Load(Doubles(), tiles.u[axis] + i), hn::Load(Doubles(), tiles.wide[axis] + i));
    return clamp(hn::Div(hn::Sub(step, to_double(hn::Sub(low, tile_low))), wide), set(0.0), set(1.0));
}

// ---- directions ----

// acdf_angle_nearly.
template <class F, class V = hn::Vec<F>>
HWY_INLINE V angle_nearly(F f, V y, V x) {
    const V angle = atan_float(f, hn::Div(hn::Min(x, y), hn::Max(x, y)));
    return hn::IfThenElse(hn::Gt(y, x), hn::Sub(hn::Set(f, 1.57079633f), angle), angle);
}

// Keeps a position on an axis, and its grid step; NaN where it is not valid.
template <class F, class V, class M>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<F>> keep_position(F f, V position, M valid, double resolution, float* out) {
    const hn::RebindToSigned<F> steps;
    hn::Store(hn::IfThenElse(valid, position, hn::NaN(f)), f, out);
    const auto step = hn::ConvertTo(steps, hn::IfThenElseZero(valid, position));
    return hn::BitCast(hn::RebindToUnsigned<F>(),
                       hn::Min(step, hn::Set(steps, static_cast<std::int32_t>(resolution) - 1)));
}

// acdf_sphere_nearly.
inline void place_nearly(const Grid& grid, const float* directions, std::size_t count, Places& places,
                         Descents& descents) {
    using V = hn::Vec<ManyFloats>;
    const ManyFloats f;
    const auto constant = [f](float x) { return hn::Set(f, x); };
    for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
        V x, y, z;
        hn::LoadInterleaved3(f, directions + 3 * i, x, y, z);
        const V sin2 = hn::Add(hn::Mul(x, x), hn::Mul(y, y)), length2 = hn::Add(sin2, hn::Mul(z, z));
        const auto valid = hn::And(hn::And(hn::Gt(length2, constant(0.9999f)), hn::Lt(length2, constant(1.0001f))),
                                   hn::Gt(sin2, constant(1e-12f)));
        const V east = hn::Mul(angle_nearly(f, hn::Abs(y), hn::Abs(x)), constant(0.15915494f));
        const V turn = hn::IfThenElse(hn::Lt(x, hn::Zero(f)), hn::Sub(constant(0.5f), east), east);
        const V angle = hn::Mul(angle_nearly(f, hn::Sqrt(sin2), hn::Abs(z)), constant(0.31830989f));
        const V column =
            hn::IfThenElse(hn::Lt(y, hn::Zero(f)), hn::Add(constant(0.5f), turn), hn::Sub(constant(0.5f), turn));
        const V row = hn::IfThenElse(hn::Lt(z, hn::Zero(f)), hn::Sub(constant(1.0f), angle), angle);
        hn::StoreInterleaved2(keep_position(f, hn::Mul(constant(static_cast<float>(grid.columns)), column), valid,
                                            grid.columns, places.position[0] + i),
                              keep_position(f, hn::Mul(constant(static_cast<float>(grid.rows)), row), valid,
                                            grid.rows, places.position[1] + i),
                              hn::RebindToUnsigned<ManyFloats>(), descents.target[i]);
    }
}

// The grid squares of directions on the octahedral square, as acdf_grid_square finds them; positions of
// directions that are not valid are NaN.
inline void place_on_square(const Grid& grid, const float* directions, std::size_t count, Places& places,
                            Descents& descents) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double x, y, z;
        load_vectors(directions + 3 * i, x, y, z);
        const Double length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        const auto valid = hn::And(hn::Gt(length, set(0.9995)), hn::Lt(length, set(1.0005)));
        Double u, v;
        octahedral_point(x, y, z, u, v);
        const auto step = [&](Double at, double resolution) {
            const Double position = hn::IfThenElseZero(valid, hn::Mul(at, set(resolution)));
            return hn::BitCast(Words(), hn::DemoteTo(Integers(), hn::Min(position, set(resolution - 1.0))));
        };
        hn::StoreInterleaved2(step(u, grid.columns), step(v, grid.rows), Words(), descents.target[i]);
        const Double marked = hn::IfThenElse(valid, set(0.0), hn::NaN(Doubles()));
        hn::Store(hn::DemoteTo(Floats(), marked), Floats(), places.position[0] + i);
    }
}

// Whether positions surely lie between two grid steps of an axis.
HWY_INLINE hn::Mask<Floats> is_surely_between(Word low, Word high, const float* position, double resolution) {
    const auto at = hn::Load(Floats(), position);
    const auto error = hn::Set(Floats(), static_cast<float>(resolution) * 4e-7f);
    const auto from = hn::ConvertTo(Floats(), hn::BitCast(Integers(), low));
    const auto to = hn::ConvertTo(Floats(), hn::BitCast(Integers(), high));
    return hn::And(hn::Gt(hn::Sub(at, from), error), hn::Gt(hn::Sub(to, at), error));
}

// Whether directions surely lie in cells.
HWY_INLINE hn::Mask<Floats> is_surely_in(const Grid& grid, Word b00, Word b01, Word b10, Word b11,
                                         const Places& places, std::size_t i) {
    const auto at = hn::Load(Floats(), places.position[0] + i);
    if (grid.octahedral) return hn::Eq(at, at);
    return hn::And(is_surely_between(b00, b01, places.position[0] + i, grid.columns),
                   is_surely_between(b10, b11, places.position[1] + i, grid.rows));
}

inline void place(const Grid& grid, const float* directions, std::size_t count, Places& places,
                  Descents& descents) {
    if (grid.octahedral) place_on_square(grid, directions, count, places, descents);
    else place_nearly(grid, directions, count, places, descents);
}

// Calls serve(i, n) for blocks of n calls from i on that are whole vectors. Returns how many are done.
template <class Serve>
std::size_t in_blocks(std::size_t count, Serve&& serve) {
    const std::size_t vector = hn::Lanes(ManyFloats());
    std::size_t done = 0;
    while (count - done >= vector) {
        const std::size_t n = std::min(kBlock, (count - done) / vector * vector);
        serve(done, n);
        done += n;
    }
    return done;
}

#endif
} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#endif
