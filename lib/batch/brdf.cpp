// BRDFs by rows of halvings: tiles and descents of a block of calls in turns, between vectors of what is computed
// before and after.
#include <acdf/batch/batch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/brdf.cpp"
#include <hwy/foreach_target.h>
//
#include "batch/cells-inl.h"
#include "batch/views-inl.h"

#ifndef ACDF_BATCH_BRDF_ONCE
#define ACDF_BATCH_BRDF_ONCE
namespace acdf::batch {

// What serves a view, if anything does.
struct Seen {
    AcdfBrdfView view;
    bool valid;
};
inline void look(const AcdfBrdf* brdf, const float wo[3], Seen* out) {
    out->valid = acdf_brdf_view(brdf, wo, &out->view) != 0;
}
using Views = Conditions<AcdfBrdf, Seen, look>;

inline AcdfDirectionSample sample_of(const AcdfBrdf& brdf, const Seen& seen, const double u[2]) {
    const AcdfDirectionSample nothing = {{0.0f, 0.0f, 0.0f}, 0.0f};
    return seen.valid ? acdf_brdf_view_sample(&brdf, &seen.view, u[0], u[1]) : nothing;
}
inline float pdf_of(const AcdfBrdf& brdf, const Seen& seen, const float wi[3]) {
    return seen.valid ? acdf_brdf_view_pdf(&brdf, &seen.view, wi) : 0.0f;
}

} // namespace acdf::batch
#endif

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {
#if !ACDF_BATCH_SINGLY

// ---- acdf/brdf_half.h ----

struct BrdfBlock {
    HWY_ALIGN double wo[3][kBlock];
    HWY_ALIGN double turn[2][kBlock];
    HWY_ALIGN double sign[kBlock];                // of samples: on which side of the mirror they lie
    HWY_ALIGN double position[2][kBlock];         // of directions, half-vectors; NaN: single calls find them
    HWY_ALIGN double rows[2][kBlock];             // where the rows of cells begin and end
    HWY_ALIGN double dot[kBlock], length[kBlock]; // of directions, as AcdfBrdfPosition
    Mixtures mixtures;
    Tiles tiles;
};

// What vectors need of a file.
struct Table {
    double columns, rows, floor;
    bool mirrored;

    explicit Table(const AcdfBrdf& brdf)
        : columns(brdf.columns), rows(brdf.rows), floor(static_cast<double>(brdf.views->diffuse_share)),
          mirrored(acdf_brdf_mirrored(&brdf) != 0) {}
};

HWY_INLINE Double at(const double* lanes, std::size_t i) { return hn::Load(Doubles(), lanes + i); }
HWY_INLINE Double three(Double a, Double b, Double c) { return hn::Add(hn::Add(a, b), c); }
HWY_INLINE Double dot_of(const BrdfBlock& block, std::size_t i, Double x, Double y, Double z) {
    return three(hn::Mul(at(block.wo[0], i), x), hn::Mul(at(block.wo[1], i), y), hn::Mul(at(block.wo[2], i), z));
}

// acdf_brdf_half of wi. Returns where it is valid.
HWY_INLINE hn::Mask<Doubles> half_of(const BrdfBlock& block, std::size_t i, Double x, Double y, Double z,
                                     Double& hx, Double& hy, Double& hz, Double& length, Double& dot) {
    const Double length2 = three(hn::Mul(x, x), hn::Mul(y, y), hn::Mul(z, z));
    hx = hn::Add(at(block.wo[0], i), x);
    hy = hn::Add(at(block.wo[1], i), y);
    hz = hn::Add(at(block.wo[2], i), z);
    length = hn::Sqrt(three(hn::Mul(hx, hx), hn::Mul(hy, hy), hn::Mul(hz, hz)));
    dot = hn::Abs(dot_of(block, i, hx, hy, hz));
    return hn::And(is_unit_square(length2), hn::Gt(length, set(0.0)));
}

// acdf_brdf_azimuth.
HWY_INLINE Double azimuth(Double y, Double x) {
    const Double ax = hn::Abs(x), high = hn::Max(ax, y), low = hn::Min(ax, y), zero = set(0.0);
    const auto wide = hn::Lt(hn::Mul(set(0.41421356237309503), high), low);
    const Double w = hn::IfThenElseZero(hn::Gt(high, zero), hn::Div(hn::Sub(low, hn::IfThenElseZero(wide, high)),
                                                                    hn::Add(high, hn::IfThenElseZero(wide, low))));
    Double turn = hn::Add(hn::IfThenElseZero(wide, set(0.25)), narrow_atanpi(w));
    turn = hn::Add(hn::IfThenElseZero(hn::Lt(ax, y), set(0.5)), hn::Mul(sign(hn::Sub(ax, y)), turn));
    return hn::Add(hn::IfThenElseZero(hn::Lt(x, zero), set(1.0)), hn::Mul(sign(x), turn));
}

// The pdf of acdf_brdf_cell_pdf in cells of probability p.
HWY_INLINE hn::Vec<Floats> half_pdf(const Table& table, Double p, Double area, Double length, Double dot,
                                    Double z) {
    const Double samples = hn::Mul(hn::Mul(hn::Mul(p, set(table.columns)), set(table.rows)), length);
    const auto any = hn::Gt(p, set(0.0));
    Double pdf = hn::IfThenElseZero(any, hn::Div(samples, hn::Mul(hn::Mul(set(8.0 * ACDF_PI), dot), area)));
    auto counts = any;
    if (table.floor > 0.0) {
        const Double diffuse = hn::IfThenElseZero(hn::Gt(z, set(0.0)), hn::Mul(set(table.floor / ACDF_PI), z));
        pdf = hn::Add(hn::Mul(set(1.0 - table.floor), pdf), diffuse);
        counts = hn::Or(any, hn::Gt(pdf, set(1.17549435e-38)));
    }
    const Double in_range = hn::Max(hn::Min(pdf, set(static_cast<double>(3.402823466e38f))), set(0x1p-126));
    return hn::DemoteTo(Floats(), hn::IfThenElseZero(counts, in_range));
}

// The probability of cells in tiles.
HWY_INLINE Double probability_of(const Tiles& tiles, std::size_t i, Double w0, Double w1) {
    return hn::Mul(at(tiles.probability, i),
                   hn::Div(hn::Mul(w0, w1), hn::Mul(at(tiles.wide[0], i), at(tiles.wide[1], i))));
}

// Finds the rows of the views of calls from `first` on, and the turns of acdf_brdf_turn.
template <int most>
void take_views(const AcdfBrdf& brdf, const float* views, std::size_t each, std::size_t first, std::size_t count,
                BrdfBlock& block) {
    mix_views<most>(brdf, block.mixtures.take(views, each, first, count), block.mixtures);
    set_rows<most>(brdf.rows_of_views, block.mixtures, count, block.tiles);
    for (std::size_t i = 0; i < count; ++i) {
        const float* wo = block.mixtures.vector_of(i);
        const double x = static_cast<double>(wo[0]), y = static_cast<double>(wo[1]);
        const bool turned = brdf.views->phi_count == 1 && x * x + y * y > 0.0;
        for (int k = 0; k < 3; ++k) block.wo[k][i] = static_cast<double>(wo[k]);
        block.turn[0][i] = turned ? x : 1.0;
        block.turn[1][i] = turned ? y : 0.0;
    }
}

void look_up_rows(const AcdfBrdf& brdf, std::size_t count, BrdfBlock& block) {
    const double* begins = acdf_halved_heights(brdf.halved);
    for (std::size_t i = 0; i < count; ++i)
        for (int end = 0; end < 2; ++end) block.rows[end][i] = begins[block.tiles.descents.box[i][1].end[end]];
}

// ---- samples ----

// acdf_brdf_begin. Numbers that sample the cosine's share are left to single calls, which are marked by NaN.
void take_numbers(const Table& table, const double* u, std::size_t count, BrdfBlock& block) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double u0, u1, side = set(1.0);
        load_numbers(u + 2 * i, u0, u1);
        if (table.floor > 0.0) {
            const auto diffuse = hn::Lt(u1, set(table.floor));
            u1 = hn::IfThenZeroElse(diffuse, hn::Div(hn::Sub(u1, set(table.floor)), set(1.0 - table.floor)));
            side = hn::IfThenElse(diffuse, hn::NaN(Doubles()), side);
        }
        if (table.mirrored) {
            const Double v = hn::Sub(hn::Mul(set(2.0), u0), set(1.0));
            u0 = hn::Abs(v);
            side = hn::Mul(side, sign(v));
        }
        hn::Store(u0, Doubles(), block.tiles.u[0] + i);
        hn::Store(u1, Doubles(), block.tiles.u[1] + i);
        hn::Store(side, Doubles(), block.sign + i);
    }
}

// acdf_brdf_end, where rounding carries nothing over a border; else pdfs are -1.
void put_samples(const Table& table, std::size_t count, const BrdfBlock& block, float* directions, float* pdfs) {
    const Tiles& tiles = block.tiles;
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11, low0, low1; // low and high of axis 0, and of axis 1
        hn::LoadInterleaved4(Words(), tiles.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), tiles.descents.box[i][0].end, b00, b01, b10, b11);
        hn::LoadInterleaved2(Words(), tiles.low[i], low0, low1);
        const Double w0 = width(s00, s01), w1 = width(s10, s11), least = set(0x1p-30), most = set(1.0 - 0x1p-30);
        const Double from0 = to_double(b00), to0 = to_double(b01), from1 = at(block.rows[0], i),
                     to1 = at(block.rows[1], i), wide0 = hn::Sub(to0, from0), wide1 = hn::Sub(to1, from1);
        const Double t0 = clamp(tile_fraction(tiles, 0, i, s00, low0, w0), least, most);
        const Double t1 = clamp(tile_fraction(tiles, 1, i, s10, low1, w1), least, most);
        const Double position0 = hn::Add(from0, hn::Mul(t0, wide0)), position1 = hn::Add(from1, hn::Mul(t1, wide1));
        // acdf_brdf_reflect.
        const Double part = hn::Div(position0, set(table.columns)), cap = hn::Div(position1, set(table.rows));
        const Double turn0 = at(block.turn[0], i), turn1 = at(block.turn[1], i), side = at(block.sign, i);
        const Double radius = hn::Sqrt(hn::Mul(cap, hn::Sub(set(2.0), cap))), hz = hn::Sub(set(1.0), cap);
        const Double scale = hn::Div(radius, hn::Sqrt(hn::Add(hn::Mul(turn0, turn0), hn::Mul(turn1, turn1))));
        Double s, c;
        sincospi(table.mirrored ? hn::Mul(side, part) : hn::Sub(hn::Mul(set(2.0), part), set(1.0)), s, c);
        const Double hx = hn::Mul(scale, hn::Sub(hn::Mul(turn0, c), hn::Mul(turn1, s)));
        const Double hy = hn::Mul(scale, hn::Add(hn::Mul(turn1, c), hn::Mul(turn0, s)));
        const Double twice = hn::Mul(set(2.0), dot_of(block, i, hx, hy, hz));
        const auto x = hn::DemoteTo(Floats(), hn::Sub(hn::Mul(twice, hx), at(block.wo[0], i)));
        const auto y = hn::DemoteTo(Floats(), hn::Sub(hn::Mul(twice, hy), at(block.wo[1], i)));
        const auto z = hn::DemoteTo(Floats(), hn::Sub(hn::Mul(twice, hz), at(block.wo[2], i)));
        const Double turn = hn::Div(set(0x1p-23), hn::Mul(hn::Abs(twice), radius)), angle = hn::Mul(turn, radius);
        const Double reach0 = hn::Mul(set(table.columns), turn);
        const Double reach1 = hn::Mul(set(table.rows), hn::Mul(angle, hn::Add(radius, angle)));
        // acdf_brdf_inside, and the half-vector of what was rounded.
        const auto inside =
            hn::And(hn::And(hn::Ge(position0, hn::Add(from0, reach0)), hn::Lt(position0, hn::Sub(to0, reach0))),
                    hn::And(hn::Ge(position1, hn::Add(from1, reach1)), hn::Lt(position1, hn::Sub(to1, reach1))));
        Double x_of_half, y_of_half, z_of_half, length, dot;
        const auto valid = half_of(block, i, hn::PromoteTo(Doubles(), x), hn::PromoteTo(Doubles(), y),
                                   hn::PromoteTo(Doubles(), z), x_of_half, y_of_half, z_of_half, length, dot);
        const auto pdf = half_pdf(table, probability_of(tiles, i, w0, w1), hn::Mul(wide0, wide1), length, dot,
                                  hn::PromoteTo(Doubles(), z));
        const Double known = hn::IfThenElse(hn::And(hn::And(inside, valid), hn::Eq(side, side)),
                                            hn::PromoteTo(Doubles(), pdf), set(-1.0));
        hn::StoreInterleaved3(x, y, z, Floats(), directions + 3 * i);
        hn::StoreU(hn::DemoteTo(Floats(), known), Floats(), pdfs + i);
    }
}

template <int most>
void samples_of_block(const AcdfBrdf& brdf, const double* u, std::size_t count, BrdfBlock& block, float* directions,
                      float* pdfs) {
    const Table table(brdf);
    take_numbers(table, u, count, block);
    block.tiles.sample<most>(brdf.rows_of_views, acdf_halvings_nodes(brdf.halved), count);
    look_up_rows(brdf, count, block);
    put_samples(table, count, block, directions, pdfs);
    for (std::size_t i = 0; i < count; ++i)
        if (!(pdfs[i] > 0.0f) || !block.mixtures.serves(i))
            put_sample(acdf_brdf_sample(&brdf, block.mixtures.vector_of(i), u[2 * i], u[2 * i + 1]),
                       directions + 3 * i, pdfs + i);
}

// ---- pdfs ----

// acdf_brdf_half_position.
void place_halves(const Table& table, const float* directions, std::size_t count, BrdfBlock& block) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double x, y, z, half_x, half_y, half_z, length, dot;
        load_vectors(directions + 3 * i, x, y, z);
        const auto valid = half_of(block, i, x, y, z, half_x, half_y, half_z, length, dot);
        const Double below = sign(half_z), turn0 = at(block.turn[0], i), turn1 = at(block.turn[1], i);
        const Double hx = hn::Mul(below, hn::Add(hn::Mul(turn0, half_x), hn::Mul(turn1, half_y)));
        const Double hy = hn::Mul(below, hn::Sub(hn::Mul(turn0, half_y), hn::Mul(turn1, half_x)));
        Double phi = azimuth(hn::Abs(hy), hx);
        if (!table.mirrored) phi = hn::Add(set(0.5), hn::Mul(hn::Mul(set(0.5), sign(hy)), phi));
        const Double sin2 = hn::Add(hn::Mul(half_x, half_x), hn::Mul(half_y, half_y));
        const Double cap = hn::Div(sin2, hn::Mul(length, hn::Add(length, hn::Abs(half_z))));
        const Double nowhere = hn::NaN(Doubles());
        hn::Store(hn::IfThenElse(valid, hn::Mul(set(table.columns), phi), nowhere), Doubles(),
                  block.position[0] + i);
        hn::Store(hn::IfThenElse(valid, hn::Mul(set(table.rows), cap), nowhere), Doubles(), block.position[1] + i);
        hn::Store(length, Doubles(), block.length + i);
        hn::Store(dot, Doubles(), block.dot + i);
    }
}

// The grid steps of half-vectors.
void take_squares(const AcdfBrdf& brdf, std::size_t count, BrdfBlock& block) {
    const double* begins = acdf_halved_heights(brdf.halved);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = block.position[0][i], y = block.position[1][i];
        const bool valid = x >= 0.0 && y >= 0.0; // else of views, too, that are none
        block.tiles.descents.target[i][0] = valid ? acdf_brdf_step(x, brdf.columns) : 0;
        block.tiles.descents.target[i][1] = valid ? acdf_half_row_of(begins, y) : 0;
    }
}

template <int most>
void pdfs_of_block(const AcdfBrdf& brdf, const float* directions, std::size_t count, BrdfBlock& block,
                   float* pdfs) {
    const Table table(brdf);
    const Tiles& tiles = block.tiles;
    place_halves(table, directions, count, block);
    take_squares(brdf, count, block);
    block.tiles.find<most>(brdf.rows_of_views, acdf_halvings_nodes(brdf.halved), count);
    look_up_rows(brdf, count, block);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11;
        hn::LoadInterleaved4(Words(), tiles.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), tiles.descents.box[i][0].end, b00, b01, b10, b11);
        Double x, y, z;
        load_vectors(directions + 3 * i, x, y, z);
        const Double p = probability_of(tiles, i, width(s00, s01), width(s10, s11));
        const Double area = hn::Mul(width(b00, b01), hn::Sub(at(block.rows[1], i), at(block.rows[0], i)));
        hn::StoreU(half_pdf(table, p, area, at(block.length, i), at(block.dot, i), z), Floats(), pdfs + i);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (!(block.position[0][i] >= 0.0) || !block.mixtures.serves(i))
            pdfs[i] = acdf_brdf_pdf(&brdf, block.mixtures.vector_of(i), directions + 3 * i);
}

// How many calls were served by blocks.
template <int most>
std::size_t brdf_samples_in_blocks(const AcdfBrdf& brdf, const float* wo, std::size_t each, const double* u,
                                   std::size_t count, float* directions, float* pdfs) {
    BrdfBlock block;
    return in_blocks(count, [&](std::size_t i, std::size_t n) {
        take_views<most>(brdf, wo, each, i, n, block);
        samples_of_block<most>(brdf, u + 2 * i, n, block, directions + 3 * i, pdfs + i);
    });
}
template <int most>
std::size_t brdf_pdfs_in_blocks(const AcdfBrdf& brdf, const float* wo, std::size_t each, const float* directions,
                                std::size_t count, float* pdfs) {
    BrdfBlock block;
    return in_blocks(count, [&](std::size_t i, std::size_t n) {
        take_views<most>(brdf, wo, each, i, n, block);
        pdfs_of_block<most>(brdf, directions + 3 * i, n, block, pdfs + i);
    });
}

#else

template <int most>
std::size_t brdf_samples_in_blocks(const AcdfBrdf&, const float*, std::size_t, const double*, std::size_t, float*,
                                   float*) {
    return 0;
}
template <int most>
std::size_t brdf_pdfs_in_blocks(const AcdfBrdf&, const float*, std::size_t, const float*, std::size_t, float*) {
    return 0;
}

#endif

void brdf_samples(const AcdfBrdf& brdf, const float* wo, std::size_t each, const double* u, std::size_t count,
                  float* wi, float* pdfs) {
    std::size_t i = 0;
    if (brdf.halved && brdf.views->phi_count == 1)
        i = brdf_samples_in_blocks<2>(brdf, wo, each, u, count, wi, pdfs);
    else if (brdf.halved) i = brdf_samples_in_blocks<ACDF_MOST_ROWS_MIXED>(brdf, wo, each, u, count, wi, pdfs);
    Views views(brdf, wo, each);
    views.one_by_one(i, count, [&](std::size_t at, const Seen& seen) {
        put_sample(sample_of(brdf, seen, u + 2 * at), wi + 3 * at, pdfs + at);
    });
}

void brdf_pdfs(const AcdfBrdf& brdf, const float* wo, std::size_t each, const float* wi, std::size_t count,
               float* pdfs) {
    std::size_t i = 0;
    if (brdf.halved && brdf.views->phi_count == 1) i = brdf_pdfs_in_blocks<2>(brdf, wo, each, wi, count, pdfs);
    else if (brdf.halved) i = brdf_pdfs_in_blocks<ACDF_MOST_ROWS_MIXED>(brdf, wo, each, wi, count, pdfs);
    Views views(brdf, wo, each);
    views.one_by_one(i, count,
                     [&](std::size_t at, const Seen& seen) { pdfs[at] = pdf_of(brdf, seen, wi + 3 * at); });
}

} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace acdf {
namespace batch {
HWY_EXPORT(brdf_samples);
HWY_EXPORT(brdf_pdfs);
} // namespace batch

void sample_batch(const BrdfView& view, const float (*wo)[3], std::size_t each, const double (*u)[2],
                  std::size_t count, float (*wi)[3], float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(brdf_samples)(view.data(), wo[0], each, u[0], count, wi[0], pdfs);
}

void pdf_batch(const BrdfView& view, const float (*wo)[3], std::size_t each, const float (*wi)[3],
               std::size_t count, float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(brdf_pdfs)(view.data(), wo[0], each, wi[0], count, pdfs);
}

} // namespace acdf
#endif
