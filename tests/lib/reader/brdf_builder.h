// Writes files of kind 3 from format/SPEC.md alone. It checks nothing, so that tests can write broken files too.
#pragma once

#include "tests/lib/reader/local_builder.h"

namespace acdf_test {

/// A BRDF. Bins have rows where there are tiles, else trees.
struct BrdfSpec {
    std::uint32_t columns = 8, rows = 8;
    std::uint32_t flags = 1;    ///< mirrored
    std::uint32_t azimuths = 1; ///< of stored views
    std::vector<float> nodes;   ///< their elevations
    float diffuse_share = 0.0f;
    TreeSpec tree = {{CurveSpec{}}, {}};
    std::vector<SplitSpec> splits; ///< empty: bins share nothing
    std::vector<std::uint16_t> codebook = even_codebook();
    std::vector<Bytes> codes;     ///< rows of one byte a split
    std::vector<int> tile_curves; ///< empty, or one a tile: its first curve, -1: it is a cell
    std::vector<BinSpec> bins;    ///< root: the row, or a curve of `tree`; no_root: not stored
    double total = 2.0;
    bool zlib = false;

    DescriptionSpec description() const {
        DescriptionSpec d;
        d.parameterization = 2;
        d.total = total;
        d.bin_count = static_cast<std::uint32_t>(bins.size());
        d.axes = {{"phi_h", 0, 0, columns, flags & 1 ? 0.0 : -pi, pi},
                  {"cos_theta_h", 0, 0, rows, 1.0, 0.0},
                  {"theta_o", 1, 0, static_cast<std::uint32_t>(nodes.size()), 0.0, 0.5 * pi},
                  {"phi_o", 1, 0, azimuths, -pi, pi}};
        return d;
    }

    Bytes view_chunk() const {
        Bytes out;
        for (std::size_t v : {nodes.size(), std::size_t{azimuths}, std::size_t{flags}})
            put32(out, static_cast<std::uint32_t>(v));
        put_float(out, diffuse_share);
        for (float x : nodes) put_float(out, x);
        return out;
    }

    /// Chunks in the order DESC, BINS, TREE, VIEW, and TILE, ROWS.
    FileSpec file() {
        const Bytes curves = tree.encode();
        std::vector<BinSpec> stored = bins;
        for (BinSpec& bin : stored)
            if (splits.empty() && bin.root != no_root) bin.root = tree.starts[bin.root];
        FileSpec file;
        file.kind = 3;
        file.chunks = {{"DESC", description().encode(), 1, zlib},
                       {"BINS", acdf_test::encode(stored), 1, zlib},
                       {"TREE", curves, 1, zlib},
                       {"VIEW", view_chunk(), 1, zlib}};
        if (splits.empty()) return file;
        LocalSpec shared; // whose chunks are the same
        shared.tiles = static_cast<std::uint32_t>(splits.size() + 1);
        shared.splits = splits;
        shared.codebook = codebook;
        shared.tree = tree;
        shared.tile_curves = tile_curves;
        shared.codes = codes;
        file.chunks.push_back({"TILE", shared.tile_chunk(), 1, zlib});
        file.chunks.push_back({"ROWS", shared.row_chunk(), 1, zlib});
        return file;
    }
    Bytes encode() { return file().encode(); }
};

/// Three elevations that share four cells of 8 x 8 squares: columns [0, 3) x rows [0, 2) and [2, 8); columns [3, 8)
/// x rows [0, 5) and [5, 8), which the first row never enters.
inline BrdfSpec shared_brdf() {
    BrdfSpec spec;
    spec.nodes = {0.0f, 0.5f, 0.875f};
    spec.splits = {{0, 3, {1, 2}}, {1, 2, {tile_flag, tile_flag | 1}}, {1, 5, {tile_flag | 2, tile_flag | 3}}};
    spec.codes = {{100, 30, 255}, {200, 77, 140}, {20, 128, 60}};
    spec.bins = {{0, 0.5f}, {1, 0.25f}, {2, 0.125f}};
    return spec;
}

/// Without shared cells: two elevations by four azimuths, trees of complete_environment.
inline BrdfSpec separate_brdf() {
    BrdfSpec spec;
    spec.flags = 0;
    spec.azimuths = 4;
    spec.nodes = {0.25f, 0.75f};
    spec.tree = complete_environment().tree;
    spec.diffuse_share = 0.25f;
    for (std::uint32_t b = 0; b < 8; ++b) spec.bins.push_back({b % 3, 0.125f});
    return spec;
}

} // namespace acdf_test
