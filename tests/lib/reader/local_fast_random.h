// Random local environments of the fast shape: any splits, sums and grids, dark lines, cells, tiles and groups,
// bright tiles, bins that are dark or not stored, all forms of bins.
#pragma once

#include "tests/lib/reader/local_random.h"

namespace acdf_test {

class RandomFast {
public:
    RandomFast(std::uint32_t seed, const RandomOptions& options) : rng_(seed), options_(options) {}

    LocalSpec make() {
        return make([this](LocalSpec& spec, const Box& all) { divide(spec, all, static_cast<int>(below(9))); });
    }

    /// With so many splits across each axis, in the middles of as many parts; a cell each tile.
    LocalSpec make_cut_evenly(std::uint32_t across0, std::uint32_t across1) {
        return make([&](LocalSpec& spec, const Box& all) {
            cut_evenly(spec, all, {{{0, across0, across0}, {0, across1, across1}}});
        });
    }

private:
    struct Box {
        std::array<std::uint32_t, 2> low, high;
    };

    template <class Divide>
    LocalSpec make(const Divide& divide_all) {
        LocalSpec spec;
        spec.columns = options_.columns;
        spec.rows = options_.rows;
        spec.octahedral = options_.octahedral;
        spec.subdivisions = below(3) == 0 ? 0 : 1 + below(6);
        spec.bin_columns = 1 + below(9);
        spec.bin_rows = 1 + below(5);
        spec.cosine_share = below(2) == 0 ? 0.0f : static_cast<float>(uniform());
        spec.total = std::exp(20.0 * uniform() - 10.0);
        spec.codebook = even_codebook();
        RandomTree trees(static_cast<std::uint32_t>(rng_()), options_);
        spec.tree = trees.make_within({0, 0}, {options_.columns, options_.rows});
        spec.fast.emplace();
        divide_all(spec, {{0, 0}, {options_.columns, options_.rows}});
        spec.tiles = static_cast<std::uint32_t>(boxes_.size());
        for (std::uint32_t t = 0; t < spec.tiles; ++t)
            if (spec.tiles > 1 && below(spec.tiles) < 3) add_light(spec, t);
        const std::uint32_t rows = 1 + below(12);
        for (std::uint32_t r = 0; r < rows; ++r) spec.fast->rows.push_back(row(spec));
        const std::size_t bins = spec.subdivisions > 0 ? 4 * spec.subdivisions * spec.subdivisions + 2
                                                       : std::size_t{spec.bin_columns} * spec.bin_rows;
        for (std::size_t b = 0; b < bins; ++b)
            spec.bins.push_back({below(20) == 0 ? no_root : below(rows), share()});
        while (RandomTree::widen_links(spec.tree)) {
        }
        return spec;
    }

    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_); }
    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(rng_); }
    float share() { return below(8) == 0 ? 0.0f : static_cast<float>(std::exp(6.0 * uniform() - 4.0)); }

    // Splits of an axis, from a number on to before another, of so many that lie in the middles of as many parts.
    struct Cuts {
        std::uint32_t first, end, all;
    };

    // What stands for a box in its parent: a tile, or a split whose halves half(box, whether it is the upper one)
    // adds.
    std::uint32_t add_tile(LocalSpec& spec, const Box& box, std::uint8_t least_shift) {
        boxes_.push_back(box);
        spec.fast->grids.push_back(grid(box, least_shift));
        return tile_flag | static_cast<std::uint32_t>(boxes_.size() - 1);
    }
    template <class Half>
    static std::uint32_t add_split(LocalSpec& spec, const Box& box, std::uint32_t axis, std::uint32_t position,
                                   const Half& half) {
        const std::size_t index = spec.splits.size();
        spec.splits.push_back({axis, position, {}});
        Box lower = box, upper = box;
        lower.high[axis] = upper.low[axis] = position;
        const std::uint32_t first = half(lower, false), second = half(upper, true);
        spec.splits[index].child[0] = first;
        spec.splits[index].child[1] = second;
        return static_cast<std::uint32_t>(index);
    }

    std::uint32_t cut_evenly(LocalSpec& spec, const Box& box, const std::array<Cuts, 2>& cuts) {
        const std::uint32_t axis = cuts[0].first < cuts[0].end ? 0 : 1;
        const Cuts& along = cuts[axis];
        if (along.first == along.end) return add_tile(spec, box, 16);
        const std::uint32_t middle = (along.first + along.end) / 2;
        const std::uint64_t whole = axis == 0 ? spec.columns : spec.rows;
        const auto position = static_cast<std::uint32_t>(whole * (2 * middle + 1) / (2 * along.all));
        return add_split(spec, box, axis, position, [&](const Box& half, bool upper) {
            std::array<Cuts, 2> left = cuts;
            if (upper) left[axis].first = middle + 1;
            else left[axis].end = middle;
            return cut_evenly(spec, half, left);
        });
    }

    std::uint32_t divide(LocalSpec& spec, const Box& box, int depth) {
        const std::uint32_t axis = box.high[0] - box.low[0] < 2 || (below(2) == 0 && box.high[1] - box.low[1] > 1);
        if (depth == 0 || below(12) == 0 || box.high[axis] - box.low[axis] < 2) return add_tile(spec, box, 0);
        const std::uint32_t position = box.low[axis] + 1 + below(box.high[axis] - box.low[axis] - 1);
        return add_split(spec, box, axis, position,
                         [&](const Box& half, bool) { return divide(spec, half, depth - 1); });
    }

    // Ends of `count` parts of some whole, some of which are 0; of those that must be 0 none else.
    std::vector<std::uint32_t> ends(std::size_t count, std::uint32_t whole, const std::vector<bool>& dark = {}) {
        std::vector<std::uint32_t> out(count), at;
        for (std::size_t i = 0; i < count; ++i)
            if (i >= dark.size() || !dark[i]) at.push_back(static_cast<std::uint32_t>(i));
        if (at.empty()) { // nothing may have any: whoever asks gives nothing to the whole
            at.push_back(static_cast<std::uint32_t>(count - 1));
        }
        std::vector<std::uint32_t> steps(count, 0);
        for (std::uint32_t left = whole, n = 0; left > 0; ++n) {
            const std::uint32_t some = n > 60 ? left : 1 + below(left);
            steps[at[below(static_cast<std::uint32_t>(at.size()))]] += some;
            left -= some;
        }
        std::uint32_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) out[i] = sum += steps[i];
        return out;
    }
    Bytes byte_ends(std::size_t count, const std::vector<bool>& dark = {}) {
        const std::vector<std::uint32_t> list = ends(count, 255, dark);
        return Bytes(list.begin(), list.end());
    }

    FastGrid grid(const Box& box, std::uint8_t least_shift) {
        FastGrid out;
        std::uint32_t count[2];
        for (std::size_t a = 0; a < 2; ++a) {
            const std::uint32_t length = box.high[a] - box.low[a];
            std::uint8_t shift = std::max(least_shift, static_cast<std::uint8_t>(below(4)));
            const auto cells = [&] { return (length + (1u << shift) - 1) >> shift; };
            while (cells() > 64) ++shift;
            if (below(9) == 0) shift = 30;
            out.shift[a] = shift;
            count[a] = cells();
        }
        out.lines = byte_ends(count[1]);
        for (std::uint32_t i = 0; i < count[1]; ++i) out.cells.push_back(byte_ends(count[0]));
        return out;
    }

    FastRow row(const LocalSpec& spec) {
        const std::size_t groups = (spec.tiles + 15) / 16;
        std::vector<bool> dark(spec.tiles, false), dark_group(groups, true);
        for (const BrightTileSpec& light : spec.bright_tiles) dark[light.tile] = true;
        for (std::size_t t = 0; t < dark.size(); ++t) dark_group[t / 16] = dark_group[t / 16] && dark[t];
        FastRow out;
        const std::vector<std::uint32_t> list = ends(groups, 32767, dark_group);
        out.groups.assign(list.begin(), list.end());
        for (std::size_t g = 0; g < groups; ++g) {
            const std::size_t end = std::min<std::size_t>(dark.size(), 16 * g + 16);
            const Bytes tiles = byte_ends(
                end - 16 * g, {dark.begin() + std::ptrdiff_t(16 * g), dark.begin() + std::ptrdiff_t(end)});
            out.tiles.insert(out.tiles.end(), tiles.begin(), tiles.end());
        }
        return out;
    }

    void add_light(LocalSpec& spec, std::uint32_t tile) {
        if (spec.bright_tiles.size() + 1 >= spec.tiles) return; // one tile at least is none
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
        spec.bright_tiles.push_back(light);
    }

    std::mt19937 rng_;
    RandomOptions options_;
    std::vector<Box> boxes_;
};

/// A file of the fast shape: on both grids, of few columns and of many.
inline LocalSpec random_fast(std::uint32_t seed) {
    RandomOptions options;
    options.columns = seed % 3 == 0 ? 1 + seed : seed % 3 == 1 ? 64 : 5000;
    options.rows = seed % 4 == 0 ? 33 : 1 + 7 * seed;
    options.long_curves = false;
    options.tilts = false; // of the tree beside the tiles
    options.octahedral = seed % 2 == 1;
    LocalSpec spec = RandomFast(seed, options).make();
    spec.zlib = seed % 5 == 0;
    return spec;
}

} // namespace acdf_test
