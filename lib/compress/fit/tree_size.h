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

/// What of a curve its bytes depend on but for the widths of its numbers.
struct SizedCurve {
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    CurveShape shape;
    std::uint32_t part = 0;          ///< whose divisions it holds
    std::uint32_t lit = 0;           ///< probabilities above 0
    std::uint32_t first_segment = 0; ///< its first probability
    std::uint32_t parent = none;
    double of_parent = 1.0;          ///< probability of its segment there
    std::uint32_t last_child = none; ///< the curve below it that lies farthest away
};

/// The curves of a pruned partition, in the order in which they are stored.
struct SizedCurves {
    std::vector<SizedCurve> curves;
    std::vector<double> probability; ///< of all segments

    std::vector<double> probabilities(const SizedCurve& curve) const {
        const auto first = probability.begin() + std::ptrdiff_t(curve.first_segment);
        return {first, first + std::ptrdiff_t(curve.shape.segments)};
    }
};

/// `begins`: begins_of the parts of `nodes`, of which there are some.
SizedCurves sized_curves(const PruneNodes& nodes, const std::vector<std::uint32_t>& begins, const Pruned& pruned);

/// What rounding to each width does to a curve, once it has been asked for.
struct KnownRoundings {
    Rounding of[3];
    bool known[3] = {};

    const Rounding& to(std::uint32_t code, const SizedCurves& all, const SizedCurve& curve) {
        if (!known[code]) of[code] = rounding_to(all.probabilities(curve), code);
        known[code] = true;
        return of[code];
    }
};

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

    std::shared_ptr<const SizedTree::Curves> curves_of(const std::vector<PrunedBin>& bins);
    std::uint32_t add_roundings();

    std::vector<Bin> bins_;
    std::vector<KnownRoundings> roundings_; ///< of all curves since forget()
    double most_ratio_;
};

} // namespace acdf::compress
