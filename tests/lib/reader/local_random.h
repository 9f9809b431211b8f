// Random local environments that use everything the format has for them: any splits, rows and codebooks, tiles with
// trees, as cells and as bright tiles, bins that are dark or not stored, all forms of bins.
#pragma once

#include "tests/lib/reader/local_builder.h"

#include <cmath>

namespace acdf_test {

/// Grids in turns, those of more columns than tables have steps among them.
inline RandomOptions varied_local_options(std::uint32_t seed) {
    RandomOptions options;
    options.columns = seed % 3 == 0 ? 64 : seed % 3 == 1 ? 37 : 5000;
    options.rows = seed % 2 == 0 ? 33 : 511;
    return options;
}

/// A normal on an edge or a corner of the octahedron that bins divide, of any length; all of it may be 0.
template <class Random>
std::array<float, 3> edge_normal(Random& random) {
    std::array<float, 3> normal;
    for (float& n : normal) n = static_cast<float>(static_cast<int>(random() % 9) - 4);
    return normal;
}

class RandomLocal {
public:
    RandomLocal(std::uint32_t seed, const RandomOptions& options)
        : rng_(seed), options_(options), trees_(seed, options) {}

    LocalSpec make() {
        LocalSpec spec;
        spec.columns = options_.columns;
        spec.rows = options_.rows;
        spec.octahedral = options_.octahedral;
        spec.subdivisions = below(3) == 0 ? 0 : 1 + below(6);
        spec.bin_columns = 1 + below(9);
        spec.bin_rows = 1 + below(5);
        spec.cosine_share = below(2) == 0 ? 0.0f : static_cast<float>(uniform());
        spec.total = std::exp(20.0 * uniform() - 10.0);
        const std::size_t bins = spec.subdivisions > 0 ? 4 * spec.subdivisions * spec.subdivisions + 2
                                                       : std::size_t{spec.bin_columns} * spec.bin_rows;
        add_tree(spec, Box{{0, 0}, {options_.columns, options_.rows}});
        if (below(4) == 0) add_trees_of_bins(spec, bins);
        else add_tiles(spec, bins);
        while (RandomTree::widen_links(spec.tree)) {
        }
        return spec;
    }

private:
    struct Box {
        std::array<std::uint32_t, 2> low, high;
    };

    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_); }
    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(rng_); }

    int add_tree(LocalSpec& spec, const Box& box) {
        const int first = static_cast<int>(spec.tree.curves.size());
        for (CurveSpec curve : trees_.make_within(box.low, box.high).curves) {
            for (int& child : curve.children)
                if (child >= 0) child += first;
            spec.tree.curves.push_back(curve);
        }
        return first;
    }

    float share() { return below(8) == 0 ? 0.0f : static_cast<float>(std::exp(6.0 * uniform() - 4.0)); }

    void add_trees_of_bins(LocalSpec& spec, std::size_t bins) {
        std::vector<std::uint32_t> roots = {0};
        for (int i = 0; i < 4; ++i)
            roots.push_back(
                static_cast<std::uint32_t>(add_tree(spec, Box{{0, 0}, {options_.columns, options_.rows}})));
        for (std::size_t b = 0; b < bins; ++b)
            spec.bins.push_back({b < roots.size() ? roots[b] : below(8) == 0 ? no_root : roots[below(5)], share()});
        for (std::size_t i = bins; i < roots.size(); ++i)
            spec.bins[below(static_cast<std::uint32_t>(bins))].root = 0;
    }

    // Returns what stands for the box in its parent.
    std::uint32_t divide(LocalSpec& spec, const Box& box, int depth) {
        const std::uint32_t axis = box.high[0] - box.low[0] < 2 || (below(2) == 0 && box.high[1] - box.low[1] > 1);
        if (depth == 0 || below(8) == 0 || box.high[axis] - box.low[axis] < 2) {
            boxes_.push_back(box);
            return tile_flag | static_cast<std::uint32_t>(boxes_.size() - 1);
        }
        const std::size_t index = spec.splits.size();
        const std::uint32_t position = box.low[axis] + 1 + below(box.high[axis] - box.low[axis] - 1);
        spec.splits.push_back({axis, position, {}});
        Box lower = box, upper = box;
        lower.high[axis] = upper.low[axis] = position;
        const std::uint32_t first = divide(spec, lower, depth - 1), second = divide(spec, upper, depth - 1);
        spec.splits[index].child[0] = first;
        spec.splits[index].child[1] = second;
        return static_cast<std::uint32_t>(index);
    }

    void add_tiles(LocalSpec& spec, std::size_t bins) {
        boxes_.clear();
        divide(spec, Box{{0, 0}, {options_.columns, options_.rows}}, static_cast<int>(below(8)));
        spec.tiles = static_cast<std::uint32_t>(boxes_.size());
        if (below(6) != 0)
            for (const Box& box : boxes_) spec.tile_curves.push_back(below(3) == 0 ? -1 : add_tree(spec, box));
        add_codebook(spec);
        const std::uint32_t rows = 1 + below(12);
        for (std::uint32_t r = 0; r < rows; ++r) {
            Bytes row;
            for (std::size_t s = 0; s < spec.splits.size(); ++s)
                row.push_back(static_cast<std::uint8_t>(below(6) == 0 ? 255 * below(2) : below(256)));
            spec.codes.push_back(row);
        }
        for (std::size_t b = 0; b < bins; ++b)
            spec.bins.push_back({below(20) == 0 ? no_root : below(rows), share()});
        if (spec.tiles > 1)
            for (std::uint32_t t = 0; t < spec.tiles; ++t)
                if (below(spec.tiles) < 2) add_light(spec, t);
    }

    void add_codebook(LocalSpec& spec) {
        std::set<std::uint16_t> values = {0, 65535};
        while (values.size() < 256) values.insert(static_cast<std::uint16_t>(below(65536)));
        spec.codebook.assign(values.begin(), values.end());
    }

    // Rows give it nothing, at a split anywhere on the way.
    void add_light(LocalSpec& spec, std::uint32_t tile) {
        BrightTileSpec light;
        const double z = 2.0 * uniform() - 1.0, phi = 2.0 * pi * uniform(), sine = std::sqrt(1.0 - z * z);
        light.direction[0] = static_cast<float>(sine * std::cos(phi));
        light.direction[1] = static_cast<float>(sine * std::sin(phi));
        light.direction[2] = static_cast<float>(z);
        light.radius = static_cast<float>(std::exp(-6.0 * uniform()));
        light.share = static_cast<float>(std::exp(4.0 * uniform() - 2.0));
        light.tile = tile;
        light.low = boxes_[tile].low;
        light.high = boxes_[tile].high;
        const Path path = path_to(spec, light);
        const std::vector<Bytes> before = spec.codes;
        for (Bytes& row : spec.codes) {
            const auto& [split, upper] =
                path[below(3) == 0 ? below(static_cast<std::uint32_t>(path.size())) : path.size() - 1];
            row[split] = upper ? 255 : 0;
        }
        spec.bright_tiles.push_back(light);
        if (all_dark(spec)) return; // else this one takes from an earlier light the split that hides it
        spec.bright_tiles.pop_back();
        spec.codes = before;
    }

    using Path = std::vector<std::pair<std::uint32_t, bool>>; // splits, and whether it is their upper part
    static Path path_to(const LocalSpec& spec, const BrightTileSpec& light) {
        Path path;
        for (std::uint32_t node = 0; !(node & tile_flag);) {
            const SplitSpec& split = spec.splits[node];
            const bool upper = light.low[split.axis] >= split.position;
            path.emplace_back(node, upper);
            node = split.child[upper];
        }
        return path;
    }

    static bool all_dark(const LocalSpec& spec) {
        for (const BrightTileSpec& light : spec.bright_tiles) {
            const Path path = path_to(spec, light);
            for (const Bytes& row : spec.codes)
                if (std::none_of(path.begin(), path.end(),
                                 [&](const auto& step) { return row[step.first] == (step.second ? 255 : 0); }))
                    return false;
        }
        return true;
    }

    std::mt19937 rng_;
    RandomOptions options_;
    RandomTree trees_;
    std::vector<Box> boxes_;
};

} // namespace acdf_test
