// What lies where a file should: pointers of Git LFS, web pages, converted line ends, photographs with gain maps.
#include "input/stand_in.h"
#include "input/brdf/brdf.h"
#include "input/line_ends.h"
#include "input/mesh/triangles.h"
#include "input/normals/scene.h"
#include "input/npy.h"
#include "tests/inputs/float_map.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

namespace {

using namespace acdf::input;
using namespace acdf::test;
using namespace std::string_literals;

const std::string kPointer =
    "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, '0') + "\nsize 1234567\n";

std::string refusal_of(const std::function<void()>& read) {
    try {
        read();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "it was read";
    return {};
}

/// Each kind of input, by the name of a file that is read so.
std::string refusal_of_any(const std::string& path) {
    const std::string end = path.substr(path.rfind('.') + 1);
    return refusal_of([&] {
        if (end == "npy") read_npy(path, {});
        else if (end == "binary" || end == "bsdf") open_brdf(path);
        else if (end == "obj" || end == "ply" || end == "instances") read_triangles(path, UpAxis::z);
        else if (end == "txt") read_scene_normals(path, {});
        else read_probe(path);
    });
}

constexpr const char* kNames[] = {"a.exr",    "a.hdr",  "a.pfm", "a.png", "a.tif",       "a.npy",
                                  "a.binary", "a.bsdf", "a.obj", "a.ply", "a.instances", "a.txt"};

TEST(StandIns, PointersAreNamed) {
    const Folder folder;
    for (const char* name : kNames) {
        write_text(folder / name, kPointer);
        EXPECT_CONTAINS(refusal_of_any(folder / name), "a Git LFS pointer, not the file itself");
        write_text(folder / name, "/annex/objects/SHA256E-s1--00.exr\n");
        EXPECT_CONTAINS(refusal_of_any(folder / name), "a git-annex pointer");
    }
}

TEST(StandIns, WebPagesAreNamed) {
    const Folder folder;
    for (const char* name : kNames)
        for (const char* page :
             {"<!DOCTYPE html><html><body>404</body></html>", "<!doctype html>\n", "\n\n  <html>", "<HTML>",
              "\xEF\xBB\xBF<!DOCTYPE html>", "<?xml version=\"1.0\"?><Error/>", "<!-- page --><html>"}) {
            write_text(folder / name, page);
            EXPECT_CONTAINS(refusal_of_any(folder / name), "a web page");
        }
}

/// As Git does it.
std::string to_crlf(const std::string& bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (bytes[i] == '\n' && (i == 0 || bytes[i - 1] != '\r')) out += '\r';
        out += bytes[i];
    }
    return out;
}
std::string to_lf(const std::string& bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != '\r' || i + 1 == bytes.size() || bytes[i + 1] != '\n') out += bytes[i];
    return out;
}

/// A sky whose bytes have line ends among them.
Pixels noisy_sky() {
    Pixels sky = latlong_sky(64);
    std::mt19937 random(3);
    for (float& v : sky.rgb) v *= 1.0f + static_cast<float>(random() % 1000) / 2000.0f;
    // CR LF and LF among their bytes.
    const std::uint32_t bits = 0x400E0A0D, alone = 0x400A0E0E;
    for (std::size_t i = 0; i < sky.rgb.size(); i += 40) std::memcpy(&sky.rgb[i], i % 80 ? &bits : &alone, 4);
    return sky;
}

std::string write_ply(const std::string& path) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 30\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face 10\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 90; ++i) {
        const float v = static_cast<float>(i * i % 17);
        bytes.append(reinterpret_cast<const char*>(&v), 4);
    }
    for (int i = 0; i < 10; ++i) {
        bytes += '\3';
        for (int k = 0; k < 3; ++k) {
            const int v = 3 * i + k;
            bytes.append(reinterpret_cast<const char*>(&v), 4);
        }
    }
    write_text(path, bytes);
    return bytes;
}

TEST(StandIns, ConvertedLineEndsAreNamed) {
    const Folder folder;
    const Pixels sky = noisy_sky();
    write_rgb(folder / "a.exr", sky, OIIO::TypeDesc::FLOAT);
    write_rgb(folder / "a.hdr", sky);
    write_rgb(folder / "a.tif", sky);
    write_float_map(folder / "a.pfm", sky.width, sky.height, sky.rgb);
    write_ply(folder / "a.ply");
    std::string npy = "\x93NUMPY\1\0\x76\0{'descr': '<f4', 'fortran_order': False, 'shape': (6144,), }"s;
    npy.resize(127, ' ');
    npy += '\n';
    npy.append(reinterpret_cast<const char*>(sky.rgb.data()), 4 * 6144);
    write_text(folder / "a.npy", npy);
    for (const char* name : {"a.exr", "a.hdr", "a.tif", "a.pfm", "a.ply", "a.npy"}) {
        const std::string path = folder / name, good = read_text(path);
        EXPECT_NO_THROW(refuse_converted_line_ends(path)) << name;
        write_text(path, to_crlf(good));
        EXPECT_CONTAINS(refusal_of_any(path), "line ends were converted");
        const std::string shorter = to_lf(good);
        if (std::string(name) != "a.pfm" && std::string(name) != "a.npy") continue; // others may have none
        write_text(path, shorter);
        EXPECT_CONTAINS(refusal_of_any(path), "line ends were converted");
    }
}

// What is text may have any line ends, and so may the text before pixels.
TEST(StandIns, LineEndsOfTextAreLeftAlone) {
    const Folder folder;
    write_text(folder / "a.obj", to_crlf("# \xC3\xA4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    EXPECT_EQ(read_triangles(folder / "a.obj", UpAxis::z).count(), 1u);
    write_text(folder / "a.txt", to_crlf("# \xC3\xA4\n0 0 1\n0 1 0\n"));
    EXPECT_NO_THROW(read_scene_normals(folder / "a.txt", {}));
    std::string map = "PF\r\n4 2\r\n-1.0\r\n" + std::string(96, '\x3F');
    write_text(folder / "a.pfm", map);
    EXPECT_NO_THROW(read_probe(folder / "a.pfm"));
    map[map.size() - 5] = '\n';
    write_text(folder / "a.pfm", map);
    EXPECT_NO_THROW(read_probe(folder / "a.pfm"));
}

TEST(StandIns, GainMapsAreNamed) {
    const Folder folder;
    write_rgb(folder / "a.jpg", latlong_sky(64), OIIO::TypeDesc::UINT8);
    EXPECT_NO_THROW(read_probe(folder / "a.jpg"));
    const std::string good = read_text(folder / "a.jpg");
    const auto segment = [](char marker, const std::string& content) {
        const std::size_t size = content.size() + 2;
        return "\xFF"s + marker + static_cast<char>(size >> 8) + static_cast<char>(size & 255) + content;
    };
    const std::string xmp =
        "http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/"
        "1.0/\" hdrgm:Version=\"1.0\"/>"s;
    for (const std::string& added :
         {segment('\xE1', xmp), segment('\xE2', "urn:iso:std:iso:ts:21496:-1\0\0\0\0\0"s),
          segment('\xE1', "http://ns.adobe.com/xap/1.0/\0<a b=\"http://ns.apple.com/HDRGainMap/1.0/\"/>"s)}) {
        write_text(folder / "a.jpg", good.substr(0, 2) + added + good.substr(2));
        EXPECT_CONTAINS(refusal(folder / "a.jpg"), "gain map");
        // In the second image alone, behind the first.
        write_text(folder / "a.jpg", good + good.substr(0, 2) + added + good.substr(2));
        EXPECT_CONTAINS(refusal(folder / "a.jpg"), "gain map");
    }
}

} // namespace
