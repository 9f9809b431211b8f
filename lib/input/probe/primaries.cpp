#include "input/probe/primaries.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::input {
namespace {

using Column = std::array<double, 3>;

double determinant(const Column& a, const Column& b, const Column& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
           c[0] * (a[1] * b[2] - a[2] * b[1]);
}

bool all_near(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::abs(x - y) < 1e-3; });
}

} // namespace

// SMPTE RP 177: how much of each primary makes white.
std::optional<builder::ChannelWeights> luminance_of(const std::vector<float>& chromaticities) {
    if (chromaticities.size() != 8) return std::nullopt;
    std::array<Column, 4> colour;
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = static_cast<double>(chromaticities[2 * i]),
                     y = static_cast<double>(chromaticities[2 * i + 1]);
        colour[i] = {x, y, 1.0 - x - y};
    }
    const auto& [red, green, blue, white] = colour;
    const double all = determinant(red, green, blue) * white[1];
    if (!(std::abs(all) > 1e-6)) return std::nullopt; // NaN, too
    std::array<double, 3> weights = {red[1] * determinant(white, green, blue) / all,
                                     green[1] * determinant(red, white, blue) / all,
                                     blue[1] * determinant(red, green, white) / all};
    double sum = 0.0;
    for (double& weight : weights) sum += weight = std::max(weight, 0.0);
    if (!(sum > 0.0) || !std::isfinite(sum)) return std::nullopt;
    for (double& weight : weights) weight /= sum;
    const builder::ChannelWeights usual;
    if (all_near(weights, {usual.r, usual.g, usual.b})) return std::nullopt;
    return builder::ChannelWeights{weights[0], weights[1], weights[2]};
}

bool are_xyz(const std::vector<float>& chromaticities) {
    constexpr float xyz[] = {1, 0, 0, 1, 0, 0};
    return chromaticities.size() == 8 && std::equal(std::begin(xyz), std::end(xyz), chromaticities.begin(),
                                                    [](float a, float b) { return std::abs(a - b) < 1e-3f; });
}

} // namespace acdf::input
