// The tables of BrdfBatch, and which loops serve.
#include "batch/brdf.h"

#include "batch/instructions.h"
#include "reader/memory.h"
#include "reader/tables/brdf.h"

#include <acdf/batch/batch.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <utility>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr std::size_t kAlignment = 64;

std::size_t aligned(std::size_t size) { return (size + kAlignment - 1) & ~(kAlignment - 1); }

/// Takes arrays one after the other out of a block; with none it only counts.
struct Arena {
    char* block;
    std::size_t used = 0;

    template <class T>
    T* take(std::size_t count) {
        T* out = block ? reinterpret_cast<T*>(block + used) : nullptr;
        used += aligned(count * sizeof(T));
        return out;
    }
};

struct Arrays {
    BatchTable* table;
    BatchSplit* splits;
    u32* boxes;
    // While the tables are made, of each split of the file:
    u32* number; // in the tables
    u32* split_boxes;
};

u32 splits_of(const AcdfBrdf& brdf) { return brdf.blend.tiles->tile_count - 1; }
u32 entries_of(const AcdfBrdf& brdf) { return (brdf.blend.tiles->tile_count + 7) & ~7u; }
std::size_t pairs_of(const AcdfBrdf& brdf) { return brdf.views->theta_count > 1 ? brdf.views->theta_count - 1 : 1; }

/// The arrays in `block`; `bytes` becomes their size.
Arrays arrays_in(char* block, const AcdfBrdf& brdf, std::size_t& bytes) {
    const std::size_t cells = brdf.blend.tiles->tile_count;
    Arena arena{block};
    Arrays out;
    out.table = arena.take<BatchTable>(1);
    out.splits = arena.take<BatchSplit>(pairs_of(brdf) * entries_of(brdf));
    out.boxes = arena.take<u32>(4 * cells);
    out.number = arena.take<u32>(cells);
    out.split_boxes = arena.take<u32>(4 * cells);
    bytes = arena.used;
    return out;
}

bool is_split(u32 child) { return !(child & ACDF_TILE_FLAG); }

u32 axis_of(const AcdfSplit& split) { return split.place & 7u; }

/// Numbers of the splits: those of axis 0 in their order, then the others. Returns how many are of axis 0.
u32 number_splits(const AcdfBrdf& brdf, u32* number) {
    u32 count = 0, first = 0;
    for (u32 axis = 0; axis < 2; ++axis) {
        for (u32 i = 0; i < splits_of(brdf); ++i)
            if (axis_of(brdf.blend.splits[i]) == axis) number[i] = count++;
        if (axis == 0) first = count;
    }
    return first;
}

constexpr std::uint16_t kAll = 0xFFFF; // the code of a split that gives all to its lower part

void place_splits(const AcdfBrdf& brdf, const u32* number, BatchSplit* out) {
    const std::size_t last = brdf.views->theta_count - 1;
    const std::uint16_t* codebook = brdf.blend.tiles->codebook;
    for (std::size_t pair = 0; pair < pairs_of(brdf); ++pair, out += entries_of(brdf)) {
        const std::uint8_t* low = brdf.blend.rows + std::size_t{brdf.bins[pair].root} * splits_of(brdf);
        const std::uint8_t* high =
            brdf.blend.rows + std::size_t{brdf.bins[std::min(pair + 1, last)].root} * splits_of(brdf);
        std::fill(out + splits_of(brdf), out + entries_of(brdf), BatchSplit{{kAll, kAll}, {0, 0}});
        for (u32 i = 0; i < splits_of(brdf); ++i) {
            BatchSplit& placed = out[number[i]];
            placed.code[0] = codebook[low[i]];
            placed.code[1] = codebook[high[i]];
            for (u32 part = 0; part < 2; ++part) {
                const u32 child = brdf.blend.splits[i].child[part];
                placed.child[part] = static_cast<std::uint16_t>(is_split(child) ? number[child] : child);
            }
        }
    }
}

/// Parents stand before their children: one pass.
void place_boxes(const AcdfBrdf& brdf, u32* of_splits, u32* of_cells) {
    const u32 whole[4] = {0, brdf.columns, 0, brdf.rows};
    std::memcpy(splits_of(brdf) > 0 ? of_splits : of_cells, whole, sizeof whole);
    for (u32 i = 0; i < splits_of(brdf); ++i) {
        const AcdfSplit& split = brdf.blend.splits[i];
        for (u32 upper = 0; upper < 2; ++upper) {
            const u32 child = split.child[upper], number = child & (ACDF_TILE_FLAG - 1);
            u32* box = (is_split(child) ? of_splits : of_cells) + 4 * std::size_t{number};
            std::memcpy(box, of_splits + 4 * std::size_t{i}, sizeof whole);
            box[2 * axis_of(split) + 1 - upper] = split.place >> 3;
        }
    }
}

/// Views may share rows, tables do not: a small file must not ask for gigabytes.
std::size_t most_bytes_of(const AcdfBrdf& brdf) {
    return std::size_t{32} * brdf.blend.tiles->row_count * splits_of(brdf) + (std::size_t{1} << 24);
}
bool are_in_proportion(const AcdfBrdf& brdf) {
    return std::size_t{16} * brdf.views->theta_count * entries_of(brdf) <= most_bytes_of(brdf);
}

/// What is the same for all batches of a file.
void add_runtime_tables(const AcdfBrdf& brdf, const AcdfBrdfTables& tables, BatchTable* out) {
    out->columns = brdf.columns;
    out->rows = brdf.rows;
    std::copy(tables.inverse, tables.inverse + 2, out->inverse);
    out->exact_inverse = has_exact_inverses(brdf);
    out->mirrored = acdf_brdf_mirrored(&brdf) != 0;
    const auto array = [&](auto*& at, u32 words) {
        at = static_cast<std::remove_reference_t<decltype(at)>>(acdf_brdf_words(&tables, words));
    };
    out->last = tables.last;
    out->stride = tables.stride;
    out->columns_between = tables.columns_between;
    for (int axis = 0; axis < 2; ++axis) {
        array(out->borders[axis].position, tables.borders[axis]);
        array(out->borders[axis].guide, tables.border_guides[axis]);
    }
    if (tables.grid) array(out->grid, tables.grid);
    array(out->guide, tables.guide);
    array(out->parts, tables.parts);
    array(out->areas, tables.areas);
    array(out->nodes, tables.nodes);
}

BatchTable* filled(const Arrays& arrays, const AcdfBrdf& brdf, const AcdfBrdfTables& tables) {
    const u32 of_axis0 = number_splits(brdf, arrays.number);
    place_splits(brdf, arrays.number, arrays.splits);
    place_boxes(brdf, arrays.split_boxes, arrays.boxes);
    BatchTable* out = new (arrays.table) BatchTable{};
    out->brdf = brdf;
    out->entries = entries_of(brdf);
    out->last_of_axis0 = static_cast<long long>(of_axis0) - 1;
    out->root = splits_of(brdf) > 0 ? arrays.number[0] : acdf_blend_root(&brdf.blend);
    out->splits = arrays.splits;
    out->boxes = arrays.boxes;
    add_runtime_tables(brdf, tables, out);
    return out;
}

Status out_of_memory(std::size_t bytes) {
    Status status;
    status.code = ErrorCode::out_of_memory;
    std::snprintf(status.message, sizeof status.message, "no memory for a batch's %zu bytes", bytes);
    return status;
}

} // namespace

void brdf_pdf_batch(const AcdfBrdf& brdf, const AcdfBrdfView& view, const float (*wi)[3], std::size_t count,
                    float* out, Instructions most) noexcept {
    using Pdfs = void (*)(const BatchTable&, const AcdfBrdfView&, const float(*)[3], std::size_t, float*);
    if (const Pdfs pdfs = ACDF_BEST_OF(most, Pdfs{nullptr}, Pdfs{view_pdf_avx2}, Pdfs{view_pdf_avx512});
        pdfs && brdf.tables && brdf.tables->grid) {
        BatchTable table;
        add_runtime_tables(brdf, *brdf.tables, &table);
        return pdfs(table, view, wi, count, out);
    }
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_view_pdf(&brdf, &view, wi[i]);
}

void brdf_sample_batch(const AcdfBrdf& brdf, const AcdfBrdfView& view, const double (*u)[2], std::size_t count,
                       DirectionSample* out, Instructions most) noexcept {
    using Samples = void (*)(const BatchTable&, const AcdfBrdf&, const AcdfBrdfView&, const double(*)[2],
                             std::size_t, DirectionSample*);
    if (const Samples samples =
            ACDF_BEST_OF(most, Samples{nullptr}, Samples{view_sample_avx2}, Samples{view_sample_avx512});
        samples && brdf.tables && brdf.tables->grid && brdf.tables->guesses && view.pair[0] + view.pair[1] > 0.0) {
        BatchTable table;
        add_runtime_tables(brdf, *brdf.tables, &table);
        return samples(table, brdf, view, u, count, out);
    }
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_view_sample(&brdf, &view, u[i][0], u[i][1]);
}

BrdfBatch::BrdfBatch(BrdfBatch&& other) noexcept { *this = std::move(other); }

BrdfBatch& BrdfBatch::operator=(BrdfBatch&& other) noexcept {
    std::swap(brdf_, other.brdf_);
    std::swap(table_, other.table_);
    std::swap(own_, other.own_);
    std::swap(instructions_, other.instructions_);
    return *this;
}

BrdfBatch::~BrdfBatch() {
    for (AcdfBlock& block : own_) give_block({}, block);
}

std::size_t BrdfBatch::bytes() const noexcept { return own_[0].bytes + own_[1].bytes; }

Status BrdfBatch::prepare(const BrdfView& view, BrdfBatch& out, Instructions most) noexcept {
    const AcdfBrdf& brdf = view.data();
    BrdfBatch made;
    made.brdf_ = brdf;
    if (can_have_tables(brdf) && are_in_proportion(brdf))
        made.instructions_ = std::min(most, instructions_of_this_processor());
    if (made.instructions_ != Instructions::none) {
        const AcdfBrdfTables* tables = brdf.tables;
        if (!tables) tables = make_brdf_tables(brdf, most_bytes_of(brdf), false, {}, made.own_[1]);
        if (!tables) return out_of_memory(most_bytes_of(brdf));
        std::size_t bytes;
        arrays_in(nullptr, brdf, bytes);
        made.own_[0] = take_block({}, bytes);
        char* const block = static_cast<char*>(made.own_[0].data);
        if (!block) return out_of_memory(bytes);
        made.table_ = filled(arrays_in(block, brdf, bytes), brdf, *tables);
    }
    out = std::move(made);
    return {};
}

void BrdfBatch::sample(const float (*wo)[3], const double (*u)[2], std::size_t count,
                       DirectionSample* out) const noexcept {
#if ACDF_BATCH_X86
    if (instructions_ == Instructions::avx512) return sample_avx512(*table_, wo, u, count, out);
    if (instructions_ == Instructions::avx2) return sample_avx2(*table_, wo, u, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_sample(&brdf_, wo[i], u[i][0], u[i][1]);
}

void BrdfBatch::pdf(const float (*wo)[3], const float (*wi)[3], std::size_t count, float* out) const noexcept {
#if ACDF_BATCH_X86
    const Instructions by = table_ && table_->grid ? instructions_ : Instructions::none;
    if (by == Instructions::avx512) return pdf_avx512(*table_, wo, wi, count, out);
    if (by == Instructions::avx2) return pdf_avx2(*table_, wo, wi, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_pdf(&brdf_, wo[i], wi[i]);
}

} // namespace acdf
