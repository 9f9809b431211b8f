#include "measure/samplers/alias_choices.h"

#include <algorithm>

namespace acdf::measure {

// Each mass below the mean is filled up by one above it.
std::vector<AliasChoice> alias_choices(std::vector<double> mass) {
    std::vector<AliasChoice> out(mass.size());
    std::vector<std::uint32_t> small, large, dark;
    const auto largest = static_cast<std::uint32_t>(std::max_element(mass.begin(), mass.end()) - mass.begin());
    for (std::uint32_t i = 0; i < mass.size(); ++i) {
        out[i] = {1.0f, i};
        (mass[i] < 1.0 ? small : large).push_back(i);
        if (!(mass[i] > 0.0)) dark.push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t filled = small.back(), filling = large.back();
        small.pop_back();
        out[filled] = {static_cast<float>(mass[filled]), filling};
        mass[filling] -= 1.0 - mass[filled];
        if (mass[filling] >= 1.0) continue;
        large.pop_back();
        small.push_back(filling);
    }
    // What rounding leaves is full, but for what is dark.
    for (const std::uint32_t i : dark)
        if (out[i].keep > 0.0f) out[i] = {0.0f, largest};
    return out;
}

} // namespace acdf::measure
