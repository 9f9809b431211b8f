// Targets of tests whose expectations are those of a renderer that looks the nearest texel up.
#pragma once

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace acdf::test {

inline builder::TargetOptions nearest_lookup() {
    builder::TargetOptions options;
    options.filter = ACDF_FILTER_NEAREST;
    return options;
}

/// Of a map whose texels have the light `light(column, row)`.
template <class Light>
builder::Target nearest_target(std::uint32_t columns, std::uint32_t rows, const Light& light) {
    std::vector<float> rgb;
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) rgb.insert(rgb.end(), 3, static_cast<float>(light(c, r)));
    builder::Pixels pixels;
    pixels.data = rgb.data();
    pixels.width = columns;
    pixels.height = rows;
    builder::Target out;
    EXPECT_TRUE(builder::Target::from(pixels, nearest_lookup(), out).ok());
    return out;
}

} // namespace acdf::test
