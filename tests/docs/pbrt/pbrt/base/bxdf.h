// Stands in for pbrt's header.
#pragma once

namespace pbrt {

enum BxDFFlags { Unset = 0, Reflection = 1 << 0, Transmission = 1 << 1 };

inline bool IsReflective(BxDFFlags flags) { return flags & Reflection; }
inline bool IsTransmissive(BxDFFlags flags) { return flags & Transmission; }

} // namespace pbrt
