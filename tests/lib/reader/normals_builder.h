// Local environments on one tree of halvings, byte by byte (SPEC.md §9).
#pragma once

#include "tests/lib/reader/local_builder.h"
#include "tests/lib/reader/random_halvings.h"
#include "tests/lib/visibility/portals_spec.h"
#include "tests/lib/visibility/visibility_spec.h"

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <vector>

namespace acdf_test {

/// A cell of such a tree as a row sees it: its box, and its probability.
struct RowCell {
    std::uint32_t box[2][2];
    double probability;
};

struct NormalsSpec {
    EnvironmentSpec tree; ///< of halvings
    std::uint32_t subdivisions = 1, code_bits = 7;
    std::vector<bool> own;                        ///< one a halving: rows have codes
    std::vector<std::vector<std::uint32_t>> rows; ///< a code for each of those
    std::vector<BinSpec> bins;                    ///< root: the row; no_root: not stored
    float cosine_share = 0.0f;
    std::optional<VisibilitySpec> visibility;
    std::optional<PortalsSpec> portals;
    bool zlib = false;

    /// The cells of a row, in preorder.
    std::vector<RowCell> cells(std::size_t row) const {
        Walk walk{*this, rows[row], {}, {}};
        walk.run();
        return walk.cells;
    }

    /// NORM: codes of nodes that a row leads no numbers to are left out.
    Bytes normals_chunk() const {
        Bytes out;
        std::uint32_t splits = 0;
        for (const bool each : own) splits += each;
        for (const std::uint32_t v : {static_cast<std::uint32_t>(rows.size()), splits, code_bits, 0u})
            put32(out, v);
        BitSpec flags, codes;
        for (const bool each : own) flags.put(each, 1);
        flags.add_to(out);
        for (const std::vector<std::uint32_t>& row : rows) {
            Walk walk{*this, row, {}, {}};
            walk.run();
            for (const std::uint32_t code : walk.stored) codes.put(code, code_bits);
        }
        codes.add_to(out);
        return out;
    }

    /// DESC, HALV, BINS, LOCL, NORM; PLAC and PORT where they are there.
    FileSpec file() const {
        EnvironmentSpec copy = tree;
        FileSpec out = copy.file();
        out.kind = 2;
        Bytes& description = out.chunks[0].raw;
        set(description, 20, 4, 3);
        set(description, 24, 4, bins.size());
        DescriptionSpec others;
        const std::uint32_t corners = 4 * subdivisions * subdivisions + 2;
        others.axes = {{"normal", 1, 0, corners, 0.0, double(corners)}};
        const Bytes encoded = others.encode();
        description.insert(description.end(), encoded.begin() + 64, encoded.end());
        LocalSpec local;
        local.cosine_share = cosine_share;
        out.chunks.push_back({"BINS", acdf_test::encode(bins), 1, zlib});
        out.chunks.push_back({"LOCL", local.local_chunk(), 1, zlib});
        out.chunks.push_back({"NORM", normals_chunk(), 1, zlib});
        if (visibility) out.chunks.push_back({"PLAC", visibility->encode(), 0, zlib});
        if (portals) out.chunks.push_back({"PORT", portals->encode(), 0, zlib});
        return out;
    }
    Bytes encode() const { return file().encode(); }

private:
    using Spans = std::array<std::array<std::uint64_t, 2>, 2>;
    struct Node {
        Spans box, steps;     ///< steps: as of an environment
        std::uint64_t of_row; ///< steps that lead the row to the tile
        double tile;          ///< what the environment gives to the tile
        bool top;
    };

    struct Walk {
        const NormalsSpec& spec;
        const std::vector<std::uint32_t>& codes;
        std::vector<std::uint32_t> stored;
        std::vector<RowCell> cells;
        std::size_t node = 0, halving = 0, split = 0;

        void run() {
            const std::uint64_t all = std::uint64_t{1} << 31;
            visit({{{{0, spec.tree.columns}, {0, spec.tree.rows}}}, {{{0, all}, {0, all}}}, all, 0.0, true});
        }
        static double area(const Node& at) {
            return double(at.steps[0][1] - at.steps[0][0]) * double(at.steps[1][1] - at.steps[1][0]);
        }
        void visit(Node at) {
            const HalvingSpec here = spec.tree.halvings.nodes[node++];
            const bool own = here.axis >= 0 && spec.own[halving];
            if (here.axis >= 0) ++halving;
            if (at.top && !own) at.tile = area(at);
            at.top = own;
            if (here.axis < 0) {
                RowCell cell = {{}, double(at.of_row) * 0x1p-31 * (at.tile > 0.0 ? area(at) / at.tile : 1.0)};
                for (std::size_t i = 0; i < 2; ++i)
                    for (std::size_t k = 0; k < 2; ++k) cell.box[i][k] = static_cast<std::uint32_t>(at.box[i][k]);
                return cells.push_back(cell);
            }
            const auto axis = static_cast<std::size_t>(here.axis);
            auto& steps = at.steps[axis];
            Node half[2] = {at, at};
            half[0].box[axis][1] = half[1].box[axis][0] = (at.box[axis][0] + at.box[axis][1]) / 2;
            half[0].steps[axis][1] = half[1].steps[axis][0] =
                steps[0] + lower(steps[1] - steps[0], here.code, spec.tree.halvings.code_bits);
            if (own) {
                const std::uint32_t code = codes[split++];
                if (at.of_row > 0) stored.push_back(code);
                half[0].of_row = lower(at.of_row, code, spec.code_bits);
                half[1].of_row = at.of_row - half[0].of_row;
            }
            for (const Node& part : half) visit(part);
        }
        static std::uint64_t lower(std::uint64_t steps, std::uint32_t code, std::uint32_t bits) {
            const std::uint32_t last = (1u << bits) - 1;
            if (steps == 0 || code == 0) return 0;
            if (code == last) return steps;
            const std::uint64_t share = steps * acdf_reference::halving_share(code, bits) >> 31;
            return std::min(std::max<std::uint64_t>(share, 1), steps - 1);
        }
    };
};

/// Three halvings, of which two have codes of rows; two rows, and a bin that is not stored.
inline NormalsSpec small_normals() {
    NormalsSpec spec;
    spec.tree.columns = spec.tree.rows = 8;
    spec.tree.halvings.nodes = {{0, 128}, {1, 128}, {}, {}, {1, 60}, {}, {}};
    spec.own = {true, true, false};
    spec.rows = {{100, 20}, {30, 127}};
    spec.bins = {{0, 0.5f}, {1, 0.25f}, {0, 0.125f}, {no_root, 0.0f}, {1, 0.5f}, {0, 0.75f}};
    return spec;
}

/// small_normals with four cells: x < 1; above it y < 0.5; the rest, by the z of normals. Each tile is a part
/// of its own.
inline NormalsSpec visible_normals() {
    NormalsSpec spec = small_normals();
    spec.visibility.emplace();
    spec.visibility->splits = {{1.0f, 0, {visibility_row, 1}},
                               {0.5f, 1, {visibility_row | 1, 2}},
                               {0.1f, 5, {visibility_row | 2, visibility_row | 3}}};
    spec.visibility->columns = {{2, 0}, {1, no_lower_column}};
    spec.visibility->rows = {{240, 200, 60}, {200, 1, 254}, {0, 128, 9}, {90, 30, 250}};
    return spec;
}

/// The same with one column alone, at the last tile in some cells and at the one before in others.
inline NormalsSpec regional_normals() {
    NormalsSpec spec = visible_normals();
    spec.visibility->further_sets = 1;
    spec.visibility->columns = {{2, no_lower_column}, {1, no_lower_column}};
    spec.visibility->set_of_row = {0, 1, 1, 0};
    for (Bytes& row : spec.visibility->rows) row.resize(2);
    return spec;
}

/// visible_normals with two portals in a wall at x = 4 and one in a wall at y = 3; the last cell samples by rows
/// alone.
inline NormalsSpec windowed_normals() {
    NormalsSpec spec = visible_normals();
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

/// Any tree, any rows.
inline NormalsSpec random_normals(std::uint32_t seed, RandomOptions options) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
    NormalsSpec spec;
    spec.tree = RandomHalvings(seed, options).make();
    spec.subdivisions = 1 + seed % 3;
    spec.code_bits = 4 + below(5);
    std::vector<bool> top{true}; // of the nodes that wait
    for (const HalvingSpec& node : spec.tree.halvings.nodes) {
        const bool above = top.back();
        top.pop_back();
        if (node.axis < 0) continue;
        spec.own.push_back(above && below(8) > 0);
        top.push_back(spec.own.back());
        top.push_back(spec.own.back());
    }
    const std::uint32_t last = (1u << spec.code_bits) - 1, rows = 1 + below(6);
    const auto splits = static_cast<std::size_t>(std::count(spec.own.begin(), spec.own.end(), true));
    for (std::uint32_t r = 0; r < rows; ++r) {
        spec.rows.emplace_back();
        for (std::size_t s = 0; s < splits; ++s) // in the middle, so that no node has but one step
            spec.rows.back().push_back(below(6) == 0 ? (below(2) ? 0 : last) : last / 4 + 1 + below(last / 2));
    }
    for (std::uint32_t b = 0; b < 4 * spec.subdivisions * spec.subdivisions + 2; ++b)
        spec.bins.push_back(below(12) == 0   ? BinSpec{no_root, 0.0f}
                            : below(12) == 0 ? BinSpec{0, 0.0f}
                                             : BinSpec{below(rows), 0.25f + 0.01f * float(below(100))});
    if (seed % 5 == 0) spec.cosine_share = 0.25f;
    return spec;
}

inline NormalsSpec random_normals(std::uint32_t seed) {
    RandomOptions options = varied_options(seed, 512);
    options.octahedral = seed % 3 == 0;
    if (options.octahedral) options.rows = options.columns;
    return random_normals(seed, options);
}

} // namespace acdf_test
