// Rows for what samples of the cosine leave over, where renderers weigh both by the balance heuristic.
#pragma once

#include "compress/visibility/parts.h"

#include <array>
#include <cstddef>
#include <vector>

namespace acdf::compress {

/// Of all samples so many go where light comes from, whatever is seen.
constexpr float kUnoccluded = 0.05f;

/// Of as many samples of the cosine as of light. A part of the sphere is taken as groups of its tiles, from dark to
/// bright: it is its bright ones that the cosine seldom samples.
class BesideCosine {
public:
    static constexpr std::size_t groups = 4;

    explicit BesideCosine(const VisibilityParts& parts);

    /// How often a sample of the cosine around a unit normal falls into each group: parts x groups.
    std::vector<float> masses(const std::array<float, 3>& normal) const;
    /// What the light of parts is to be multiplied by, so that samples of light, and as many of the cosine, are
    /// least noisy. `light`: of parts, in any unit; `seen`: which share of it arrives, at most 1 counts. `out` may
    /// be `seen`.
    void factors(const float* light, const float* seen, const float* masses, float* out) const;

private:
    struct Tile {
        std::array<float, 3> direction{};
        float solid_angle = 0.0f;
        std::size_t group = 0;
    };
    std::vector<Tile> tiles_;
    std::vector<float> shares_; ///< of each group, of the light of its part
};

} // namespace acdf::compress
