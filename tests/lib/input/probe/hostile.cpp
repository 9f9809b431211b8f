// Files that are damaged, cut short or no images: one clear line each, never a crash or half a probe.
#include "input/brdf/merl.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace {

using namespace acdf::input;
using namespace acdf::test;
using namespace std::string_literals;

TEST(InputHostile, NoFileFolderEmptyText) {
    const Folder folder;
    EXPECT_CONTAINS(refusal(folder.file("missing.exr")), "No such file");
    EXPECT_CONTAINS(refusal(folder.file("")), "folder");
    write_bytes(folder.file("empty.hdr"), "");
    EXPECT_CONTAINS(refusal(folder.file("empty.hdr")), "empty");
    for (const char* name : {"text.txt", "text.exr", "text.hdr", "text.tif", "text"}) {
        write_bytes(folder.file(name), "Dear sir,\nthis is not an image.\n");
        EXPECT_CONTAINS(refusal(folder.file(name)), "no image");
    }
}

TEST(InputHostile, FilesOfOtherKindsAreCalledByTheirNames) {
    const Folder folder;
    write_bytes(folder.file("a"), "\xab\x41\x43\x44\x46" + std::string(100, ' '));
    EXPECT_CONTAINS(refusal(folder.file("a")), "it is an .acdf file; give the image");
    write_bytes(folder.file("a"), "tensor_file" + std::string(100, '\0'));
    EXPECT_CONTAINS(refusal(folder.file("a")), "acdf brdf takes");
    write_bytes(folder.file("a"), "\x93NUMPY" + std::string(100, '\0'));
    EXPECT_CONTAINS(refusal(folder.file("a")), "acdf table takes");
    write_bytes(folder.file("a"), "\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"s);
    std::filesystem::resize_file(folder.file("a"), MerlLayout::bytes);
    EXPECT_CONTAINS(refusal(folder.file("a")), "MERL BRDF");
}

std::vector<std::string> sample_files(const Folder& folder) {
    const Pixels sky = latlong_sky(64);
    OIIO::ImageSpec tiled = rgb_spec(sky);
    tiled.tile_width = tiled.tile_height = 16;
    write_rgb(folder.file("a.exr"), sky, OIIO::TypeDesc::HALF);
    write_image(folder.file("tiled.exr"), tiled, sky.rgb);
    write_rgb(folder.file("a.hdr"), sky);
    write_rgb(folder.file("a.tif"), sky);
    return {"a.exr", "tiled.exr", "a.hdr", "a.tif"};
}

TEST(InputHostile, TruncatedAnywhere) {
    const Folder folder;
    for (const std::string& name : sample_files(folder)) {
        const std::string bytes = read_bytes(folder.file(name));
        ASSERT_NO_THROW(read_probe(folder.file(name))) << name;
        for (const std::size_t length :
             {std::size_t{1}, std::size_t{4}, std::size_t{11}, std::size_t{60}, std::size_t{200}, bytes.size() / 4,
              bytes.size() / 2, bytes.size() * 3 / 4, bytes.size() - 100, bytes.size() - 1}) {
            write_bytes(folder.file("cut_" + name), bytes.substr(0, length));
            EXPECT_NE(refusal(folder.file("cut_" + name)), "")
                << name << " cut to " << length << " of " << bytes.size();
        }
    }
}

TEST(InputHostile, Garbage) {
    const Folder folder;
    std::mt19937 random(17);
    for (const char* name : {"garbage.exr", "garbage.hdr", "garbage.tif", "garbage.tx"}) {
        std::string bytes(5000, '\0');
        for (char& c : bytes) c = static_cast<char>(random());
        write_bytes(folder.file(name), bytes);
        EXPECT_CONTAINS(refusal(folder.file(name)), "no image");
        // With a good start.
        const std::string good = read_bytes(folder.file(sample_files(folder)[0]));
        write_bytes(folder.file(name), good.substr(0, 8) + bytes);
        EXPECT_NE(refusal(folder.file(name)), "");
    }
}

TEST(InputHostile, AbsurdSizesAreRefusedBeforeAllocating) {
    const Folder folder;
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    write_bytes(folder.file("huge.hdr"), head + "-Y 60000 +X 120000\n" + std::string(1000, '\x02'));
    EXPECT_CONTAINS(refusal(folder.file("huge.hdr")), "2^30");
    write_bytes(folder.file("large.hdr"), head + "-Y 20000 +X 40000\n" + std::string(1000, '\x02'));
    EXPECT_CONTAINS(refusal(folder.file("large.hdr")), "claims");
    write_bytes(folder.file("negative.hdr"), head + "-Y -4 +X 8\n" + std::string(1000, '\x02'));
    EXPECT_NE(refusal(folder.file("negative.hdr")), "");

    // OpenEXR's windows, patched: 4 int32 each after the attribute's name, type and size.
    sample_files(folder);
    const std::string exr = read_bytes(folder.file("a.exr"));
    for (const char* window : {"dataWindow", "displayWindow"}) {
        std::string bytes = exr;
        const std::size_t at = bytes.find(window);
        ASSERT_NE(at, std::string::npos);
        const std::size_t box = at + std::string(window).size() + 1 + std::string("box2i").size() + 1 + 4;
        for (const std::size_t high : {box + 8, box + 12})
            bytes.replace(high, 4, std::string("\xff\xff\x0f\x00", 4)); // 2^20 - 1
        write_bytes(folder.file("window.exr"), bytes);
        EXPECT_NE(refusal(folder.file("window.exr")), "") << window;
    }
}

// Every damaged file is either read (the damage is in pixels or notes) or refused in one line.
TEST(InputHostile, FlippedBytes) {
    const Folder folder;
    std::mt19937 random(23);
    for (const std::string& name : sample_files(folder)) {
        const std::string good = read_bytes(folder.file(name));
        const std::string path = folder.file("flipped_" + name);
        int refused = 0;
        const int times = acdf_test::kSanitized ? 60 : 200; // most of what they meet is OpenImageIO
        for (int i = 0; i < times; ++i) {
            std::string bytes = good;
            const std::size_t range =
                i % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400); // headers break most
            bytes[random() % range] = static_cast<char>(random());
            write_bytes(path, bytes);
            try {
                ProbeOptions options;
                options.threads = 1;
                const Probe probe = read_probe(path, options);
                ASSERT_EQ(probe.rgb.size(), static_cast<std::size_t>(3 * probe.width * probe.height));
                for (const float v : probe.rgb) ASSERT_TRUE(v >= 0.0f && std::isfinite(v));
            } catch (const Error& error) {
                ++refused;
                ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            }
        }
        EXPECT_GT(refused, 0) << name;
    }
}

} // namespace
