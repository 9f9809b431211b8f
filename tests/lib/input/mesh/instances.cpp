// Lists of instances: the same as meshes that were written out where they stand, and what is no list.
#include "tests/inputs/folder.h"

#include "input/mesh/instances.h"
#include "input/mesh/triangles.h"
#include "input/normals/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace acdf::input;
using namespace acdf::test;
using Row = std::array<double, 4>;

/// A tetrahedron with corners on the axes, wound counterclockwise as seen from outside.
const char* const kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
/// A triangle with a normal of its own at each corner.
const char* const kSmooth = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 0.8\nvn 0 -0.6 0.8\nf 1//1 2//2 3//3\n";

double weight_near(const SceneNormals& scene, const std::array<double, 3>& n) {
    double sum = 0.0;
    for (const WeightedNormal& w : scene.normals)
        if (w.n[0] * n[0] + w.n[1] * n[1] + w.n[2] * n[2] > 1.0 - 1e-5) sum += w.weight;
    return sum;
}

std::array<double, 3> to_unit(std::array<double, 3> v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (double& x : v) x /= length;
    return v;
}

TEST(Instances, AreReadInTheOrderOfTheirMeshes) {
    const Folder folder;
    write_text(folder / "a.instances", "# trees\n\n1 0 0 2,0 1 0 3,0 0 1 4 a tree.obj  \r\n"
                                       "0 -1 0 0  1 0 0 0  0 0 2 0 rock.ply\n+2 0 0 0 0 2 0 0 0 0 2 0 a tree.obj");
    const std::vector<Instances> read = read_instances(folder / "a.instances");
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].mesh, folder / "a tree.obj");
    ASSERT_EQ(read[0].placements.size(), 2u);
    EXPECT_EQ(read[0].placements[0].rows[1], (Row{0, 1, 0, 3}));
    EXPECT_EQ(read[0].placements[1].rows[2], (Row{0, 0, 2, 0}));
    EXPECT_EQ(read[1].placements.at(0).rows[0], (Row{0, -1, 0, 0}));
    EXPECT_NEAR(read[1].placements.at(0).determinant(), 2.0, 1e-15);
    EXPECT_EQ(scene_files(folder / "a.instances"),
              (std::vector<std::string>{folder / "a.instances", folder / "a tree.obj", folder / "rock.ply"}));
}

TEST(Instances, TrianglesStandWhereTheListPutsThem) {
    const Folder folder;
    write_text(folder / "t.obj", kTetrahedron);
    write_text(folder / "t.instances", "1 0 0 0 0 1 0 0 0 0 1 0 t.obj\n"    // as it is
                                       "0 -2 0 5 2 0 0 6 0 0 2 7 t.obj\n"   // turned, twice as large, moved
                                       "-1 0 0 0 0 1 0 0 0 0 1 0 t.obj\n"); // mirrored
    const Triangles own = read_triangles(folder / "t.obj", UpAxis::z),
                    all = read_triangles(folder / "t.instances", UpAxis::z);
    ASSERT_EQ(own.count(), 4u);
    ASSERT_EQ(all.count(), 12u);
    const std::array<double, 3> inside[3] = {{0.1, 0.2, 0.3}, {5.0 - 0.4, 6.2, 7.6}, {-0.1, 0.2, 0.3}};
    for (std::size_t t = 0; t < all.count(); ++t) {
        const std::size_t k = t % 4;
        if (t < 4) {
            EXPECT_EQ(all.corners[3 * t + 1].position, own.corners[3 * t + 1].position);
        }
        if (t >= 4 && t < 8) {
            const auto &p = own.corners[3 * k].position, &q = all.corners[3 * t].position;
            EXPECT_EQ(q, (std::array<float, 3>{5 - 2 * p[1], 6 + 2 * p[0], 7 + 2 * p[2]}));
        }
        EXPECT_NEAR(all.area(t), own.area(k) * (t / 4 == 1 ? 4.0 : 1.0), 1e-6);
        const auto n = all.face_normal(t), at = all.position(t, 0.3, 0.3);
        double outwards = 0.0;
        for (std::size_t a = 0; a < 3; ++a) outwards += n[a] * (at[a] - inside[t / 4][a]);
        EXPECT_GT(outwards, 0.0) << t; // the mirrored one, too
    }
}

TEST(Instances, NormalsAreThoseOfMeshesWrittenOut) {
    const Folder folder;
    write_text(folder / "t.obj", kTetrahedron);
    write_text(folder / "t.instances", "1 0 0 0 0 1 0 0 0 0 0.5 9 t.obj\n0 0 1 0 1 0 0 0 0 1 0 0 t.obj\n"
                                       "0 1 0 0 1 0 0 0 0 0 1 0 t.obj\n");
    const SceneNormals scene = read_scene_normals(folder / "t.instances");
    EXPECT_EQ(scene.kind, "list of instances");
    // The slanted face has the normal (1, 1/2, 1/3) and half the area of its edges' product, 7 / 2.
    EXPECT_NEAR(weight_near(scene, to_unit({1.0, 0.5, 1.0 / 1.5})), std::sqrt(9.0 + 2.25 + 4.0) / 2.0,
                1e-5);                                                          // flattened
    EXPECT_NEAR(weight_near(scene, to_unit({1.0 / 3.0, 1.0, 0.5})), 3.5, 1e-5); // turned
    EXPECT_NEAR(weight_near(scene, to_unit({0.5, 1.0, 1.0 / 3.0})), 3.5, 1e-5); // mirrored
    double whole = 0.0;
    for (const WeightedNormal& w : scene.normals) whole += w.weight;
    EXPECT_NEAR(whole, (1.0 + 0.75 + 1.5 + std::sqrt(15.25) / 2.0) + 2.0 * (1.0 + 1.5 + 3.0 + 3.5), 1e-4);
}

TEST(Instances, NormalsOfCornersGoByTheInverseTransposed) {
    const Folder folder;
    write_text(folder / "s.obj", kSmooth);
    write_text(folder / "s.instances", "1 0 0 0 0 1 0 0 0 0 -4 0 s.obj\n");
    const Triangles t = read_triangles(folder / "s.instances", UpAxis::z);
    ASSERT_EQ(t.count(), 1u);
    // Corners 2 and 3 have changed placements, as the triangle is mirrored; all normals point down.
    const std::array<double, 3> wanted[3] = {{0, 0, -1}, to_unit({0, -0.6, -0.2}), to_unit({0.6, 0, -0.2})};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(double{t.corners[c].normal[k]}, wanted[c][k], 1e-6) << c;
    EXPECT_LT(t.face_normal(0)[2], 0.0);
}

TEST(Instances, SceneAxesTurnWhatStands) {
    const Folder folder;
    write_text(folder / "s.obj", kSmooth);
    write_text(folder / "s.instances", "1 0 0 1 0 1 0 2 0 0 1 3 s.obj\n");
    EXPECT_EQ(read_triangles(folder / "s.instances", UpAxis::y).corners[0].position,
              (std::array<float, 3>{3, 1, 2}));
}

TEST(Instances, DigestAndSizeAreOfAllFiles) {
    const Folder folder;
    write_text(folder / "t.obj", kTetrahedron);
    write_text(folder / "t.instances", "1 0 0 0 0 1 0 0 0 0 1 0 t.obj\n1 0 0 9 0 1 0 0 0 0 1 0 t.obj\n");
    const std::string before = scene_sha256(folder / "t.instances");
    EXPECT_EQ(before.size(), 64u);
    EXPECT_EQ(before, scene_sha256(folder / "t.instances"));
    EXPECT_EQ(scene_bytes(folder / "t.instances"), 2 * std::string(kTetrahedron).size());
    EXPECT_EQ(scene_bytes(folder / "t.obj"), std::string(kTetrahedron).size());
    EXPECT_EQ(scene_bytes(folder / "none.instances"), 0u);
    write_text(folder / "t.obj", std::string(kTetrahedron) + "# changed\n");
    EXPECT_NE(before, scene_sha256(folder / "t.instances"));
}

/// The message that a list is refused with; "" where it is read.
std::string refusal_of(const Folder& folder, const std::string& text) {
    const std::string path = folder / "a.instances";
    write_text(path, text);
    try {
        read_scene_normals(path);
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.what();
    }
    return {};
}

TEST(Instances, WhatIsNoList) {
    const Folder folder;
    write_text(folder / "t.obj", kTetrahedron);
    write_text(folder / "other.instances", "1 0 0 0 0 1 0 0 0 0 1 0 t.obj\n");
    const std::string whole = "1 0 0 0 0 1 0 0 0 0 1 0 t.obj\n";
    EXPECT_EQ(refusal_of(folder, whole), "");
    EXPECT_CONTAINS(refusal_of(folder, ""), "empty");
    EXPECT_CONTAINS(refusal_of(folder, "# nothing\n"), "lists no mesh");
    EXPECT_CONTAINS(refusal_of(folder, whole + "1 0 0 0 0 1 0 0 0 0 1 t.obj\n"), "line 2 is not an instance");
    EXPECT_CONTAINS(refusal_of(folder, "1 0 0 0 0 1 0 0 0 0 1 0\n"), "line 1 is not an instance");
    EXPECT_CONTAINS(refusal_of(folder, "t.obj\n"), "line 1 is not an instance");
    EXPECT_CONTAINS(refusal_of(folder, "1 0 0 0 0 1 0 0 0 0 1 0 other.instances\n"), "does not name a mesh");
    EXPECT_CONTAINS(refusal_of(folder, "1 0 0 0 0 1 0 0 0 0 1 0 none.obj\n"), "none.obj");
    EXPECT_CONTAINS(refusal_of(folder, "1 0 0 0 1 0 0 0 0 0 1 0 t.obj\n"), "flat");
    EXPECT_CONTAINS(refusal_of(folder, "nan 0 0 0 0 1 0 0 0 0 1 0 t.obj\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "1 0 0 inf 0 1 0 0 0 0 1 0 t.obj\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, "1e300 0 0 0 0 1 0 0 0 0 1 0 t.obj\n"), "line 1");
    EXPECT_CONTAINS(refusal_of(folder, std::string(5000, '1') + "\n"), "longer");
    for (std::size_t size = 1; size < whole.size() - 1; ++size)
        EXPECT_NE(refusal_of(folder, whole.substr(0, size)), "");
}

} // namespace
