// Many distributions on one grid that share one partition into cells: each is a row of probabilities, and what is
// sampled from is a mixture of rows (acdf/blend.h).
#pragma once

#include "compress/fit/tiles.h"
#include "compress/store/store.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Rows x columns squares; the measure of a square is the product of its row's and its column's. Axis 0 of boxes
/// and splits are the rows, axis 1 the columns.
struct SharedGrid {
    std::vector<double> row_measure, column_measure; ///< > 0

    std::uint32_t rows() const { return static_cast<std::uint32_t>(row_measure.size()); }
    std::uint32_t columns() const { return static_cast<std::uint32_t>(column_measure.size()); }
    std::size_t size() const { return row_measure.size() * column_measure.size(); }
};

/// One of the distributions: row-major squares of the pdf that it is to have, at best, and what it counts.
struct SharedTarget {
    std::vector<float> square;
    double weight = 1.0;
};

/// Divides the grid so that the weighted sum over targets of E[(f/p)^2]^(1/2) = sum over cells of
/// sqrt(measure . integral of f^2) is small. Each division is the one that lowers it most; of more divisions than
/// are wanted those are taken back that gain least.
class SharedPartition {
public:
    /// Divides until there are `cells` cells or nothing is gained. The same for any number of threads.
    SharedPartition(const SharedGrid& grid, const std::vector<SharedTarget>& targets, std::uint32_t cells);
    /// The best tree of at most `cells` cells within that partition.
    TileTree pruned(std::uint32_t cells) const;

private:
    struct Node {
        Box box;
        double cost = 0.0, gain = 0.0;
        std::uint32_t axis = 0, position = 0;
        std::uint32_t first_child = 0; ///< 0: none
        std::uint32_t depth = 1;
    };
    void consider(const SharedGrid& grid, const std::vector<SharedTarget>& targets, Node& node) const;
    std::uint32_t keep(double price, std::vector<bool>& divided) const;
    std::uint32_t emit(const std::vector<bool>& divided, std::uint32_t node, TileTree& tree) const;
    std::vector<Node> nodes_;
};

/// The cell of each square.
std::vector<std::uint32_t> cell_of_squares(const SharedGrid& grid, const TileTree& tree);

/// A distribution that is sampled from as a mixture of rows: q = sum of share[i] row[bin[i]] (Lawrence et al. 2005
/// take the nearest bin; mixtures are what acdf/blend.h samples from).
struct SharedMixture {
    std::vector<double> moment; ///< one a cell: measure . integral of f^2, f normalised
    double weight = 1.0;        ///< in the mean of relative variances
    std::uint32_t bin[4] = {};
    double share[4] = {}; ///< sum 1
    int count = 0;
};

/// Probabilities, one row a bin, one number a cell.
using RowProbabilities = std::vector<std::vector<double>>;

/// Weighted mean over mixtures of sum over cells moment / q: 1 plus the mean relative variance.
double second_moment(const RowProbabilities& rows, const std::vector<SharedMixture>& mixtures);

/// Lowers second_moment, which is convex in the rows, step by step. A probability that is positive stays so.
void optimise_rows(RowProbabilities& rows, const std::vector<SharedMixture>& mixtures, int steps);

/// 256 probabilities out of 65535, p = x^2 / (x^2 + (1 - x)^2) with x = code / 255: steps of a few per cent at the
/// ends and in the middle alike.
std::vector<std::uint16_t> row_codebook();
/// The code nearest to the probability lower / (lower + upper). Neither part vanishes unless it is 0.
std::uint8_t row_code(double lower, double upper);

/// The splits as they are stored: `place(split)` is AcdfSplit::place.
template <class Place>
std::vector<AcdfSplit> stored_splits(const TileTree& tree, const Place& place) {
    std::vector<AcdfSplit> out;
    for (const TileTree::Split& split : tree.splits) {
        AcdfSplit stored = {place(split), {}};
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t child = split.child[k], number = child & ~TileTree::tile;
            stored.child[k] = static_cast<std::uint16_t>(number | (child & TileTree::tile ? ACDF_TILE_FLAG : 0u));
        }
        out.push_back(stored);
    }
    return out;
}

/// The bytes of a row, one a split, and the probabilities that they give to the cells.
std::vector<std::uint8_t> encode_row(const TileTree& tree, const std::vector<double>& probability);
std::vector<double> decode_row(const TileTree& tree, const std::vector<std::uint16_t>& codebook,
                               const std::uint8_t* row);

} // namespace acdf::compress
