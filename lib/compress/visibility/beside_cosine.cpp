#include "compress/visibility/beside_cosine.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {

BesideCosine::BesideCosine(const VisibilityParts& parts) : shares_(parts.count() * groups, 0.0f) {
    for (std::size_t p = 0; p < parts.count(); ++p) {
        std::vector<VisibilityParts::Tile> own = parts.tiles(p);
        std::sort(own.begin(), own.end(), [](const VisibilityParts::Tile& a, const VisibilityParts::Tile& b) {
            return a.light * b.solid_angle < b.light * a.solid_angle;
        });
        double all = 0.0, before = 0.0;
        for (const VisibilityParts::Tile& tile : own) all += tile.light;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const double middle = all > 0.0 ? (before + 0.5 * own[i].light) / all : 0.0;
            const std::size_t group =
                p * groups + std::min<std::size_t>(static_cast<std::size_t>(middle * double(groups)), groups - 1);
            before += own[i].light;
            shares_[group] += static_cast<float>(all > 0.0 ? own[i].light / all : 1.0 / double(own.size()));
            tiles_.push_back({own[i].direction, static_cast<float>(own[i].solid_angle), group});
        }
    }
}

std::vector<float> BesideCosine::masses(const std::array<float, 3>& n) const {
    std::vector<float> out(shares_.size(), 0.0f);
    for (const Tile& tile : tiles_) {
        const std::array<float, 3>& d = tile.direction;
        const float cosine = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        if (cosine > 0.0f) out[tile.group] += cosine * tile.solid_angle * static_cast<float>(1.0 / ACDF_PI);
    }
    return out;
}

void BesideCosine::factors(const float* light, const float* seen, const float* masses, float* out) const {
    constexpr int kSteps = 12;
    constexpr float kLeastLight = 1e-12f; // of all: less has no factor of its own
    const std::size_t parts = shares_.size() / groups;
    std::vector<float> pdf(parts);
    float all = 0.0f;
    for (std::size_t p = 0; p < parts; ++p) all += light[p];
    const float unit = all > 0.0f ? 1.0f / all : 0.0f;
    for (std::size_t p = 0; p < parts; ++p) pdf[p] = light[p] * unit;
    // At the least noise the derivative by the probability of each part is the same; each step multiplies by the
    // root of it, which without a partner is the answer at once.
    for (int step = 0; step < kSteps; ++step) {
        float sum = 0.0f;
        for (std::size_t p = 0; p < parts; ++p) {
            const double own = double{light[p] * unit};
            double derivative = 0.0;
            for (std::size_t g = p * groups; g < (p + 1) * groups; ++g) {
                const double share = double{shares_[g]}, both = double{pdf[p]} * share + double{masses[g]};
                if (both > 0.0) derivative += share * share * share / (both * both);
            }
            pdf[p] *= static_cast<float>(own * std::sqrt(double{std::min(seen[p], 1.0f)} * derivative));
            sum += pdf[p];
        }
        if (!(sum > 0.0f)) break;
        for (std::size_t p = 0; p < parts; ++p) pdf[p] /= sum;
    }
    for (std::size_t p = 0; p < parts; ++p)
        out[p] = kUnoccluded +
                 (light[p] * unit > kLeastLight ? (1.0f - kUnoccluded) * pdf[p] / (light[p] * unit) : 0.0f);
}

} // namespace acdf::compress
