// The size of a tree before it is made: what the search for a price asks again and again.
#pragma once

#include "compress/curve_layout.h"
#include "compress/outline.h"
#include "compress/quantize.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// Bytes that encode_tree makes of pruned partitions, one root each, without making them. What one price leaves as
/// it was at the last is not looked at again.
class TreeSize {
public:
    /// `most_ratio`: see quantize.
    explicit TreeSize(std::size_t bins, double most_ratio = std::numeric_limits<double>::infinity())
        : bins_(bins), most_ratio_(most_ratio) {}

    /// What the bytes of a tree are made from: equal ones are of equal trees, as long as partitions stay as they
    /// are.
    struct Tree {
        std::vector<std::vector<std::uint8_t>> divided; ///< for each bin
        std::vector<std::uint8_t> widths;               ///< of probabilities, one a curve: their codes

        bool operator==(const Tree& other) const { return widths == other.widths && divided == other.divided; }
    };

    /// Goes on to the next price. Adds a bin: parts and how they are pruned, both of which must stay until
    /// finish(). A bin without parts has nothing to sample.
    void begin();
    void add(const std::vector<Part>* parts, const Pruned& pruned);
    /// The size in bytes at `price` a byte, as encode_tree takes it.
    std::uint64_t finish(double price);

    const Tree& tree() const { return tree_; }
    /// The partitions have changed: nothing of before counts.
    void forget();

private:
    /// What rounding to each width does to a curve, once it has been asked for.
    struct Roundings {
        Rounding of[3];
        bool known[3] = {};
    };
    struct Bin {
        std::vector<std::uint8_t> divided; ///< at the last price
        std::vector<std::uint32_t> slot;   ///< one a part: its curve's roundings, or none
        std::vector<Roundings> roundings;
    };
    struct Added {
        const std::vector<Part>* parts;
        std::vector<double> cost;
        Outline outline;
        std::size_t first_curve;
    };

    void drop_changed(const std::vector<Part>& parts, const Pruned& pruned, Bin& bin) const;
    CurveShape shape_of(const Added& added, const Outline::Curve& curve, double reach, double price, Bin& bin);
    std::uint64_t placed(std::vector<CurveShape>& shapes) const;

    std::vector<Bin> bins_;
    double most_ratio_;
    std::vector<Added> added_;
    std::vector<double> probability_; ///< of the curve that is looked at
    std::size_t curves_ = 0;
    Tree tree_;
};

} // namespace acdf::compress
