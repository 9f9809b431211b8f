// Pdfs of BrdfBatch over vectors, and of many directions for one view: tables give the cell, whatever the
// view, and what each view gives to it. Internal linkage: see brdf_kernel.h.
#pragma once

#include "batch/brdf_kernel.h"

namespace {

/* How many borders lie at or below a square. */
ACDF_LANE int borders_below(const acdf::BatchBorders& borders, long long step, long long square) {
    int below = borders.guide[step];
    const __m256i squares = _mm256_set1_epi32((int)square);
    for (;;) {
        const __m256i some = _mm256_loadu_si256((const __m256i*)(borders.position + below));
        const int above = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(some, squares)));
        const int more = __builtin_ctz((unsigned)above | 1u << ACDF_BORDERS_AT_ONCE);
        below += more;
        if (more < ACDF_BORDERS_AT_ONCE) return below;
    }
}

/* The step of the guide and the square. */
ACDF_LANE void find_square(Vector position, double resolution, long long* step, long long* square) {
    const Vector bounded = select(position < resolution, position, all(resolution - 1.0));
    const Integer binades =
        (Integer)((Unsigned)bounded >> (52 - ACDF_BORDER_STEP_BITS)) - (0x3FFLL << ACDF_BORDER_STEP_BITS);
    *(Integer*)step = most(binades, Integer{});
    *(Integer*)square = truncated(bounded);
}

/* Lanes whose cells are found and asked for from memory. */
template <int Groups>
struct PdfsOf {
    static constexpr std::size_t kLanes = Groups * kWidth;
    View view[Groups];
    Place place[Groups];
    Integer valid[Groups];
    int cell[kLanes];
};

/* Of views that are known. */
template <int Groups>
ACDF_LANE void find(const BatchTable& t, const float (*wi)[3], PdfsOf<Groups>* d) {
    constexpr std::size_t lanes = PdfsOf<Groups>::kLanes;
    alignas(64) long long step[2][lanes], square[2][lanes], lower[lanes];
    Directions half[Groups];
    for (int g = 0; g < Groups; ++g)
        d->valid[g] = half_of(d->view[g], load(&wi[g * kWidth]), &half[g], &d->place[g]);
    for (int g = 0; g < Groups; ++g) {
        const int lane = g * kWidth;
        place_half(t, d->view[g], half[g], &d->place[g]);
        for (int axis = 0; axis < 2; ++axis)
            find_square(select(d->valid[g], d->place[g].position[axis], all(0.0)), axis ? t.rows : t.columns,
                        &step[axis][lane], &square[axis][lane]);
        *(Integer*)&lower[lane] = d->view[g].lower;
    }
    for (std::size_t i = 0; i < lanes; ++i) {
        const int column = borders_below(t.borders[0], step[0][i], square[0][i]);
        const int line = borders_below(t.borders[1], step[1][i], square[1][i]);
        d->cell[i] = t.grid[line * t.columns_between + column];
        __builtin_prefetch(t.parts + d->cell[i] * t.stride + lower[i]);
    }
}

template <int Groups>
ACDF_LANE void end(const BatchTable& t, const PdfsOf<Groups>& d, float* out) {
    Vector part[Groups][2], area[Groups];
    for (int g = 0; g < Groups; ++g) {
        const Integer cell = widened(&d.cell[g * kWidth]);
        gather_pairs<8>(t.parts, multiplied(cell, t.stride) + d.view[g].lower, part[g]);
        area[g] = (Vector)gathered<8>(t.areas, cell);
    }
    for (int g = 0; g < Groups; ++g) {
        const Vector share = share_of(d.view[g], part[g]); // NaN where no view weighs anything
        const Vector probability = select(d.valid[g] & (share > 0.0), positive(share), all(0.0));
        store(&out[g * kWidth], density(t, probability, area[g], d.place[g]));
    }
}

/* A block of them. */
using ViewPdfs = PdfsOf<kGroups>;

ACDF_LANE void begin(const BatchTable& t, const float (*wo)[3], const float (*wi)[3], ViewPdfs* d) {
    find_views(t, wo, d->view);
    find(t, wi, d);
}

// ---- of one view -----------------------------------------------------------------------------------------------

/* A view that lanes share. */
ACDF_LANE View same_view(const AcdfBrdfView& view) {
    View out;
    out.wo = {all(view.wo[0]), all(view.wo[1]), all(view.wo[2])};
    for (int i = 0; i < 2; ++i) {
        out.turn[i] = all(view.turn[i]);
        out.weight[i] = all(view.pair[i]);
    }
    out.lower = Integer{} + view.lower;
    return out;
}

/* Pdfs of a view, of up to `Lanes` directions. */
template <int Lanes>
ACDF_LANE void some_view_pdfs(const BatchTable& t, const AcdfBrdfView& view, const float (*wi)[3],
                              std::size_t count, float* out) {
    PdfsOf<Lanes / kWidth> d;
    for (View& v : d.view) v = same_view(view);
    float last[Lanes][3] = {}, told[Lanes];
    if (count < Lanes) std::memcpy(last, wi, count * sizeof *wi);
    find(t, count < Lanes ? last : wi, &d);
    end(t, d, told);
    std::memcpy(out, told, count * sizeof *told);
}

/* acdf_brdf_view_pdf of an array of directions: sixteen at once, or as many as are left. */
ACDF_LANE void view_pdfs(const BatchTable& t, const AcdfBrdfView& view, const float (*wi)[3], std::size_t count,
                         float* out) {
    constexpr std::size_t most = 16, few = 8;
    for (; count > few; count -= most, wi += most, out += most) {
        some_view_pdfs<most>(t, view, wi, count < most ? count : most, out);
        if (count <= most) return;
    }
    if (count > kWidth) some_view_pdfs<few>(t, view, wi, count, out);
    else if (count > 0) some_view_pdfs<kWidth>(t, view, wi, count, out);
}

} // namespace
