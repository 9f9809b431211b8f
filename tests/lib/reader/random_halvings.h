// Random trees of halvings: any depth, codes of any number of bits, halves without probability, chains along one
// axis.
#pragma once

#include "tests/lib/reader/random.h"
#include "tests/lib/reader/reference.h"

#include <random>

namespace acdf_test {

class RandomHalvings {
public:
    RandomHalvings(std::uint32_t seed, const RandomOptions& options) : rng_(seed), options_(options) {}

    EnvironmentSpec make() {
        EnvironmentSpec spec;
        spec.columns = options_.columns;
        spec.rows = options_.rows;
        spec.octahedral = options_.octahedral;
        out_ = &spec.halvings;
        out_->code_bits = 2 + below(11);
        const std::uint64_t all = std::uint64_t{1} << 31;
        grow({{{0, spec.columns}, {0, spec.rows}}, {{0, all}, {0, all}}}, 2 * options_.depth);
        return spec;
    }

private:
    using Node = acdf_reference::Halved;

    std::uint32_t below(std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n - 1)(rng_); }
    bool chance(double p) { return std::uniform_real_distribution<double>(0.0, 1.0)(rng_) < p; }

    void grow(const Node& node, int depth) {
        const std::size_t axis = below(2), other = 1 - axis;
        const std::size_t on = can_halve(node, axis) ? axis : other;
        if (depth == 0 || !can_halve(node, on) || (depth < 2 * options_.depth && chance(0.5 * options_.end)))
            return out_->nodes.push_back({});
        const std::uint32_t last = (1u << out_->code_bits) - 1;
        const std::uint64_t wide = node.steps[on][1] - node.steps[on][0];
        std::uint32_t code = options_.dark && chance(0.1) ? (chance(0.5) ? 0 : last) : 1 + below(last - 1);
        if (wide < 2) code = chance(0.5) ? 0 : last;
        out_->nodes.push_back({static_cast<int>(on), code});
        std::uint64_t lower = wide * acdf_reference::halving_share(code, out_->code_bits) >> 31;
        if (code == 0) lower = 0;
        else if (code == last) lower = wide;
        else lower = std::min(std::max<std::uint64_t>(lower, 1), wide - 1);
        Node half[2] = {node, node};
        half[0].steps[on][1] = half[1].steps[on][0] = node.steps[on][0] + lower;
        half[0].box[on][1] = half[1].box[on][0] = (node.box[on][0] + node.box[on][1]) / 2;
        for (const Node& part : half) {
            if (part.steps[on][0] == part.steps[on][1]) out_->nodes.push_back({});
            else grow(part, depth - 1);
        }
    }
    static bool can_halve(const Node& node, std::size_t axis) { return node.box[axis][1] - node.box[axis][0] > 1; }

    std::mt19937 rng_;
    RandomOptions options_;
    HalvingsSpec* out_ = nullptr;
};

/// A file of either structure.
inline EnvironmentSpec random_environment(std::uint32_t seed, const RandomOptions& options) {
    return seed % 2 == 0 ? RandomHalvings(seed, options).make() : RandomTree(seed, options).make();
}

} // namespace acdf_test
