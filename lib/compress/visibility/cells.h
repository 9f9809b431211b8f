// Cells of visibility: a k-d tree over positions and normals, fine where what arrives differs most.
#pragma once

#include "compress/visibility/light.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// How much an estimate from few points is trusted.
struct VisibilityCaution {
    float floor = 0.02f; ///< the least factor: such a share of the samples goes where the normal alone sends them
    float prior = 1.0f;  ///< times as many points count for what is known of the cells around
};

/// What is known of a part beforehand: which share of it arrives, by so many points.
struct VisibilityPrior {
    float share, points;
};
inline float visible_share(float all, float seen, float points, const VisibilityPrior& prior) {
    constexpr float least = 1e-30f; // where nothing is known
    const float unit = prior.points * all / points + least;
    return (seen + unit * prior.share) / (all + unit);
}
/// What rows are to multiply the light of a part with: the root of the share that arrives, which is best where
/// parts are seen by some of a cell's points and not by others.
inline float factor_of_share(float share, float floor) {
    return floor + (1.0f - floor) * std::sqrt(share < 1.0f ? share : 1.0f);
}
inline float visible_factor(float all, float seen, float points, const VisibilityPrior& prior, float floor) {
    return factor_of_share(visible_share(all, seen, points, prior), floor);
}

/// Cells, best first: each division is the one that lowers most, summed over points, the root of the second moment.
class VisibilityCells {
public:
    static constexpr std::size_t axes = 6;
    using Box = std::array<float, axes>;

    /// At most `cells` cells. `low`, `high`: the box of all. Points and light must outlive this. The same for any
    /// number of threads.
    VisibilityCells(const VisibilityParts& parts, const VisibilityLight& light,
                    const std::vector<VisibilityPoint>& points, const Box& low, const Box& high,
                    std::uint32_t cells);

    std::uint32_t cell_count() const { return cell_count_; }
    /// In preorder, cells numbered in the order of the traversal.
    std::vector<AcdfVisibilitySplit> splits() const;
    /// Cells that follow each other.
    struct Range {
        std::uint32_t begin = 0, end = 0;
    };
    /// At most `count` nodes of the tree that have all cells; the largest are divided first.
    std::vector<std::uint32_t> regions(std::uint32_t count) const;
    /// The cells below a node, and of several both halves.
    const Range& cells(std::uint32_t node) const { return nodes_[node].cells; }
    std::uint32_t half(std::uint32_t node, std::uint32_t k) const { return nodes_[node].first_child + k; }
    /// What the points of each cell of a range are given.
    std::vector<VisibilitySums> sums(const Range& range) const;

private:
    struct Node {
        Box low{}, high{};
        std::uint32_t begin = 0, end = 0; ///< its points
        std::uint32_t first_child = 0, depth = 0, axis = 0;
        Range cells;
        float position = 0.0f;
        double gain = 0.0;
        std::vector<float> factors;
    };
    /// Where a node is divided best.
    struct Division {
        double gain = 0.0;
        std::uint32_t axis = 0;
        float position = 0.0f;
    };
    void consider(Node& node) const;
    Division consider_axis(const Node& node, const VisibilitySums& sums, std::uint32_t stride,
                           std::uint32_t axis) const;
    void divide(std::uint32_t index);
    void number(std::uint32_t node);
    double thinnest(std::uint32_t node, std::uint32_t axis, bool at_low) const;

    const VisibilityParts& parts_;
    const VisibilityLight& light_;
    const std::vector<VisibilityPoint>& points_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_; ///< points, those of a node together
    std::vector<std::uint32_t> walk_;  ///< nodes in preorder
    std::vector<std::uint32_t> number_, node_of_cell_;
    std::uint32_t cell_count_ = 0;
};

} // namespace acdf::compress
