// Writes down trees as splits and leaves for shaders (acdf/shader/tree.h).
#include "shader/tables/walk.h"

#include "memory.h"
#include "shader/tables/walk_cells.h"
#include "shader/tables/walk_maps.h"

#include <acdf/indexed/views.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;

// What a file samples from, if it is one that can be traversed.
AcdfLocal local_of(const File& file, const AcdfIndexed& maps) {
    AcdfLocal local = {};
    if (file.kind() == ACDF_KIND_LOCAL) return file.local().data();
    if (file.kind() == ACDF_KIND_ENVIRONMENT) {
        local.environment = file.environment().data();
        return local;
    }
    if (file.kind() == ACDF_KIND_INDEXED) {
        local.environment.halved = maps.halved;
        local.environment.columns = maps.columns;
        local.environment.rows = maps.rows;
        local.environment.parameterization = maps.parameterization;
        return local;
    }
    const AcdfBrdf brdf = file.brdf().data();
    local.environment.halved = brdf.halved;
    local.rows_of_normals = brdf.rows_of_views;
    local.environment.columns = brdf.columns;
    local.environment.rows = brdf.rows;
    local.environment.parameterization = ACDF_PARAM_HALF_ANGLE;
    local.bins = brdf.bins;
    local.cosine_share = brdf.views->diffuse_share;
    return local;
}

class WalkMaker {
public:
    WalkMaker(const File& file, const AcdfIndexed& maps)
        : file_(file), local_(local_of(file, maps)), environment_(local_.environment), indexed_(maps),
          nodes_(environment_.halved ? acdf_halvings_nodes(environment_.halved) : nullptr),
          rows_(local_.rows_of_normals),
          cells_(environment_.parameterization, environment_.columns, environment_.rows),
          most_leaves_(64 + (environment_.halved ? 2 * std::size_t{environment_.halved->count} : 0)) {}

    bool make();
    bool assemble(AcdfBlock& block) const;

private:
    bool brdf() const { return file_.kind() == ACDF_KIND_BRDF; }
    // Whether steps of an axis are rows of half-vectors (ACDF_HALF_ROWS).
    bool is_of_rows(u32 axis) const { return axis == 1 && brdf() && rows_; }
    u32 node(u32 axis, u32 position, u32 chance);
    u32 halvings(u32 at, const AcdfSpan* steps, const Cell& box);
    u32 environment();
    u32 tile(const AcdfTopTile& tile);
    u32 top(u32 at);
    u32 row_split(u32 at);
    const AcdfTopTile& map_tile(u32 at) const {
        return ACDF_TOP_ARRAY(AcdfTopTile, indexed_.top, indexed_.top->tiles)[at];
    }
    u32 leaf(const Cell& cell);
    std::size_t stride() const { return rows_ ? rows_->splits : 0; }
    u32 row_count() const { return rows_ ? rows_->rows : 0; }
    void shares(u32 row, float* out) const;
    float unit() const;
    bool bins();
    bool views();

    const File& file_;
    AcdfLocal local_;
    AcdfEnvironment environment_;
    const AcdfIndexed& indexed_; // zero: the file is of another kind
    const AcdfHalving* nodes_;   // of the tree, if it is one of halvings
    const AcdfNormalRows* rows_; // at its top, of normals or views; null: there are none
    WalkCells cells_;
    std::size_t most_leaves_, leaves_ = 0;
    bool failed_ = false;
    WalkParts parts_;
    Growable<u32> bins_, views_;
    WalkMaps maps_;
    u32 root_ = ACDF_WALK_NONE, mixture_ = ACDF_WALK_NONE;
};

u32 WalkMaker::node(u32 axis, u32 position, u32 chance) {
    const u32 step = is_of_rows(axis) ? acdf_half_row(position) : position;
    const u32 at = parts_.add(WalkNode{axis << 31 | cells_.key(axis, step), 0, 0, chance});
    failed_ = failed_ || parts_.failed();
    return at;
}

u32 WalkMaker::leaf(const Cell& cell) {
    if (++leaves_ > most_leaves_) failed_ = true;
    if (cell.dark || failed_) return ACDF_WALK_LEAF; // the first one
    Cell placed = cell;
    if (is_of_rows(1)) {
        placed.first[1] = acdf_half_row(cell.first[1]);
        placed.last[1] = acdf_half_row(cell.last[1]);
    }
    const u32 link = cells_.add(placed, parts_);
    failed_ = parts_.failed();
    return link;
}

// A node of halvings, the box of it and the random numbers that lead there. A path passes at most 62 halvings.
u32 WalkMaker::halvings(u32 at, const AcdfSpan* steps, const Cell& box) {
    const AcdfHalving node = nodes_[at];
    const u32 axis = node.link & 7u, middle = (box.first[axis] + box.last[axis]) / 2;
    const u32 wide[2] = {node.threshold - steps[axis].end[0], steps[axis].end[1] - node.threshold};
    const u32 made = this->node(axis, middle, chance_of(wide[0], wide[1]));
    u32 links[2] = {};
    for (u32 upper = 0; upper < 2 && !failed_; ++upper) {
        Cell part = box;
        AcdfSpan part_steps[2] = {steps[0], steps[1]};
        (upper ? part.first : part.last)[axis] = middle;
        part_steps[axis].end[1 - upper] = node.threshold;
        part.probability *= static_cast<double>(wide[upper]) / (wide[0] + wide[1]);
        part.dark = wide[upper] == 0;
        links[upper] = node.link >> (3 + upper) & 1u
                           ? leaf(part)
                           : halvings(upper ? at + (node.link >> 5) : at + 1, part_steps, part);
    }
    if (failed_) return ACDF_WALK_LEAF;
    parts_.nodes[made].lower = links[0];
    parts_.nodes[made].upper = links[1];
    return made;
}

u32 WalkMaker::environment() {
    const AcdfHalvedTree* halved = environment_.halved;
    const AcdfSpan steps[2] = {{{0, ACDF_STEPS}}, {{0, ACDF_STEPS}}};
    return halved->count ? halvings(0, steps, cells_.whole()) : leaf(cells_.whole());
}

// What maps or rows share.
u32 WalkMaker::tile(const AcdfTopTile& tile) {
    Cell box = cells_.whole();
    for (u32 axis = 0; axis < 2; ++axis) {
        box.first[axis] = tile.box[axis].end[0];
        box.last[axis] = tile.box[axis].end[1];
    }
    return tile.node == ACDF_LEAF ? leaf(box) : halvings(tile.node, tile.steps, box);
}

// A split of several maps, and what is below. A path passes at most 62.
u32 WalkMaker::top(u32 at) {
    const AcdfTopSplit& split = ACDF_TOP_ARRAY(AcdfTopSplit, indexed_.top, indexed_.top->top)[at];
    const u32 made = node(split.axis, split.middle, ACDF_WALK_SPLIT | at);
    u32 links[2] = {};
    for (u32 upper = 0; upper < 2 && !failed_; ++upper) {
        const u32 child = split.child[upper];
        links[upper] = child & ACDF_TOP_TILE ? tile(map_tile(child & ~ACDF_TOP_TILE)) : top(child);
    }
    if (failed_) return ACDF_WALK_LEAF;
    parts_.nodes[made].lower = links[0];
    parts_.nodes[made].upper = links[1];
    return made;
}

// The same of rows of normals or views, from a split or a tile on.
u32 WalkMaker::row_split(u32 at) {
    if (at & ACDF_TOP_TILE) return tile(*acdf_row_tile(rows_, at & ~ACDF_TOP_TILE));
    const AcdfRowSplit& split = acdf_row_splits(rows_)[at];
    const u32 made = node(split.place & 1u, split.place >> 1, ACDF_WALK_SPLIT | at);
    u32 links[2] = {};
    for (u32 upper = 0; upper < 2 && !failed_; ++upper) links[upper] = row_split(split.child[upper]);
    if (failed_) return ACDF_WALK_LEAF;
    parts_.nodes[made].lower = links[0];
    parts_.nodes[made].upper = links[1];
    return made;
}

// A power of two that brings shares, which are only compared, to where the products of floats neither end nor
// begin.
float WalkMaker::unit() const {
    float most = 0.0f;
    for (u32 i = 0; i < file_.description().bin_count; ++i) most = std::max(most, local_.bins[i].share);
    return most > 0.0f ? static_cast<float>(std::ldexp(1.0, -std::max(std::ilogb(most), -126))) : 1.0f;
}

bool WalkMaker::bins() {
    const u32 count = file_.description().bin_count;
    const float scale = unit();
    for (u32 i = 0; i < count && !failed_; ++i) {
        const AcdfBin& bin = local_.bins[i];
        bins_.add(bin.root);
        bins_.add(acdf_float_bits(bin.share * scale));
    }
    return !(failed_ || bins_.failed());
}

// Coordinates of the stored elevations, and what is needed to be exact between them (acdf/shader/brdf.h).
bool WalkMaker::views() {
    const AcdfBrdf brdf = file_.brdf().data();
    const u32 count = brdf.views->theta_count;
    for (u32 i = 0; i < count; ++i) {
        const double x = double{brdf.nodes[i]}, square = x * x;
        const double next = i + 1 < count ? double{brdf.nodes[i + 1]} - x : 1.0;
        views_.add(acdf_float_bits(brdf.nodes[i]));
        views_.add(float_bits(square));
        views_.add(float_bits(square - double{static_cast<float>(square)}));
        views_.add(float_bits(std::min(1.0 / next, 3e38)));
    }
    return !views_.failed();
}

bool WalkMaker::make() {
    parts_.add(WalkLeaf{0, 0.0f, {}}); // what is dark
    if (!cells_.remember(most_leaves_)) return false;
    if (indexed_.top) {
        mixture_ = indexed_.top->splits ? top(0) : tile(map_tile(0));
        return !failed_ && maps_.make(indexed_);
    }
    if (!brdf()) root_ = environment();
    if (rows_ && !failed_) mixture_ = row_split(rows_->splits ? 0 : ACDF_TOP_TILE);
    if (failed_ || (brdf() && !views())) return false;
    return file_.kind() == ACDF_KIND_ENVIRONMENT || bins();
}

// What a row gives to the halves of each split, in preorder: the smaller share, negative where it is the upper
// half's.
void WalkMaker::shares(u32 row, float* out) const {
    const auto put = [](double lower, double upper) {
        return lower <= upper ? static_cast<float>(lower) : -static_cast<float>(upper);
    };
    const u32* before = acdf_row_before(rows_, row);
    struct Tiles {
        u32 first, end;
    } open[128], at = {0, rows_->splits + 1}; // of the halves that wait: a level of each axis, and one
    u32 waiting = 0;
    for (std::size_t i = 0; i < rows_->splits; ++i) {
        const AcdfRowSplit& split = acdf_row_splits(rows_)[i];
        if (i > 0) at = open[--waiting];
        const double steps = before[at.end] - before[at.first], lower = before[split.tile] - before[at.first];
        out[i] = steps > 0.0 ? put(lower / steps, (steps - lower) / steps) : 0.0f;
        if (!(split.child[1] & ACDF_TOP_TILE)) open[waiting++] = {split.tile, at.end};
        if (!(split.child[0] & ACDF_TOP_TILE)) open[waiting++] = {at.first, split.tile};
    }
}

bool WalkMaker::assemble(AcdfBlock& block) const {
    const std::size_t shares = stride() * row_count();
    const std::size_t words = ACDF_WALK_HEADER_WORDS +
                              (parts_.nodes.bytes() + parts_.leaves.bytes() + bins_.bytes() + views_.bytes()) / 4 +
                              shares + maps_.words();
    if (words > 0x3FFFFFFFu) return false;
    block = take_block({}, 4 * words);
    if (!block.data) return false;
    u32* const out = static_cast<u32*>(std::memset(block.data, 0, 4 * words));
    std::size_t at = ACDF_WALK_HEADER_WORDS;
    const auto place = [&](u32 header, const void* from,
                           std::size_t bytes) { // where there is none, its offset is 0
        if (bytes == 0) return;
        out[header] = static_cast<u32>(at);
        std::memcpy(out + at, from, bytes);
        at += (bytes + 3) / 4;
    };
    out[ACDF_WALK_SIZE] = static_cast<u32>(words);
    out[ACDF_WALK_OCTAHEDRAL] = cells_.octahedral();
    out[ACDF_WALK_ENVIRONMENT] = root_;
    out[ACDF_WALK_MIXTURE] = mixture_;
    out[ACDF_WALK_SUBDIVISIONS] = local_.subdivisions;
    out[ACDF_WALK_BIN_COUNT] = brdf() ? 0 : static_cast<u32>(bins_.size() / 2);
    out[ACDF_WALK_STRIDE] = static_cast<u32>(stride());
    out[ACDF_WALK_COSINE] = float_bits(local_.cosine_share);
    if (brdf()) {
        const AcdfViews& views = *file_.brdf().data().views; // in the file
        out[ACDF_WALK_VIEW_COUNT] = views.theta_count;
        out[ACDF_WALK_AZIMUTHS] = views.phi_count;
        out[ACDF_WALK_MIRRORED] = (views.flags & ACDF_VIEWS_MIRRORED) != 0;
    }
    place(ACDF_WALK_VIEWS, views_.data(), views_.bytes());
    place(ACDF_WALK_NODES, parts_.nodes.data(), parts_.nodes.bytes());
    place(ACDF_WALK_LEAVES, parts_.leaves.data(), parts_.leaves.bytes());
    place(ACDF_WALK_BINS, bins_.data(), bins_.bytes());
    if (shares > 0) out[ACDF_WALK_SHARES] = static_cast<u32>(at);
    for (u32 row = 0; shares > 0 && row < row_count(); ++row, at += stride())
        this->shares(row, reinterpret_cast<float*>(out + at));
    if (indexed_.top) maps_.place(out, at);
    return true;
}

} // namespace

bool make_walk(const File& file, AcdfBlock& block) noexcept {
    IndexedEnvironment maps;
    if (file.kind() == ACDF_KIND_INDEXED && !IndexedEnvironment::open(file, maps).ok()) return false;
    WalkMaker maker(file, maps.data());
    return maker.make() && maker.assemble(block);
}

} // namespace acdf
