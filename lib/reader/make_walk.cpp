// Writes down trees as splits and leaves for shaders (acdf/shader_walk.h).
#include "make_walk.h"

#include "make_sides.h"
#include "memory.h"

#include <acdf/shader_walk.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr double kSquareMargin = 0x1p-20; // of the side of the square

struct Node {
    u32 key, lower, upper, chance;
};
struct Leaf {
    u32 flags;
    float density, axes[2][4];
};
static_assert(sizeof(Node) == 16 && sizeof(Leaf) == 4 * ACDF_LEAF_WORDS);

u32 bits_of(double x) { return acdf_float_bits(static_cast<float>(x)); }

// The chance of a node whose parts share lower + upper.
u32 chance_of(double lower, double upper) {
    const double sum = lower + upper;
    return lower <= upper ? bits_of(lower / sum) : bits_of(upper / sum) | 0x80000000u;
}

// low, width, least and greatest of a leaf's axis: `margin` inside, or in its middle.
void set_axis(double low, double high, const double margin[2], float out[4]) {
    const double least = std::min(low, high) + margin[low > high], most = std::max(low, high) - margin[low < high];
    const double middle = 0.5 * (low + high);
    out[0] = static_cast<float>(low);
    out[1] = static_cast<float>(high - low);
    out[2] = static_cast<float>(least < most ? least : middle);
    out[3] = static_cast<float>(least < most ? most : middle);
}

// What keys of directions are at or above from the beginning of a side on.
u32 azimuth_key(const Side& side) {
    const double from_seam = double{ACDF_WALK_SEAM} - side.key[1];
    return static_cast<u32>(std::ceil(from_seam > 0.0 ? from_seam : from_seam + 0x1p25));
}
const u32 equator_key = acdf_float_bits(1.0f);

class WalkMaker {
public:
    explicit WalkMaker(const File& file)
        : file_(file), local_(file.kind() == ACDF_KIND_LOCAL ? file.local().data() : AcdfLocal()),
          environment_(file.kind() == ACDF_KIND_LOCAL ? local_.environment : file.environment().data()),
          sides_(environment_.columns, environment_.rows),
          most_cells_(2 * std::size_t{file.tree_units()} + 64 +
                      (local_.blend.tiles ? local_.blend.tiles->tile_count : 0)) {}

    bool make();
    bool assemble(AcdfBlock& block) const;

private:
    // A curve, and the cell that it divides: probabilities are those of tile or tree.
    struct Divided {
        const std::uint8_t* tree;
        u32 at;
        Cell box;
        u32 light;
    };

    bool octahedral() const { return environment_.parameterization == ACDF_PARAM_OCTAHEDRAL; }
    Cell whole() const {
        return {1.0, {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {environment_.columns, environment_.rows}, false, false};
    }
    u32 key(u32 axis, u32 position) const;
    u32 node(u32 axis, u32 position, u32 chance);
    u32 tree(const std::uint8_t* tree, u32 root, const Cell& box, u32 light);
    u32 curve(const Divided& divided, const AcdfCurve& curve, u32 first, u32 last);
    u32 splits(u32 node, const Cell& box);
    u32 leaf(const Cell& cell, u32 light);
    u32 pieces(const Cell& cell, u32 light);
    u32 add(const Node& node);
    u32 add(const Leaf& leaf);
    float unit() const;
    bool bins();

    const File& file_;
    AcdfLocal local_;
    AcdfEnvironment environment_;
    Sides sides_;
    std::size_t most_cells_, cells_ = 0;
    bool failed_ = false;
    Growable<Node> nodes_;
    Growable<Leaf> leaves_;
    Growable<u32> bins_, light_links_, tree_links_;
    u32 root_ = 0, mixture_ = ACDF_WALK_NONE;
};

// What keys of directions are at or above from a position on.
u32 WalkMaker::key(u32 axis, u32 position) const {
    const u32 count = axis == 0 ? environment_.columns : environment_.rows;
    if (octahedral())
        return static_cast<u32>(std::ceil(static_cast<double>(position) / count * double{ACDF_SQUARE_STEPS}));
    Cell beyond = whole();
    beyond.first[axis] = position;
    Side sides[5];
    if (axis == 0) {
        sides_.azimuths(beyond, sides);
        return azimuth_key(sides[0]);
    }
    sides_.heights(beyond, sides);
    const u32 cap = bits_of(sides[0].local[0]);
    return sides[0].piece == 1 ? ACDF_WALK_SOUTH - cap : cap;
}

u32 WalkMaker::node(u32 axis, u32 position, u32 chance) {
    return add(Node{axis << 31 | key(axis, position), 0, 0, chance});
}

u32 WalkMaker::add(const Node& node) {
    nodes_.add(node);
    if (nodes_.failed()) failed_ = true;
    return static_cast<u32>(nodes_.size() - 1);
}

u32 WalkMaker::add(const Leaf& leaf) {
    leaves_.add(leaf);
    if (leaves_.failed()) failed_ = true;
    return ACDF_WALK_LEAF | static_cast<u32>(leaves_.size() - 1);
}

u32 WalkMaker::leaf(const Cell& cell, u32 light) {
    if (++cells_ > most_cells_ || cell.tilted) failed_ = true;
    if (cell.dark || failed_) return ACDF_WALK_LEAF; // the first one
    if (!octahedral()) return pieces(cell, light);
    Leaf leaf = {light << 3, 0.0f, {}};
    const AcdfGrid grid = acdf_environment_grid(&environment_);
    const AcdfRange range[2] = {{cell.first[0], cell.last[0], 0.0}, {cell.first[1], cell.last[1], 0.0}};
    const double margin[2] = {kSquareMargin, kSquareMargin}, t[2] = {0.5, 0.5};
    leaf.density = acdf_grid_pdf(&grid, range, t, acdf_positive(cell.probability));
    for (int axis = 0; axis < 2; ++axis) {
        const double count = axis == 0 ? environment_.columns : environment_.rows;
        set_axis(cell.first[axis] / count, cell.last[axis] / count, margin, leaf.axes[axis]);
    }
    return add(leaf);
}

// Divides a cell along the borders of the pieces of the sphere: first heights, then azimuths.
u32 WalkMaker::pieces(const Cell& cell, u32 light) {
    const Cell even = {1.0,   {0.0, 0.0}, {1.0, 1.0}, {cell.first[0], cell.first[1]}, {cell.last[0], cell.last[1]},
                       false, false};
    const float density = sides_.density(cell);
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = sides_.azimuths(even, columns), row_count = sides_.heights(even, rows);
    u32 link = ACDF_WALK_LEAF;
    for (int r = row_count - 1; r >= 0; --r) {
        const Side& height = rows[r];
        const bool south = height.piece == 1;
        const double margins[2] = {height.margin[south], height.margin[!south]};
        u32 row = ACDF_WALK_LEAF;
        for (int c = column_count - 1; c >= 0; --c) {
            const Side& azimuth = columns[c];
            Leaf leaf = {azimuth.piece | height.piece << 2 | light << 3, density, {}};
            set_axis(azimuth.local[0], azimuth.local[1], azimuth.margin, leaf.axes[0]);
            set_axis(height.local[south], height.local[!south], margins, leaf.axes[1]);
            const u32 part = add(leaf);
            row = c + 1 == column_count ? part
                                        : add(Node{azimuth_key(columns[c + 1]), part, row,
                                                   chance_of(azimuth.high - azimuth.low, 1.0 - azimuth.high)});
        }
        link = r + 1 == row_count ? row
                                  : add(Node{0x80000000u | equator_key, row, link,
                                             chance_of(height.high - height.low, 1.0 - height.high)});
    }
    return link;
}

u32 WalkMaker::tree(const std::uint8_t* tree, u32 root, const Cell& box, u32 light) {
    const AcdfCurve whole = acdf_curve_at(tree, root);
    return curve({tree, root, box, light}, whole, 0, whole.segments);
}

// Segments [first, last) of a curve, which are halved. A path passes at most 64 curves.
u32 WalkMaker::curve(const Divided& divided, const AcdfCurve& curve, u32 first, u32 last) {
    const u32 axis = acdf_curve_axis(&curve), maximum = acdf_curve_maximum(&curve);
    const u32 low = acdf_curve_cumulative(&curve, first), high = acdf_curve_cumulative(&curve, last);
    if (failed_) return ACDF_WALK_LEAF;
    if (low == high) { // dark, all of them
        Cell dark = divided.box;
        dark.dark = true;
        return leaf(dark, divided.light);
    }
    if (first + 1 < last) {
        const u32 middle = first + (last - first) / 2, border = acdf_curve_cumulative(&curve, middle);
        AcdfRange range = {divided.box.first[axis], divided.box.last[axis], 0.0};
        acdf_curve_narrow(&curve, middle, &range);
        const u32 at = node(axis, range.low, chance_of(border - low, high - border));
        const u32 lower = this->curve(divided, curve, first, middle),
                  upper = this->curve(divided, curve, middle, last);
        if (failed_) return ACDF_WALK_LEAF;
        nodes_[at].lower = lower;
        nodes_[at].upper = upper;
        return at;
    }
    Divided part = divided;
    AcdfRange range = {divided.box.first[axis], divided.box.last[axis], 0.0};
    acdf_curve_narrow(&curve, first, &range);
    part.box.first[axis] = range.low;
    part.box.last[axis] = range.high;
    part.box.tilted = part.box.tilted || range.tilt != 0.0;
    part.box.probability *= static_cast<double>(high - low) / maximum;
    const u32 link = acdf_curve_link(&curve, first);
    if (link == 0) return leaf(part.box, part.light);
    part.at += link;
    const AcdfCurve child = acdf_curve_at(part.tree, part.at);
    return this->curve(part, child, 0, child.segments);
}

// What rows share below a node of theirs. A path passes at most 48 splits.
u32 WalkMaker::splits(u32 split, const Cell& box) {
    const AcdfBlend& blend = local_.blend;
    if (failed_) return ACDF_WALK_LEAF;
    if (!(split & ACDF_TILE_FLAG)) {
        const u32 axis = blend.splits[split].place & 7u, position = blend.splits[split].place >> 3;
        Cell lower = box, upper = box;
        lower.last[axis] = upper.first[axis] = position;
        const u32 at = node(axis, position, ACDF_WALK_SPLIT | split);
        const u32 below = splits(blend.splits[split].child[0], lower),
                  above = splits(blend.splits[split].child[1], upper);
        if (failed_) return ACDF_WALK_LEAF;
        nodes_[at].lower = below;
        nodes_[at].upper = above;
        return at;
    }
    const u32 tile = split & ~ACDF_TILE_FLAG, root = blend.roots ? blend.roots[tile] : ACDF_NO_ROOT;
    const u32 light = acdf_local_light_of(&local_, tile);
    const u32 link = root == ACDF_NO_ROOT ? leaf(box, light) : tree(blend.tree, root, box, light);
    if (light != 0 && light_links_.size() >= light) light_links_[light - 1] = link;
    return link;
}

// A power of two that brings shares, which are only compared, to where the products of floats neither end nor
// begin.
float WalkMaker::unit() const {
    if (!local_.blend.tiles) return 1.0f;
    float most = 0.0f;
    for (u32 i = 0; i < file_.description().bin_count; ++i) most = std::max(most, local_.bins[i].share);
    for (u32 i = 0; i < local_.light_count; ++i) most = std::max(most, local_.lights[i].share);
    return most > 0.0f ? static_cast<float>(std::ldexp(1.0, -std::max(std::ilogb(most), -126))) : 1.0f;
}

bool WalkMaker::bins() {
    const u32 count = file_.description().bin_count;
    const bool trees = !local_.blend.tiles;
    const float scale = unit();
    const u32* const links = trees ? tree_links_.add(file_.tree_units(), ACDF_WALK_NONE) : nullptr;
    if (trees && !links) return false;
    for (u32 i = 0; i < count && !failed_; ++i) {
        const AcdfBin& bin = local_.bins[i];
        const bool drawn = bin.root != ACDF_NO_ROOT && bin.share > 0.0f;
        if (trees && drawn && tree_links_[bin.root] == ACDF_WALK_NONE) // several may have the same
            tree_links_[bin.root] = tree(environment_.tree, bin.root, whole(), 0);
        bins_.add(trees && drawn ? tree_links_[bin.root] : bin.root);
        bins_.add(acdf_float_bits(bin.share * scale));
    }
    return !(failed_ || bins_.failed());
}

bool WalkMaker::make() {
    add(Leaf{0, 0.0f, {}}); // what is dark
    if (!sides_.remember(most_cells_)) return false;
    if (local_.light_count > 0 && !light_links_.add(local_.light_count, ACDF_WALK_LEAF)) return false;
    root_ = tree(environment_.tree, environment_.root, whole(), 0);
    if (local_.blend.tiles && !failed_) mixture_ = splits(acdf_blend_root(&local_.blend), whole());
    return !failed_ && (file_.kind() != ACDF_KIND_LOCAL || bins());
}

bool WalkMaker::assemble(AcdfBlock& block) const {
    const AcdfTiles* const tiles = local_.blend.tiles;
    const std::size_t stride = tiles ? tiles->tile_count - 1 : 0, rows = tiles ? stride * tiles->row_count : 0;
    const std::size_t codes = tiles ? 512 : 0, lights = 8 * std::size_t{local_.light_count};
    const std::size_t words = ACDF_WALK_HEADER_WORDS + (nodes_.bytes() + leaves_.bytes() + bins_.bytes()) / 4 +
                              codes + lights + rows / 4 + 1;
    if (rows > 0xFFFFFFFFu || words > 0x3FFFFFFFu) return false;
    block = take_block({}, 4 * words);
    if (!block.data) return false;
    u32* const out = static_cast<u32*>(std::memset(block.data, 0, 4 * words));
    const float scale = unit();
    std::size_t at = ACDF_WALK_HEADER_WORDS;
    const auto place = [&](u32 header, const void* from, std::size_t bytes) { // where there is none, its place is 0
        if (bytes == 0) return;
        out[header] = static_cast<u32>(at);
        std::memcpy(out + at, from, bytes);
        at += (bytes + 3) / 4;
    };
    out[ACDF_WALK_SIZE] = static_cast<u32>(words);
    out[ACDF_WALK_OCTAHEDRAL] = octahedral();
    out[ACDF_WALK_ENVIRONMENT] = root_;
    out[ACDF_WALK_MIXTURE] = mixture_;
    out[ACDF_WALK_SUBDIVISIONS] = local_.subdivisions;
    out[ACDF_WALK_COLUMNS] = local_.columns;
    out[ACDF_WALK_ROWS] = local_.rows;
    out[ACDF_WALK_BIN_COUNT] = static_cast<u32>(bins_.size() / 2);
    out[ACDF_WALK_STRIDE] = static_cast<u32>(stride);
    out[ACDF_WALK_LIGHT_COUNT] = local_.light_count;
    out[ACDF_WALK_COSINE] = bits_of(local_.cosine_share);
    place(ACDF_WALK_NODES, nodes_.data(), nodes_.bytes());
    place(ACDF_WALK_LEAVES, leaves_.data(), leaves_.bytes());
    place(ACDF_WALK_BINS, bins_.data(), bins_.bytes());
    if (codes > 0) out[ACDF_WALK_CODES] = static_cast<u32>(at);
    for (std::size_t i = 0; i < codes / 2; ++i) {
        out[at++] = bits_of(tiles->codebook[i] / 65535.0);
        out[at++] = bits_of((65535.0 - tiles->codebook[i]) / 65535.0);
    }
    if (lights > 0) out[ACDF_WALK_LIGHTS] = static_cast<u32>(at);
    for (u32 i = 0; i < local_.light_count; ++i) {
        const AcdfLight& light = local_.lights[i];
        for (int k = 0; k < 3; ++k) out[at + static_cast<std::size_t>(k)] = acdf_float_bits(light.direction[k]);
        out[at + 3] = acdf_float_bits(light.radius);
        out[at + 4] = acdf_float_bits(light.share * scale);
        out[at + 5] = light_links_[i];
        at += 8;
    }
    place(ACDF_WALK_CODE_ROWS, local_.blend.rows, rows);
    return true;
}

} // namespace

bool make_walk(const File& file, AcdfBlock& block) noexcept {
    WalkMaker maker(file);
    return maker.make() && maker.assemble(block);
}

} // namespace acdf
