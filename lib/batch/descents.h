// Descents of a tree of halvings, many at once. Each goes down by a node in turn, so that no load waits for
// another, and no branch depends on where it leads: the loop over single calls guesses half of those wrong.
#pragma once

#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace acdf::batch {

constexpr std::size_t kBlock = 128; // calls at once; what is kept of them stays in the first cache

// What a single call sampled.
inline void put_sample(const AcdfDirectionSample& sample, float direction[3], float* pdf) {
    std::memcpy(direction, sample.direction, sizeof sample.direction);
    *pdf = sample.pdf;
}

struct Descents {
    alignas(64) std::uint32_t target[kBlock][2]; // steps of random numbers, or grid steps
    alignas(64) AcdfSpan steps[kBlock][2], box[kBlock][2];

    // Begins one at a node, or at a leaf, of which `steps` and `box` are set.
    void begin(std::size_t lane, std::uint32_t node) {
        open_[count_] = {static_cast<std::uint32_t>(lane), node};
        count_ += node != ACDF_LEAF;
    }

    // Ends all that were begun: `steps` and `box` become those of leaves, as acdf_halvings_sample leaves them.
    void sample(const AcdfHalving* nodes) { descend<false>(nodes); }
    // The same as acdf_halvings_find does.
    void find(const AcdfHalving* nodes) { descend<true>(nodes); }

private:
    template <bool by_position>
    void descend(const AcdfHalving* nodes) {
        while (count_ > 0) {
            std::size_t left = 0;
            for (std::size_t k = 0; k < count_; ++k) {
                const Open at = open_[k];
                const AcdfHalving node = nodes[at.node];
                const std::uint32_t axis = node.link & 1u;
                AcdfSpan& across = box[at.lane][axis];
                const std::uint32_t middle = acdf_span_middle(&across);
                const std::uint32_t upper = target[at.lane][axis] >= (by_position ? middle : node.threshold);
                across.end[1u - upper] = middle;
                steps[at.lane][axis].end[1u - upper] = node.threshold;
                // Compilers would make a branch of a condition.
                open_[left] = {at.lane, at.node + 1u + (((node.link >> 5) - 1u) & (0u - upper))};
                left += ~(node.link >> (3u + upper)) & 1u;
            }
            count_ = left;
        }
    }

    struct Open {
        std::uint32_t lane, node;
    };
    Open open_[kBlock];
    std::size_t count_ = 0;
};

} // namespace acdf::batch
