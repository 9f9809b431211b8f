// Local environments by rows of halvings, at normals alone: tiles and descents of a block of calls in turns,
// between vectors of what is computed before and after.
#include <acdf/batch/batch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch/local.cpp"
#include <hwy/foreach_target.h>
//
#include "batch/cells-inl.h"
#include "batch/normals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace acdf {
namespace batch {
namespace HWY_NAMESPACE {

using LocalPoints = Conditions<AcdfLocal, AcdfLocalPoint, acdf_local_at>;

#if !ACDF_BATCH_SINGLY

struct LocalBlock {
    Places places;
    Mixtures mixtures;
    Tiles tiles;
};

// Finds the rows of the normals of calls from `first` on.
void take_normals(const AcdfLocal& local, const float* normals, std::size_t each, std::size_t first,
                  std::size_t count, LocalBlock& block) {
    mix_normals(local, block.mixtures.take(normals, each, first, count), block.mixtures);
    set_rows<ACDF_NORMALS_MIXED>(local.rows_of_normals, block.mixtures, count, block.tiles);
}

// The pdf of cells in tiles, by the widths of their steps and of their boxes.
HWY_INLINE hn::Vec<Floats> tile_pdf(const Grid& grid, Double w0, Double w1, Double box_wide, Double height,
                                    const Tiles& tiles, std::size_t i) {
    const Double of_tile = hn::Mul(hn::Load(Doubles(), tiles.wide[0] + i), hn::Load(Doubles(), tiles.wide[1] + i));
    const Double share = hn::Div(hn::Mul(w0, w1), of_tile);
    const Double scale = hn::Div(set(grid.columns), area_of(box_wide, height));
    return float_pdf(hn::Mul(hn::Mul(hn::Load(Doubles(), tiles.probability + i), share), scale));
}

void local_samples_of_block(const AcdfLocal& local, const double* u, std::size_t count, LocalBlock& block,
                            float* directions, float* pdfs) {
    const Grid grid(local.environment);
    Tiles& tiles = block.tiles;
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Double u0, u1;
        load_numbers(u + 2 * i, u0, u1);
        hn::Store(u0, Doubles(), tiles.u[0] + i);
        hn::Store(u1, Doubles(), tiles.u[1] + i);
    }
    tiles.sample<ACDF_NORMALS_MIXED>(local.rows_of_normals, acdf_halvings_nodes(local.environment.halved), count);
    look_up_heights(local.environment, tiles.descents, count, block.places);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11, low0, low1; // low and high of axis 0, and of axis 1
        hn::LoadInterleaved4(Words(), tiles.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), tiles.descents.box[i][0].end, b00, b01, b10, b11);
        hn::LoadInterleaved2(Words(), tiles.low[i], low0, low1);
        const Double w0 = width(s00, s01), w1 = width(s10, s11);
        put_direction(grid, b00, b01, b10, b11, tile_fraction(tiles, 0, i, s00, low0, w0),
                      tile_fraction(tiles, 1, i, s10, low1, w1), block.places, i, directions + 3 * i);
        hn::StoreU(tile_pdf(grid, w0, w1, width(b00, b01), height_of(grid, b10, b11, block.places, i), tiles, i),
                   Floats(), pdfs + i);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (!block.mixtures.serves(i))
            put_sample(acdf_local_sample(&local, block.mixtures.vector_of(i), u[2 * i], u[2 * i + 1]),
                       directions + 3 * i, pdfs + i);
}

void local_pdfs_of_block(const AcdfLocal& local, const float* directions, std::size_t count, LocalBlock& block,
                         float* pdfs) {
    const Grid grid(local.environment);
    Tiles& tiles = block.tiles;
    place(grid, directions, count, block.places, tiles.descents);
    tiles.find<ACDF_NORMALS_MIXED>(local.rows_of_normals, acdf_halvings_nodes(local.environment.halved), count);
    look_up_heights(local.environment, tiles.descents, count, block.places);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Doubles())) {
        Word s00, s01, s10, s11, b00, b01, b10, b11;
        hn::LoadInterleaved4(Words(), tiles.descents.steps[i][0].end, s00, s01, s10, s11);
        hn::LoadInterleaved4(Words(), tiles.descents.box[i][0].end, b00, b01, b10, b11);
        const auto pdf = tile_pdf(grid, width(s00, s01), width(s10, s11), width(b00, b01),
                                  height_of(grid, b10, b11, block.places, i), tiles, i);
        const auto sure = is_surely_in(grid, b00, b01, b10, b11, block.places, i);
        hn::StoreU(hn::IfThenElse(sure, pdf, hn::Set(Floats(), -1.0f)), Floats(), pdfs + i);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (pdfs[i] < 0.0f || !block.mixtures.serves(i))
            pdfs[i] = acdf_local_pdf(&local, block.mixtures.vector_of(i), directions + 3 * i);
}

// How many calls were served by blocks.
std::size_t local_samples_in_blocks(const AcdfLocal& local, const float* normals, std::size_t each, const double* u,
                                    std::size_t count, float* directions, float* pdfs) {
    LocalBlock block;
    return in_blocks(count, [&](std::size_t i, std::size_t n) {
        take_normals(local, normals, each, i, n, block);
        local_samples_of_block(local, u + 2 * i, n, block, directions + 3 * i, pdfs + i);
    });
}
std::size_t local_pdfs_in_blocks(const AcdfLocal& local, const float* normals, std::size_t each,
                                 const float* directions, std::size_t count, float* pdfs) {
    LocalBlock block;
    return in_blocks(count, [&](std::size_t i, std::size_t n) {
        take_normals(local, normals, each, i, n, block);
        local_pdfs_of_block(local, directions + 3 * i, n, block, pdfs + i);
    });
}

#else

std::size_t local_samples_in_blocks(const AcdfLocal&, const float*, std::size_t, const double*, std::size_t, float*,
                                    float*) {
    return 0;
}
std::size_t local_pdfs_in_blocks(const AcdfLocal&, const float*, std::size_t, const float*, std::size_t, float*) {
    return 0;
}

#endif

// What blocks serve: samples that all follow the light.
bool serves(const AcdfLocal& local) { return local.rows_of_normals && local.cosine_share == 0.0; }

void local_samples(const AcdfLocal& local, const float* normals, std::size_t each, const double* u,
                   std::size_t count, float* directions, float* pdfs) {
    const std::size_t i =
        serves(local) ? local_samples_in_blocks(local, normals, each, u, count, directions, pdfs) : 0;
    LocalPoints points(local, normals, each);
    points.one_by_one(i, count, [&](std::size_t at, const AcdfLocalPoint& point) {
        put_sample(acdf_local_sample_at(&local, &point, u[2 * at], u[2 * at + 1]), directions + 3 * at, pdfs + at);
    });
}

void local_pdfs(const AcdfLocal& local, const float* normals, std::size_t each, const float* directions,
                std::size_t count, float* pdfs) {
    const std::size_t i = serves(local) ? local_pdfs_in_blocks(local, normals, each, directions, count, pdfs) : 0;
    LocalPoints points(local, normals, each);
    points.one_by_one(i, count, [&](std::size_t at, const AcdfLocalPoint& point) {
        pdfs[at] = acdf_local_pdf_at(&local, &point, directions + 3 * at);
    });
}

} // namespace HWY_NAMESPACE
} // namespace batch
} // namespace acdf
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace acdf {
namespace batch {
HWY_EXPORT(local_samples);
HWY_EXPORT(local_pdfs);
} // namespace batch

void sample_batch(const LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
                  const double (*u)[2], std::size_t count, float (*directions)[3], float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(local_samples)(view.data(), normals[0], each, u[0], count, directions[0], pdfs);
}

void pdf_batch(const LocalEnvironmentView& view, const float (*normals)[3], std::size_t each,
               const float (*directions)[3], std::size_t count, float* pdfs) noexcept {
    if (count == 0) return;
    using namespace batch;
    HWY_DYNAMIC_DISPATCH(local_pdfs)(view.data(), normals[0], each, directions[0], count, pdfs);
}

} // namespace acdf
#endif
