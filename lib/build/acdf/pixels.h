// Light as a caller of the builder has it: pixels in memory, or rows on demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace acdf::builder {

/// How a number is stored.
enum class Number { float32, float16, float64 };

/// How an image is laid out.
enum class Projection {
    latlong,
    angular,        ///< P. Debevec's light probes, mirrored like the ball: distance from the centre ~ angle; square
    mirrorball,     ///< orthographic photograph of a mirror ball; square
    vertical_cross, ///< cube, 3:4, the back face upside down at the foot
    horizontal_cross, ///< cube, 4:3, the back face at the right end
    stacked_cube,     ///< cube, 1:6, OpenEXR's ENVMAP_CUBE: texel centres on the face's borders
    octahedral,       ///< P. Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", 2008; square
};

/// Linear radiance that the caller holds, rows from the top, in the projection's own order of texels. Row 0 of a
/// lat-long map touches +z, column 0 begins at phi = +pi and phi falls. Strides are in bytes, of any sign; 0:
/// channels next to each other, pixels `channels` numbers apart, rows `width` pixels apart. Numbers need not be
/// aligned, and may not overlap. At most 2^30 pixels and 2^16 on a side. TargetOptions::domain says what is
/// resampled.
struct Pixels {
    const void* data = nullptr; ///< the first channel of the top left pixel
    std::uint32_t width = 0, height = 0;
    std::uint32_t channels = 3; ///< 1 (grey), 3, or 4 (the last one is ignored)
    Number number = Number::float32;
    std::ptrdiff_t channel_stride = 0, pixel_stride = 0, row_stride = 0;
    Projection projection = Projection::latlong;
};

/// A lat-long map whose rows are asked for when they are needed. Memory is that of the target and a band of rows: 4
/// bytes a texel for one channel and nearest lookup. On another grid than its own it is that of the whole map.
struct Rows {
    std::uint32_t width = 0, height = 0;
    /// Fills `rgb` (count x width x 3) with rows first to first + count - 1. Called by one thread, from the top to
    /// the bottom, once (twice with BadTexelPolicy::clamp). false gives up.
    std::function<bool(std::uint32_t first, std::uint32_t count, float* rgb)> read;
};

/// What becomes of NaN, infinite and negative values. None of them ever reaches a pdf.
enum class BadTexelPolicy {
    zero, ///< all are 0
    /// +infinity is the largest finite value of its channel, of half floats 65504, at which they end; the others
    /// are 0
    clamp,
    error, ///< ErrorCode::bad_source
};

/// Texels with channels that are no radiance, each counted once, as the first of nan, infinite, negative that it
/// has. `x`, `y`: the first in the source, row by row from the top; -1 where there is none.
struct BadTexels {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    int x = -1, y = -1;

    /// All of them.
    std::uint64_t count() const { return nan + infinite + negative; }
};

} // namespace acdf::builder
