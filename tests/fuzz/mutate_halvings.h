// Mutations of chunk HALV that keep its bits in order: most trees of theirs are accepted.
#pragma once

#include "tests/fuzz/fuzz_random.h"
#include "tests/lib/reader/builder.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf_test {

/// Bits as BitSpec writes them; zeros behind the end.
class BitReader {
public:
    BitReader(const Bytes& bytes, std::size_t begin) : bytes_(bytes), at_(8 * begin) {}
    bool ended() const { return at_ >= 8 * bytes_.size(); }
    std::uint32_t take(std::uint32_t count) {
        std::uint32_t value = 0;
        for (std::uint32_t i = 0; i < count; ++i, ++at_)
            if (!ended()) value |= std::uint32_t{static_cast<std::uint32_t>(bytes_[at_ / 8]) >> at_ % 8 & 1u} << i;
        return value;
    }

private:
    const Bytes& bytes_;
    std::size_t at_;
};

/// What a chunk says, as far as it says a tree.
inline HalvingsSpec taken_apart_halvings(const Bytes& chunk) {
    constexpr std::size_t header = 16;
    HalvingsSpec spec;
    if (chunk.size() < header) return spec;
    spec.code_bits = std::min<std::uint32_t>(std::max<std::uint32_t>(chunk[4], 2), 12);
    BitReader structure(chunk, header);
    std::size_t open = 1, halvings = 0;
    while (open > 0 && !structure.ended()) {
        HalvingSpec node;
        if (structure.take(1) != 0) node.axis = static_cast<int>(structure.take(spec.axis_bits));
        open += node.axis < 0 ? std::size_t(-1) : 1;
        halvings += node.axis >= 0;
        spec.nodes.push_back(node);
    }
    for (; open > 0; --open) spec.nodes.push_back({});
    const std::size_t words = (halvings * (2 + spec.axis_bits) + 1 + 31) / 32;
    BitReader codes(chunk, header + 4 * words);
    for (HalvingSpec& node : spec.nodes)
        if (node.axis >= 0) node.code = codes.take(spec.code_bits);
    return spec;
}

/// The node behind the subtree of `at`.
inline std::size_t subtree_end(const std::vector<HalvingSpec>& nodes, std::size_t at) {
    for (std::size_t open = 1; open > 0; ++at) open += nodes[at].axis < 0 ? std::size_t(-1) : 1;
    return at;
}

/// Another code, axis, number of bits, a leaf that is halved, or a subtree that is a leaf or stands twice.
inline Bytes mutated_halvings(const Bytes& chunk, FuzzRandom& random) {
    HalvingsSpec spec = taken_apart_halvings(chunk);
    if (spec.nodes.empty()) spec.nodes.push_back({});
    for (std::uint32_t times = 1 + random.below(3); times > 0; --times) {
        const std::uint32_t last = (1u << spec.code_bits) - 1;
        const std::size_t at = random.below(static_cast<std::uint32_t>(spec.nodes.size()));
        const auto node = spec.nodes.begin() + static_cast<std::ptrdiff_t>(at);
        const auto end = spec.nodes.begin() + static_cast<std::ptrdiff_t>(subtree_end(spec.nodes, at));
        const HalvingSpec halved{static_cast<int>(random.below(2)), random.below(last + 1)};
        switch (random.below(6)) {
        case 0:
            node->code = random.below(4) == 0 ? (random.below(2) == 0 ? 0 : last) : random.below(last + 1);
            break;
        case 1:
            if (node->axis >= 0) node->axis = 1 - node->axis;
            break;
        case 2:
            spec.code_bits = 2 + random.below(11);
            for (HalvingSpec& any : spec.nodes) any.code &= (1u << spec.code_bits) - 1;
            break;
        case 3: // a leaf, halved
            if (node->axis < 0) {
                *node = halved;
                spec.nodes.insert(node + 1, 2, HalvingSpec{});
            }
            break;
        case 4: // a subtree becomes a leaf
            spec.nodes.erase(node + 1, end);
            *node = {};
            break;
        default: { // a subtree stands in both halves of a new node
            const std::vector<HalvingSpec> subtree(node, end);
            if (subtree.size() > 64) break;
            spec.nodes.insert(end, subtree.begin(), subtree.end());
            spec.nodes.insert(spec.nodes.begin() + static_cast<std::ptrdiff_t>(at), halved);
        }
        }
    }
    return spec.encode();
}

} // namespace acdf_test
