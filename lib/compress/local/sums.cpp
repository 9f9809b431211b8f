#include "compress/local/sums.h"

#include "compress/store/quantize.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

/// What a group adds to the root of the second moment: more than the sum of its parts, as its tiles are rounded.
double cost_of(const std::vector<double>& parts, const std::vector<std::uint64_t>& steps) {
    const double largest = *std::max_element(parts.begin(), parts.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (steps[i] > 0) sum += parts[i] / largest * (parts[i] / largest) / double(steps[i]);
    return largest * std::sqrt(sum * double(kTileSteps));
}

} // namespace

void encode_sums(const Sums& sums, std::size_t row, const std::vector<double>& parts, std::uint8_t* chunk) {
    std::uint8_t* tile = chunk + sums.tiles_at(row);
    std::fill(tile, tile + kSumTiles * sums.groups(), std::uint8_t{255});
    std::vector<double> costs(sums.groups(), 0.0);
    for (std::size_t g = 0; g < costs.size(); ++g, tile += kSumTiles) {
        const std::size_t end_of_group = std::min((g + 1) * kSumTiles, parts.size());
        const std::vector<double> in(parts.begin() + std::ptrdiff_t(g * kSumTiles),
                                     parts.begin() + std::ptrdiff_t(end_of_group));
        if (!(*std::max_element(in.begin(), in.end()) > 0.0)) continue; // its bytes stay 255: never sampled from
        const std::vector<std::uint64_t> steps = apportion(in, kTileSteps, 1);
        costs[g] = cost_of(in, steps);
        std::uint64_t end = 0;
        for (std::size_t i = 0; i < steps.size(); ++i) tile[i] = static_cast<std::uint8_t>(end += steps[i]);
    }
    std::vector<std::uint64_t> steps(sums.groups(), 0);
    steps.front() = kGroupSteps; // of a bin that sees nothing
    if (*std::max_element(costs.begin(), costs.end()) > 0.0) steps = apportion(costs, kGroupSteps, 1);
    steps.resize(sums.ends(), 0);
    std::uint8_t* group = chunk + sums.groups_at(row);
    std::uint64_t end = 0;
    for (std::size_t g = 0; g < steps.size(); ++g) {
        end += steps[g];
        group[2 * g] = static_cast<std::uint8_t>(end & 0xFF);
        group[2 * g + 1] = static_cast<std::uint8_t>(end >> 8);
    }
}

std::vector<double> decode_sums(const Sums& sums, std::size_t row, const std::uint8_t* chunk) {
    std::vector<double> out(sums.tiles);
    const std::uint8_t *group = chunk + sums.groups_at(row), *tile = chunk + sums.tiles_at(row);
    std::uint32_t before = 0;
    for (std::size_t g = 0; g < sums.groups(); ++g) {
        const std::uint32_t end = group[2 * g] + (std::uint32_t{group[2 * g + 1]} << 8);
        const double part = double(end - before) / double(kGroupSteps);
        before = end;
        std::uint32_t below = 0;
        for (std::size_t t = g * kSumTiles; t < std::min((g + 1) * kSumTiles, sums.tiles); ++t) {
            out[t] = part * (double(tile[t] - below) / double(kTileSteps));
            below = tile[t];
        }
    }
    return out;
}

} // namespace acdf::compress
