#include "compress/local/sums.h"

#include "compress/store/quantize.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr std::size_t kGroupsTogether = 16;

std::size_t groups_of(std::size_t tiles) { return (tiles + kSumTiles - 1) / kSumTiles; }
/// Groups of a row, and those that only fill it.
std::size_t ends_of(std::size_t tiles) {
    return (groups_of(tiles) + kGroupsTogether - 1) / kGroupsTogether * kGroupsTogether;
}

/// What a group adds to the root of the second moment: more than the sum of its parts, as its tiles are rounded.
double cost_of(const std::vector<double>& parts, const std::vector<std::uint64_t>& steps) {
    const double largest = *std::max_element(parts.begin(), parts.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (steps[i] > 0) sum += parts[i] / largest * (parts[i] / largest) / double(steps[i]);
    return largest * std::sqrt(sum * double(kTileSteps));
}

} // namespace

std::size_t sums_stride(std::size_t tiles) { return 2 * ends_of(tiles) + kSumTiles * groups_of(tiles); }

std::vector<std::uint8_t> encode_sums(const std::vector<double>& parts) {
    const std::size_t groups = groups_of(parts.size()), ends = ends_of(parts.size());
    std::vector<std::uint8_t> row(sums_stride(parts.size()), 255);
    std::vector<double> costs(groups, 0.0);
    for (std::size_t g = 0; g < groups; ++g) {
        const auto begin = parts.begin() + std::ptrdiff_t(g * kSumTiles);
        const std::vector<double> in(begin,
                                     parts.begin() + std::ptrdiff_t(std::min((g + 1) * kSumTiles, parts.size())));
        if (!(*std::max_element(in.begin(), in.end()) > 0.0)) continue; // its bytes stay 255: never drawn from
        const std::vector<std::uint64_t> steps = apportion(in, kTileSteps, 1);
        costs[g] = cost_of(in, steps);
        std::uint64_t end = 0;
        for (std::size_t i = 0; i < steps.size(); ++i)
            row[2 * ends + g * kSumTiles + i] = static_cast<std::uint8_t>(end += steps[i]);
    }
    std::vector<std::uint64_t> steps(ends, 0);
    if (*std::max_element(costs.begin(), costs.end()) > 0.0) {
        const std::vector<std::uint64_t> lit = apportion(costs, kGroupSteps, 1);
        std::copy(lit.begin(), lit.end(), steps.begin());
    } else {
        steps.front() = kGroupSteps; // of a bin that sees nothing
    }
    std::uint64_t end = 0;
    for (std::size_t g = 0; g < ends; ++g) {
        end += steps[g];
        row[2 * g] = static_cast<std::uint8_t>(end & 0xFF);
        row[2 * g + 1] = static_cast<std::uint8_t>(end >> 8);
    }
    return row;
}

std::vector<double> decode_sums(std::size_t tiles, const std::uint8_t* row) {
    std::vector<double> out(tiles);
    const std::uint8_t* in = row + 2 * ends_of(tiles);
    std::uint32_t before = 0;
    for (std::size_t g = 0; g < groups_of(tiles); ++g) {
        const std::uint32_t end = row[2 * g] + (std::uint32_t{row[2 * g + 1]} << 8);
        const double group = double(end - before) / double(kGroupSteps);
        before = end;
        std::uint32_t below = 0;
        for (std::size_t t = g * kSumTiles; t < std::min((g + 1) * kSumTiles, tiles); ++t) {
            out[t] = group * (double(in[t] - below) / double(kTileSteps));
            below = in[t];
        }
    }
    return out;
}

} // namespace acdf::compress
