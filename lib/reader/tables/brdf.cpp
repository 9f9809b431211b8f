#include "tables/brdf.h"

#include "memory.h"
#include "tables/growable.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;
using i32 = std::int32_t;

constexpr u32 kNoSplit = 0xFFFFFFFFu;
constexpr u32 kMostGuessBits = 5, kLeastGuessBits = 4;

/// Words of `count` items, up to the next cache line.
template <class T>
std::size_t words_of(std::size_t count) {
    return ((count * sizeof(T) + 63) & ~std::size_t{63}) / 4;
}

bool is_power_of_two(u32 x) { return x != 0 && (x & (x - 1)) == 0; }

struct BrdfCell {
    u32 side[2][2];  // of each axis: the first position, and the last one
    u32 split[2][2]; // at which those sides lie; of the table's own none
    double area() const {
        return static_cast<double>(side[0][1] - side[0][0]) * static_cast<double>(side[1][1] - side[1][0]);
    }
};

class BrdfTablesMaker {
public:
    BrdfTablesMaker(const AcdfBrdf& brdf, std::size_t most_bytes, bool guesses)
        : brdf_(brdf), most_bytes_(most_bytes), guesses_(guesses) {}

    /// False where there can be no tables.
    bool gather();
    AcdfBrdfTables* assemble(const AcdfAllocator& allocator, AcdfBlock& block);

private:
    u32 cells() const { return brdf_.blend.tiles->tile_count; }
    u32 views() const { return brdf_.views->theta_count; }
    u32 pairs() const { return views() > 1 ? views() - 1 : 1; }
    std::size_t between() const { return (borders_[0].size() + 1) * (borders_[1].size() + 1); }
    /// How many borders lie at or below a position.
    std::size_t below(int axis, u32 position) const {
        const std::int32_t *first = borders_[axis].data(), *last = first + borders_[axis].size();
        return static_cast<std::size_t>(std::upper_bound(first, last, static_cast<std::int32_t>(position)) - first);
    }
    bool find_borders();
    void gather(u32 node, const BrdfCell& box);
    std::size_t lay_out(AcdfBrdfTables& out, bool grid, u32 guess_bits) const;
    bool choose(AcdfBrdfTables& out) const;
    void place_views(double* nodes, std::uint16_t* guide) const;
    void place_borders(int axis, std::int32_t* out, std::uint16_t* guide) const;
    void place_grid(std::uint16_t* out) const;
    u32 cell_beyond(u32 cell, u32 axis, u32 upper) const;
    void place_paths(u32 node, const AcdfBrdfPath& above, u32 depth, AcdfBrdfPath* out) const;
    void add_parts(const std::uint8_t* row, u32 node, double product, double* out) const;
    template <class T>
    static T* at(AcdfBrdfTables* tables, u32 word) {
        return reinterpret_cast<T*>(reinterpret_cast<u32*>(tables) + word);
    }

    AcdfBrdf brdf_;
    std::size_t most_bytes_, stride_ = 0;
    bool guesses_;
    Growable<std::int32_t> borders_[2];
    Growable<BrdfCell> cells_;
};

/// The different positions of the splits of each axis, increasing.
bool BrdfTablesMaker::find_borders() {
    for (u32 axis = 0; axis < 2; ++axis) {
        Growable<std::int32_t>& borders = borders_[axis];
        for (u32 i = 0; i + 1 < cells(); ++i) {
            const u32 place = brdf_.blend.splits[i].place;
            if ((place & 7u) == axis) borders.add(static_cast<std::int32_t>(place >> 3));
        }
        if (borders.failed()) return false;
        std::int32_t *const first = borders.data(), *const last = first + borders.size();
        std::sort(first, last);
        borders.cut(static_cast<std::size_t>(std::unique(first, last) - first));
        if (!borders.reserve(1)) return false; // the address of none is not to be null
    }
    return true;
}

// A path passes at most 48 splits.
void BrdfTablesMaker::gather(u32 node, const BrdfCell& box) {
    if (node & ACDF_TILE_FLAG) {
        cells_[node & ~ACDF_TILE_FLAG] = box;
        return;
    }
    const AcdfSplit& split = brdf_.blend.splits[node];
    for (u32 upper = 0; upper < 2; ++upper) {
        BrdfCell part = box;
        part.side[split.place & 7u][1 - upper] = split.place >> 3;
        part.split[split.place & 7u][1 - upper] = node;
        gather(split.child[upper], part);
    }
}

bool BrdfTablesMaker::gather() {
    stride_ = std::size_t{views()} + 1;
    if (sizeof(double) * stride_ * cells() > most_bytes_) return false;
    const BrdfCell whole = {{{0, brdf_.columns}, {0, brdf_.rows}}, {{kNoSplit, kNoSplit}, {kNoSplit, kNoSplit}}};
    if (!find_borders() || !cells_.add(cells(), whole)) return false;
    gather(acdf_blend_root(&brdf_.blend), whole);
    return true;
}

/// Where arrays stand; returns how many words all take.
std::size_t BrdfTablesMaker::lay_out(AcdfBrdfTables& out, bool grid, u32 guess_bits) const {
    std::size_t words = sizeof(AcdfBrdfTables) / 4;
    const auto take = [&](std::size_t more) {
        const std::size_t begin = words;
        words += more;
        return static_cast<u32>(begin);
    };
    out = {};
    out.last = views() > 1 ? views() - 2 : 0;
    out.stride = static_cast<u32>(stride_);
    out.nodes = take(words_of<double>(2 * stride_));
    out.guide = take(words_of<std::uint16_t>(ACDF_VIEW_STEPS + 1));
    for (int axis = 0; axis < 2; ++axis) {
        out.borders[axis] = take(words_of<std::int32_t>(borders_[axis].size() + ACDF_BORDERS_AT_ONCE));
        out.border_guides[axis] = take(words_of<std::uint16_t>(ACDF_BORDER_STEPS));
    }
    out.columns_between = static_cast<u32>(borders_[0].size() + 1);
    out.areas = take(words_of<double>(cells()));
    out.parts = take(words_of<double>(stride_ * cells()));
    out.codes = take(words_of<double>(512));
    if (grid) out.grid = take(words_of<std::uint16_t>(between()));
    if (guess_bits) {
        out.paths = take(words_of<AcdfBrdfPath>(cells()));
        out.guesses = take(words_of<std::uint16_t>(std::size_t{pairs()} << 2 * guess_bits));
    }
    out.guess_bits = guess_bits;
    out.words = static_cast<u32>(words);
    return words;
}

/// With a grid and guesses, if there is room. Usual files have some twenty pairs of borders a cell. False where
/// nothing is left that tables are made for.
bool BrdfTablesMaker::choose(AcdfBrdfTables& out) const {
    const bool grid = between() <= 256 * std::size_t{cells()} && 4 * lay_out(out, true, 0) <= most_bytes_;
    u32 bits = guesses_ && has_exact_inverses(brdf_) ? kMostGuessBits : 0;
    while (bits && 4 * lay_out(out, grid, bits) > most_bytes_) bits = bits > kLeastGuessBits ? bits - 1 : 0;
    return 4 * lay_out(out, grid, bits) <= most_bytes_ && (grid || bits || !guesses_);
}

AcdfBrdfTables* BrdfTablesMaker::assemble(const AcdfAllocator& allocator, AcdfBlock& block) {
    AcdfBrdfTables layout;
    if (!choose(layout)) return nullptr;
    const std::size_t words = layout.words;
    block = take_block(allocator, 4 * words);
    if (!block.data) return nullptr;
    std::memset(block.data, 0, 4 * words);
    AcdfBrdfTables* const tables = new (block.data) AcdfBrdfTables(layout);
    tables->inverse[0] = 1.0 / brdf_.columns;
    tables->inverse[1] = 1.0 / brdf_.rows;
    place_views(at<double>(tables, layout.nodes), at<std::uint16_t>(tables, layout.guide));
    for (int axis = 0; axis < 2; ++axis)
        place_borders(axis, at<std::int32_t>(tables, layout.borders[axis]),
                      at<std::uint16_t>(tables, layout.border_guides[axis]));
    for (std::size_t view = 0; view < stride_; ++view) {
        const AcdfBin& bin = brdf_.bins[std::min<std::size_t>(view, views() - 1)];
        add_parts(acdf_blend_row(&brdf_.blend, bin.root), acdf_blend_root(&brdf_.blend), 1.0,
                  at<double>(tables, layout.parts) + view);
    }
    double* const codes = at<double>(tables, layout.codes);
    for (int i = 0; i < 256; ++i) {
        const double code = brdf_.blend.tiles->codebook[i];
        codes[i] = code * (1.0 / 65535.0);
        codes[256 + i] = (65535.0 - code) * (1.0 / 65535.0);
    }
    for (u32 i = 0; i < cells(); ++i) at<double>(tables, layout.areas)[i] = cells_[i].area();
    if (layout.grid) place_grid(at<std::uint16_t>(tables, layout.grid));
    if (!layout.guesses) return tables;
    const AcdfBrdfPath whole = {0, {}, {static_cast<i32>(brdf_.columns), static_cast<i32>(brdf_.rows)}, {}, {}};
    place_paths(acdf_blend_root(&brdf_.blend), whole, 0, at<AcdfBrdfPath>(tables, layout.paths));
    guess_brdf_cells(brdf_, layout.guess_bits, at<std::uint16_t>(tables, layout.guesses));
    return tables;
}

void BrdfTablesMaker::place_views(double* nodes, std::uint16_t* guide) const {
    for (u32 i = 0; i < views(); ++i) {
        nodes[2 * i] = static_cast<double>(brdf_.nodes[i]);
        nodes[2 * i + 1] = static_cast<double>(brdf_.bins[i].share);
    }
    nodes[2 * views()] = std::numeric_limits<double>::infinity();
    u32 node = 1;
    for (u32 step = 0; step <= ACDF_VIEW_STEPS; ++step) {
        while (node + 2 <= views() && nodes[2 * node] * nodes[2 * node] * ACDF_VIEW_STEPS < step) ++node; // exactly
        guide[step] = static_cast<std::uint16_t>(std::min(node - 1, 0xFFFFu)); // it may start too low
    }
}

void BrdfTablesMaker::place_borders(int axis, std::int32_t* out, std::uint16_t* guide) const {
    std::int32_t* const last = std::copy_n(borders_[axis].data(), borders_[axis].size(), out);
    std::fill_n(last, ACDF_BORDERS_AT_ONCE, std::numeric_limits<std::int32_t>::max());
    constexpr int steps = 1 << ACDF_BORDER_STEP_BITS; // of a binade; the first one begins at 0
    for (int step = 1; step < ACDF_BORDER_STEPS; ++step) {
        const double begin = std::ldexp(1.0 + static_cast<double>(step % steps) / steps, step / steps);
        guide[step] = static_cast<std::uint16_t>(below(axis, static_cast<u32>(begin)));
    }
}

void BrdfTablesMaker::place_grid(std::uint16_t* out) const {
    for (u32 i = 0; i < cells(); ++i) {
        const auto& side = cells_[i].side;
        const std::size_t left = below(0, side[0][0]), right = below(0, side[0][1] - 1) + 1;
        const std::size_t last = below(1, side[1][1] - 1);
        for (std::size_t row = below(1, side[1][0]); row <= last; ++row) {
            std::uint16_t* const line = out + row * (borders_[0].size() + 1);
            std::fill(line + left, line + right, static_cast<std::uint16_t>(i));
        }
    }
}

/// The cell across the middle of a side, itself where there is none.
u32 BrdfTablesMaker::cell_beyond(u32 cell, u32 axis, u32 upper) const {
    const BrdfCell& from = cells_[cell];
    if (from.split[axis][upper] == kNoSplit) return cell;
    const u32 middle = from.side[1 - axis][0] + (from.side[1 - axis][1] - from.side[1 - axis][0]) / 2;
    u32 node = brdf_.blend.splits[from.split[axis][upper]].child[upper];
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = brdf_.blend.splits[node];
        node = split.child[(split.place & 7u) == axis ? 1 - upper : middle >= split.place >> 3];
    }
    return node & ~ACDF_TILE_FLAG;
}

// A path passes at most 48 splits.
void BrdfTablesMaker::place_paths(u32 node, const AcdfBrdfPath& above, u32 depth, AcdfBrdfPath* out) const {
    if (node & ACDF_TILE_FLAG) {
        const u32 cell = node & ~ACDF_TILE_FLAG;
        out[cell] = above;
        for (u32 axis = 0; axis < 2; ++axis)
            for (u32 upper = 0; upper < 2; ++upper)
                out[cell].beyond[acdf_way_number(acdf_brdf_way(axis, upper))] =
                    static_cast<std::uint16_t>(cell_beyond(cell, axis, 1 - upper));
        return;
    }
    const AcdfSplit& split = brdf_.blend.splits[node];
    const u32 axis = split.place & 7u;
    for (u32 upper = 0; upper < 2; ++upper) {
        AcdfBrdfPath path = above;
        (upper ? path.low : path.high)[axis] = static_cast<i32>(split.place >> 3);
        if (depth < ACDF_PATH_SPLITS) {
            path.splits[depth] = static_cast<std::uint16_t>(node);
            path.ways |= std::uint64_t{acdf_brdf_way(axis, upper)} << 4 * depth;
        }
        place_paths(split.child[upper], path, depth + 1, out);
    }
}

// The products of the codes above each cell, as acdf_blend_find multiplies them.
void BrdfTablesMaker::add_parts(const std::uint8_t* row, u32 node, double product, double* out) const {
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = brdf_.blend.splits[node];
        const double code = brdf_.blend.tiles->codebook[row[node]];
        add_parts(row, split.child[1], product * ((65535.0 - code) * (1.0 / 65535.0)), out);
        product *= code * (1.0 / 65535.0);
        node = split.child[0];
    }
    out[stride_ * (node & ~ACDF_TILE_FLAG)] = product;
}

} // namespace

bool has_exact_inverses(const AcdfBrdf& brdf) noexcept {
    return is_power_of_two(brdf.columns) && is_power_of_two(brdf.rows);
}

bool can_have_tables(const AcdfBrdf& brdf) noexcept {
    return brdf.blend.tiles && !brdf.blend.roots && brdf.views->phi_count == 1 &&
           !(brdf.views->diffuse_share > 0.0f);
}

AcdfBrdfTables* make_brdf_tables(const AcdfBrdf& brdf, std::size_t most_bytes, bool guesses,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    BrdfTablesMaker maker(brdf, most_bytes, guesses);
    return maker.gather() ? maker.assemble(allocator, block) : nullptr;
}

} // namespace acdf
