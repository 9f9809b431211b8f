#include "compress/store/quantize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace acdf::compress {
namespace {

constexpr std::uint64_t kMaximum[] = {0xFF, 0xFFFF, 0xFFFFFFFF};
constexpr double kFaint = 1e-200;
constexpr std::uint64_t kSmallest[] = {1, 1, 256}; // 256 of 2^32: 2^-24

QuantizedCurve accumulate(const std::vector<std::uint64_t>& shares, std::uint32_t code) {
    QuantizedCurve out{code, {}};
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
        sum += shares[i];
        out.cumulative.push_back(static_cast<std::uint32_t>(sum));
    }
    return out;
}

} // namespace

std::vector<std::uint64_t> apportion(const std::vector<double>& probability, std::uint64_t maximum,
                                     std::uint64_t smallest) {
    const std::size_t n = probability.size();
    const double largest = n == 0 ? 0.0 : *std::max_element(probability.begin(), probability.end());
    if (largest > 0.0 && largest < kFaint) { // scaled to `maximum` they would overflow
        std::vector<double> relative = probability;
        for (double& p : relative) p /= largest;
        return apportion(relative, maximum, smallest);
    }
    std::vector<std::uint64_t> shares(n, 0); // those at the floor alone are above 0 at first
    // Raising small shares to the floor leaves less for the others, which may
    // then fall below it in turn.
    std::uint64_t left = maximum;
    double scale = 0.0;
    for (bool changed = true; changed;) {
        changed = false;
        double mass = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            if (shares[i] == 0) mass += probability[i];
        scale = mass > 0.0 ? static_cast<double>(left) / mass : 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (shares[i] > 0 || !(probability[i] > 0.0) || probability[i] * scale >= double(smallest)) continue;
            if (left < smallest) throw std::invalid_argument("more segments than probabilities to give them");
            shares[i] = smallest;
            left -= smallest;
            changed = true;
        }
    }
    struct Free {
        double remainder;
        std::size_t index;
        bool operator<(const Free& other) const {
            return remainder != other.remainder ? remainder > other.remainder : index < other.index;
        }
    };
    std::vector<Free> free; // larger remainders first
    std::uint64_t given = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (shares[i] > 0 || !(probability[i] > 0.0)) continue;
        const double ideal = probability[i] * scale;
        shares[i] = std::max(smallest, static_cast<std::uint64_t>(ideal));
        free.push_back({ideal - static_cast<double>(shares[i]), i});
        given += shares[i];
    }
    // Every share is at the floor: the first of the most probable ones takes what
    // is left.
    if (free.empty()) {
        shares[static_cast<std::size_t>(std::max_element(probability.begin(), probability.end()) -
                                        probability.begin())] += left;
        return shares;
    }
    std::sort(free.begin(), free.end());
    for (std::size_t k = 0; given < left; k = (k + 1) % free.size(), ++given) ++shares[free[k].index];
    for (std::size_t k = free.size(); given > left; k = k == 0 ? free.size() : k) { // rounding of `ideal` upwards
        --k;
        if (shares[free[k].index] > smallest) --shares[free[k].index], --given;
    }
    return shares;
}

double quantization_excess(const std::vector<double>& probability, const std::vector<std::uint64_t>& shares) {
    const double maximum = static_cast<double>(std::accumulate(shares.begin(), shares.end(), std::uint64_t{0}));
    double excess = 0.0;
    for (std::size_t i = 0; i < probability.size(); ++i) {
        if (shares[i] == 0) continue;
        const double q = static_cast<double>(shares[i]) / maximum, difference = probability[i] - q;
        excess += difference * difference / q;
    }
    return excess;
}

QuantizedCurve quantize(const std::vector<double>& probability, double reach, double price) {
    const auto lit = static_cast<std::uint64_t>(
        std::count_if(probability.begin(), probability.end(), [](double p) { return p > 0.0; }));
    std::uint32_t best = 0;
    std::vector<std::uint64_t> best_shares;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t code = 0; code < 3; ++code) {
        if (lit > kMaximum[code]) continue;
        const double bytes = static_cast<double>(probability.size() - 1) * static_cast<double>(1u << code);
        if (bytes * price >= least) break; // wider ones cost more even without any excess
        std::vector<std::uint64_t> shares = apportion(probability, kMaximum[code], kSmallest[code]);
        const double cost = bytes * price + reach * quantization_excess(probability, shares);
        if (cost >= least) continue;
        least = cost;
        best = code;
        best_shares = std::move(shares);
    }
    return accumulate(best_shares, best);
}

} // namespace acdf::compress
