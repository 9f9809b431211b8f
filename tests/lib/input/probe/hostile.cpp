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
    EXPECT_CONTAINS(refusal(folder / "missing.exr"), "No such file");
    EXPECT_CONTAINS(refusal(folder / ""), "folder");
    write_text(folder / "empty.hdr", "");
    EXPECT_CONTAINS(refusal(folder / "empty.hdr"), "empty");
    for (const char* name : {"text.txt", "text.exr", "text.hdr", "text.tif", "text"}) {
        write_text(folder / name, "Dear sir,\nthis is not an image.\n");
        EXPECT_CONTAINS(refusal(folder / name), "no image");
    }
}

TEST(InputHostile, FilesOfOtherKindsAreCalledByTheirNames) {
    const Folder folder;
    write_text(folder / "a", "\xab\x41\x43\x44\x46" + std::string(100, ' '));
    EXPECT_CONTAINS(refusal(folder / "a"), "it is an .acdf file; give the image");
    write_text(folder / "a", "tensor_file" + std::string(100, '\0'));
    EXPECT_CONTAINS(refusal(folder / "a"), "acdf brdf takes");
    // Fields "M" and "wvls", of one dimension each, as a .pbsdf has them: brdf refuses it as well.
    write_text(folder / "a", "tensor_file\0\1\0\2\0\0\0"s + "\1\0M\1\0\12"s + std::string(16, '\0') +
                                 "\4\0wvls\1\0\12"s + std::string(16, '\0'));
    EXPECT_CONTAINS(refusal(folder / "a"), "a polarised BRDF of the RGL database, which acdf does not read");
    write_text(folder / "a", "\x93NUMPY" + std::string(100, '\0'));
    EXPECT_CONTAINS(refusal(folder / "a"), "acdf table takes");
    write_text(folder / "a", "\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"s);
    std::filesystem::resize_file(folder / "a", MerlLayout::bytes);
    EXPECT_CONTAINS(refusal(folder / "a"), "MERL BRDF");
}

std::vector<std::string> sample_files(const Folder& folder) {
    const Pixels sky = latlong_sky(64);
    OIIO::ImageSpec tiled = rgb_spec(sky);
    tiled.tile_width = tiled.tile_height = 16;
    write_rgb(folder / "a.exr", sky, OIIO::TypeDesc::HALF);
    write_image(folder / "tiled.exr", tiled, sky.rgb);
    write_rgb(folder / "a.hdr", sky);
    write_rgb(folder / "a.tif", sky);
    return {"a.exr", "tiled.exr", "a.hdr", "a.tif"};
}

TEST(InputHostile, TruncatedAnywhere) {
    const Folder folder;
    for (const std::string& name : sample_files(folder)) {
        const std::string bytes = read_text(folder / name);
        ASSERT_NO_THROW(read_probe(folder / name)) << name;
        for (const std::size_t length :
             {std::size_t{1}, std::size_t{4}, std::size_t{11}, std::size_t{60}, std::size_t{200}, bytes.size() / 4,
              bytes.size() / 2, bytes.size() * 3 / 4, bytes.size() - 100, bytes.size() - 1}) {
            write_text(folder / ("cut_" + name), bytes.substr(0, length));
            EXPECT_NE(refusal(folder / ("cut_" + name)), "")
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
        write_text(folder / name, bytes);
        EXPECT_CONTAINS(refusal(folder / name), "no image");
        // With a good start.
        const std::string good = read_text(folder / (sample_files(folder)[0]));
        write_text(folder / name, good.substr(0, 8) + bytes);
        EXPECT_NE(refusal(folder / name), "");
    }
}

TEST(InputHostile, AbsurdSizesAreRefusedBeforeAllocating) {
    const Folder folder;
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    write_text(folder / "huge.hdr", head + "-Y 60000 +X 120000\n" + std::string(1000, '\x02'));
    EXPECT_CONTAINS(refusal(folder / "huge.hdr"), "2^30");
    write_text(folder / "large.hdr", head + "-Y 20000 +X 40000\n" + std::string(1000, '\x02'));
    EXPECT_CONTAINS(refusal(folder / "large.hdr"), "claims");
    write_text(folder / "negative.hdr", head + "-Y -4 +X 8\n" + std::string(1000, '\x02'));
    EXPECT_NE(refusal(folder / "negative.hdr"), "");

    // OpenEXR's windows, patched: 4 int32 each after the attribute's name, type and size.
    sample_files(folder);
    const std::string exr = read_text(folder / "a.exr");
    for (const char* window : {"dataWindow", "displayWindow"}) {
        std::string bytes = exr;
        const std::size_t at = bytes.find(window);
        ASSERT_NE(at, std::string::npos);
        const std::size_t box = at + std::string(window).size() + 1 + std::string("box2i").size() + 1 + 4;
        for (const std::size_t high : {box + 8, box + 12})
            bytes.replace(high, 4, std::string("\xff\xff\x0f\x00", 4)); // 2^20 - 1
        write_text(folder / "window.exr", bytes);
        EXPECT_NE(refusal(folder / "window.exr"), "") << window;
    }
}

// Every damaged file is either read (the damage is in pixels or notes) or refused in one line.
TEST(InputHostile, FlippedBytes) {
    const Folder folder;
    std::mt19937 random(23);
    for (const std::string& name : sample_files(folder)) {
        const std::string good = read_text(folder / name);
        const std::string path = folder / ("flipped_" + name);
        int refused = 0;
        const int times = acdf_test::kSanitized ? 60 : 200; // most of what they meet is OpenImageIO
        for (int i = 0; i < times; ++i) {
            std::string bytes = good;
            const std::size_t range =
                i % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400); // headers break most
            bytes[random() % range] = static_cast<char>(random());
            write_text(path, bytes);
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
