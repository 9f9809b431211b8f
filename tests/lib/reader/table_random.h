// Random tables over axes of any number, range and order.
#pragma once

#include "tests/inputs/table_files.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace acdf::test {

using acdf_test::uniform;

inline compress::AxisDescription axis(const std::string& name, std::uint32_t resolution, double low, double high,
                                      AcdfAxisRole role = ACDF_AXIS_SAMPLED) {
    return {name, role, ACDF_MEASURE_LINEAR, resolution, low, high};
}

inline std::vector<std::uint8_t> table_file(const compress::Cascade& cascade,
                                            std::vector<compress::AxisDescription> axes,
                                            std::vector<float> shares = {1.0f}) {
    compress::Description description;
    description.kind = ACDF_KIND_TABLE;
    description.parameterization = ACDF_PARAM_TABLE;
    for (const int i : {0, 1, 2}) description.channel_weights[i] = i == 0 ? 1.0 : 0.0;
    description.axes = std::move(axes);
    description.shares = std::move(shares);
    return compress::store(compress::encode_tree(cascade), description);
}

/// A random tree over `resolution`, some segments tilted or dark.
class RandomTableTree {
public:
    RandomTableTree(std::uint64_t seed, std::vector<std::uint32_t> resolution, std::uint32_t first_axis,
                    bool tilted)
        : random_(seed), resolution_(std::move(resolution)), first_axis_(first_axis), tilted_(tilted) {}

    void add_bin(compress::Cascade& cascade) {
        cascade.roots.push_back(static_cast<std::uint32_t>(cascade.curves.size()));
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;
        for (const std::uint32_t n : resolution_) ranges.emplace_back(0, n);
        add(cascade, ranges, 0);
    }

private:
    using Ranges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    std::int32_t add(compress::Cascade& cascade, const Ranges& ranges, int depth) {
        const auto index = static_cast<std::int32_t>(cascade.curves.size());
        cascade.curves.emplace_back();
        compress::Curve curve;
        const std::size_t axis = random_() % ranges.size();
        const auto [low, high] = ranges[axis];
        curve.axis = first_axis_ + static_cast<std::uint32_t>(axis);
        for (std::uint32_t at = low + 1; at < high; ++at)
            if (random_() % (1 + (high - low) / 3) == 0) curve.knots.push_back(at);
        double sum = 0.0;
        for (std::size_t i = 0; i < curve.segments(); ++i) {
            curve.probability.push_back(i > 0 && random_() % 5 == 0 ? 0.0 : 0.1 + uniform(random_));
            sum += curve.probability.back();
        }
        curve.children.assign(curve.segments(), -1);
        const bool tilted = tilted_ && random_() % 2;
        if (tilted) curve.tilts.assign(curve.segments(), 0.0);
        for (std::size_t i = 0; i < curve.segments(); ++i) {
            curve.probability[i] /= sum;
            Ranges inside = ranges;
            inside[axis] = {i == 0 ? low : curve.knots[i - 1], i + 1 == curve.segments() ? high : curve.knots[i]};
            if (curve.probability[i] > 0.0 && depth < 4 && !tilted && random_() % 3)
                curve.children[i] = add(cascade, inside, depth + 1);
            else if (tilted) curve.tilts[i] = 1.8 * uniform(random_) - 0.9;
        }
        cascade.curves[static_cast<std::size_t>(index)] = std::move(curve);
        return index;
    }

    std::mt19937_64 random_;
    std::vector<std::uint32_t> resolution_;
    std::uint32_t first_axis_;
    bool tilted_;
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

/// The file of a random tree over a space: of steps up to the 1000th of an axis.
inline std::vector<std::uint8_t> random_table(const Space& space, std::uint64_t seed, bool tilted) {
    std::vector<std::uint32_t> resolution;
    for (const auto& a : space.axes) resolution.push_back(std::min(a.resolution, 1000u));
    compress::Cascade cascade;
    RandomTableTree(seed, resolution, 0, tilted).add_bin(cascade);
    return table_file(cascade, space.axes);
}

inline double next_double(std::mt19937_64& random) {
    const double edges[] = {0.0, 1.0, 1.0 - 0x1p-53, 0x1p-60, 0.5};
    return random() % 4 == 0 ? edges[random() % 5] : uniform(random);
}

} // namespace acdf::test
