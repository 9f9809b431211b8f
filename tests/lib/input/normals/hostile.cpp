// Scenes that are damaged, cut short or no scenes: one clear line each, never a crash.
#include "tests/inputs/sanitized.h"
#include "tests/lib/input/write.h"

#include "input/normals/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

/// The library that reads meshes forgets some of what it made before it found that a file is broken. (Asked by
/// sanitizers.)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }

namespace {

using namespace acdf::input;
using namespace acdf::test;

/// The message that reading `path` throws; "" where it is read, and the result is sound.
std::string scene_refusal(const std::string& path) {
    try {
        const SceneNormals scene = read_scene_normals(path);
        EXPECT_FALSE(scene.normals.empty());
        for (const WeightedNormal& w : scene.normals) {
            EXPECT_NEAR(length(Vec{w.n[0], w.n[1], w.n[2]}), 1.0, 1e-6);
            EXPECT_TRUE(w.weight > 0.0 && std::isfinite(w.weight));
        }
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_EQ(text.rfind(path, 0), 0u) << "the file is not named first: " << text;
        return text;
    }
    return {};
}

std::string refusal_of(const Folder& folder, const std::string& name, const std::string& bytes) {
    write_text(folder / name, bytes);
    return scene_refusal(folder / name);
}

TEST(SceneHostile, NoSceneAtAll) {
    const Folder folder;
    EXPECT_CONTAINS(scene_refusal(folder / "missing.obj"), "No such file");
    EXPECT_CONTAINS(scene_refusal(folder / ""), "folder");
    for (const char* name : {"a.obj", "a.ply", "a.exr", "a.txt"})
        EXPECT_CONTAINS(refusal_of(folder, name, ""), "empty");
    for (const char* name : {"a.obj", "a.ply", "a.exr", "a.txt", "a.fbx", "a"})
        EXPECT_NE(refusal_of(folder, name, "Dear sir,\nthis is not a scene.\n"), "") << name;
    EXPECT_CONTAINS(refusal_of(folder, "a.fbx", "Dear sir"), "neither a mesh");
}

TEST(SceneHostile, Lists) {
    const Folder folder;
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1\n1 0\n"), "line 2");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1 1 1\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1x\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "\n\n0 0 1 -1\n"), "line 3 has a weight");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1 nan\n"), "weight");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1 1e40\n"), "weight");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1e999\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "0 0 1 " + std::string(5000, ' ') + "\n"), "line 1 is longer");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", std::string("0 0\0 1\n", 7)), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "a.txt", "# nothing\n0 0 0\n"), "no normals (1 are");
}

TEST(SceneHostile, NormalPasses) {
    const Folder folder;
    OIIO::ImageSpec spec(4, 2, 3, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"N.X", "N.Y", "N.Z"};
    write_image(folder / "black.exr", spec, std::vector<float>(24, 0.0f));
    EXPECT_CONTAINS(scene_refusal(folder / "black.exr"), "no normals (8 are");
    spec.channelnames = {"N.X", "N.Y", "depth"};
    write_image(folder / "two.exr", spec, std::vector<float>(24, 1.0f));
    EXPECT_CONTAINS(scene_refusal(folder / "two.exr"), "N.Z");
    spec.channelnames = {"N.X", "N.Y", "N.Z"};
    spec.format = OIIO::TypeDesc::UINT32;
    write_image(folder / "integers.exr", spec, std::vector<float>(24, 1.0f));
    EXPECT_CONTAINS(scene_refusal(folder / "integers.exr"), "integers");
}

TEST(SceneHostile, Meshes) {
    const Folder folder;
    EXPECT_NE(refusal_of(folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "");       // no face
    EXPECT_NE(refusal_of(folder, "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9999999\n"), ""); // no such vertex
    EXPECT_NE(refusal_of(folder, "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 -9\n"), "");
    EXPECT_NE(refusal_of(folder, "a.obj", "v nan nan nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "");
    EXPECT_NE(refusal_of(folder, "a.obj", "v 1e38 0 0\nv 1e39 0 0\nv 0 inf 0\nf 1 2 3\n"), "");
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_CONTAINS(
        refusal_of(folder, "a.ply", start + "element vertex 4000000000\nproperty float x\nend_header\n"), "claims");
    EXPECT_CONTAINS(refusal_of(folder, "a.ply", start + "element vertex -1\nproperty float x\nend_header\n"),
                    "claims");
    EXPECT_CONTAINS(refusal_of(folder, "a.ply", start + "element vertex 3\n"), "does not end");
    EXPECT_NE(refusal_of(folder, "a.ply", start + "end_header\n"), "");
}

/// A list of as many corners as `length` says, of a file of some hundred bytes.
std::string ply_of_a_list(const std::string& format, const std::string& type, const std::string& length) {
    std::string bytes = "ply\nformat " + format +
                        " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 1\nproperty list " +
                        type + " int vertex_indices\nend_header\n";
    if (format == "ascii") return bytes + "0 0 0\n1 0 0\n0 1 0\n" + length + " 0 1 2\n";
    const float vertices[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::int32_t corners[3] = {0, 1, 2};
    bytes.append(reinterpret_cast<const char*>(vertices), sizeof vertices) += length;
    return bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
}

TEST(SceneHostile, PlyListsAreNoLongerThanTheFile) {
    const Folder folder;
    const auto told = [&](const std::string& format, const std::string& type, const std::string& length) {
        return refusal_of(folder, "a.ply", ply_of_a_list(format, type, length));
    };
    const std::string little = "binary_little_endian", big = "binary_big_endian", zeros(3, '\0');
    EXPECT_EQ(told("ascii", "uint", "3"), "");
    EXPECT_EQ(told(little, "uint", "\3" + zeros), "");
    EXPECT_EQ(told(little, "char", "\3"), "");
    EXPECT_CONTAINS(told("ascii", "uint", "3000000000"), "a list in it claims");
    EXPECT_CONTAINS(told("ascii", "int", "-1"), "a list in it claims");
    EXPECT_CONTAINS(told(little, "uint", zeros + "\xB0"), "a list in it claims");
    EXPECT_CONTAINS(told(little, "int", zeros + "\xB0"), "a list in it claims");
    EXPECT_CONTAINS(told(little, "char", "\xFF"), "a list in it claims");
    EXPECT_CONTAINS(told(big, "uint", "\x70" + zeros), "a list in it claims");
    EXPECT_CONTAINS(told(little, "float", zeros + "\x40"), "of a type that PLY does not have");
}

struct Sample {
    std::string name, bytes;
};

std::vector<Sample> samples(const Folder& folder) {
    std::vector<Sample> all;
    all.push_back({"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
                            "o b\nv 3 3 3\nf -1 1 2\nl 1 2\n"});
    const std::string head = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    all.push_back({"ascii.ply", "ply\nformat ascii 1.0\n" + head + "0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n"});
    std::string binary = "ply\nformat binary_little_endian 1.0\n" + head;
    const float vertices[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::int32_t corners[4] = {0, 1, 2, 3};
    binary.append(reinterpret_cast<const char*>(vertices), sizeof vertices);
    binary += '\x04';
    binary.append(reinterpret_cast<const char*>(corners), sizeof corners);
    all.push_back({"binary.ply", binary});
    OIIO::ImageSpec spec(40, 30, 3, OIIO::TypeDesc::HALF);
    spec.channelnames = {"N.X", "N.Y", "N.Z"};
    write_image(folder / "n.exr", spec, std::vector<float>(3600, 0.5f));
    all.push_back({"n.exr", read_text(folder / "n.exr")});
    all.push_back({"a.csv", "0,0,1\n1,0,0,2\n# end\n"});
    return all;
}

TEST(SceneHostile, TruncatedAnywhere) {
    const Folder folder;
    for (const Sample& sample : samples(folder)) {
        EXPECT_EQ(refusal_of(folder, sample.name, sample.bytes), "");
        for (std::size_t length = 0; length < sample.bytes.size(); length += 1 + sample.bytes.size() / 100)
            refusal_of(folder, sample.name, sample.bytes.substr(0, length));
    }
}

// An importer takes what is left of a PLY file: a mesh with holes, where the positions that it hides light from are
// others.
TEST(SceneHostile, PlyFilesThatAreCutShortAreRefused) {
    const Folder folder;
    for (const Sample& sample : samples(folder)) {
        if (sample.name.find(".ply") == std::string::npos) continue;
        // In a text only the last line's last number may lose digits unnoticed, or the end of its line.
        const std::size_t lost = sample.name == "ascii.ply" ? 2 : 1;
        for (std::size_t length = 0; length + lost <= sample.bytes.size(); ++length)
            EXPECT_NE(refusal_of(folder, sample.name, sample.bytes.substr(0, length)), "") << length;
    }
}

TEST(SceneHostile, LinesOfPlyFilesAreWhole) {
    const Folder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
    const auto told = [&](const std::string& rest) { return refusal_of(folder, "a.ply", head + rest); };
    EXPECT_EQ(told("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0"), "");
    EXPECT_EQ(told("0 0 0\n1 0 0\n\n0 1 0\n \r\n3 0 1 2\n3 2 1 0\n\n"), ""); // the importer skips blank lines
    EXPECT_CONTAINS(told("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "ends before the elements");
    EXPECT_CONTAINS(told("0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 2 1 0\n"), "ends before the elements");
    EXPECT_CONTAINS(told("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1\n"), "fewer numbers");
    EXPECT_CONTAINS(told("0 0 0\n1 0\n0 1 0\n3 0 1 2\n3 2 1 0\n"), "fewer numbers");
}

TEST(SceneHostile, FlippedBytes) {
    const Folder folder;
    std::mt19937 random(29);
    for (const Sample& sample : samples(folder)) {
        int refused = 0;
        for (int i = 0; i < (acdf_test::kSanitized ? 60 : 200); ++i) { // a fuzzer goes on from there
            std::string bytes = sample.bytes;
            for (auto flips = 1 + random() % 3; flips > 0; --flips)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            refused += !refusal_of(folder, sample.name, bytes).empty();
        }
        EXPECT_GT(refused, 0) << sample.name;
    }
}

} // namespace
