// The reader of images as it is built without OpenImageIO: what it reads, and what it says of all else.
#include "tests/inputs/folder.h"
#include "tests/inputs/write_rgb.h"

#include "images/image_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace acdf::images {
namespace {

using test::Folder;

constexpr int kWidth = 16, kHeight = 2;

std::vector<float> pixels() {
    std::vector<float> rgb;
    for (int i = 0; i < 3 * kWidth * kHeight; ++i) rgb.push_back(0.25f * static_cast<float>(1 + i % 8));
    return rgb;
}

TEST(WithoutOpenImageIO, OpenExrRadianceAndPfmAreRead) {
    const Folder folder;
    for (const char* name : {"a.pfm", "a.hdr", "a.exr"}) {
        test::write_rgb(folder / name, kWidth, kHeight, pixels());
        ImageFile file(folder / name);
        ASSERT_TRUE(file.is_open()) << name << ": " << file.error();
        EXPECT_EQ(file.header().data, (Window{0, 0, kWidth, kHeight})) << name;
        std::vector<float> read(pixels().size());
        const Rows all{0, kHeight, 0, 3, 3 * sizeof(float), 3 * kWidth * sizeof(float)};
        ASSERT_TRUE(file.read(all, read.data())) << file.error();
        for (std::size_t i = 0; i < read.size(); ++i) EXPECT_NEAR(read[i], pixels()[i], 0.02f) << name << " " << i;
    }
}

// As stb, OpenCV and others write Radiance pictures, in rows that are encoded and in some that are not.
TEST(WithoutOpenImageIO, RadianceOfOtherProgramsIsRead) {
    const Folder folder;
    const std::string flat_row(4 * kWidth, '\x80');
    std::string row = {2, 2, 0, kWidth};
    for (int i = 0; i < 4; ++i) row += {static_cast<char>(128 + kWidth), '\x80'};
    for (const char* first : {"#?RADIANCE\n", "#?RGBE\n"})
        for (const std::string& rows : {row + row, row + flat_row, flat_row + row, flat_row + flat_row}) {
            std::ofstream(folder / "a.hdr", std::ios::binary)
                << first << "FORMAT=32-bit_rle_rgbe\n\n-Y 2 +X " << kWidth << "\n"
                << rows;
            ImageFile file(folder / "a.hdr");
            ASSERT_TRUE(file.is_open()) << file.error();
            std::vector<float> read(3 * kWidth * kHeight);
            ASSERT_TRUE(file.read({0, kHeight, 0, 3, 3 * sizeof(float), 3 * kWidth * sizeof(float)}, read.data()));
            EXPECT_EQ(read, std::vector<float>(read.size(), 0.5f));
        }
}

TEST(WithoutOpenImageIO, OtherFormatsAreRefusedWithTheReason) {
    const Folder folder;
    test::write_rgb(folder / "a.tif", kWidth, kHeight, pixels());
    const ImageFile file(folder / "a.tif");
    EXPECT_FALSE(file.is_open());
    EXPECT_NE(file.error().find("without OpenImageIO"), std::string::npos) << file.error();
}

TEST(WithoutOpenImageIO, WhatCannotBeOpenedIsNoMatterOfFormats) {
    const Folder folder;
    const ImageFile file(folder / "none.exr");
    EXPECT_FALSE(file.is_open());
    EXPECT_NE(file.error().find("No such file"), std::string::npos) << file.error();
}

TEST(WithoutOpenImageIO, DamagedFilesAreReportedByTheirOwnReader) {
    const Folder folder;
    const std::string path = folder / "cut.exr";
    test::write_rgb(path, kWidth, kHeight, pixels());
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 9);
    ImageFile file(path);
    std::vector<float> read(pixels().size());
    const Rows all{0, kHeight, 0, 3, 3 * sizeof(float), 3 * kWidth * sizeof(float)};
    EXPECT_FALSE(file.is_open() && file.read(all, read.data()));
    EXPECT_FALSE(file.error().empty());
}

} // namespace
} // namespace acdf::images
