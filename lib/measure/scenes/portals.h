// Portals: rectangles, given by hand, that light comes through. Renderers use them for rooms; a baseline.
//
// Directions that reach no portal are never sampled: where light comes another way, these samplers are biased
// alone.
#pragma once

#include "compress/target.h"
#include "measure/samplers/light_samplers.h"
#include "measure/scenes/scene.h"

#include <vector>

namespace acdf::measure {

/// Uniform over the solid angle of all portals (Urena, Fajardo, King, "An Area-Preserving Parametrization for
/// Spherical Rectangles", EGSR 2013). Knows no light. Throws std::invalid_argument where there is no portal.
/// `turned`: as of Geometry.
LightSamplerPtr uniform_portal_sampler(std::vector<Portal> portals, bool turned);

/// Bitterli, Novak, Jarosz, "Portal-Masked Environment Map Sampling" (EGSR 2015): for each direction that portals
/// face, the light of `target` (a lat-long probe of one channel) on a map in which a portal is an upright rectangle
/// from wherever it is seen, as a summed-area table; light is sampled from the rectangles that the portals cut out
/// of it. The pdf is exact. `size`: cells along each axis of the map. Throws std::invalid_argument where there is
/// no portal, or no cell.
LightSamplerPtr windowed_portal_sampler(const compress::Target& target, const std::vector<Portal>& portals,
                                        bool turned, std::uint32_t size);

} // namespace acdf::measure
