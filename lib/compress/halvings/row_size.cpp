#include "compress/halvings/row_size.h"

#include "compress/halvings/code_bits.h"
#include "compress/halvings/rows.h"

#include <acdf/layout.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace acdf::compress {
namespace {

constexpr double kLeastTop = 0.2;     // of the bytes, for codes of rows
constexpr std::size_t kSampled = 8;   // one in so many tiles is divided to see what that gains
constexpr std::size_t kSmoothed = 50; // halvings at the top over which gains are averaged

std::size_t words(std::size_t bits) { return (bits + 31) / 32 * 4; }

std::size_t whole_chunk(std::size_t bytes) {
    return (bytes + ACDF_ALIGNMENT - 1) / ACDF_ALIGNMENT * ACDF_ALIGNMENT;
}

/// What halvings gain in the order in which they are made, as it falls.
std::vector<double> falling_gains(const HalvedGrowth& growth, std::size_t roots, std::size_t smoothed) {
    std::vector<double> gains;
    double sum = 0.0, least = std::numeric_limits<double>::infinity();
    const std::size_t first = growth.nodes().size() - 2 * (growth.leaves() - roots);
    std::vector<float> gain_of(growth.leaves() - roots);
    for (const HalvedNode& node : growth.nodes())
        if (node.lower >= first && node.lower != 0) gain_of[(node.lower - first) / 2] = node.gain;
    for (std::size_t i = 0; i < gain_of.size(); ++i) {
        sum += double{gain_of[i]};
        if (i >= smoothed) sum -= double{gain_of[i - smoothed]};
        least = std::min(least, sum / double(std::min(i + 1, smoothed)));
        gains.push_back(least);
    }
    return gains;
}

std::size_t above(const std::vector<double>& falling, double least) {
    return static_cast<std::size_t>(std::upper_bound(falling.begin(), falling.end(), least, std::greater<>()) -
                                    falling.begin());
}

} // namespace

std::size_t row_bytes(std::size_t halvings, std::size_t codes, std::uint32_t code_bits) {
    return whole_chunk(halvings_bytes(halvings + 1, kAxisBits, kSharedCodeBits)) +
           whole_chunk(sizeof(AcdfNormalsHeader) + words(halvings) + words(codes * code_bits));
}

std::size_t halvings_within(std::uint64_t bytes, std::size_t codes, std::uint32_t code_bits) {
    std::size_t low = 0, high = std::min<std::uint64_t>(bytes, ACDF_MOST_HALVINGS);
    while (low < high) {
        const std::size_t middle = low + (high - low + 1) / 2;
        if (row_bytes(middle, codes, code_bits) <= bytes) low = middle;
        else high = middle - 1;
    }
    return low;
}

bool are_dense(std::size_t rows, std::size_t top, std::size_t codes, std::uint32_t code_bits) {
    return rows * top <= ACDF_MOST_NORMAL_RATIO * (sizeof(AcdfNormalsHeader) + codes * code_bits / 8);
}

double halvings_for(double bytes, double row_bits) {
    return std::min(bytes * 8.0 / (row_bits + kSharedBits - 8.0), double{ACDF_MOST_HALVINGS});
}

std::vector<HalvedNode> first_halvings(const std::vector<HalvedNode>& nodes, std::size_t halvings) {
    std::vector<HalvedNode> out(nodes.begin(), nodes.begin() + std::ptrdiff_t(2 * halvings + 1));
    for (HalvedNode& node : out)
        if (node.lower >= out.size()) node.lower = 0;
    return out;
}

std::size_t choose_top(const HalvedGrowth& top, const HalvedCosts& below, double unit, double row_bits,
                       double bytes) {
    const std::size_t all = top.leaves() - 1;
    const auto within = [&](double part) {
        return std::min(static_cast<std::size_t>(halvings_for(part * bytes, row_bits)), all);
    };
    std::vector<HalvedNode> some;
    std::size_t tiles = 0;
    for (const HalvedNode& node : first_halvings(top.nodes(), within(0.7)))
        if (node.lower == 0 && tiles++ % kSampled == 0) some.push_back(node);
    const std::size_t roots = some.size();
    HalvedGrowth shared({{0, roots + static_cast<std::size_t>(halvings_for(bytes, 8.0) / kSampled)}});
    shared.run_below(std::move(some), below, Loop(false), {});
    const std::vector<double> of_top = falling_gains(top, 1, kSmoothed),
                              of_shared = falling_gains(shared, roots, 1);
    double low = 1e-15, high = 1e-1;
    std::size_t best = 0;
    for (int step = 0; step < 60; ++step) {
        const double price = std::sqrt(low * high);
        const std::size_t halvings = std::min(above(of_top, price * row_bits), all);
        const std::size_t others = kSampled * above(of_shared, price * kSharedBits * unit);
        const double size = (double(halvings) * (row_bits + 3.0) + double(others) * kSharedBits) / 8.0;
        if (size > bytes) low = price;
        else high = price, best = halvings;
    }
    return std::max(best, within(kLeastTop));
}

} // namespace acdf::compress
