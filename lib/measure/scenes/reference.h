// Pictures without noise: the light of every texel, summed.
#pragma once

#include "measure/scenes/scene_points.h"

#include <functional>
#include <vector>

namespace acdf::measure {

/// Each texel counts with its solid angle times the integrand at its centre; those that give more than
/// kRefinedShare of a point's light are summed over kRefinement x kRefinement parts of equal solid angle instead.
/// What is approximated: visibility and BRDF within the other texels, O(1 / rows) where shadows end.
constexpr double kRefinedShare = 1.0 / 4096.0;
constexpr std::uint32_t kRefinement = 8;

/// Reflected light of each point, in the order of `points`. Uses all cores; the result does not depend on their
/// number. `progress`, if any, is called with the share that is done, by several threads.
std::vector<Rgb> reference(const ProbeLight& light, const std::vector<ScenePoint>& points,
                           const std::function<void(double)>& progress = {});

} // namespace acdf::measure
