// Samples of one view of a BRDF file over vectors, by the file's own runtime tables: its rows are traversed as
// BrdfBatch traverses its arrays. Internal linkage: see brdf_kernel.h.
#pragma once

#include "batch/brdf_pdf_kernel.h"

namespace {

/* Part of a split's lower part in each of the two rows. */
ACDF_LANE void lower_parts(const double* codes, const AcdfBrdfView& view, Integer split, Vector out[2]) {
    alignas(64) long long at[ACDF_WIDTH];
    alignas(64) double part[2][ACDF_WIDTH];
    *(Integer*)at = split;
    for (int i = 0; i < ACDF_WIDTH; ++i) {
        part[0][i] = codes[view.row[0][at[i]]];
        part[1][i] = codes[view.row[1][at[i]]];
    }
    for (int row = 0; row < 2; ++row) out[row] = *(const Vector*)part[row];
}

/* sample_step by a file's splits. Lanes that are in a cell give all to the lower part of a split that is not
 * entered, which changes nothing. */
ACDF_LANE void view_step(const AcdfSplit* splits, const double* codes, const AcdfBrdfView& view, Walk* s) {
    static_assert(offsetof(AcdfSplit, child) == 4);
    const Integer ended = s->node >= (long long)ACDF_TILE_FLAG, at = select(ended, Integer{}, s->node);
    const Integer split = gathered<sizeof(AcdfSplit)>(splits, at);
    Vector part[2];
    lower_parts(codes, view, at, part);
    const Vector code[2] = {select(ended, all(1.0), part[0]), select(ended, all(1.0), part[1])};
    const Integer upper = go(s, code, (split & 7) != 0);
    s->node = select(ended, s->node, select(upper, split >> 48, split >> 32) & 0xFFFF);
}

/* Samples of a view, Groups vectors of them, of which `some` are asked for. */
template <int Groups>
ACDF_LANE void view_samples(const BatchTable& t, const AcdfBrdf& brdf, const AcdfBrdfView& view,
                            const double (*u)[2], std::size_t some, AcdfDirectionSample* out) {
    constexpr std::size_t lanes = Groups * kWidth;
    const double* codes = (const double*)acdf_brdf_words(brdf.tables, brdf.tables->codes);
    const char* boxes = (const char*)acdf_brdf_words(brdf.tables, brdf.tables->paths) + offsetof(AcdfBrdfPath, low);
    static_assert(offsetof(AcdfBrdfPath, high) == offsetof(AcdfBrdfPath, low) + 8);
    const View of = same_view(view);
    double given[lanes][2] = {};
    AcdfDirectionSample drawn[lanes];
    Walk walked[Groups];
    Vector sign[Groups];
    std::memcpy(given, u, some * sizeof *u);
    for (int g = 0; g < Groups; ++g) {
        const double* first = given[g * kWidth];
        begin_walk(t, of, every_second(first), every_second(first + 1), &walked[g], &sign[g]);
        walked[g].node = Integer{} + acdf_blend_root(&brdf.blend);
    }
    for (;;) {
        Integer open{};
        for (int g = 0; g < Groups; ++g) open |= walked[g].node < (long long)ACDF_TILE_FLAG;
        if (!any(open)) break;
        for (int g = 0; g < Groups; ++g) view_step(brdf.blend.splits, codes, view, &walked[g]);
    }
    Cell cells[Groups];
    for (int g = 0; g < Groups; ++g) {
        Vector sides[2];
        gather_pairs<sizeof(AcdfBrdfPath)>(boxes, walked[g].node & 0x7FFF, sides);
        const Integer low = (Integer)sides[0], high = (Integer)sides[1];
        cells[g] = {{low_word(low), high_word(low)}, {low_word(high), high_word(high)}};
    }
    std::uint64_t left = end_samples<Groups>(t, &of, true, walked, cells, sign, drawn);
    for (std::size_t i = 0; left != 0 && i < some; ++i, left >>= 1)
        if (left & 1) drawn[i] = acdf_brdf_view_sample(&brdf, &view, given[i][0], given[i][1]);
    std::memcpy(out, drawn, some * sizeof *out);
}

/* acdf_brdf_view_sample of an array of numbers: sixteen at once, or as many as are left. */
ACDF_LANE void view_samples(const BatchTable& t, const AcdfBrdf& brdf, const AcdfBrdfView& view,
                            const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    constexpr std::size_t most = 16, few = 8;
    for (; count > few; count -= most, u += most, out += most) {
        view_samples<most / kWidth>(t, brdf, view, u, count < most ? count : most, out);
        if (count <= most) return;
    }
    if (count > kWidth) view_samples<few / kWidth>(t, brdf, view, u, count, out);
    else if (count > 0) view_samples<1>(t, brdf, view, u, count, out);
}

} // namespace
