// Libraries of small probes for the tests of acdf batch.
#pragma once

#include "tests/inputs/float_map.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace acdf::test {

/// A lat-long probe of 2 rows x rows texels as a portable float map: noise of `seed` and one bright texel.
inline void write_small_probe(const std::string& path, std::uint32_t seed, std::uint32_t rows = 8) {
    std::mt19937 random(seed);
    std::vector<float> rgb(std::size_t{6} * rows * rows);
    for (float& v : rgb) v = 0.1f + static_cast<float>(random() % 1024) / 1024.0f;
    const std::size_t bright = random() % (rgb.size() / 3);
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * bright + c] = 100.0f;
    write_float_map(path, static_cast<int>(2 * rows), static_cast<int>(rows), rgb);
}

/// A lat-long probe of 16 x 8 texels, all alike but for the first few, which are negative.
inline void write_mended_probe(const std::string& path, int negative) {
    std::vector<float> rgb(std::size_t{3} * 16 * 8, 1.0f);
    std::fill_n(rgb.begin(), 3 * negative, -1.0f);
    write_float_map(path, 16, 8, rgb);
}

/// probe000.pfm to probe<count - 1>.pfm in `folder`, which is made.
inline void write_small_probes(const std::string& folder, std::uint32_t count, std::uint32_t rows = 8) {
    std::filesystem::create_directories(folder);
    for (std::uint32_t i = 0; i < count; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "/probe%03u.pfm", i);
        write_small_probe(folder + name, i, rows);
    }
}

} // namespace acdf::test
