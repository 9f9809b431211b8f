// The tangents that everyone who needs some gives a surface of which only the normal is known: what an anisotropic
// BRDF and the samplers of it must agree on.
#pragma once

#include <cmath>

namespace acdf::measure {

/// Right-handed with unit n: without branches, after Duff et al., "Building an Orthonormal Basis, Revisited", JCGT
/// 6(1), 2017.
inline void surface_frame(const double n[3], double tangent[3], double bitangent[3]) {
    const double sign = std::copysign(1.0, n[2]), a = -1.0 / (sign + n[2]), b = n[0] * n[1] * a;
    tangent[0] = 1.0 + sign * n[0] * n[0] * a;
    tangent[1] = sign * b;
    tangent[2] = -sign * n[0];
    bitangent[0] = b;
    bitangent[1] = sign + n[1] * n[1] * a;
    bitangent[2] = -n[1];
}

} // namespace acdf::measure
