// Writes files of kind 2 from format/SPEC.md alone. It checks nothing, so that tests can write broken files too.
#pragma once

#include "tests/lib/reader/files.h"
#include "tests/lib/reader/portals_spec.h"

#include <optional>

namespace acdf_test {

constexpr std::uint32_t tile_flag = 0x8000, no_root = 0xFFFFFFFF;

struct SplitSpec {
    std::uint32_t axis, position;
    std::uint32_t child[2]; ///< a split, or tile_flag | a tile
};

struct BrightTileSpec {
    float direction[3] = {0.6f, 0.0f, 0.8f};
    float radius = 2.0f, share = 0.25f;
    std::uint32_t tile = 0;
    std::array<std::uint32_t, 2> low{}, high{};
};

struct VisibilitySplitSpec {
    float position, blend;
    std::uint32_t axis;
    std::uint32_t part[2]; ///< a split, or visibility_row | a row
};
constexpr std::uint32_t visibility_row = 0x10000000;

/// Chunk PLAC.
struct VisibilitySpec {
    float low[3] = {-1.0f, -2.0f, 0.0f}, high[3] = {3.0f, 2.0f, 4.0f};
    float transform[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    std::vector<VisibilitySplitSpec> splits;
    std::uint32_t further_sets = 0;
    std::vector<std::uint16_t> columns;    ///< of each set one a split of tiles
    std::vector<std::uint16_t> set_of_row; ///< empty, or one a row
    std::vector<Bytes> rows;

    Bytes encode() const {
        Bytes out;
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < columns.size() / (1 + further_sets); ++i) count += columns[i] != 0xFFFF;
        for (std::size_t v : {splits.size(), rows.size(), std::size_t{count}, std::size_t{further_sets}})
            put32(out, static_cast<std::uint32_t>(v));
        for (float x : low) put_float(out, x);
        for (float x : high) put_float(out, x);
        for (float x : transform) put_float(out, x);
        for (const VisibilitySplitSpec& split : splits) {
            put_float(out, split.position);
            put_float(out, split.blend);
            put32(out, split.axis | split.part[0] << 3);
            put32(out, split.part[1]);
        }
        for (std::uint16_t column : columns) put16(out, column);
        for (std::uint16_t set : set_of_row) put16(out, set);
        for (const Bytes& row : rows) out.insert(out.end(), row.begin(), row.end());
        return out;
    }
};

/// A local environment. Bins have rows where there are tiles, else trees.
struct LocalSpec {
    std::uint32_t columns = 8, rows = 8;
    std::uint32_t subdivisions = 1;              ///< 0: lat-long bins
    std::uint32_t bin_columns = 0, bin_rows = 0; ///< of these
    TreeSpec tree;                               ///< curve 0 is the root of the environment
    std::uint32_t tiles = 0;                     ///< 0: bins share nothing
    std::vector<SplitSpec> splits;               ///< tiles - 1
    std::vector<int> tile_curves;                ///< empty, or one a tile: its first curve, -1: it is a cell
    std::vector<std::uint16_t> codebook;         ///< 256
    std::vector<Bytes> codes;                    ///< rows of one byte a split
    std::vector<BinSpec> bins;                   ///< root: the row, or a curve of `tree`; no_root: not stored
    std::vector<BrightTileSpec> bright_tiles;
    float cosine_share = 0.0f;
    std::optional<VisibilitySpec> visibility;
    std::optional<PortalsSpec> portals;
    double total = 3.0;
    bool zlib = false;
    bool octahedral = false; ///< axes u and v

    DescriptionSpec description() const {
        DescriptionSpec d;
        d.axes[0].resolution = columns;
        d.axes[1].resolution = rows;
        d.total = total;
        if (octahedral) d.make_octahedral();
        d.bin_count = static_cast<std::uint32_t>(bins.size());
        const std::uint32_t corners = 4 * subdivisions * subdivisions + 2;
        if (subdivisions > 0) {
            d.axes.push_back({"normal", 1, 0, corners, 0.0, double(corners)});
        } else {
            d.axes.push_back({"normal theta", 1, 0, bin_rows, 0.0, pi});
            d.axes.push_back({"normal phi", 1, 0, bin_columns, pi, -pi});
        }
        return d;
    }

    Bytes tile_chunk() const {
        Bytes out;
        for (std::size_t v : {std::size_t{tiles}, tile_curves.size(), codes.size(), std::size_t{0}})
            put32(out, static_cast<std::uint32_t>(v));
        for (std::uint16_t v : codebook) put16(out, v);
        for (const SplitSpec& split : splits) {
            put32(out, split.axis | split.position << 3);
            for (std::uint32_t child : split.child) put16(out, child);
        }
        for (int curve : tile_curves)
            put32(out, curve < 0 ? no_root : tree.starts[static_cast<std::size_t>(curve)]);
        return out;
    }

    Bytes row_chunk() const {
        Bytes out;
        for (const Bytes& row : codes) out.insert(out.end(), row.begin(), row.end());
        return out;
    }

    Bytes local_chunk() const {
        Bytes out;
        put_float(out, cosine_share);
        put32(out, static_cast<std::uint32_t>(bright_tiles.size()));
        for (const BrightTileSpec& light : bright_tiles) {
            for (float x : light.direction) put_float(out, x);
            put_float(out, light.radius);
            put_float(out, light.share);
            put32(out, light.tile);
            for (std::uint32_t v : light.low) put32(out, v);
            for (std::uint32_t v : light.high) put32(out, v);
        }
        return out;
    }

    FileSpec file() {
        const Bytes curves = tree.encode();
        std::vector<BinSpec> stored = bins;
        for (BinSpec& bin : stored)
            if (tiles == 0 && bin.root != no_root) bin.root = tree.starts[bin.root];
        FileSpec file;
        file.kind = 2;
        file.chunks = {{"DESC", description().encode(), 1, zlib},
                       {"BINS", acdf_test::encode(stored), 1, zlib},
                       {"TREE", curves, 1, zlib}};
        if (tiles > 0) {
            file.chunks.push_back({"TILE", tile_chunk(), 1, zlib});
            file.chunks.push_back({"ROWS", row_chunk(), 1, zlib});
        }
        file.chunks.push_back({"LOCL", local_chunk(), 1, zlib});
        if (visibility) file.chunks.push_back({"PLAC", visibility->encode(), 0, zlib});
        if (portals) file.chunks.push_back({"PORT", portals->encode(), 0, zlib});
        return file;
    }
    Bytes encode() { return file().encode(); }
};

/// Codes and probabilities in proportion.
inline std::vector<std::uint16_t> even_codebook() {
    std::vector<std::uint16_t> out;
    for (int i = 0; i < 256; ++i) out.push_back(static_cast<std::uint16_t>(257 * i));
    return out;
}

/// The six corners of the octahedron and three tiles of the curves of complete_environment:
///   tile 0 columns [0, 3), curve 1; tile 1 columns [3, 8) x rows [0, 2), a cell; tile 2 rows [2, 8) of those,
///   curve 2.
inline LocalSpec shared_local() {
    LocalSpec spec;
    spec.tree = complete_environment().tree;
    spec.tiles = 3;
    spec.splits = {{0, 3, {tile_flag, 1}}, {1, 2, {tile_flag | 1, tile_flag | 2}}};
    spec.tile_curves = {1, -1, 2};
    spec.codebook = even_codebook();
    spec.codes = {{100, 30}, {200, 255}};
    spec.bins = {{0, 0.5f}, {1, 0.25f}, {0, 0.125f}, {no_root, 0.0f}, {1, 0.5f}, {0, 0.75f}};
    return spec;
}

/// Tile 1 as a light: no row may give it anything.
inline LocalSpec lit_local() {
    LocalSpec spec = shared_local();
    spec.codes = {{100, 0}, {255, 77}}; // at the last split; at the one above it
    spec.bright_tiles.resize(1);
    spec.bright_tiles[0].tile = 1;
    spec.bright_tiles[0].low = {3, 0};
    spec.bright_tiles[0].high = {8, 2};
    return spec;
}

/// lit_local with four visibility: x < 1; above it y < 0.5; the rest, by the z of normals. Both splits of tiles are
/// distinguished.
inline LocalSpec visibility_local() {
    LocalSpec spec = lit_local();
    spec.visibility.emplace();
    spec.visibility->splits = {{1.0f, 0.25f, 0, {visibility_row, 1}},
                               {0.5f, 0.5f, 1, {visibility_row | 1, 2}},
                               {0.1f, 0.2f, 5, {visibility_row | 2, visibility_row | 3}}};
    spec.visibility->columns = {0, 1};
    spec.visibility->rows = {{240, 30, 200, 60}, {200, 255, 1, 254}, {0, 100, 128, 9}, {90, 17, 30, 250}};
    return spec;
}

/// visibility_local with one column alone, of the first split in some cells and of the second in others.
inline LocalSpec regional_local() {
    LocalSpec spec = visibility_local();
    spec.visibility->further_sets = 1;
    spec.visibility->columns = {0, 0xFFFF, 0xFFFF, 0};
    spec.visibility->set_of_row = {0, 1, 1, 0};
    for (Bytes& row : spec.visibility->rows) row.resize(3);
    return spec;
}

/// visibility_local with two portals in a wall at x = 4 and one in a wall at y = 3; the last cell samples by rows
/// alone.
inline LocalSpec windowed_local() {
    LocalSpec spec = visibility_local();
    spec.portals.emplace();
    spec.portals->portals = {
        {{4, -1, 0.5f}, {1, 2}, 0}, {{4, 0.5f, 1}, {1.5f, 1.5f}, 0}, {{1.5f, 3, 1}, {2, 1}, 1}};
    spec.portals->maps = {
        {{0, 1, 0, 0, 0, 1, 1, 0, 0}, 0.01f, {1, 2, 3, 4, 5, 60, 7, 8, 0, 9, 10, 11, 12, 13, 14, 1}},
        {{-1, 0, 0, 0, 0, 1, 0, 1, 0}, 0.02f, {9, 2, 3, 4, 5, 6, 7, 30, 9, 9, 10, 0, 1, 3, 14, 1}}};
    for (Bytes& row : spec.portals->rows = std::vector<Bytes>(4, Bytes(13, 250))) row[0] = 40;
    spec.portals->rows[1] = {5, 255, 240, 30, 200, 100, 255, 255, 254, 230, 180, 70, 255};
    spec.portals->rows[3][0] = 255;
    return spec;
}

/// Without tiles: bins of a lat-long grid of 3 x 2.
inline LocalSpec separate_local() {
    LocalSpec spec;
    spec.tree = complete_environment().tree;
    spec.subdivisions = 0;
    spec.bin_columns = 3;
    spec.bin_rows = 2;
    spec.bins = {{1, 0.5f}, {2, 0.25f}, {no_root, 0.0f}, {0, 0.125f}, {1, 0.0f}, {2, 0.75f}};
    spec.cosine_share = 0.25f;
    return spec;
}

} // namespace acdf_test
