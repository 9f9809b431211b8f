// Writes the golden files of the present version: for each NAME.acdf a NAME.txt of samples.
//
//   make_golden OUTDIR
//
// The files in tests/golden/ were made by it and are frozen with each release: a reader of any later version
// must sample the same samples from them, bit for bit. (One of them, `untilted`, has the curves that the variance
// fit of environments once made. They stay legal, and nothing makes them any more.) A line of the text is
//
//   u0 u1  x y z  pdf
//
// in hexadecimal floating point (C99 %a), of a local environment with the normal before it (where it has visibility
// cells with position and normal), of a BRDF with wo, of several maps with three coordinates. None of the files is
// symmetric, so that a mirrored, turned or transposed frame shows.
#include "compress/fit/fit.h"
#include "compress/indexed/fit.h"
#include "compress/store/store.h"
#include "golden_samples.h"
#include "write_file.h"

#include <acdf/brdf_half.h>
#include <acdf/sphere.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

namespace {

using namespace acdf::compress;

struct Golden {
    std::string name;
    std::vector<std::uint8_t> bytes;
};

constexpr std::uint32_t kPhi = ACDF_AXIS_PHI, kTheta = ACDF_AXIS_THETA;

Golden golden(const char* name, const Cascade& cascade, const Description& description, double price = 1e-8) {
    return {name, store(encode_tree(cascade, price), description)};
}

/// One cell: the whole sphere.
Golden smallest() {
    Description description = environment_description(1, 1);
    description.total = 12.566370614359172; // 4 pi: radiance 1
    return golden("smallest", {{{kTheta, {}, {1.0}, {}, {}}}, {0}}, description);
}

/// One lit texel, column 2 of 8 and row 1 of 4: phi from pi/4 to pi/2, theta from pi/4 to pi/2. Its first and
/// last segments are dark.
Golden one_texel() {
    const Cascade cascade = {
        {{kTheta, {1, 2}, {0.0, 1.0, 0.0}, {-1, 1, -1}, {}}, {kPhi, {2, 3}, {0.0, 1.0, 0.0}, {}, {}}}, {0}};
    return golden("one_texel", cascade, environment_description(8, 4));
}

/// A target without symmetry: small integers, so that it is the same on every machine.
Target integer_target(std::uint32_t columns, std::uint32_t rows) {
    std::vector<float> rgb;
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const std::uint32_t noise = (c * 7 + r * 13 + c * r * 3) % 11;
            rgb.insert(rgb.end(), {float(noise), float(c), c == 9 && r == 2 ? 500.0f : float(r * r)});
        }
    TargetOptions options;
    options.weights = {0.25, 0.5, 0.25};
    return environment_target(rgb.data(), columns, rows, options);
}

Golden fitted() {
    const Target target = integer_target(12, 7);
    FitOptions options;
    options.fit = ACDF_FIT_CDF;
    options.order = Order::phi;
    options.column_segments = 6;
    options.row_segments = 4;
    Description description = environment_description(12, 7);
    description.fit = options.fit;
    description.total = integral(target);
    description.channel_weights[0] = description.channel_weights[2] = 0.25;
    description.channel_weights[1] = 0.5;
    description.metadata = {{"generator", "make_golden"}, {"note", "a target of small integers, 12 x 7"}};
    return {"zlib", store(fit(target, options).tree, description, ACDF_CODEC_ZLIB)};
}

/// Densities that are linear across a segment, on either axis and on both.
Golden tilted() {
    const Cascade cascade = {{{kPhi, {3, 10}, {0.25, 0.5, 0.25}, {1, -1, 2}, {0.5, -0.75, 0.0}},
                              {kTheta, {4}, {0.375, 0.625}, {}, {-0.9375, 0.25}},
                              {kTheta, {1, 7}, {0.125, 0.375, 0.5}, {}, {0.0, 0.999, -0.5}}},
                             {0}};
    Description description = environment_description(16, 9);
    description.fit = ACDF_FIT_PDF;
    return golden("tilted", cascade, description);
}

/// theta, phi, theta, phi: a tree that returns to both axes, and branches that end at every depth.
Golden deep() {
    const Cascade cascade = {{{kTheta, {6, 20}, {0.25, 0.5, 0.25}, {-1, 1, 2}, {}},
                              {kPhi, {10, 11, 40}, {0.125, 0.625, 0.125, 0.125}, {-1, -1, 3, -1}, {}},
                              {kPhi, {50}, {0.75, 0.25}, {4, -1}, {}},
                              {kTheta, {8, 9}, {0.25, 0.25, 0.5}, {-1, 5, -1}, {}},
                              {kTheta, {21, 30}, {0.0, 0.875, 0.125}, {}, {}},
                              {kPhi, {12, 13}, {0.0625, 0.875, 0.0625}, {}, {}}},
                             {0}};
    return golden("deep", cascade, environment_description(64, 32));
}

/// Not to be used alone: half of the sphere is left to its partner.
Golden partner() {
    const Cascade cascade = {
        {{kTheta, {3, 5}, {0.75, 0.25, 0.0}, {1, -1, -1}, {}}, {kPhi, {2, 9}, {0.5, 0.0, 0.5}, {}, {}}}, {0}};
    Description description = environment_description(12, 10);
    description.chunks = {
        partner_chunk({ACDF_PARTNER_COSINE, ACDF_HEURISTIC_POWER, 3.0, 1.0}, 0.625f, {{0.625f, 0.0f}})};
    return golden("partner", cascade, description);
}

/// One curve that three segments share.
Golden shared_child() {
    const Cascade cascade = {{{kTheta, {2, 3, 5}, {0.125, 0.25, 0.5, 0.125}, {1, 2, 1, 1}, {}},
                              {kPhi, {1, 4}, {0.5, 0.125, 0.375}, {}, {}},
                              {kPhi, {7}, {0.0, 1.0}, {}, {}}},
                             {0}};
    return golden("shared_child", cascade, environment_description(10, 6));
}

/// The largest grid, and probabilities that need 32 bits.
Golden wide() {
    const Cascade cascade = {{{kTheta, {30000, 50001}, {1e-6, 0.5, 0.499999}, {-1, 1, -1}, {}},
                              {kPhi, {5, 32768, 65535}, {1e-7, 0.25, 0.5, 0.2499999}, {}, {}}},
                             {0}};
    return golden("wide", cascade, environment_description(65536, 65536), 0.0);
}

/// On the octahedral square: parts of all eight octants, and one across both folds of the middle.
Golden octahedral() {
    const Cascade cascade = {{{kPhi, {3, 9, 20}, {0.125, 0.25, 0.5, 0.125}, {1, 2, -1, 3}, {}},
                              {kTheta, {5, 16}, {0.5, 0.125, 0.375}, {}, {}},
                              {kTheta, {10, 14}, {0.25, 0.75, 0.0}, {-1, 4, -1}, {}},
                              {kTheta, {1, 23}, {0.375, 0.25, 0.375}, {}, {}},
                              {kPhi, {4}, {0.25, 0.75}, {}, {}}},
                             {0}};
    return golden("octahedral", cascade, environment_description(24, 24, ACDF_PARAM_OCTAHEDRAL));
}

/// A tree that halves the longer side of each box, or the one that a number chooses, and ends where another says
/// so.
class HalvingsGrower {
public:
    HalvingsGrower(std::uint32_t code_bits, std::uint32_t least_depth, std::uint32_t most_depth)
        : least_depth_(least_depth), most_depth_(most_depth) {
        tree_.code_bits = code_bits;
    }

    Halvings grown(std::uint32_t columns, std::uint32_t rows) {
        grow(columns, rows, 0);
        return std::move(tree_);
    }

private:
    void grow(std::uint32_t columns, std::uint32_t rows, std::uint32_t depth) {
        const std::uint32_t choice = next(8);
        const bool is_single = columns == 1 && rows == 1;
        if (is_single || depth == most_depth_ || (depth >= least_depth_ && choice == 0))
            return tree_.axes.push_back(-1);
        const bool is_wide = rows == 1 || (columns > 1 && (choice < 4 ? choice < 2 : columns >= rows));
        const std::uint32_t quarter = 1u << (tree_.code_bits - 2);
        tree_.axes.push_back(static_cast<std::int8_t>(is_wide ? kPhi : kTheta));
        tree_.codes.push_back(static_cast<std::uint16_t>(quarter + next(2 * quarter)));
        const std::uint32_t wide = is_wide ? columns / 2 : columns, high = is_wide ? rows : rows / 2;
        grow(wide, high, depth + 1);
        grow(is_wide ? columns - wide : columns, is_wide ? rows : rows - high, depth + 1);
    }

    /// A linear congruential generator (Knuth 1997, §3.3.4).
    std::uint32_t next(std::uint32_t below) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>(state_ >> 33) % below;
    }

    Halvings tree_;
    std::uint64_t state_ = 1701;
    std::uint32_t least_depth_, most_depth_;
};

Golden halvings(const char* name, const Description& description, std::uint32_t code_bits,
                std::uint32_t least_depth, std::uint32_t most_depth, AcdfCodec codec = ACDF_CODEC_NONE) {
    HalvingsGrower grower(code_bits, least_depth, most_depth);
    const Halvings tree = grower.grown(description.axes[0].resolution, description.axes[1].resolution);
    return {name, store(tree, description, codec)};
}

/// Which halvings have codes of each map: those above a depth.
std::vector<bool> halvings_above(const Halvings& tree, std::uint32_t depth) {
    std::vector<bool> out;
    std::vector<std::uint32_t> open = {0};
    for (const std::int8_t axis : tree.axes) {
        const std::uint32_t here = open.back();
        open.pop_back();
        if (axis < 0) continue;
        out.push_back(here < depth);
        open.insert(open.end(), 2, here + 1);
    }
    return out;
}

/// Codes of a row where it leads random numbers: some of `code(i)`, by the number of the split.
template <class Code>
std::vector<std::uint16_t> reached_codes(const RowHalvings& tree, const Code& code) {
    std::vector<std::uint16_t> out;
    std::vector<bool> open = {true}; // of the nodes that wait: whether the row leads there
    const std::uint32_t last = (1u << tree.code_bits) - 1;
    std::size_t halving = 0;
    std::uint32_t split = 0;
    for (const std::int8_t axis : tree.halvings.axes) {
        const bool here = open.back();
        open.pop_back();
        if (axis < 0) continue;
        if (!tree.has_codes[halving++]) {
            open.insert(open.end(), 2, here);
            continue;
        }
        const std::uint32_t of_split = code(split++);
        if (here) out.push_back(static_cast<std::uint16_t>(of_split));
        open.push_back(here && of_split != last); // the upper half
        open.push_back(here && of_split != 0);
    }
    return out;
}

/// Five rows at the top of a tree; the first leaves a half dark.
RowHalvings five_rows(std::uint32_t columns, std::uint32_t rows) {
    RowHalvings out;
    out.halvings = HalvingsGrower(8, 3, 7).grown(columns, rows);
    out.has_codes = halvings_above(out.halvings, 4);
    out.code_bits = 6;
    for (std::uint32_t row = 0; row < 5; ++row)
        out.rows.push_back(reached_codes(out, [&](std::uint32_t split) {
            return row == 0 && split == 2 ? 63u : 12u + (13 * row + 7 * split + 3 * row * split) % 40;
        }));
    return out;
}

/// Four cells, told apart by position and, in the last two, by the normal's z.
/// `regions`: the first and the last part tiles in one place, those between them in another.
Chunk visibility_chunk(bool regions) {
    Chunk chunk{ACDF_CHUNK_VISIBILITY, {}};
    const AcdfVisibility header = {
        3, 4, 2, regions, {-1, -2, 0}, {3, 2, 4}, {{0, 0, 1, 0.5f}, {1, 0, 0, 0}, {0, 1, 0, 0}}}; // y up, moved
    const AcdfVisibilitySplit splits[] = {{1.0f, 0 | ACDF_VISIBILITY_ROW << 3, 1},
                                          {0.5f, 1 | (ACDF_VISIBILITY_ROW | 1) << 3, 2},
                                          {0.25f, 5 | (ACDF_VISIBILITY_ROW | 2) << 3, ACDF_VISIBILITY_ROW | 3}};
    const AcdfColumn columns[] = {{2, 0}, {1, 0x8000}, {1, 0x8001}, {3, 0x8000}};
    const std::uint16_t set_of_row[] = {0, 1, 1, 0};
    const std::uint8_t rows[] = {240, 30,  200, 200, 254, 7, // all light and odds of each
                                 17,  100, 128, 90,  180, 44};
    const auto add = [&](const void* data, std::size_t size) {
        const auto* first = static_cast<const std::uint8_t*>(data);
        chunk.bytes.insert(chunk.bytes.end(), first, first + size);
    };
    add(&header, sizeof header);
    add(splits, sizeof splits);
    add(columns, regions ? sizeof columns : sizeof columns / 2);
    if (regions) add(set_of_row, sizeof set_of_row);
    add(rows, sizeof rows);
    return chunk;
}

/// Two portals that face two ways, in pieces, beside visibility_chunk. The last place samples by rows alone.
Chunk portals_chunk() {
    Chunk chunk{ACDF_CHUNK_PORTALS, {}};
    const AcdfPortals header = {2, 2, 3, 2};
    const AcdfPortal portals[] = {{{4, -1, 0.5f}, {2, 2.5f}, 0}, {{1, 4, 1}, {1.5f, 1}, 1}};
    const AcdfPortalMap maps[] = {{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, 0.0078125f},
                                  {{{-0.8f, 0.6f, 0}, {0, 0, 1}, {0.6f, 0.8f, 0}}, 0.015625f}};
    const std::uint32_t sums[] = {0, 0, 0, 0, 0, 3, 4, 9,  0, 5, 21, 27, 0, 8, 25, 40,  // of the first map
                                  0, 0, 0, 0, 0, 1, 9, 10, 0, 2, 12, 18, 0, 7, 19, 26}; // of the second
    const std::uint8_t rows[] = {12,  250, 240, 200, 255, 30,  90,  180, 251,           //
                                 99,  100, 250, 251, 252, 200, 210, 220, 230,           //
                                 3,   255, 255, 255, 255, 17,  255, 255, 255,           //
                                 255, 1,   2,   3,   4,   5,   6,   7,   8};
    const auto add = [&](const void* data, std::size_t size) {
        const auto* first = static_cast<const std::uint8_t*>(data);
        chunk.bytes.insert(chunk.bytes.end(), first, first + size);
    };
    add(&header, sizeof header);
    add(portals, sizeof portals);
    add(maps, sizeof maps);
    add(sums, sizeof sums);
    add(rows, sizeof rows);
    return chunk;
}

/// A local environment on a tree of halvings; a bin is not stored.
Golden local(const char* name, float cosine_share, const std::vector<Chunk>& visibility = {}) {
    Description d = environment_description(24, 14);
    const RowHalvings tree = five_rows(24, 14);
    d.kind = ACDF_KIND_LOCAL;
    d.total = 4.0;
    d.axes.push_back({"normal", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 18, 0.0, 18.0});
    d.shares.clear();
    std::vector<std::uint32_t> roots;
    for (std::uint32_t bin = 0; bin < 18; ++bin) {
        roots.push_back(bin == 7 ? ACDF_NO_ROOT : bin % 5);
        d.shares.push_back(bin == 7 ? 0.0f : float(1 + bin % 4) / 16.0f);
    }
    d.chunks = {local_chunk(cosine_share), rows_chunk(tree)};
    d.chunks.insert(d.chunks.end(), visibility.begin(), visibility.end());
    return {name, store(tree.halvings, roots, d)};
}

/// Maps of one tree along `axes`; the codes of the first map leave two halves dark.
Golden indexed(const char* name, Description d, const std::vector<AxisDescription>& axes,
               const std::vector<double>& coordinates, const std::vector<AcdfMap>& maps, std::uint32_t sun,
               AcdfCodec codec) {
    IndexedTree tree;
    tree.halvings = HalvingsGrower(8, 3, 8).grown(d.axes[0].resolution, d.axes[1].resolution);
    tree.has_codes = halvings_above(tree.halvings, 4);
    tree.code_bits = sun > 0 ? 6 : 9;
    const std::uint32_t most = (1u << tree.code_bits) - 1;
    std::uint32_t splits = 0;
    for (const bool own : tree.has_codes) splits += own;
    for (std::uint32_t map = 0; map < maps.size(); ++map) {
        std::vector<std::uint16_t> row;
        for (std::uint32_t i = 0; i < splits; ++i)
            row.push_back(static_cast<std::uint16_t>(most / 4 + (17 * map + 29 * i + 5 * map * i) % (most / 2)));
        tree.rows.push_back(row);
    }
    tree.rows[0][splits - 1] = 0;
    tree.rows[0][splits / 2] = static_cast<std::uint16_t>(most);
    d.kind = ACDF_KIND_INDEXED;
    d.total = 6.0;
    d.axes.insert(d.axes.end(), axes.begin(), axes.end());
    d.shares.assign(maps.size(), 0.0f);
    d.chunks = {{ACDF_CHUNK_MAPS, maps_chunk(tree, coordinates, maps, sun)}};
    return {name, store(tree.halvings, d, codec)};
}

/// Three hours of two hazes. The sun moves, is the same in both, hidden at the end, and not known once.
Golden day() {
    return indexed("indexed", environment_description(24, 14),
                   {{"time", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 3, 6.0, 18.0},
                    {"haze", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 2, 1.0, 2.5}},
                   {6.0, 9.0, 18.0, 1.0, 2.5},
                   {{0.125f, 0.5f, 0.25f, {0.6f, 0.0f, 0.8f}},
                    {0.25f, 0.25f, 0.375f, {0.6f, 0.0f, 0.8f}},
                    {0.125f, 0.75f, 0.125f, {0.0f, 0.6f, 0.8f}},
                    {0.25f, 0.5f, 0.125f, {0.0f, 0.6f, 0.8f}},
                    {0.125f, 0.0f, 0.0f, {0.0f, 0.0f, 0.0f}},
                    {0.125f, 0.0f, 0.25f, {-0.8f, 0.6f, 0.0f}}},
                   4, ACDF_CODEC_NONE);
}

/// Without suns, compressed, on the octahedral square.
Golden frames() {
    return indexed("indexed_octahedral", environment_description(16, 16, ACDF_PARAM_OCTAHEDRAL),
                   {{"frame", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 2, -1.0, 1.0}}, {-1.0, 1.0},
                   {{0.25f, 0.0f, 0.0f, {}}, {0.75f, 0.0f, 0.0f, {}}}, 0, ACDF_CODEC_ZLIB);
}

/// Codes of 12 bits: the first and the last, which leave a half dark, and those next to them.
Golden dark_halvings() {
    Halvings tree;
    tree.code_bits = 12;
    tree.axes = {kTheta, kPhi, -1, kPhi, kTheta, -1, -1, kTheta, -1, kPhi, -1, -1, -1};
    tree.codes = {4095, 0, 1, 2048, 300, 4094};
    return {"halvings_dark", store(tree, environment_description(8, 6))};
}

/// On from a node at `level`: the halvings of a level are alike, and leaves are texels of 16 x 16.
void halve_evenly(Halvings& tree, std::uint32_t level) {
    if (level == 8) return tree.axes.push_back(-1);
    tree.axes.push_back(static_cast<std::int8_t>(level % 2 == 0 ? kPhi : kTheta));
    tree.codes.push_back(static_cast<std::uint16_t>(100 + 8 * level));
    halve_evenly(tree, level + 1);
    halve_evenly(tree, level + 1);
}

/// One that zlib makes shorter.
Golden even_halvings() {
    Halvings tree;
    halve_evenly(tree, 0);
    return {"halvings_zlib", store(tree, environment_description(16, 16), ACDF_CODEC_ZLIB)};
}

/// One cell: a tree that is a leaf.
Golden leaf_halvings() {
    Halvings tree;
    tree.axes = {-1};
    Description description = environment_description(12, 7);
    description.total = 12.566370614359172; // 4 pi: radiance 1
    return {"halvings_leaf", store(tree, description)};
}

/// More segments than the short form of a count holds, and a child behind them that takes a longer link.
Golden many_segments(const char* name, AcdfCodec codec) {
    Curve many{kPhi, {}, {}, {}, {}};
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 150; ++i) {
        if (i > 0) many.knots.push_back(2 * i + i % 2);
        many.probability.push_back(double(1 + i * i % 17));
        sum += many.probability.back();
    }
    for (double& p : many.probability) p /= sum;
    const Cascade cascade = {{{kTheta, {3, 5}, {0.5, 0.125, 0.375}, {1, -1, 2}, {}},
                              std::move(many),
                              {kPhi, {10, 290}, {0.25, 0.25, 0.5}, {}, {}}},
                             {0}};
    return {name, store(encode_tree(cascade), environment_description(301, 9), codec)};
}

/// A tree for each bin of a grid of normals, some of them the same; bin 2 is not stored, bin 4 dark.
Golden local_grid() {
    const Cascade cascade = {{{kPhi, {5}, {0.375, 0.625}, {-1, 1}, {}},
                              {kTheta, {3}, {0.75, 0.25}, {}, {}},
                              {kTheta, {1, 4}, {0.125, 0.75, 0.125}, {-1, 3, -1}, {}},
                              {kPhi, {2, 11}, {0.25, 0.5, 0.25}, {}, {}}},
                             {0, 2, 3, 1}};
    EncodedTree tree = encode_tree(cascade);
    tree.roots = {tree.roots[1], tree.roots[2], ACDF_NO_ROOT, 0, tree.roots[1], tree.roots[3]};
    constexpr double pi = 3.141592653589793;
    Description d = environment_description(12, 8);
    d.kind = ACDF_KIND_LOCAL;
    d.total = 3.0;
    d.axes.push_back({"normal theta", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 2, 0.0, pi});
    d.axes.push_back({"normal phi", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 3, pi, -pi});
    d.shares = {0.125f, 0.25f, 0.375f, 0.5f, 0.0f, 0.25f};
    d.chunks = {local_chunk(0.0f)};
    return {"local_grid", store(tree, d)};
}

/// A BRDF of `elevations` stored views by `azimuths`; `flags` and `diffuse_share` as in AcdfViews.
Description brdf_axes(const std::vector<float>& elevations, std::uint32_t azimuths, std::uint32_t flags,
                      float diffuse_share) {
    constexpr double pi = 3.141592653589793;
    const AcdfViews views = {static_cast<std::uint32_t>(elevations.size()), azimuths, flags, diffuse_share};
    Description d;
    d.kind = ACDF_KIND_BRDF;
    d.parameterization = ACDF_PARAM_HALF_ANGLE;
    d.total = 2.0;
    d.axes = {{"phi_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 48, flags ? 0.0 : -pi, pi},
              {"cos_theta_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 1000, 1.0, 0.0},
              {"theta_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, views.theta_count, 0.0, 0.5 * pi},
              {"phi_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, azimuths, -pi, pi}};
    d.shares.clear();
    for (std::uint32_t bin = 0; bin < views.theta_count * azimuths; ++bin)
        d.shares.push_back(float(1 + bin % 4) / 16.0f);
    Chunk chunk{ACDF_CHUNK_VIEWS, std::vector<std::uint8_t>(sizeof views + 4 * elevations.size())};
    std::memcpy(chunk.bytes.data(), &views, sizeof views);
    std::memcpy(chunk.bytes.data() + sizeof views, elevations.data(), 4 * elevations.size());
    d.chunks.push_back(std::move(chunk));
    return d;
}

/// Bins that share a tree of halvings.
Golden brdf(const char* name, const std::vector<float>& elevations, std::uint32_t azimuths, std::uint32_t flags,
            float diffuse_share) {
    Description d = brdf_axes(elevations, azimuths, flags, diffuse_share);
    d.axes[1].measure = ACDF_MEASURE_HALF;
    d.axes[1].resolution = ACDF_HALF_ROWS;
    RowHalvings tree = five_rows(d.axes[0].resolution, d.axes[1].resolution);
    std::vector<std::uint32_t> roots;
    for (std::uint32_t bin = 0; bin < d.shares.size(); ++bin) roots.push_back(bin % 5);
    tree.rows.resize(std::min<std::size_t>(5, roots.size()));
    d.chunks.push_back(rows_chunk(tree));
    return {name, store(tree.halvings, roots, d)};
}

/// A tree for each bin, with and without a linear density; the nearest bin serves.
Golden brdf_separate() {
    const Cascade cascade = {{{kTheta, {30, 200}, {0.625, 0.25, 0.125}, {1, -1, -1}, {}},
                              {kPhi, {10, 25}, {0.25, 0.625, 0.125}, {}, {}},
                              {kTheta, {90}, {0.75, 0.25}, {3, -1}, {-0.5, 0.25}},
                              {kPhi, {40}, {0.875, 0.125}, {}, {0.75, 0.0}}},
                             {0, 2}};
    EncodedTree tree = encode_tree(cascade);
    const std::vector<std::uint32_t> roots = tree.roots;
    Description d = brdf_axes({0.125f, 0.625f}, 4, 0, 0.0f);
    d.fit = ACDF_FIT_PDF;
    tree.roots.clear();
    for (std::uint32_t bin = 0; bin < 8; ++bin) tree.roots.push_back(roots[bin % 2]);
    return {"brdf_separate", store(tree, d)};
}

} // namespace

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_golden OUTDIR (which exists)\n");
        return 2;
    }
    const std::string folder = std::string(argv[1]) + "/";
    for (const Golden& golden :
         {smallest(),
          one_texel(),
          fitted(),
          tilted(),
          deep(),
          partner(),
          shared_child(),
          wide(),
          many_segments("many_segments", ACDF_CODEC_NONE),
          many_segments("planes", ACDF_CODEC_ZLIB),
          octahedral(),
          halvings("halvings", environment_description(12, 7), 8, 2, 9),
          halvings("halvings_octahedral", environment_description(24, 24, ACDF_PARAM_OCTAHEDRAL), 10, 3, 7),
          dark_halvings(),
          even_halvings(),
          leaf_halvings(),
          day(),
          frames(),
          local("local", 0.0f),
          local_grid(),
          local("visibility", 0.25f, {visibility_chunk(false)}),
          local("visibility_regions", 0.25f, {visibility_chunk(true)}),
          local("portals", 0.25f, {visibility_chunk(false), portals_chunk()}),
          brdf("brdf", {0.0f, 0.375f, 0.75f, 0.9375f}, 1, 0, 0.0f),
          brdf("brdf_mirrored", {0.0f, 0.375f, 0.75f, 0.9375f}, 1, ACDF_VIEWS_MIRRORED, 0.0f),
          brdf("brdf_anisotropic", {0.125f, 0.5f, 0.875f}, 4, 0, 0.0f),
          brdf("brdf_floor", {0.25f, 0.75f}, 1, ACDF_VIEWS_MIRRORED, 0.25f),
          brdf_separate()}) {
        const std::string text = golden_samples(golden.name, golden.bytes);
        write_file(folder + golden.name + ".acdf", golden.bytes.data(), golden.bytes.size());
        write_file(folder + golden.name + ".txt", text.data(), text.size());
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "make_golden: %s\n", error.what());
    return 1;
}
