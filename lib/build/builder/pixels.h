// Texels of images that a caller holds, as RGB floats.
#pragma once

#include <acdf/builder.h>

namespace acdf::builder {

/// Throws build::OptionError for what is no image.
void check(const Pixels& pixels);
void check(const Rows& rows);

/// Fills `rgb` with `count` texels of row y from column x on, of `pixels`, which were checked.
void read_texels(const Pixels& pixels, std::uint32_t x, std::uint32_t y, std::uint32_t count, float* rgb);

/// The same where they lie; null where they are not RGB floats next to each other.
const float* packed_texels(const Pixels& pixels, std::uint32_t x, std::uint32_t y);

/// Fills `rgb` with rows first to first + count - 1 of `pixels`, which were checked.
void read_rows(const Pixels& pixels, std::uint32_t first, std::uint32_t count, float* rgb);

/// "latlong", "angular", "mirrorball", "cube-cross", "octahedral".
const char* name_of(Projection projection);

} // namespace acdf::builder
