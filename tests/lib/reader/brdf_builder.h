// Writes files of kind 3 from format/SPEC.md alone. It checks nothing, so that tests can write broken files too.
#pragma once

#include "tests/lib/reader/normals_builder.h"

namespace acdf_test {

/// A BRDF. Bins have rows where there are halvings, else trees of curves.
struct BrdfSpec {
    static constexpr std::uint32_t half_rows = 512; ///< of halvings

    std::uint32_t columns = 8;
    std::uint32_t rows = 8;     ///< of curves
    std::uint32_t flags = 1;    ///< mirrored
    std::uint32_t azimuths = 1; ///< of stored views
    std::vector<float> nodes;   ///< their elevations
    float diffuse_share = 0.0f;
    TreeSpec tree = {{CurveSpec{}}, {}}; ///< of curves
    NormalsSpec halved;                  ///< halvings, and rows of codes; no nodes: there are curves
    std::vector<BinSpec> bins;           ///< root: the row, or a curve of `tree`; no_root: not stored
    double total = 2.0;
    bool zlib = false;

    bool is_halved() const { return !halved.tree.halvings.nodes.empty(); }

    DescriptionSpec description() const {
        DescriptionSpec d;
        d.parameterization = 2;
        d.total = total;
        d.bin_count = static_cast<std::uint32_t>(bins.size());
        d.axes = {{"phi_h", 0, 0, columns, flags & 1 ? 0.0 : -pi, pi},
                  {"cos_theta_h", 0, is_halved() ? 2u : 0u, is_halved() ? half_rows : rows, 1.0, 0.0},
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

    /// The cells of a row, in preorder.
    std::vector<RowCell> cells(std::size_t row) const { return sized().cells(row); }

    /// Chunks in the order DESC, BINS, HALV, VIEW, NORM, or DESC, BINS, TREE, VIEW.
    FileSpec file() {
        std::vector<BinSpec> stored = bins;
        const Bytes curves = tree.encode();
        for (BinSpec& bin : stored)
            if (!is_halved() && bin.root != no_root) bin.root = tree.starts[bin.root];
        FileSpec file;
        file.kind = 3;
        file.chunks = {{"DESC", description().encode(), 1, zlib}, {"BINS", acdf_test::encode(stored), 1, zlib}};
        if (is_halved()) file.chunks.push_back({"HALV", halved.tree.halvings.encode(), 1, zlib});
        else file.chunks.push_back({"TREE", curves, 1, zlib});
        file.chunks.push_back({"VIEW", view_chunk(), 1, zlib});
        if (is_halved()) file.chunks.push_back({"NORM", sized().normals_chunk(), 1, zlib});
        return file;
    }
    Bytes encode() { return file().encode(); }

private:
    NormalsSpec sized() const {
        NormalsSpec out = halved;
        out.tree.columns = columns;
        out.tree.rows = half_rows;
        return out;
    }
};

/// Three elevations whose rows have codes of two halvings, and share two more: the second row leads nothing to the
/// upper columns.
inline BrdfSpec shared_brdf() {
    BrdfSpec spec;
    spec.nodes = {0.0f, 0.5f, 0.875f};
    spec.halved.tree.halvings.nodes = {{0, 128}, {1, 100}, {}, {0, 60}, {}, {}, {1, 200}, {}, {}};
    spec.halved.own = {true, true, false, false};
    spec.halved.rows = {{50, 30}, {127, 77}, {20, 100}};
    spec.bins = {{0, 0.5f}, {1, 0.25f}, {2, 0.125f}};
    return spec;
}

/// Of curves: two elevations by four azimuths, trees of complete_environment.
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

/// Any tree of halvings, any rows and views.
inline BrdfSpec random_brdf(std::uint32_t seed) {
    std::mt19937 random(seed);
    RandomOptions options = varied_options(seed, 512);
    options.octahedral = false;
    options.rows = BrdfSpec::half_rows;
    options.columns = seed % 4 == 1 ? 1u << 16 : options.columns;
    options.depth = std::min(options.depth, 5); // else rows lead one step to some halvings
    BrdfSpec spec;
    spec.columns = options.columns;
    spec.halved = random_normals(seed, options);
    spec.azimuths = seed % 3 == 2 ? 1 + std::uint32_t(random() % 9) : 1;
    spec.flags = spec.azimuths == 1 ? random() % 2 : 0;
    spec.diffuse_share = random() % 2 ? 0.0f : 0x1p-32f * static_cast<float>(random());
    const std::uint32_t views = 1 + std::uint32_t(random() % 40);
    for (std::uint32_t i = 0; i < views; ++i)
        spec.nodes.push_back((static_cast<float>(i) + 0x1p-33f * static_cast<float>(random())) / float(views));
    const std::uint32_t bins = views * spec.azimuths;
    spec.halved.rows.resize(std::min<std::size_t>(spec.halved.rows.size(), bins));
    for (std::uint32_t i = 0; i < bins; ++i)
        spec.bins.push_back({static_cast<std::uint32_t>(random() % spec.halved.rows.size()),
                             random() % 8 == 0 ? 0.0f : std::exp(0x1p-30f * static_cast<float>(random()))});
    return spec;
}

} // namespace acdf_test
