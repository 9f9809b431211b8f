// Rows of probabilities as sums over groups of tiles and within them (format/SPEC.md, section 10.6).
#pragma once

#include <acdf/layout.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

constexpr std::size_t kSumTiles = ACDF_FAST_GROUP;     ///< in a group
constexpr std::uint64_t kGroupSteps = ACDF_FAST_WHOLE; ///< that make up a probability of 1: of groups,
constexpr std::uint64_t kTileSteps = 255;              ///< and of tiles in one

/// Chunk SUMS of so many rows.
struct Sums {
    std::size_t rows = 0, tiles = 0;

    std::size_t groups() const { return (tiles + kSumTiles - 1) / kSumTiles; }
    /// Groups that a row has, and those that only fill it.
    std::size_t ends() const { return (groups() + 15) / 16 * 16; }
    std::size_t bytes() const { return rows * (2 * ends() + kSumTiles * groups()); }
    /// Where a row's groups and tiles begin.
    std::size_t groups_at(std::size_t row) const { return row * 2 * ends(); }
    std::size_t tiles_at(std::size_t row) const { return rows * 2 * ends() + row * kSumTiles * groups(); }
};

/// Writes the row that samples tiles in proportion to `parts` as nearly as it can: what is positive stays so.
/// `chunk` has sums.bytes() of them.
void encode_sums(const Sums& sums, std::size_t row, const std::vector<double>& parts, std::uint8_t* chunk);
/// The probabilities that a row gives to tiles.
std::vector<double> decode_sums(const Sums& sums, std::size_t row, const std::uint8_t* chunk);

} // namespace acdf::compress
