// Sums over boxes of a table, and over the parts that one or two halvings make of them.
#pragma once

#include <acdf/layout.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Steps [low, high) of each axis.
struct TableBox {
    struct Span {
        std::uint32_t low = 0, high = 0;
        std::uint32_t length() const { return high - low; }
        /// Where it is halved.
        std::uint32_t middle() const { return low + (high - low) / 2; }
        bool can_halve() const { return high - low > 1; }
    };
    std::array<Span, ACDF_MAX_AXES> axis;
};

/// The lower or upper half of a box.
TableBox half(TableBox box, std::size_t axis, std::uint32_t upper);

/// Of numbers >= 0, laid out as a table.
struct TableNumbers {
    const std::vector<std::uint32_t>& shape;
    const float* values;
    bool squared; ///< whether squares are summed
};

/// What parts of a box hold.
struct BoxSums {
    double all = 0.0;
    /// Of the halves of both halves of an axis; of a half of one step the upper one has all.
    std::array<std::array<double, 4>, ACDF_MAX_AXES> quarter{};
    /// Of axes a < b: of half i of a and half j of b at 2 i + j.
    std::array<std::array<std::array<double, 4>, ACDF_MAX_AXES>, ACDF_MAX_AXES> pair{};

    double of_half(std::size_t axis, std::uint32_t upper) const {
        return quarter[axis][2 * upper] + quarter[axis][2 * upper + 1];
    }
    /// Half `i` of axis a, of which half `j` of another axis b.
    double of_pair(std::size_t a, std::uint32_t i, std::size_t b, std::uint32_t j) const {
        return a < b ? pair[a][b][2 * i + j] : pair[b][a][2 * j + i];
    }
};

/// Sums of positive numbers alone, none of them a difference: beside a bright spot nothing dim is lost.
void sum_box(const TableNumbers& numbers, const TableBox& box, BoxSums& out);
/// The sum of a box alone.
double sum_in(const TableNumbers& numbers, const TableBox& box);
/// The largest number in a box.
float largest_in(const TableNumbers& numbers, const TableBox& box);

} // namespace acdf::compress
