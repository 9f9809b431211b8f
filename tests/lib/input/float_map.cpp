// Portable float maps: our own reader reads the same as OpenImageIO, and leaves unusual files to it.
#include "tests/inputs/float_map.h"
#include "tests/lib/input/write.h"

#include "images/float_map.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>

namespace {

using namespace acdf;
using namespace acdf::test;

constexpr int kWidth = 7, kHeight = 5;

std::vector<float> texels() {
    std::vector<float> rgb(3 * kWidth * kHeight);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = 0.1f + static_cast<float>(i * 37 % 101);
    rgb[4] = std::numeric_limits<float>::infinity(), rgb[11] = -1.0f, rgb[20] = 1e-42f;
    return rgb;
}

/// Whether our own reader opens a file.
bool is_float_map(const std::string& path) {
    images::Header header;
    std::string error;
    void* const image = images::float_map_reader().open(path, 1, header, error);
    images::float_map_reader().close(image);
    return image != nullptr;
}

/// Rows 1 to 3 of two channels, between numbers that stay.
std::vector<float> read_part(const images::ImageReader& reader, const std::string& path, images::Header& header) {
    std::string error;
    void* image = reader.open(path, 1, header, error);
    EXPECT_TRUE(image) << error;
    std::vector<float> out(3 * 4 * kWidth, 77.0f);
    if (!image) return out;
    EXPECT_TRUE(reader.read(image, {1, 4, 1, 3, 16, 16 * kWidth}, out.data() + 1, error)) << error;
    EXPECT_FALSE(reader.seek(image, 1, header));
    EXPECT_TRUE(reader.seek(image, 0, header));
    EXPECT_EQ(reader.text(image, "textureformat"), "");
    EXPECT_EQ(reader.integer(image, "Orientation", 1), 1);
    EXPECT_EQ(reader.real(image, "oiio:Gamma", 0.5f), 0.5f);
    reader.close(image);
    return out;
}

TEST(FloatMap, IsWhatOpenImageIOReads) {
    const Folder folder;
    const std::string path = folder / "a.pfm";
    write_float_map(path, kWidth, kHeight, texels());
    ASSERT_TRUE(is_float_map(path));
    images::Header ours, theirs;
    EXPECT_EQ(read_part(images::float_map_reader(), path, ours), read_part(images::module().reader, path, theirs));
    EXPECT_EQ(ours.format, theirs.format);
    EXPECT_EQ(ours.data, theirs.data);
    EXPECT_EQ(ours.display, theirs.display);
    EXPECT_EQ(ours.depth, theirs.depth);
    EXPECT_EQ(ours.tile_height, theirs.tile_height);
    EXPECT_EQ(ours.channel_count, theirs.channel_count);
    EXPECT_EQ(ours.channels, theirs.channels);
    EXPECT_EQ(ours.deep, theirs.deep);
    EXPECT_EQ(ours.floating, theirs.floating);
    EXPECT_EQ(ours.sample_bytes, theirs.sample_bytes);
}

TEST(FloatMap, IsReadAsAProbe) {
    const Folder folder;
    const Pixels sky = latlong_sky(32);
    write_float_map(folder / "a.pfm", sky.width, sky.height, sky.rgb);
    const input::Probe probe = input::read_probe(folder / "a.pfm");
    EXPECT_EQ(probe.rgb, sky.rgb);
    EXPECT_TRUE(probe.warnings.empty());
}

/// A number as a map stores it.
std::string stored(float number, bool large_first) {
    std::uint32_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> 8 * (large_first ? 3 - i : i));
    return bytes;
}

struct Form {
    const char *type, *scale;
    bool large_first;
};
/// Of four channels, which OpenImageIO does not know.
TEST(FloatMap, FourChannelsAreColoursAndAlpha) {
    const Folder folder;
    const Pixels sky = latlong_sky(32);
    std::string bytes = "PF4\n32 16\n-1.0\n";
    for (int y = 15; y >= 0; --y)
        for (int x = 0; x < 32; ++x) {
            bytes.append(reinterpret_cast<const char*>(sky.at(x, y)), 12);
            bytes.append("\0\0\0", 4); // an alpha of 0 changes nothing
        }
    write_text(folder / "a.pfm", bytes);
    EXPECT_TRUE(is_float_map(folder / "a.pfm"));
    EXPECT_EQ(input::read_probe(folder / "a.pfm").rgb, sky.rgb);
    write_text(folder / "a.pfm", bytes + "x");
    EXPECT_FALSE(is_float_map(folder / "a.pfm"));
}

constexpr Form kForms[] = {{"PF", "-1.0", false}, {"PF", "1.0", true}, {"PF", "-2.5", false}, {"PF", "3e-1", true},
                           {"Pf", "-1.0", false}, {"Pf", "1.0", true}, {"Pf", "-0.3", false}, {"Pf", "7", true}};

std::string map_of(const Form& form, const std::string& line_end) {
    std::string bytes = form.type + line_end + "7 5" + line_end + form.scale + line_end;
    std::vector<float> numbers = texels();
    if (form.type[1] == 'f') numbers.resize(kWidth * kHeight);
    for (const float number : numbers) bytes += stored(number, form.large_first);
    return bytes;
}

std::vector<float> read_all(const images::ImageReader& reader, const std::string& path, images::Header& header) {
    std::string error;
    void* image = reader.open(path, 1, header, error);
    EXPECT_TRUE(image) << error;
    if (!image) return {};
    const auto channels = static_cast<std::size_t>(header.channel_count);
    std::vector<float> out(channels * kWidth * kHeight);
    const auto pixel = static_cast<std::ptrdiff_t>(channels * sizeof(float));
    EXPECT_TRUE(
        reader.read(image, {0, kHeight, 0, header.channel_count, pixel, kWidth * pixel}, out.data(), error));
    reader.close(image);
    return out;
}

TEST(FloatMap, ChannelsScalesAndOrdersOfBytesAreReadAsByOpenImageIO) {
    const Folder folder;
    const std::string path = folder / "a.pfm";
    for (const Form& form : kForms) {
        SCOPED_TRACE(std::string(form.type) + " " + form.scale);
        write_text(path, map_of(form, "\n"));
        images::Header ours, theirs;
        const std::vector<float> numbers = read_all(images::float_map_reader(), path, ours);
        EXPECT_EQ(numbers, read_all(images::module().reader, path, theirs));
        EXPECT_EQ(ours.channels, theirs.channels);
        write_text(path, map_of(form, "\r\n")); // of which OpenImageIO takes the last byte for a pixel's first
        EXPECT_EQ(numbers, read_all(images::float_map_reader(), path, ours));
    }
}

TEST(FloatMap, WhatIsUnusualIsLeftToOpenImageIO) {
    const Folder folder;
    const std::string path = folder / "a.pfm", pixels(12 * 8, '\x3F');
    const auto is_ours = [&](const std::string& header, const std::string& rest) {
        write_text(path, header + rest);
        return is_float_map(path);
    };
    for (const char* usual :
         {"PF\n4 2\n-1.0\n", "PF\n4 2\n-1\n", "PF\n4 2\n-1.000000\n", "PF\n1 8\n-1.\n", "PF\r\n4 2\r\n-1.0\r\n",
          "PF\n4 2 \n-1.0 \n", "PF\n# by hand\n4 2\n-1.0\n", "PF\r\n# 9\r\n4 2\r\n-1.0\r\n", "PF 4 2 -1.0\n",
          "PF\r4 2\r-1.0\r", "PF\n4 2\n-1.0 ", "PF\n4  2\n-1.0\n"}) {
        EXPECT_TRUE(is_ours(usual, pixels)) << usual;
        EXPECT_FLOAT_EQ(input::read_probe(path, {input::Projection::latlong}).rgb.back(), 0.747059f) << usual;
    }
    for (const char* other :
         {"P6\n4 8\n255\n", "Pf\n4 6\n-1.0\nx", "PF\n4 2\n-1.0x\n", "PF\n4 2\n0\n", "PF\n4 2\n-nan\n",
          "PF\n4 2\n-inf\n", "PF\n4 2\n-1e99\n", "PF\n# without an end", "PF\n-4 -2\n-1.0\n", "PF\n0 0\n-1.0\n",
          "PF\n8\n-1.0\n", "PF\n4 3\n-1.0\n", "PF\n4 1\n-1.0\n", "PF\n65537 1\n-1.0\n", "PF\n99999999999 2\n-1.0\n",
          "PF\n4 2\n-1.0", "PF", ""})
        EXPECT_FALSE(is_ours(other, pixels)) << other;
    EXPECT_FALSE(is_ours("PF\n4 2\n-1.0\n", pixels.substr(1)));
    EXPECT_FALSE(is_float_map(folder / "missing.pfm"));
    EXPECT_FALSE(is_float_map(folder / ""));
}

} // namespace
