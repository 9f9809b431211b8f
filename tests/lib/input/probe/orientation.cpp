// Images that are stored turned or mirrored are read upright.
#include "input/probe/image_header.h"
#include "tests/inputs/paths.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <functional>

namespace {

using namespace acdf::input;
using namespace acdf::test;

constexpr int kStoredWidth = 32, kStoredHeight = 16;

/// No two texels of it are alike.
Pixels upright() {
    Pixels pixels{kStoredWidth, kStoredHeight, std::vector<float>(std::size_t{3} * kStoredWidth * kStoredHeight)};
    for (int y = 0; y < kStoredHeight; ++y)
        for (int x = 0; x < kStoredWidth; ++x) {
            float* const rgb = pixels.at(x, y);
            rgb[0] = 0.5f + static_cast<float>(x) / 64.0f; // numbers that .hdr files hold exactly
            rgb[1] = 0.5f + static_cast<float>(y) / 64.0f;
            rgb[2] = 0.25f;
        }
    return pixels;
}

/// Orientation `number` of TIFF: where on the upright image the first row and the first column are seen.
struct Turn {
    int number;
    const char* first_row;
    const char* first_column;
    const char* radiance; ///< the same as a .hdr file's header says it
};

const Turn turns[] = {{1, "top", "left", "-Y 16 +X 32"},     {2, "top", "right", "-Y 16 -X 32"},
                      {3, "bottom", "right", "+Y 16 -X 32"}, {4, "bottom", "left", "+Y 16 +X 32"},
                      {5, "left", "top", "+X 32 -Y 16"},     {6, "right", "top", "-X 32 -Y 16"},
                      {7, "right", "bottom", "-X 32 +Y 16"}, {8, "left", "bottom", "+X 32 +Y 16"}};

/// What is seen `i` steps from a side of the upright image.
void step_from(const std::string& side, int i, int& x, int& y) {
    if (side == "left") x = i;
    else if (side == "right") x = kStoredWidth - 1 - i;
    else if (side == "top") y = i;
    else y = kStoredHeight - 1 - i;
}

Pixels stored(const Turn& turn) {
    const Pixels image = upright();
    const bool rows = turn.number < 5;
    Pixels out{rows ? kStoredWidth : kStoredHeight, rows ? kStoredHeight : kStoredWidth,
               std::vector<float>(image.rgb.size())};
    for (int row = 0; row < out.height; ++row)
        for (int column = 0; column < out.width; ++column) {
            int x = 0, y = 0;
            step_from(turn.first_row, row, x, y);
            step_from(turn.first_column, column, x, y);
            std::copy_n(image.at(x, y), 3, out.at(column, row));
        }
    return out;
}

void expect_upright(const std::string& path, const Turn& turn) {
    SCOPED_TRACE(path + " " + turn.radiance);
    const ImageSize size = image_size(path);
    EXPECT_EQ(size.width, kStoredWidth);
    EXPECT_EQ(size.height, kStoredHeight);
    const Probe probe = read_probe(path);
    ASSERT_EQ(probe.width, kStoredWidth);
    ASSERT_EQ(probe.height, kStoredHeight);
    EXPECT_EQ(probe.source_width, kStoredWidth);
    EXPECT_EQ(probe.rgb, upright().rgb);
    ASSERT_EQ(probe.warnings.size(), turn.number == 1 ? 0u : 1u);
    if (turn.number != 1) {
        EXPECT_CONTAINS(probe.warnings[0], "orientation " + std::to_string(turn.number));
    }
}

TEST(InputOrientation, AllEightOfTiffAndOpenExr) {
    const Folder folder;
    for (const Turn& turn : turns)
        for (const char* const name : {"a.tif", "a.exr"}) {
            const Pixels pixels = stored(turn);
            OIIO::ImageSpec spec = rgb_spec(pixels);
            spec.attribute("Orientation", turn.number);
            write_image(folder / name, spec, pixels.rgb);
            expect_upright(folder / name, turn);
        }
}

TEST(InputOrientation, AllEightOfRadiance) {
    const Folder folder;
    for (const Turn& turn : turns) {
        const Pixels pixels = stored(turn);
        write_rgb(folder / "a.hdr", pixels);
        const std::string usual = read_text(folder / "a.hdr");
        const std::string rows = usual.substr(usual.find('\n', usual.find("\n-Y ") + 1) + 1);
        // The second header has what only OpenImageIO reads.
        for (const char* const more : {"", "COLORCORR=1 1 1\n"}) {
            write_text(folder / "a.hdr", std::string("#?RADIANCE\n") + more + "FORMAT=32-bit_rle_rgbe\n\n" +
                                             turn.radiance + "\n" + rows);
            expect_upright(folder / "a.hdr", turn);
        }
    }
}

TEST(InputOrientation, WhatIsNoneIsUpright) {
    const Folder folder;
    OIIO::ImageSpec spec = rgb_spec(upright());
    spec.attribute("Orientation", 9);
    write_image(folder / "a.exr", spec, upright().rgb);
    expect_upright(folder / "a.exr", turns[0]);
}

TEST(InputOrientation, BadTexelsAreLocatedInTheUprightImage) {
    const Folder folder;
    Pixels pixels = stored(turns[5]);
    pixels.at(3, 30)[1] = -1.0f; // the right side from above: row 30 from the right is column 1 from the left
    OIIO::ImageSpec spec = rgb_spec(pixels);
    spec.attribute("Orientation", 6);
    write_image(folder / "a.tif", spec, pixels.rgb);
    const Probe probe = read_probe(folder / "a.tif");
    EXPECT_EQ(probe.bad.x, 1);
    EXPECT_EQ(probe.bad.y, 3);
}

TEST(InputOrientation, DataWindowsAreThoseOfTheStoredImage) {
    const Folder folder;
    const Pixels pixels = stored(turns[4]); // 16 x 32
    OIIO::ImageSpec spec(kStoredHeight, kStoredWidth - 8, 3, OIIO::TypeDesc::FLOAT);
    spec.y = 8; // the eight columns at the left are missing
    spec.full_width = kStoredHeight;
    spec.full_height = kStoredWidth;
    spec.attribute("Orientation", 5);
    write_image(folder / "a.exr", spec,
                {pixels.at(0, 8), pixels.at(0, 8) + 3 * kStoredHeight * (kStoredWidth - 8)});
    const Probe probe = read_probe(folder / "a.exr");
    ASSERT_EQ(probe.width, kStoredWidth);
    for (int y = 0; y < kStoredHeight; ++y)
        for (int x = 0; x < kStoredWidth; ++x)
            EXPECT_EQ(probe.rgb[3 * static_cast<std::size_t>(y * kStoredWidth + x)],
                      x < 8 ? 0.0f : upright().at(x, y)[0]);
}

} // namespace
