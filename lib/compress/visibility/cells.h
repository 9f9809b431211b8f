// Cells of visibility: a k-d tree over positions and normals, fine where what arrives differs most.
#pragma once

#include "compress/visibility/light.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// What is known of the parts in a cell: sums over its points.
struct VisibilitySums {
    std::vector<float> all, seen; ///< one a part
    float points = 0.0f;

    explicit VisibilitySums(std::size_t parts = 0) : all(parts, 0.0f), seen(parts, 0.0f) {}
    /// One point's light, as VisibilityLight::given has it.
    void add(const float* given, float weight) {
        const std::size_t count = all.size();
        float *const a = all.data(), *const s = seen.data();
        points += weight;
        for (std::size_t p = 0; p < count; ++p) a[p] += weight * std::fabs(given[p]);
        for (std::size_t p = 0; p < count; ++p) s[p] += weight * (given[p] > 0.0f ? given[p] : 0.0f);
    }
};

/// How much an estimate from few points is trusted.
struct VisibilityCaution {
    float floor = 0.02f; ///< the least factor: such a share of the samples goes where the normal alone sends them
    float prior = 1.0f;  ///< points that the factors of the cell around count as
};

/// What rows are to multiply the light of a part with: the root of the share that arrives, which is best where
/// parts are seen by some of a cell's points and not by others. `prior`: such a factor, of the cell around it.
inline float visible_factor(float all, float seen, float points, float prior, const VisibilityCaution& caution) {
    constexpr float least = 1e-30f; // where nothing is known
    const float unit = caution.prior * all / points + least, share = (seen + unit * prior * prior) / (all + unit);
    return caution.floor + (1.0f - caution.floor) * std::sqrt(share < 1.0f ? share : 1.0f);
}

/// Cells, best first: each division is the one that lowers most, summed over points, the root of the second moment.
class VisibilityCells {
public:
    static constexpr std::size_t axes = 6;
    using Box = std::array<float, axes>;

    /// At most `cells` cells. `low`, `high`: the box of all. Points and light must outlive this. The same for any
    /// number of threads.
    VisibilityCells(const VisibilityLight& light, const std::vector<VisibilityPoint>& points, const Box& low,
                    const Box& high, std::uint32_t cells);

    std::uint32_t cell_count() const { return cell_count_; }
    /// In preorder, cells numbered in the order of the traversal.
    std::vector<AcdfVisibilitySplit> splits() const;
    /// Cells that follow each other.
    struct Range {
        std::uint32_t begin = 0, end = 0;
    };
    /// At most `count` ranges of all cells, each below a node of the tree; the largest are divided first.
    std::vector<Range> regions(std::uint32_t count) const;
    /// The cells below the one that a cell was divided from.
    Range around(std::uint32_t cell) const { return nodes_[nodes_[node_of_cell_[cell]].parent].cells; }
    /// Of each part, summed over the cells of a range.
    struct Parts {
        std::vector<double> loss;  ///< by how much its root of the second moment is larger than it were if all rays
                                   ///< of a cell either arrived or did not
        std::vector<double> light; ///< what it would give to the points
    };
    Parts parts(const Range& range) const;

private:
    struct Node {
        Box low{}, high{};
        std::uint32_t begin = 0, end = 0; ///< its points
        std::uint32_t first_child = 0, depth = 0, axis = 0, parent = 0;
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

    const VisibilityLight& light_;
    const std::vector<VisibilityPoint>& points_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_; ///< points, those of a node together
    std::vector<std::uint32_t> walk_;  ///< nodes in preorder
    std::vector<std::uint32_t> number_, node_of_cell_;
    std::uint32_t cell_count_ = 0;
};

} // namespace acdf::compress
