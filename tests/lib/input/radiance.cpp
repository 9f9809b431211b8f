// Radiance pictures in every encoding that renderers read, by our own reader: OpenImageIO may be missing.
#include "images/radiance.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

namespace {

using namespace acdf;
using namespace acdf::test;

using Pixel = std::array<unsigned char, 4>;

constexpr int kRows = 6;

Pixel pixel_at(int x, int y) {
    return {static_cast<unsigned char>(40 + 7 * (x % 5)), static_cast<unsigned char>(90 + y),
            static_cast<unsigned char>(200 - x % 50), static_cast<unsigned char>(126 + (x + y) % 4)};
}

std::string flat_row(int columns, int y) {
    std::string out;
    for (int x = 0; x < columns; ++x)
        for (const unsigned char byte : pixel_at(x, y)) out += static_cast<char>(byte);
    return out;
}

std::string new_row(int columns, int y) {
    std::string out = {2, 2, static_cast<char>(columns >> 8), static_cast<char>(columns & 255)};
    for (std::size_t k = 0; k < 4; ++k)
        for (int x = 0; x < columns; x += 100) {
            const int count = std::min(100, columns - x);
            out += static_cast<char>(count);
            for (int i = x; i < x + count; ++i) out += static_cast<char>(pixel_at(i, y)[k]);
        }
    return out;
}

std::string head(int columns, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n",
                 const std::string& first = "#?RADIANCE\n") {
    return first + lines + "\n-Y " + std::to_string(kRows) + " +X " + std::to_string(columns) + "\n";
}

/// What our reader makes of a file; empty where it does not open it or cannot read a row.
std::vector<float> read_ours(const std::string& path, images::Header& header) {
    const images::ImageReader& reader = images::radiance_reader();
    std::string error;
    const std::unique_ptr<void, void (*)(void*)> image(reader.open(path, 1, header, error), reader.close);
    if (!image) return {};
    std::vector<float> out(static_cast<std::size_t>(3 * header.data.width * header.data.height));
    const images::Rows rows{0, header.data.height, 0, 3, 12, 12 * std::ptrdiff_t{header.data.width}};
    return reader.read(image.get(), rows, out.data(), error) ? out : std::vector<float>{};
}

std::vector<float> expected_pixels(int columns) {
    std::vector<float> out;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Pixel p = pixel_at(x, y);
            for (std::size_t k = 0; k < 3; ++k) out.push_back(std::ldexp(static_cast<float>(p[k]), p[3] - 136));
        }
    return out;
}

TEST(Radiance, EachRowMayBeEncodedInItsOwnWay) {
    const Folder folder;
    const std::string path = folder / "a.hdr";
    images::Header header;
    for (const int columns : {8, 32, 300})
        for (int ways = 0; ways < 1 << kRows; ++ways) {
            std::string bytes = head(columns);
            for (int y = 0; y < kRows; ++y) bytes += ways >> y & 1 ? new_row(columns, y) : flat_row(columns, y);
            write_text(path, bytes);
            ASSERT_EQ(read_ours(path, header), expected_pixels(columns)) << columns << " " << ways;
        }
    // Narrow pictures have flat rows alone.
    for (const int columns : {1, 7}) {
        std::string bytes = head(columns);
        for (int y = 0; y < kRows; ++y) bytes += flat_row(columns, y);
        write_text(path, bytes);
        EXPECT_EQ(read_ours(path, header), expected_pixels(columns)) << columns;
    }
}

// The first pixel looks like the mark of a row, of that width or of another.
TEST(Radiance, FlatPicturesMayBeginAsEncodedRowsDo) {
    const Folder folder;
    const std::string path = folder / "a.hdr";
    images::Header header;
    for (const int columns : {32, 2690, 100})
        for (const bool all : {false, true}) {
            std::string bytes = head(columns);
            std::vector<float> expected = expected_pixels(columns);
            const std::string pixel = {2, 2, 10, static_cast<char>(130)};
            for (int y = 0; y < kRows; ++y)
                for (int x = 0; x < columns; ++x) {
                    const bool marked = all || (x == 0 && y % 2 == 0);
                    bytes += marked ? pixel : flat_row(columns, y).substr(static_cast<std::size_t>(4 * x), 4);
                    float* at = expected.data() + 3 * (y * columns + x);
                    if (marked) at[0] = at[1] = 2.0f / 64.0f, at[2] = 10.0f / 64.0f;
                }
            write_text(path, bytes);
            EXPECT_EQ(read_ours(path, header), expected) << columns << " " << all;
        }
}

TEST(Radiance, HeadersThatChangeNothing) {
    const Folder folder;
    const std::string path = folder / "a.hdr", format = "FORMAT=32-bit_rle_rgbe\n";
    std::string pixels;
    for (int y = 0; y < kRows; ++y) pixels += y % 2 ? new_row(32, y) : flat_row(32, y);
    images::Header header;
    for (const std::string& lines : std::initializer_list<std::string>{
             format, format + "GAMMA=2.2\n", "GAMMA=0.4545\n" + format, format + "gamma=1\n",
             format + "COLORCORR=2 2 2\n", format + "EXPOSURE=0\n", format + "-v\n",
             "# " + std::string(5000, 'x') + "\n" + format, "FORMAT= 32-bit_rle_rgbe \n", format + "PIXASPECT=1\n"})
        for (const char* first : {"#?RADIANCE\n", "#?RGBE\n", "#?RGBE \n"}) {
            write_text(path, head(32, lines, first) + pixels);
            EXPECT_EQ(read_ours(path, header), expected_pixels(32)) << lines;
            EXPECT_TRUE(header.chromaticities.empty());
            // By the way of a probe nothing is undone, either.
            EXPECT_EQ(input::read_probe(path, {input::Projection::latlong}).rgb, expected_pixels(32));
        }
}

TEST(Radiance, XyzeAndPrimariesAreKnown) {
    const Folder folder;
    const std::string path = folder / "a.hdr";
    std::string pixels;
    for (int y = 0; y < kRows; ++y) pixels += new_row(2 * kRows, y);
    write_text(path, head(2 * kRows, "FORMAT=32-bit_rle_xyze\n") + pixels);
    const input::Probe xyz = input::read_probe(path);
    ASSERT_TRUE(xyz.luminance);
    EXPECT_NEAR(xyz.luminance->r, 0.0, 1e-6);
    EXPECT_NEAR(xyz.luminance->g, 1.0, 1e-6);
    EXPECT_EQ(xyz.rgb, expected_pixels(2 * kRows));
    const std::string format = "FORMAT=32-bit_rle_rgbe\n";
    for (const char* usual :
         {"PRIMARIES=0 0 0 0 0 0 0 0\n", "PRIMARIES= 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n", "PRIMARIES=1 2\n",
          "PRIMARIES=none\n"}) {
        write_text(path, head(2 * kRows, format + usual) + pixels);
        EXPECT_FALSE(input::read_probe(path).luminance) << usual;
    }
    write_text(path, head(2 * kRows, format + "PRIMARIES=.713 .293 .165 .83 .128 .044 .32168 .33767\n") + pixels);
    ASSERT_TRUE(input::read_probe(path).luminance);
    EXPECT_NEAR(input::read_probe(path).luminance->r, 0.2722, 1e-3);
}

TEST(Radiance, DamagedRowsAreNotTakenForPixels) {
    const Folder folder;
    const std::string path = folder / "a.hdr";
    std::string good = head(300);
    for (int y = 0; y < kRows; ++y) good += new_row(300, y);
    const std::size_t row = new_row(300, 0).size();
    images::Header header;
    for (std::size_t i = 0; i < 4; ++i) {
        std::string bad = good;
        bad[head(300).size() + 2 * row + i] ^= 1;
        write_text(path, bad);
        EXPECT_TRUE(read_ours(path, header).empty()) << i;
    }
}

} // namespace
