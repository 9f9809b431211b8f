// Image files of known pixels, for the tests.
#pragma once

#include "tests/inputs/float_map.h"

#include "images/openexr.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::test {

/// TIFF 6.0 of a machine like this one: the header, 32-bit floats in one strip, then what they are.
inline std::vector<std::uint8_t> float_tiff(int width, int height, const std::vector<float>& rgb) {
    constexpr std::uint16_t kShort = 3, kLong = 4;
    const auto size = static_cast<std::uint32_t>(rgb.size() * sizeof(float)), bits = 8 + size, tags = bits + 6;
    struct Tag {
        std::uint16_t number, type;
        std::uint32_t count, value;
    };
    const Tag all[] = {{256, kLong, 1, static_cast<std::uint32_t>(width)},
                       {257, kLong, 1, static_cast<std::uint32_t>(height)},
                       {258, kShort, 3, bits},
                       {259, kShort, 1, 1}, // not compressed
                       {262, kShort, 1, 2}, // RGB
                       {273, kLong, 1, 8},
                       {277, kShort, 1, 3},
                       {278, kLong, 1, static_cast<std::uint32_t>(height)},
                       {279, kLong, 1, size},
                       {284, kShort, 1, 1},  // channels side by side
                       {339, kShort, 1, 3}}; // floats: one number for all channels
    std::vector<std::uint8_t> out;
    const auto put = [&](const void* from, std::size_t count) {
        const auto* bytes = static_cast<const std::uint8_t*>(from);
        out.insert(out.end(), bytes, bytes + count);
    };
    const std::uint16_t magic[] = {0x4949, 42}, each_bits[] = {32, 32, 32}, count = std::size(all);
    const std::uint32_t none = 0;
    put(magic, sizeof magic);
    put(&tags, sizeof tags);
    put(rgb.data(), size);
    put(each_bits, sizeof each_bits);
    put(&count, sizeof count);
    put(all, sizeof all);
    put(&none, sizeof none);
    return out;
}

/// Radiance's RGBE, the rows encoded in runs of which none repeats.
inline std::vector<std::uint8_t> radiance_picture(int width, int height, const std::vector<float>& rgb) {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                             std::to_string(width) + "\n";
    std::vector<std::uint8_t> out(head.begin(), head.end());
    for (int y = 0; y < height; ++y) {
        std::vector<std::uint8_t> planes[4];
        for (int x = 0; x < width; ++x) {
            const float* pixel = rgb.data() + 3 * (static_cast<std::ptrdiff_t>(y) * width + x);
            int exponent = 0;
            const float largest = *std::max_element(pixel, pixel + 3);
            std::frexp(largest, &exponent);
            for (int c = 0; c < 3; ++c)
                planes[c].push_back(static_cast<std::uint8_t>(std::ldexp(pixel[c], 8 - exponent)));
            planes[3].push_back(static_cast<std::uint8_t>(largest > 0.0f ? exponent + 128 : 0));
        }
        out.insert(out.end(), {2, 2, static_cast<std::uint8_t>(width >> 8), static_cast<std::uint8_t>(width)});
        for (const std::vector<std::uint8_t>& plane : planes)
            for (std::size_t at = 0; at < plane.size(); at += 128) {
                const std::size_t count = std::min<std::size_t>(128, plane.size() - at);
                const auto from = plane.begin() + static_cast<std::ptrdiff_t>(at);
                out.push_back(static_cast<std::uint8_t>(count));
                out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(count));
            }
    }
    return out;
}

/// Writes height x width x 3 floats, rows from the top: .pfm, .hdr, .tif or .exr.
inline void write_rgb(const std::string& path, int width, int height, const std::vector<float>& rgb) {
    const std::string kind = std::filesystem::path(path).extension().string();
    if (kind == ".pfm") return write_float_map(path, width, height, rgb);
    std::vector<std::uint8_t> bytes;
    if (kind == ".hdr") bytes = radiance_picture(width, height, rgb);
    else if (kind == ".tif") bytes = float_tiff(width, height, rgb);
    else if (kind == ".exr") {
        images::Picture picture(width, height);
        picture.values = rgb;
        bytes = images::encode_exr(picture, {"R", "G", "B"}, {});
    } else throw std::invalid_argument(path + ": of no such kind");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace acdf::test
