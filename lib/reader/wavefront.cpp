// The tables of BrdfWavefront, and which loops serve.
#include "wavefront.h"
#include "memory.h"

#include <acdf/wavefront.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
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
    WavefrontTable* table;
    WavefrontSplit* splits;
    u32 *codes, *boxes;
    double *areas, *nodes;
    std::uint16_t* guide;
    std::int32_t* borders[2];
    std::uint16_t *border_guide[2], *cells; // cells: null where there are too many borders
    double* probabilities;
    // While the tables are made, of each split of the file:
    u32* number; // in the tables
    u32* split_boxes;
    double* parts; // of a row that reach it
};

/// The different positions of the splits of each axis, increasing.
struct Borders {
    std::unique_ptr<std::int32_t[]> position[2];
    std::size_t count[2] = {0, 0};

    std::size_t between() const { return (count[0] + 1) * (count[1] + 1); }
    /// How many lie at or below a square.
    std::size_t below(int axis, u32 square) const {
        const std::int32_t *first = position[axis].get(), *last = first + count[axis];
        return static_cast<std::size_t>(std::upper_bound(first, last, static_cast<std::int32_t>(square)) - first);
    }
};

u32 splits_of(const AcdfBrdf& brdf) { return brdf.blend.tiles->tile_count - 1; }
u32 entries_of(const AcdfBrdf& brdf) { return (brdf.blend.tiles->tile_count + 7) & ~7u; }
std::size_t pairs_of(const AcdfBrdf& brdf) { return brdf.views->theta_count > 1 ? brdf.views->theta_count - 1 : 1; }

/// False where memory fails.
bool find_borders(const AcdfBrdf& brdf, Borders& out) {
    const u32 splits = splits_of(brdf);
    for (int axis = 0; axis < 2; ++axis) {
        std::int32_t* const first = new (std::nothrow) std::int32_t[splits + 1];
        if (!first) return false;
        out.position[axis].reset(first);
        std::int32_t* last = first;
        for (u32 i = 0; i < splits; ++i)
            if ((brdf.blend.splits[i].place & 7u) == static_cast<u32>(axis))
                *last++ = static_cast<std::int32_t>(brdf.blend.splits[i].place >> 3);
        std::sort(first, last);
        out.count[axis] = static_cast<std::size_t>(std::unique(first, last) - first);
    }
    return true;
}

/// Whether a table of the cells between all borders is worth its memory. Usual files have some twenty a cell.
bool have_table(const Borders& borders, const AcdfBrdf& brdf) {
    return borders.between() <= 256 * std::size_t{brdf.blend.tiles->tile_count};
}

/// The arrays in `block`. `bytes` becomes the size of those that stay, `all_bytes` that of all. Vectors load the
/// bytes behind an element, too: eight in all.
Arrays arrays_in(char* block, const AcdfBrdf& brdf, const Borders& borders, std::size_t& bytes,
                 std::size_t& all_bytes) {
    const std::size_t cells = brdf.blend.tiles->tile_count, views = brdf.views->theta_count;
    Arena arena{block};
    Arrays out;
    out.table = arena.take<WavefrontTable>(1);
    out.splits = arena.take<WavefrontSplit>(entries_of(brdf));
    out.codes = arena.take<u32>(pairs_of(brdf) * entries_of(brdf) + 1);
    out.boxes = arena.take<u32>(4 * cells);
    out.areas = arena.take<double>(cells);
    out.nodes = arena.take<double>(2 * (views + 1));
    out.guide = arena.take<std::uint16_t>(kGuideSteps + 4);
    for (int axis = 0; axis < 2; ++axis) {
        out.borders[axis] = arena.take<std::int32_t>(borders.count[axis] + kBordersAtOnce);
        out.border_guide[axis] = arena.take<std::uint16_t>(kBorderSteps);
    }
    out.cells = have_table(borders, brdf) ? arena.take<std::uint16_t>(borders.between()) : nullptr;
    out.probabilities = arena.take<double>((views + 1) * entries_of(brdf));
    bytes = arena.used;
    out.number = arena.take<u32>(cells);
    out.split_boxes = arena.take<u32>(4 * cells);
    out.parts = arena.take<double>(cells);
    all_bytes = arena.used;
    return out;
}

bool is_split(u32 child) { return !(child & ACDF_TILE_FLAG); }

/// Numbers of the splits: those of the first levels from 0 on, then the others in their order.
void number_splits(const AcdfBrdf& brdf, u32* number) {
    const u32 none = splits_of(brdf);
    u32 level[8] = {0}, width = none > 0 ? 1 : 0, count = 0;
    std::fill(number, number + none, none);
    for (u32 depth = 0; depth < kTopLevels; ++depth) {
        u32 next[8], next_width = 0;
        for (u32 i = 0; i < width; ++i) {
            number[level[i]] = count++;
            for (const u32 child : brdf.blend.splits[level[i]].child)
                if (is_split(child)) next[next_width++] = child;
        }
        std::copy(next, next + next_width, level);
        width = next_width;
    }
    for (u32 i = 0; i < none; ++i)
        if (number[i] == none) number[i] = count++;
}

constexpr WavefrontSplit kAllBelow = {{0, 0}, 0};

void place_splits(const AcdfBrdf& brdf, const u32* number, WavefrontSplit* out) {
    std::fill(out, out + entries_of(brdf), kAllBelow);
    for (u32 i = 0; i < splits_of(brdf); ++i) {
        const AcdfSplit& split = brdf.blend.splits[i];
        WavefrontSplit& placed = out[number[i]];
        placed.axis = split.place & 7u;
        for (u32 part = 0; part < 2; ++part) {
            const u32 child = split.child[part];
            placed.child[part] = static_cast<std::uint16_t>(is_split(child) ? number[child] : child);
        }
    }
}

void pair_codes(const AcdfBrdf& brdf, const u32* number, u32* out) {
    const std::size_t last = brdf.views->theta_count - 1;
    const std::uint16_t* codebook = brdf.blend.tiles->codebook;
    for (std::size_t pair = 0; pair < pairs_of(brdf); ++pair, out += entries_of(brdf)) {
        const std::uint8_t* low = brdf.blend.rows + std::size_t{brdf.bins[pair].root} * splits_of(brdf);
        const std::uint8_t* high =
            brdf.blend.rows + std::size_t{brdf.bins[std::min(pair + 1, last)].root} * splits_of(brdf);
        std::fill(out, out + entries_of(brdf), 0xFFFFFFFFu);
        for (u32 i = 0; i < splits_of(brdf); ++i) out[number[i]] = codebook[low[i]] | u32{codebook[high[i]]} << 16;
    }
    *out = 0;
}

/// Parents stand before their children: one pass.
void place_boxes(const AcdfBrdf& brdf, u32* of_splits, u32* of_cells, double* areas) {
    const u32 whole[4] = {0, brdf.columns, 0, brdf.rows};
    std::memcpy(splits_of(brdf) > 0 ? of_splits : of_cells, whole, sizeof whole);
    for (u32 i = 0; i < splits_of(brdf); ++i) {
        const AcdfSplit& split = brdf.blend.splits[i];
        for (u32 upper = 0; upper < 2; ++upper) {
            const u32 child = split.child[upper], number = child & (ACDF_TILE_FLAG - 1);
            u32* box = (is_split(child) ? of_splits : of_cells) + 4 * std::size_t{number};
            std::memcpy(box, of_splits + 4 * std::size_t{i}, sizeof whole);
            box[2 * (split.place & 7u) + 1 - upper] = split.place >> 3;
        }
    }
    for (std::size_t i = 0; i < brdf.blend.tiles->tile_count; ++i) {
        const u32* box = of_cells + 4 * i;
        areas[i] = static_cast<double>(box[1] - box[0]) * static_cast<double>(box[3] - box[2]);
    }
}

void place_borders(const Borders& borders, const Arrays& out) {
    for (int axis = 0; axis < 2; ++axis) {
        std::int32_t* const last =
            std::copy_n(borders.position[axis].get(), borders.count[axis], out.borders[axis]);
        std::fill_n(last, kBordersAtOnce, std::numeric_limits<std::int32_t>::max());
        out.border_guide[axis][0] = 0; // the first step begins at 0
        for (int step = 1; step < kBorderSteps; ++step) {
            const double begin =
                std::ldexp(1.0 + std::ldexp(step % (1 << kStepBits), -kStepBits), step >> kStepBits);
            out.border_guide[axis][step] = static_cast<std::uint16_t>(borders.below(axis, static_cast<u32>(begin)));
        }
    }
}

void place_cells(const AcdfBrdf& brdf, const Borders& borders, const Arrays& out) {
    for (std::size_t i = 0; i < brdf.blend.tiles->tile_count; ++i) {
        const u32* box = out.boxes + 4 * i;
        const std::size_t left = borders.below(0, box[0]), right = borders.below(0, box[1] - 1) + 1;
        const std::size_t last = borders.below(1, box[3] - 1);
        for (std::size_t row = borders.below(1, box[2]); row <= last; ++row) {
            std::uint16_t* const cells = out.cells + row * (borders.count[0] + 1);
            std::fill(cells + left, cells + right, static_cast<std::uint16_t>(i));
        }
    }
}

/// The products of the codes above each cell, as acdf_blend_find multiplies them.
void place_probabilities(const AcdfBrdf& brdf, const Arrays& out) {
    const std::uint16_t* codebook = brdf.blend.tiles->codebook;
    const std::size_t views = brdf.views->theta_count;
    for (std::size_t view = 0; view <= views; ++view) {
        const u32 root = brdf.bins[std::min(view, views - 1)].root;
        const std::uint8_t* row = brdf.blend.rows + std::size_t{root} * splits_of(brdf);
        double* const cells = out.probabilities + view * entries_of(brdf);
        std::fill(cells, cells + entries_of(brdf), 1.0);
        out.parts[0] = 1.0;
        for (u32 i = 0; i < splits_of(brdf); ++i)
            for (u32 upper = 0; upper < 2; ++upper) {
                const u32 child = brdf.blend.splits[i].child[upper];
                const double code = upper ? 65535 - codebook[row[i]] : codebook[row[i]];
                (is_split(child) ? out.parts[child] : cells[child & (ACDF_TILE_FLAG - 1)]) =
                    out.parts[i] * (code * (1.0 / 65535.0));
            }
    }
}

u32 last_lower(const AcdfBrdf& brdf) { return brdf.views->theta_count > 1 ? brdf.views->theta_count - 2 : 0; }

void place_views(const AcdfBrdf& brdf, const Arrays& out) {
    const u32 count = brdf.views->theta_count;
    for (u32 i = 0; i < count; ++i) {
        out.nodes[2 * i] = static_cast<double>(brdf.nodes[i]);
        out.nodes[2 * i + 1] = static_cast<double>(brdf.bins[i].share);
    }
    out.nodes[2 * count] = std::numeric_limits<double>::infinity();
    out.nodes[2 * count + 1] = 0.0;
    u32 node = 1;
    for (u32 step = 0; step <= kGuideSteps; ++step) {
        while (node <= last_lower(brdf) && static_cast<u32>(out.nodes[2 * node] * kGuideSteps) < step) ++node;
        out.guide[step] = static_cast<std::uint16_t>(std::min(node - 1, 0xFFFFu)); // it may start too low
    }
}

Instructions of_this_processor() {
#if ACDF_WAVEFRONT_X86
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return Instructions::avx512;
    if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
    return Instructions::none;
}

/// Views may share rows, tables do not: a small file must not ask for gigabytes.
bool are_in_proportion(const AcdfBrdf& brdf) {
    const double tables = 12.0 * brdf.views->theta_count * entries_of(brdf);
    return tables <= 32.0 * brdf.blend.tiles->row_count * splits_of(brdf) + 0x1p24;
}

bool fits(const AcdfBrdf& brdf) {
    return brdf.blend.tiles && !brdf.blend.roots && brdf.views->phi_count == 1 &&
           !(brdf.views->diffuse_share > 0.0f) && are_in_proportion(brdf);
}

WavefrontTable* filled(const Arrays& arrays, const AcdfBrdf& brdf, const Borders& borders) {
    number_splits(brdf, arrays.number);
    place_splits(brdf, arrays.number, arrays.splits);
    pair_codes(brdf, arrays.number, arrays.codes);
    place_boxes(brdf, arrays.split_boxes, arrays.boxes, arrays.areas);
    place_views(brdf, arrays);
    place_borders(borders, arrays);
    if (arrays.cells) place_cells(brdf, borders, arrays);
    place_probabilities(brdf, arrays);
    WavefrontTable* out = new (arrays.table) WavefrontTable{};
    out->brdf = brdf;
    out->columns = brdf.columns;
    out->rows = brdf.rows;
    out->mirrored = acdf_brdf_mirrored(&brdf) != 0;
    out->entries = entries_of(brdf);
    std::copy(arrays.splits, arrays.splits + 7, out->top);
    out->top[7] = kAllBelow;
    out->last = last_lower(brdf);
    out->splits = arrays.splits;
    out->codes = arrays.codes;
    out->boxes = arrays.boxes;
    out->areas = arrays.areas;
    for (int axis = 0; axis < 2; ++axis) out->borders[axis] = {arrays.borders[axis], arrays.border_guide[axis]};
    out->columns_between = static_cast<long long>(borders.count[0]) + 1;
    out->cells = arrays.cells;
    out->probabilities = arrays.probabilities;
    out->nodes = arrays.nodes;
    out->guide = arrays.guide;
    return out;
}

Status out_of_memory(std::size_t bytes) {
    Status status;
    status.code = ErrorCode::out_of_memory;
    std::snprintf(status.message, sizeof status.message, "no memory for a wavefront's %zu bytes", bytes);
    return status;
}

} // namespace

BrdfWavefront::BrdfWavefront(BrdfWavefront&& other) noexcept { *this = std::move(other); }

BrdfWavefront& BrdfWavefront::operator=(BrdfWavefront&& other) noexcept {
    std::swap(brdf_, other.brdf_);
    std::swap(table_, other.table_);
    std::swap(bytes_, other.bytes_);
    std::swap(instructions_, other.instructions_);
    return *this;
}

BrdfWavefront::~BrdfWavefront() {
    AcdfBlock block = {table_, bytes_};
    give_block({}, block);
}

Status BrdfWavefront::prepare(const BrdfView& view, BrdfWavefront& out, Instructions most) noexcept {
    const AcdfBrdf& brdf = view.data();
    BrdfWavefront made;
    made.brdf_ = brdf;
    if (fits(brdf)) made.instructions_ = std::min(most, of_this_processor());
    if (made.instructions_ != Instructions::none) {
        Borders borders;
        if (!find_borders(brdf, borders)) return out_of_memory(sizeof(std::int32_t) * splits_of(brdf));
        std::size_t all_bytes;
        arrays_in(nullptr, brdf, borders, made.bytes_, all_bytes);
        char* block = static_cast<char*>(take_block({}, all_bytes).data);
        if (!block) return out_of_memory(all_bytes);
        made.table_ = filled(arrays_in(block, brdf, borders, made.bytes_, all_bytes), brdf, borders);
    }
    out = std::move(made);
    return {};
}

void BrdfWavefront::sample(const float (*wo)[3], const double (*u)[2], std::size_t count,
                           DirectionSample* out) const noexcept {
#if ACDF_WAVEFRONT_X86
    if (instructions_ == Instructions::avx512) return sample_avx512(*table_, wo, u, count, out);
    if (instructions_ == Instructions::avx2) return sample_avx2(*table_, wo, u, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_sample(&brdf_, wo[i], u[i][0], u[i][1]);
}

void BrdfWavefront::pdf(const float (*wo)[3], const float (*wi)[3], std::size_t count, float* out) const noexcept {
#if ACDF_WAVEFRONT_X86
    const Instructions by = table_ && table_->cells ? instructions_ : Instructions::none;
    if (by == Instructions::avx512) return pdf_avx512(*table_, wo, wi, count, out);
    if (by == Instructions::avx2) return pdf_avx2(*table_, wo, wi, count, out);
#endif
    for (std::size_t i = 0; i < count; ++i) out[i] = acdf_brdf_pdf(&brdf_, wo[i], wi[i]);
}

} // namespace acdf
