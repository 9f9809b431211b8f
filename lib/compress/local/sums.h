// Rows of probabilities as sums over groups of tiles and within them (format/SPEC.md, section 5.11).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

constexpr std::size_t kSumTiles = 32;        ///< in a group
constexpr std::uint64_t kGroupSteps = 32767; ///< that make up a probability of 1: of groups,
constexpr std::uint64_t kTileSteps = 255;    ///< and of tiles in one

/// Bytes of a row.
std::size_t sums_stride(std::size_t tiles);

/// The row that draws tiles in proportion to `parts` as nearly as it can: what is positive stays so.
std::vector<std::uint8_t> encode_sums(const std::vector<double>& parts);
/// The probabilities that a row gives to so many tiles.
std::vector<double> decode_sums(std::size_t tiles, const std::uint8_t* row);

} // namespace acdf::compress
