// Normals of scenes: meshes, normal passes and lists, written here; directions and weights checked by hand.
#include "tests/lib/input/write.h"

#include "input/normals/scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace acdf::input;
using namespace acdf::test;

double total_weight(const SceneNormals& scene) {
    double sum = 0.0;
    for (const WeightedNormal& w : scene.normals) sum += w.weight;
    return sum;
}

/// The weight of the normals within about 1e-3 of (x, y, z).
double weight_of(const SceneNormals& scene, double x, double y, double z) {
    double sum = 0.0;
    for (const WeightedNormal& w : scene.normals)
        if (length(Vec{w.n[0], w.n[1], w.n[2]} - Vec{x, y, z}) < 1e-3) sum += w.weight;
    return sum;
}

void expect_unit(const SceneNormals& scene) {
    for (const WeightedNormal& w : scene.normals) {
        EXPECT_NEAR(length(Vec{w.n[0], w.n[1], w.n[2]}), 1.0, 1e-6);
        EXPECT_GT(w.weight, 0.0);
    }
}

// A box 1 x 2 x 3 of quads, wound counterclockwise as seen from outside.
const char* const kBox = "# a box\nmtllib elsewhere.mtl\n"
                         "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
                         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

TEST(SceneNormals, FacesOfABoxByArea) {
    const Folder folder;
    write_text(folder / "box.obj", kBox);
    const SceneNormals scene = read_scene_normals(folder / "box.obj");
    EXPECT_EQ(scene.kind, "mesh");
    EXPECT_EQ(scene.skipped, 0u);
    EXPECT_EQ(scene.normals.size(), 6u);
    expect_unit(scene);
    for (const double s : {-1.0, 1.0}) {
        EXPECT_NEAR(weight_of(scene, s, 0, 0), 6.0, 1e-6);
        EXPECT_NEAR(weight_of(scene, 0, s, 0), 3.0, 1e-6);
        EXPECT_NEAR(weight_of(scene, 0, 0, s), 2.0, 1e-6);
    }
}

TEST(SceneNormals, ConcavePolygon) {
    const Folder folder;
    write_text(folder / "l.obj", "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 3 0 0\nv 3 1 0\nf 3 4 5 6 1 2\n");
    const SceneNormals scene = read_scene_normals(folder / "l.obj");
    EXPECT_EQ(scene.normals.size(), 1u);
    EXPECT_NEAR(weight_of(scene, 0, 0, 1), 4.0, 1e-6);
}

TEST(SceneNormals, YUpIsTurned) {
    const Folder folder;
    write_text(folder / "floor.OBJ", "v 0 0 0\nv 0 0 4\nv 4 0 0\nf 1 2 3\n"   // +y, area 8
                                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 4 5 6\n"   // +z, area 1/2
                                     "v 0 0 0\nv 0 2 0\nv 0 0 1\nf 7 8 9\n"); // +x, area 1
    const SceneNormals scene = read_scene_normals(folder / "floor.OBJ", {UpAxis::y, false});
    EXPECT_NEAR(weight_of(scene, 0, 0, 1), 8.0, 1e-6);
    EXPECT_NEAR(weight_of(scene, 1, 0, 0), 0.5, 1e-6);
    EXPECT_NEAR(weight_of(scene, 0, 1, 0), 1.0, 1e-6);
    EXPECT_NEAR(weight_of(read_scene_normals(folder / "floor.OBJ"), 0, 1, 0), 8.0, 1e-6);
}

TEST(SceneNormals, TrianglesWithoutAreaAreSkipped) {
    const Folder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 1\n");
    const SceneNormals scene = read_scene_normals(folder / "a.obj");
    EXPECT_NEAR(total_weight(scene), 0.5, 1e-9);
    EXPECT_EQ(scene.skipped, 2u);
}

// The normals of the vertices count, not the face's: one at x, two at z; 1/20 and 2/15 of the area 1/2 a point.
TEST(SceneNormals, VertexNormalsAreInterpolated) {
    const Folder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 5 0 0\nvn 0 0 1\nf 1//1 2//2 3//2\n");
    const SceneNormals scene = read_scene_normals(folder / "a.obj");
    expect_unit(scene);
    const double half = std::sqrt(0.5), fifth = std::sqrt(0.2);
    EXPECT_EQ(scene.normals.size(), 4u);
    EXPECT_NEAR(weight_of(scene, 1, 0, 0), 0.5 / 20, 1e-6);
    EXPECT_NEAR(weight_of(scene, 0, 0, 1), 0.5 * (2.0 / 20 + 2.0 / 15), 1e-6);
    EXPECT_NEAR(weight_of(scene, half, 0, half), 0.5 * 4.0 / 15, 1e-6);
    EXPECT_NEAR(weight_of(scene, fifth, 0, 2 * fifth), 0.5 * 9.0 / 20, 1e-6);
}

TEST(SceneNormals, FaceNormalWhereAVertexHasNone) {
    const Folder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 0 0 0\nf 1//1 2//1 3//2\n");
    EXPECT_NEAR(weight_of(read_scene_normals(folder / "a.obj"), 0, 0, 1), 0.5, 1e-6);
}

// A sphere of smooth normals: its normals are even over the sphere, whatever the triangles.
TEST(SceneNormals, SmoothSphere) {
    const Folder folder;
    std::string text, faces;
    constexpr int kColumns = 64, kRows = 32;
    for (int r = 0; r <= kRows; ++r)
        for (int c = 0; c < kColumns; ++c) {
            const double theta = pi * r / kRows, phi = 2.0 * pi * c / kColumns;
            const std::string p = std::to_string(std::sin(theta) * std::cos(phi)) + " " +
                                  std::to_string(std::sin(theta) * std::sin(phi)) + " " +
                                  std::to_string(std::cos(theta)) + "\n";
            text += "v " + p + "vn " + p;
            const auto corner = [&](int row, int column) {
                const std::string i = std::to_string(row * kColumns + column % kColumns + 1);
                return i + "//" + i + " ";
            };
            if (r < kRows)
                faces += "f " + corner(r, c) + corner(r + 1, c) + corner(r + 1, c + 1) + corner(r, c + 1) + "\n";
        }
    write_text(folder / "sphere.obj", text + faces);
    const SceneNormals scene = read_scene_normals(folder / "sphere.obj");
    const double total = total_weight(scene);
    EXPECT_NEAR(total / (4.0 * pi), 1.0, 0.005);
    double mean[3] = {0, 0, 0}, square[3] = {0, 0, 0};
    for (const WeightedNormal& w : scene.normals)
        for (int i = 0; i < 3; ++i) {
            mean[i] += w.weight * w.n[i] / total;
            square[i] += w.weight * w.n[i] * w.n[i] / total;
        }
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(mean[i], 0.0, 1e-3);
        EXPECT_NEAR(square[i], 1.0 / 3.0, 1e-3);
    }
}

std::string ply_header(const char* format, int vertices, const char* properties, int faces) {
    return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" +
           properties + "element face " + std::to_string(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}
const char* const kPositions = "property float x\nproperty float y\nproperty float z\n";

TEST(SceneNormals, AsciiAndBinaryPly) {
    const Folder folder;
    write_text(folder / "a.ply", ply_header("ascii", 4, kPositions, 1) + "0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n");
    const SceneNormals quad = read_scene_normals(folder / "a.ply");
    EXPECT_EQ(quad.kind, "mesh");
    EXPECT_NEAR(weight_of(quad, 0, 0, 1), 6.0, 1e-6);

    std::string bytes = ply_header("binary_little_endian", 3,
                                   "property float x\nproperty float y\nproperty float z\nproperty float "
                                   "nx\nproperty float ny\nproperty float nz\n",
                                   1);
    const float vertices[3][6] = {{0, 0, 0, 0, -1, 0}, {1, 0, 0, 0, -1, 0}, {0, 1, 0, 0, -1, 0}};
    bytes.append(reinterpret_cast<const char*>(vertices), sizeof vertices);
    const std::int32_t corners[3] = {0, 1, 2};
    bytes += '\x03';
    bytes.append(reinterpret_cast<const char*>(corners), sizeof corners);
    write_text(folder / "b.ply", bytes);
    const SceneNormals smooth = read_scene_normals(folder / "b.ply");
    EXPECT_NEAR(weight_of(smooth, 0, -1, 0), 0.5, 1e-6);
    EXPECT_NEAR(total_weight(smooth), 0.5, 1e-6);
}

/// Five pixels facing (0, 0.6, 0.8), one antialiased at half of it, one background, one NaN.
void write_pass(const std::string& path, const std::vector<std::string>& names, std::size_t first,
                bool tiled = false) {
    OIIO::ImageSpec spec(4, 2, static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    if (tiled) spec.tile_width = spec.tile_height = 16;
    std::vector<float> pixels(8 * names.size(), 0.25f);
    for (std::size_t i = 0; i < 8; ++i) {
        const float scale = i < 5 ? 1.0f : i == 5 ? 0.5f : i == 6 ? 0.0f : NAN;
        const float n[3] = {0.0f, 0.6f * scale, 0.8f * scale};
        for (std::size_t k = 0; k < 3; ++k) pixels[i * names.size() + first + k] = n[k];
    }
    write_image(path, spec, pixels);
}

TEST(SceneNormals, NormalPasses) {
    const Folder folder;
    const std::vector<std::string> layers[] = {
        {"N.X", "N.Y", "N.Z"},
        {"R", "G", "B", "A", "N.X", "N.Y", "N.Z"},
        {"Nx", "Ny", "Nz"},
        {"R", "G", "B", "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"},
        {"normals.R", "normals.G", "normals.B"},
        {"A", "normal.X", "normal.Y", "normal.Z", "P.X", "P.Y", "P.Z"},
    };
    for (const auto& names : layers)
        for (const bool tiled : {false, true}) {
            std::size_t first = 0;
            while (names[first][0] != 'N' && names[first][0] != 'n' && names[first][0] != 'V') ++first;
            write_pass(folder / "n.exr", names, first, tiled);
            const SceneNormals scene = read_scene_normals(folder / "n.exr");
            EXPECT_EQ(scene.kind, "normal pass") << names[first];
            EXPECT_EQ(scene.normals.size(), 1u) << names[first];
            EXPECT_EQ(weight_of(scene, 0, 0.6, 0.8), 6.0) << names[first];
            EXPECT_EQ(scene.skipped, 2u) << names[first];
        }
}

TEST(SceneNormals, RgbOnlyWhereAsked) {
    const Folder folder;
    write_pass(folder / "n.exr", {"R", "G", "B"}, 0);
    EXPECT_EQ(weight_of(read_scene_normals(folder / "n.exr", {UpAxis::z, true}), 0, 0.6, 0.8), 6.0);
    EXPECT_EQ(weight_of(read_scene_normals(folder / "n.exr", {UpAxis::y, true}), 0.8, 0, 0.6), 6.0);
    try {
        read_scene_normals(folder / "n.exr");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_CONTAINS(std::string(error.what()), "N.X");
    }
}

TEST(SceneNormals, MorePixelsThanNormalsInMemory) {
    const Folder folder;
    OIIO::ImageSpec spec(512, 300, 3, OIIO::TypeDesc::FLOAT); // several bands of rows
    spec.channelnames = {"N.X", "N.Y", "N.Z"};
    std::vector<float> pixels;
    for (int i = 0; i < 512 * 300; ++i) {
        const float tilt = 1e-5f * static_cast<float>(i % 7);
        for (const float v : {tilt, -tilt, i < 512 * 100 ? 1.0f : -1.0f}) pixels.push_back(v);
    }
    write_image(folder / "n.exr", spec, pixels);
    const SceneNormals scene = read_scene_normals(folder / "n.exr");
    EXPECT_LE(scene.normals.size(), 4u); // the lower pole lies on four corners of the map
    EXPECT_EQ(weight_of(scene, 0, 0, 1), 512.0 * 100.0);
    EXPECT_EQ(weight_of(scene, 0, 0, -1), 512.0 * 200.0);
}

TEST(SceneNormals, Lists) {
    const Folder folder;
    write_text(folder / "a.txt", "\xEF\xBB\xBF# normals\n0 0 2\n\n  0,0,+1, 2.5 # up\r\n1e-200 0 0\n-1e300\t0 0 4\n"
                                 "0 0 0\n nan 0 0\n0 1 0 0\n0 -3 0 1e-3");
    const SceneNormals scene = read_scene_normals(folder / "a.txt");
    EXPECT_EQ(scene.kind, "list");
    EXPECT_EQ(scene.normals.size(), 4u);
    EXPECT_EQ(scene.skipped, 3u);
    EXPECT_DOUBLE_EQ(weight_of(scene, 0, 0, 1), 3.5);
    EXPECT_DOUBLE_EQ(weight_of(scene, 1, 0, 0), 1.0);
    EXPECT_DOUBLE_EQ(weight_of(scene, -1, 0, 0), 4.0);
    EXPECT_DOUBLE_EQ(weight_of(scene, 0, -1, 0), 1e-3);
    expect_unit(scene);
}

// Whatever the direction, it is found again, and its weight with it.
TEST(SceneNormals, AnyDirectionSurvives) {
    const Folder folder;
    std::string text;
    std::vector<Vec> all;
    for (int i = 0; i < 500; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / 500, phi = i * 2.399963229728653, s = std::sqrt(1.0 - z * z);
        all.push_back({s * std::cos(phi), s * std::sin(phi), z});
        text += std::to_string(all.back().x) + " " + std::to_string(all.back().y) + " " +
                std::to_string(all.back().z) + " " + std::to_string(i + 1) + "\n";
    }
    write_text(folder / "a.csv", text);
    const SceneNormals scene = read_scene_normals(folder / "a.csv");
    ASSERT_EQ(scene.normals.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_EQ(weight_of(scene, all[i].x, all[i].y, all[i].z), double(i + 1));
}

} // namespace
