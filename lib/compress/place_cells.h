// Cells of places: a k-d tree over positions and normals, fine where what arrives differs most.
#pragma once

#include "compress/place_light.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// What is known of the parts in a cell: sums over its points.
struct PlaceSums {
    std::vector<double> all, seen; ///< one a part
    double points = 0.0;

    explicit PlaceSums(std::size_t parts = 0) : all(parts, 0.0), seen(parts, 0.0) {}
    void add(const PlaceLight& light, std::size_t point, double weight) {
        points += weight;
        for (std::size_t p = 0; p < all.size(); ++p) {
            const float g = light.given[point * all.size() + p];
            all[p] += weight * std::fabs(double{g});
            seen[p] += g > 0.0f ? weight * double{g} : 0.0;
        }
    }
};

/// How much is believed of what few points tell.
struct PlaceCaution {
    double floor = 0.02; ///< the least factor: such a share of the samples goes where the normal alone sends them
    double prior = 1.0;  ///< points that the factors of the cell around count as
};

/// What rows are to multiply the light of a part with: the root of the share that arrives, which is best where
/// parts are seen by some of a cell's points and not by others. `prior`: such a factor, of the cell around it.
double place_factor(double all, double seen, double points, double prior, const PlaceCaution& caution);

/// Cells, best first: each division is the one that lowers most, summed over points, the root of the second moment.
class PlaceCells {
public:
    static constexpr std::size_t axes = 6;
    using Box = std::array<float, axes>;

    /// At most `cells` cells. `low`, `high`: the box of all. Points and light must outlive this. The same for any
    /// number of threads.
    PlaceCells(const PlaceLight& light, const std::vector<PlacePoint>& points, const Box& low, const Box& high,
               std::uint32_t cells);

    std::uint32_t cell_count() const { return cell_count_; }
    /// In preorder, cells numbered in the order of the walk. On both sides of a split as far as `blend` times the
    /// smallest cell that touches it is mixed.
    std::vector<AcdfPlaceSplit> splits(double blend) const;
    /// Of each cell: what is known of the cell that it came from, as place_factor.
    const std::vector<float>& prior(std::uint32_t cell) const {
        return nodes_[nodes_[node_of_cell_[cell]].parent].factors;
    }

private:
    struct Node {
        Box low{}, high{};
        std::uint32_t begin = 0, end = 0; ///< its points
        std::uint32_t first_child = 0, depth = 0, axis = 0, parent = 0;
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
    Division consider_axis(const Node& node, const PlaceSums& sums, std::uint32_t axis) const;
    void divide(std::uint32_t index);
    void number(std::uint32_t node);
    double thinnest(std::uint32_t node, std::uint32_t axis, bool at_low) const;

    const PlaceLight& light_;
    const std::vector<PlacePoint>& points_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_; ///< points, those of a node together
    std::vector<std::uint32_t> walk_;  ///< nodes in preorder
    std::vector<std::uint32_t> number_, node_of_cell_;
    std::uint32_t cell_count_ = 0;
};

} // namespace acdf::compress
