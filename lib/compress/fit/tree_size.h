// The size of a tree before it is made: what the search for a price asks again and again.
#pragma once

#include "compress/fit/outline.h"
#include "compress/store/curve_layout.h"
#include "compress/store/quantize.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace acdf::compress {

/// A bin that is pruned.
struct PrunedBin {
    const PruneNodes* nodes;                  ///< empty: it has nothing to sample
    const std::vector<std::uint32_t>* begins; ///< begins_of the parts of `nodes`
    const Pruned* pruned;
};

/// What encode_tree would make of pruned partitions, one root each, without making it.
struct SizedTree {
    /// The curves of all bins, whatever widths their numbers have.
    struct Curves;

    std::shared_ptr<const Curves> curves;
    std::vector<std::uint8_t> widths; ///< of probabilities, one a curve: their codes

    /// Trees of the same partitions are the same then, byte for byte.
    bool operator==(const SizedTree& other) const { return curves == other.curves && widths == other.widths; }
};

/// Sizes trees of the same partitions at one price after the other. What a price leaves as it was is not looked at
/// again.
class TreeSizer {
public:
    /// `most_ratio`: see quantize.
    explicit TreeSizer(std::size_t bins, double most_ratio = std::numeric_limits<double>::infinity());
    ~TreeSizer();

    /// At `price` a byte, as encode_tree takes it. Curves are taken from one of `known` that is divided alike.
    SizedTree tree(const std::vector<PrunedBin>& bins, double price, const std::vector<const SizedTree*>& known);
    std::uint64_t bytes(const SizedTree& tree) const;
    /// The partitions have changed: nothing of before counts, and no tree of before may be known to tree().
    void forget();

private:
    struct Bin;
    struct Roundings;

    std::shared_ptr<const SizedTree::Curves> curves_of(const std::vector<PrunedBin>& bins);
    std::uint32_t add_roundings();

    std::vector<Bin> bins_;
    std::vector<Roundings> roundings_; ///< of all curves since forget()
    double most_ratio_;
};

} // namespace acdf::compress
