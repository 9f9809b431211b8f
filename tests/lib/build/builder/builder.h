// What the tests of the public library share: a sky in every form that it takes pixels in, and the program to
// compare with.
#pragma once

#include "tests/inputs/sanitized.h"
#include "tests/tools/run.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace acdf::test {

using Bytes = std::vector<std::uint8_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr std::uint32_t kSkyWidth = 64, kSkyHeight = 32;

/// Numbers of few bits, so that half floats hold them too: a gradient, a pattern and a sun.
inline std::vector<float> sky(std::uint32_t width = kSkyWidth, std::uint32_t height = kSkyHeight) {
    std::vector<float> rgb;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const bool sun = x == width / 3 && y == height / 4;
                rgb.push_back(sun ? 1024.0f : static_cast<float>(64 + 2 * y + (x * 7 + k * 13) % 32) / 64.0f);
            }
    return rgb;
}

inline builder::Pixels pixels_of(const std::vector<float>& rgb, std::uint32_t width = kSkyWidth,
                                 std::uint32_t height = kSkyHeight) {
    builder::Pixels pixels;
    pixels.data = rgb.data();
    pixels.width = width;
    pixels.height = height;
    return pixels;
}

inline builder::EnvironmentOptions cells(std::uint32_t n) {
    builder::EnvironmentOptions options;
    options.goal = builder::Goal::of_cells(n);
    return options;
}

/// The file of pixels, which must be made.
inline Bytes bytes_of(const builder::Pixels& pixels, const builder::EnvironmentOptions& options) {
    builder::Environment made;
    const builder::Status status = builder::environment(pixels, options, made);
    EXPECT_TRUE(status.ok()) << status.message;
    EXPECT_FALSE(made.bytes.empty());
    return made.bytes;
}

inline Bytes file_bytes(const std::string& path) {
    const std::string text = read_text(path);
    return {text.begin(), text.end()};
}

/// The file that the program makes.
inline Bytes program_bytes(std::vector<std::string> arguments, const std::string& path) {
    arguments.insert(arguments.end(), {"-o", path, "--force", "--quiet"});
    const Result made = run_acdf(arguments);
    EXPECT_EQ(made.code, 0) << made.err;
    return file_bytes(path);
}

} // namespace acdf::test
