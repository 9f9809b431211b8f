// Writes files of kind 2 from format/SPEC.md alone. It checks nothing, so that tests can write broken files too.
#pragma once

#include "tests/lib/reader/files.h"

namespace acdf_test {

constexpr std::uint32_t no_root = 0xFFFFFFFF;

/// A local environment whose bins have trees of curves.
struct LocalSpec {
    std::uint32_t columns = 8, rows = 8;
    std::uint32_t subdivisions = 1;              ///< 0: lat-long bins
    std::uint32_t bin_columns = 0, bin_rows = 0; ///< of these
    TreeSpec tree;                               ///< curve 0 is the root of the environment
    std::vector<BinSpec> bins;                   ///< root: a curve of `tree`; no_root: not stored
    float cosine_share = 0.0f;
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

    Bytes local_chunk() const {
        Bytes out;
        put_float(out, cosine_share);
        put32(out, 0);
        return out;
    }

    FileSpec file() {
        const Bytes curves = tree.encode();
        std::vector<BinSpec> stored = bins;
        for (BinSpec& bin : stored)
            if (bin.root != no_root) bin.root = tree.starts[bin.root];
        FileSpec file;
        file.kind = 2;
        file.chunks = {{"DESC", description().encode(), 1, zlib},
                       {"BINS", acdf_test::encode(stored), 1, zlib},
                       {"TREE", curves, 1, zlib}};
        file.chunks.push_back({"LOCL", local_chunk(), 1, zlib});
        return file;
    }
    Bytes encode() { return file().encode(); }
};

/// Bins of a lat-long grid of 3 x 2.
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
