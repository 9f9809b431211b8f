// The parts of the sphere that visibility cells weigh.
#pragma once

#include "compress/visibility/part_runs.h"

#include <acdf/local.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The tiles of a local environment on one tree of halvings, cut where positions may see one side and not the
/// other. Parts are numbered in the order of the tree: each has the tiles from its first to that of the next.
class VisibilityParts {
public:
    static constexpr std::uint32_t directions = 64; ///< of a part: where its light comes from

    /// Cuts at most at `columns` tiles: so that parts have as much light, and room for an edge, as others.
    /// `local`, which has rows of halvings, must outlive this.
    VisibilityParts(const AcdfLocal& local, std::uint32_t bins, std::uint32_t columns);
    /// Cuts as often between what `cells` see of the parts of `coarse`, and most where they see edges. Orders
    /// columns by the light of these cells. `coarse` may go.
    VisibilityParts(const VisibilityParts& coarse, const std::vector<VisibilitySums>& cells);

    /// Cells x parts: what all parts of `coarse` that a part has tiles of let expect, by what cells see of them.
    std::vector<Ray> expect(const VisibilityParts& coarse, const std::vector<VisibilitySums>& cells) const;

    const AcdfLocal& local() const { return local_; }
    std::size_t count() const { return first_.size() - 1; }
    /// Where tiles are parted. The more light a part has, the fewer columns lead to it: what the sun adds to the
    /// light of a side must not count where it does not shine.
    const std::vector<AcdfColumn>& columns() const { return columns_; }
    /// The part that begins at the tile of each column.
    const std::vector<std::uint32_t>& part_of_column() const { return part_of_column_; }
    std::uint32_t column_count() const { return static_cast<std::uint32_t>(count() - 1); }

    /// visit(first, middle, end) of all columns, in preorder: one parts [first, end) at `middle`.
    template <class Visit>
    void for_each_column(const Visit& visit) const {
        std::size_t column = 0;
        for_each_column(0, count(), column, visit);
    }

    /// What of its light a normal gives to each part, by the stored rows; the sum is its irradiance over `total`.
    void weigh(const AcdfLocalPoint& point, float* out) const;
    /// A tile of a part: its middle, and what of the light it gives in the mean of all normals.
    struct Tile {
        std::array<float, 3> direction{};
        double solid_angle = 0.0, light = 0.0;
    };
    std::vector<Tile> tiles(std::size_t part) const;
    /// The part that a direction lies in; false where it is none.
    bool find(const float direction[3], std::uint32_t& part) const;
    const std::array<float, 3>& direction(std::size_t part, std::uint32_t index) const {
        return directions_[part * directions + index % directions];
    }

private:
    template <class Visit>
    void for_each_column(std::size_t first, std::size_t end, std::size_t& column, const Visit& visit) const {
        if (end - first < 2) return;
        const std::size_t middle = part_of_column_[column++];
        visit(first, middle, end);
        for_each_column(first, middle, column, visit);
        for_each_column(middle, end, column, visit);
    }
    std::vector<double> mean_tiles(std::uint32_t bins) const;
    Spread spread(std::uint32_t tile, double light) const;
    void cut(PartRuns& runs, const std::vector<double>& light, std::uint32_t columns);
    void order(const std::vector<double>& before, std::uint32_t first, std::uint32_t end, std::uint32_t depth);
    void aim();
    std::array<float, 3> place(std::uint32_t tile, double u0, double u1) const;
    double solid_angle(std::uint32_t tile) const;

    const AcdfLocal& local_;
    const AcdfNormalRows& rows_;
    const AcdfGrid grid_;
    std::vector<double> light_;        ///< of the tiles
    std::vector<std::uint32_t> first_; ///< tile of each part, and how many tiles there are
    std::vector<AcdfColumn> columns_;
    std::vector<std::uint32_t> part_of_column_;
    std::vector<std::array<float, 3>> directions_;
};

} // namespace acdf::compress
