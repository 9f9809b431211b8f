// Portable float maps: what we read ourselves is what OpenImageIO reads, and what is unusual is left to it.
#include "tests/inputs/float_map.h"
#include "tests/lib/input/write.h"

#include "images/float_map.h"

#include <gtest/gtest.h>

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
    const std::string path = folder.file("a.pfm");
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
    write_float_map(folder.file("a.pfm"), sky.width, sky.height, sky.rgb);
    const input::Probe probe = input::read_probe(folder.file("a.pfm"));
    EXPECT_EQ(probe.rgb, sky.rgb);
    EXPECT_TRUE(probe.warnings.empty());
}

TEST(FloatMap, WhatIsUnusualIsLeftToOpenImageIO) {
    const Folder folder;
    const std::string path = folder.file("a.pfm"), pixels(12 * 8, '\x3F');
    const auto is_ours = [&](const std::string& header, const std::string& rest) {
        write_bytes(path, header + rest);
        return is_float_map(path);
    };
    for (const char* usual : {"PF\n4 2\n-1.0\n", "PF\n4 2\n-1\n", "PF\n4 2\n-1.000000\n", "PF\n1 8\n-1.\n",
                              "PF\r\n4 2\r\n-1.0\r\n", "PF\n4 2 \n-1.0 \n"}) {
        EXPECT_TRUE(is_ours(usual, pixels)) << usual;
        EXPECT_FLOAT_EQ(input::read_probe(path, {input::Projection::latlong}).rgb.back(), 0.747059f) << usual;
    }
    for (const char* other : {"PF\n4 2\n1.0\n",
                              "PF\n4 2\n-2.0\n",
                              "PF\n4 2\n-1.5\n",
                              "PF\n4 2\n-10\n",
                              "Pf\n4 6\n-1.0\n",
                              "P6\n4 8\n255\n",
                              "PF\n# by hand\n4 2\n-1.0\n",
                              "PF 4 2 -1.0\n",
                              "PF\r4 2\r-1.0\r",
                              "PF\n4 2\n-1.0 ",
                              "PF\n4  2\n-1.0\n",
                              "PF\n-4 -2\n-1.0\n",
                              "PF\n0 0\n-1.0\n",
                              "PF\n8\n-1.0\n",
                              "PF\n4 3\n-1.0\n",
                              "PF\n4 1\n-1.0\n",
                              "PF\n65537 1\n-1.0\n",
                              "PF\n99999999999 2\n-1.0\n",
                              "PF\n4 2\n-1.0",
                              "PF",
                              ""})
        EXPECT_FALSE(is_ours(other, pixels)) << other;
    EXPECT_FALSE(is_ours("PF\n4 2\n-1.0\n", pixels.substr(1)));
    EXPECT_FALSE(is_float_map(folder.file("missing.pfm")));
    EXPECT_FALSE(is_float_map(folder.file("")));
    // Big-endian and scaled numbers, which it understands.
    const std::string one("\x3F\x80\0\0", 4), two("\0\0\0\x40", 4);
    std::string large, scaled;
    for (int i = 0; i < 24; ++i) large += one, scaled += two;
    write_bytes(path, "PF\n4 2\n1.0\n" + large);
    EXPECT_EQ(input::read_probe(path).rgb, std::vector<float>(24, 1.0f));
    write_bytes(path, "PF\n4 2\n-2.0\n" + scaled);
    EXPECT_EQ(input::read_probe(path).rgb, std::vector<float>(24, 4.0f));
}

} // namespace
