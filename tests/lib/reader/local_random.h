// Random local environments whose bins have trees of curves: bins that are dark or not stored, some of the same
// tree, all forms of bins.
#pragma once

#include "tests/lib/reader/local_builder.h"

#include <cmath>

namespace acdf_test {

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
        add_tree(spec);
        add_bins(spec, bins);
        while (RandomTree::widen_links(spec.tree)) {
        }
        return spec;
    }

private:
    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_); }
    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(rng_); }

    int add_tree(LocalSpec& spec) {
        const int first = static_cast<int>(spec.tree.curves.size());
        for (CurveSpec curve : trees_.make_tree().curves) {
            for (int& child : curve.children)
                if (child >= 0) child += first;
            spec.tree.curves.push_back(curve);
        }
        return first;
    }

    float share() { return below(8) == 0 ? 0.0f : static_cast<float>(std::exp(6.0 * uniform() - 4.0)); }

    void add_bins(LocalSpec& spec, std::size_t bins) {
        std::vector<std::uint32_t> roots = {0};
        for (int i = 0; i < 4; ++i) roots.push_back(static_cast<std::uint32_t>(add_tree(spec)));
        for (std::size_t b = 0; b < bins; ++b)
            spec.bins.push_back({b < roots.size() ? roots[b] : below(8) == 0 ? no_root : roots[below(5)], share()});
        for (std::size_t i = bins; i < roots.size(); ++i)
            spec.bins[below(static_cast<std::uint32_t>(bins))].root = 0;
    }

    std::mt19937 rng_;
    RandomOptions options_;
    RandomTree trees_;
};

} // namespace acdf_test
