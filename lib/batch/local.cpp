// Local environment files many times at once. What a single call waits for, memory and the splits on the way to a
// tile, is asked for by several of them side by side; the operations are the same ones, on any processor.
#include "batch/local.h"

#include "batch/alone.h"
#include "batch/instructions.h"

#include <algorithm>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr std::size_t kBlock = 16, kSideBySide = 4;
constexpr std::size_t kFewest = 6; // fewer wait for each other as long as single calls do
constexpr int kRows = 3;           // of nearly all normals: those on edges of triangles have fewer

/// Where a sample is, of those that are side by side.
struct Lane {
    std::size_t number;
    AcdfLocalPoint point;
    u32 tile;
    AcdfTileWalk walk;
};

bool usual(const AcdfLocal& local, const AcdfLocalPoint& point) {
    return point.what == ACDF_LOCAL_BLEND && point.mix.count == kRows && local.cosine_share == 0.0 &&
           local.tables && local.blend.tiles->tile_count > 1;
}

/// Steps of the traversals of some lanes until all are at a tile.
void walk(const AcdfLocal& local, Lane* lane, std::size_t count) {
    const u32* const words = acdf_local_words(local.tables);
    for (bool any = true; any;) {
        any = false;
        for (Lane* l = lane; l < lane + count; ++l) {
            if (l->walk.node & ACDF_TILE_FLAG) continue;
            acdf_tile_walk_step(words, &local.tables->tiles, l->point.by.tabled.codes, kRows, &l->walk);
            any = true;
        }
    }
    for (Lane* l = lane; l < lane + count; ++l) {
        l->tile = l->walk.node & ~ACDF_TILE_FLAG;
        ACDF_PREFETCH(acdf_local_tile(local.tables, l->tile));
    }
}

DirectionSample end_draw(const AcdfLocal& local, const AcdfGrid& grid, const Lane& lane) {
    AcdfRange range[2];
    double u[2], given;
    acdf_sphere_ranges(grid.columns, grid.rows, range);
    acdf_tile_walk_end(&lane.walk, &lane.point.mix, kRows, u, &given);
    const double of_mixture = acdf_local_sampled_tile(&local, &lane.point, lane.tile, given, range);
    const double probability = acdf_local_tile_probability(&local, &lane.point, lane.tile, of_mixture);
    const double p = acdf_local_sample_inside(&local, lane.tile, probability, u, range);
    return acdf_local_direction_sample(&local, &lane.point, &grid, range, u, p);
}

void ask_for_curves(const AcdfLocal& local, const Lane* lane, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) acdf_local_ahead(&local, acdf_local_tile(local.tables, lane[k].tile));
}

// Whether vectors serve a file, and a point of such.
bool serves_batches(const AcdfLocal& local) {
    return local.tables && local.tables->facets && local.cosine_share == 0.0 && local.blend.tiles->tile_count > 1;
}
bool serves_batches(const AcdfLocalPoint& point) {
    return (point.what == ACDF_LOCAL_BLEND || point.what == ACDF_LOCAL_FAST) && point.mix.count == kRows &&
           point.cells == 0;
}

#if ACDF_BATCH_X86
/// Loops by instructions that serve a file; null: by none.
const LocalLoops* loops_of(const AcdfLocal& local, Instructions instructions) {
    switch (instructions) {
    case Instructions::avx512:
        return local.fast.grid ? &fast_avx512 : &local_avx512;
    case Instructions::avx2:
        return local.fast.grid ? &fast_avx2 : &local_avx2;
    default:
        return nullptr;
    }
}
#endif

} // namespace

LocalBatch::LocalBatch(const LocalEnvironmentView& view, Instructions most) noexcept : local_(view.data()) {
    if (serves_batches(local_)) instructions_ = std::min(most, instructions_of_this_processor());
}

void LocalBatch::sample(const AcdfLocalPoint& point, const double (*u)[2], std::size_t count,
                        DirectionSample* out) const noexcept {
#if ACDF_BATCH_X86
    const LocalLoops* const loops = loops_of(local_, instructions_);
    if (loops && count >= kFewest && serves_batches(point)) return loops->sample_at(local_, point, u, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = alone::local_sample(local_, point, u[i]);
}

void LocalBatch::sample(const float (*normals)[3], const double (*u)[2], std::size_t count,
                        DirectionSample* out) const noexcept {
#if ACDF_BATCH_X86
    if (const LocalLoops* const loops = loops_of(local_, instructions_))
        return loops->sample(local_, normals, u, count, out);
#endif
    if (local_.fast.grid) { // there is no traversal
        for (std::size_t i = 0; i < count; ++i) out[i] = alone::local_sample(local_, normals[i], u[i]);
        return;
    }
    const AcdfGrid grid = acdf_environment_grid(&local_.environment);
    Lane lane[kBlock];
    for (std::size_t first = 0; first < count; first += kBlock) {
        std::size_t used = 0;
        for (std::size_t i = first; i < std::min(count, first + kBlock); ++i) {
            Lane& l = lane[used];
            acdf_local_at(&local_, normals[i], &l.point);
            const double v[2] = {acdf_unit_interval(u[i][0]), acdf_unit_interval(u[i][1])};
            if (!usual(local_, l.point) || !acdf_local_samples_mixture(&l.point, v[0])) {
                out[i] = alone::local_sample(local_, l.point, v);
                continue;
            }
            double from[2];
            acdf_local_of_mixture(&l.point, v, from);
            acdf_tile_walk_begin(acdf_local_words(local_.tables), &local_.tables->tiles, &l.point.mix,
                                 l.point.by.tabled.codes, kRows, local_.tables->tiles.root, from, &l.walk);
            l.number = i;
            ++used;
        }
        for (std::size_t k = 0; k < used; k += kSideBySide) walk(local_, lane + k, std::min(kSideBySide, used - k));
        ask_for_curves(local_, lane, used);
        for (std::size_t k = 0; k < used; ++k) out[lane[k].number] = end_draw(local_, grid, lane[k]);
    }
}

void LocalBatch::pdf(const AcdfLocalPoint& point, const float (*directions)[3], std::size_t count,
                     float* out) const noexcept {
#if ACDF_BATCH_X86
    const LocalLoops* const loops = loops_of(local_, instructions_);
    if (loops && count >= kFewest && serves_batches(point))
        return loops->pdf_at(local_, point, directions, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = alone::local_pdf(local_, point, directions[i]);
}

void LocalBatch::pdf(const float (*normals)[3], const float (*directions)[3], std::size_t count,
                     float* out) const noexcept {
#if ACDF_BATCH_X86
    if (const LocalLoops* const loops = loops_of(local_, instructions_))
        return loops->pdf(local_, normals, directions, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = alone::local_pdf(local_, normals[i], directions[i]);
}

} // namespace acdf
