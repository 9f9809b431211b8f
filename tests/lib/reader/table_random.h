// Random tables over axes of any number, range and order.
#pragma once

#include "compress/halvings/codes.h"
#include "compress/tables/fit.h"
#include "tests/inputs/table_files.h"

#include <acdf/halvings.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace acdf::test {

using acdf_test::uniform;
using compress::TableTrees;

inline compress::AxisDescription axis(const std::string& name, std::uint32_t resolution, double low, double high,
                                      AcdfAxisRole role = ACDF_AXIS_SAMPLED) {
    return {name, role, ACDF_MEASURE_LINEAR, resolution, low, high};
}

inline std::vector<std::uint8_t> table_file(const TableTrees& trees, std::vector<compress::AxisDescription> axes,
                                            std::vector<float> shares = {1.0f}) {
    compress::Description description;
    description.kind = ACDF_KIND_TABLE;
    description.parameterization = ACDF_PARAM_TABLE;
    for (const int i : {0, 1, 2}) description.channel_weights[i] = i == 0 ? 1.0 : 0.0;
    description.axes = std::move(axes);
    description.shares = std::move(shares);
    return compress::store(trees.halvings, trees.roots, description);
}

/// Random trees over `resolution`, some of whose nodes are dark.
class RandomTableTrees {
public:
    RandomTableTrees(std::uint64_t seed, std::vector<std::uint32_t> resolution, std::uint32_t code_bits = 8)
        : random_(seed), resolution_(std::move(resolution)) {
        trees.halvings.code_bits = code_bits;
        trees.halvings.axis_bits = compress::axis_bits_for(resolution_.size());
    }

    TableTrees trees;

    void add_bin() {
        const auto first = static_cast<std::uint32_t>(trees.halvings.codes.size());
        std::vector<AcdfSpan> box;
        for (const std::uint32_t n : resolution_) box.push_back({{0, n}});
        add(box, std::vector<AcdfSpan>(resolution_.size(), AcdfSpan{{0, ACDF_STEPS}}), 0);
        trees.roots.push_back(trees.halvings.codes.size() > first ? first : std::uint32_t{ACDF_NO_ROOT});
    }
    /// A bin without energy.
    void add_none() { trees.roots.push_back(ACDF_NO_ROOT); }

private:
    void add(std::vector<AcdfSpan> box, std::vector<AcdfSpan> steps, int depth) {
        const std::size_t axis = random_() % box.size();
        const std::uint32_t wide = steps[axis].end[1] - steps[axis].end[0];
        if (box[axis].end[1] - box[axis].end[0] < 2 || wide < 2 || depth > 10 || random_() % 8 == 0)
            return trees.halvings.axes.push_back(-1);
        const std::uint32_t bits = trees.halvings.code_bits, last = (1u << bits) - 1;
        const auto code = random_() % 8 == 0 ? (random_() % 2 ? last : 0u)
                                             : 1u + static_cast<std::uint32_t>(random_() % (last - 1));
        trees.halvings.axes.push_back(static_cast<std::int8_t>(axis));
        trees.halvings.codes.push_back(static_cast<std::uint16_t>(code));
        const std::uint32_t middle = acdf_span_middle(&box[axis]);
        const std::uint32_t threshold =
            acdf_halving_threshold(&steps[axis], code, bits, acdf_halving_share(code, bits));
        for (std::uint32_t upper = 0; upper < 2; ++upper) {
            std::vector<AcdfSpan> half_box = box, half_steps = steps;
            half_box[axis].end[1 - upper] = middle;
            half_steps[axis].end[1 - upper] = threshold;
            const bool dark = half_steps[axis].end[0] == half_steps[axis].end[1];
            if (dark) trees.halvings.axes.push_back(-1);
            else add(half_box, half_steps, depth + 1);
        }
    }

    std::mt19937_64 random_;
    std::vector<std::uint32_t> resolution_;
};

struct Space {
    const char* name;
    std::vector<compress::AxisDescription> axes;
};

inline std::vector<Space> spaces() {
    std::vector<compress::AxisDescription> eight;
    for (int i = 0; i < 8; ++i) eight.push_back(axis("a" + std::to_string(i), 5, 0.0, 1.0 + i));
    return {{"one", {axis("x", 37, 0.0, 37.0)}},
            {"reversed", {axis("x", 12, 3.0, -5.0), axis("y", 9, -0.1, -0.7)}},
            {"far", {axis("x", 16, 1e6, 1e6 + 1e-4), axis("y", 7, -1.0, -1.0 + 0x1p-36)}},
            {"large", {axis("x", 2147483647, 0.0, 1e30), axis("y", 1000000, -1e-20, 1e-20)}},
            {"three", {axis("x", 20, -1.0, 1.0), axis("y", 30, 0.0, 7.3), axis("z", 11, 2.0, 2.5)}},
            {"eight", eight}};
}

/// The file of a random tree over a space.
inline std::vector<std::uint8_t> random_table(const Space& space, std::uint64_t seed) {
    std::vector<std::uint32_t> resolution;
    for (const auto& a : space.axes) resolution.push_back(a.resolution);
    RandomTableTrees random(seed, resolution, 2 + static_cast<std::uint32_t>(seed % 11));
    random.add_bin();
    return table_file(random.trees, space.axes);
}

inline double next_double(std::mt19937_64& random) {
    const double edges[] = {0.0, 1.0, 1.0 - 0x1p-53, 0x1p-60, 0.5};
    return random() % 4 == 0 ? edges[random() % 5] : uniform(random);
}

} // namespace acdf::test
