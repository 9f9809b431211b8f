// Many distributions on one grid that share one partition into cells: each is a row of probabilities, and what is
// sampled from is a mixture of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Rows x columns squares; the measure of a square is the product of its row's and its column's.
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

/// A distribution that is sampled from as a mixture of rows: q = sum of share[i] row[bin[i]] (Lawrence et al. 2005
/// take the nearest bin).
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

} // namespace acdf::compress
