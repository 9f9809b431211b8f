// Pruning a partition at a price per byte, and turning what is left into curves.
#pragma once

#include "compress/cascade.h"
#include "compress/fit/partition.h"
#include "compress/store/store.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

// What a division is charged, in bytes: about what encode_tree makes of it.
constexpr double kKnotBytes = 3.0;
constexpr double kCurveBytes = 2.0; // header, and the link that leads to it
constexpr double kLeastBytes = 2.5; // of any division: what could gain less at a price need not be grown for it

/// What pruning looks at of a part, close together: it goes through all parts for every price.
struct PruneNode {
    double cost, share; ///< see Moments
    std::uint32_t first_child;
    std::uint16_t children;
    std::int8_t split; ///< Part::whole where there are no children
    bool heavy;        ///< a cell would hold weights above the bound
};
using PruneNodes = std::vector<PruneNode>;

PruneNodes prune_nodes(const std::vector<Part>& parts, double heaviest, const Filling* filling = nullptr);

/// For each part but the first, where it begins on the axis along which the part above it is divided.
std::vector<std::uint32_t> begins_of(const std::vector<Part>& parts);

/// A partition pruned at one price.
struct Pruned {
    std::vector<std::uint8_t> divided; ///< one a part: whether its division stays
    std::vector<std::uint32_t> cells;  ///< below each part
};

/// Keeps a division where it lowers the cost by more than `price` times its bytes, or where a cell would hold
/// weights above `heaviest` without it.
Pruned prune(const PruneNodes& nodes, double price);
Pruned prune(const std::vector<Part>& parts, double price, double heaviest);

/// For each part, whether prune() could keep its division at a price from `price` on: divisions that a lower cost
/// could pay if the curves below them took no bytes of their own, and those of parts with weights above `heaviest`.
/// Then a division that does not pay pays at no higher price either.
std::vector<bool> may_pay(const std::vector<Part>& parts, double price, double heaviest);

/// The trees of all bins, and what belongs to their cells.
struct Flattened {
    Cascade cascade;
    std::vector<std::vector<float>> weights; ///< for each curve one a segment: Moments::weight where it ends
    std::vector<double> cost;                ///< one a bin: the sum of the shares of its cells
};

/// Appends the curves of a pruned partition as one bin. Divisions along the same axis become one curve. `nodes`:
/// prune_nodes of its parts, whatever the bound on weights.
void flatten(const Partition& partition, const PruneNodes& nodes, const Pruned& pruned, Flattened& out);
void flatten(const Partition& partition, const Pruned& pruned, Flattened& out);

/// Appends a bin of one cell, for a grid without energy; `axis` is any sampled axis of the file.
void flatten_nothing(std::uint32_t axis, Flattened& out);

/// What the rounding of probabilities makes of a bin.
struct StoredQuality {
    double excess = 1.0;     ///< the sum over cells of p^2/q for probabilities p and stored ones q; at least 1
    double max_weight = 0.0; ///< the largest f/q over its mean
};
StoredQuality stored_quality(const Flattened& flat, std::size_t bin, const EncodedTree& tree);

} // namespace acdf::compress
