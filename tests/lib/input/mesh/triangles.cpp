// Triangles of meshes and what lies on a ray among them: against all triangles one by one.
#include "tests/lib/input/write.h"

#include "input/mesh/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace acdf::input;
using namespace acdf::test;
using Point3 = std::array<double, 3>;

/// Triangles of all sizes, anywhere.
Triangles soup(int count) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> anywhere(-1.0f, 1.0f);
    Triangles out;
    for (int i = 0; i < count; ++i) {
        const float size = i % 50 == 0 ? 0.8f : 0.03f;
        const std::array<float, 3> middle{anywhere(random), anywhere(random), anywhere(random)};
        for (int k = 0; k < 3; ++k) {
            Triangles::Corner corner;
            for (std::size_t a = 0; a < 3; ++a) corner.position[a] = middle[a] + size * anywhere(random);
            out.corners.push_back(corner);
        }
    }
    return out;
}

TEST(TriangleTrees, FindTheHitsOfAllTriangles) {
    const Triangles triangles = soup(1500);
    const TriangleTree tree(triangles);
    std::vector<Triangles> each;
    for (std::size_t t = 0; t < triangles.count(); ++t) {
        each.emplace_back();
        each.back().corners.assign(triangles.corners.begin() + std::ptrdiff_t(3 * t),
                                   triangles.corners.begin() + std::ptrdiff_t(3 * t + 3));
    }
    std::vector<TriangleTree> trees;
    trees.reserve(each.size());
    for (const Triangles& one : each) trees.emplace_back(one);
    std::mt19937_64 random(12);
    std::normal_distribution<double> normal;
    int met = 0;
    for (int i = 0; i < 400; ++i) {
        Point3 from{normal(random), normal(random), normal(random)},
            to{normal(random), normal(random), normal(random)};
        if (i % 5 == 0) to = {0.0, 0.0, i % 2 ? 1.0 : -1.0}; // along an axis
        double nearest = INFINITY;
        std::size_t which = 0;
        for (std::size_t t = 0; t < trees.size(); ++t)
            if (const auto hit = trees[t].first(from, to, 1e-9); hit && hit->distance < nearest) {
                nearest = hit->distance;
                which = t;
            }
        const auto found = tree.first(from, to, 1e-9);
        ASSERT_EQ(found.has_value(), nearest < INFINITY) << i;
        EXPECT_EQ(tree.any(from, to, 1e-9), found.has_value());
        if (!found) continue;
        ++met;
        EXPECT_EQ(found->distance, nearest);
        EXPECT_EQ(found->triangle, which);
        const Point3 at = triangles.position(found->triangle, found->b1, found->b2);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at[k], from[k] + nearest * to[k], 1e-9);
        EXPECT_FALSE(tree.first(from, to, nearest) && tree.first(from, to, nearest)->triangle == which);
    }
    EXPECT_GT(met, 60);
    EXPECT_LT(met, 340);
}

TEST(TriangleTrees, OfManyTrianglesAtOnePosition) {
    Triangles same;
    for (int i = 0; i < 300; ++i)
        for (const std::array<float, 3>& p : {std::array<float, 3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})
            same.corners.push_back({p, {}});
    const TriangleTree tree(same);
    EXPECT_TRUE(tree.any({0.2, 0.2, 1.0}, {0.0, 0.0, -1.0}, 0.0));
    EXPECT_FALSE(tree.any({0.2, 0.2, 1.0}, {0.0, 0.0, 1.0}, 0.0));
    EXPECT_FALSE(TriangleTree(Triangles()).any({0, 0, 0}, {0, 0, 1}, 0.0));
}

TEST(MeshTriangles, ArePolygonsInFansTurnedWithYUp) {
    const Folder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\n");
    const Triangles z = read_triangles(folder / "a.obj", UpAxis::z),
                    y = read_triangles(folder / "a.obj", UpAxis::y);
    ASSERT_EQ(z.count(), 2u);
    EXPECT_EQ(z.area(0) + z.area(1), 2.0);
    EXPECT_EQ(z.face_normal(0), (Point3{0, 0, 1}));
    EXPECT_EQ(y.face_normal(1), (Point3{1, 0, 0})); // (x, y, z) becomes (z, x, y)
    EXPECT_EQ(y.corners[2].position, (std::array<float, 3>{0, 1, 2}));
}

TEST(MeshTriangles, OfCornersThatAreNoNumbersOrTooFarAwayAreLeftOut) {
    const Folder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\nv nan 2 0\nv 0 3e38 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    EXPECT_EQ(read_triangles(folder / "a.obj", UpAxis::z).count(), 1u);
    write_text(folder / "b.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n");
    try {
        read_triangles(folder / "b.obj", UpAxis::z);
        ADD_FAILURE() << "read";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("b.obj: it has no triangle whose corners"), std::string::npos)
            << error.what();
    }
}

/// Both sides of a triangle are sampled all over, whatever sequence numbers the points.
TEST(MeshSurfaces, GiveEachTriangleAndSideItsPoints) {
    Triangles four;
    for (float x : {0.0f, 2.0f, 4.0f, 6.0f})
        for (const std::array<float, 3>& p : {std::array<float, 3>{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}})
            four.corners.push_back({p, {}});
    const MeshSurface surface(four);
    int count[4][2] = {};
    double mean[4][2] = {};
    constexpr int points = 8000;
    for (int i = 0; i < points; ++i) {
        std::uint32_t bits = 0; // of van der Corput's sequence, as the first coordinate of Sobol's
        for (int b = 0; b < 32; ++b) bits |= std::uint32_t(i >> b & 1) << (31 - b);
        const MeshSurface::Point p =
            surface.at(bits * 0x1p-32, std::fmod(i * 0.6180339887498949, 1.0), is_front(std::uint64_t(i)));
        const int triangle = int(p.position[0] / 2.0), side = p.normal[2] > 0.0;
        ++count[triangle][side];
        mean[triangle][side] += p.position[1];
    }
    for (int t = 0; t < 4; ++t)
        for (int s = 0; s < 2; ++s) {
            EXPECT_NEAR(count[t][s], points / 8, points / 80);
            EXPECT_NEAR(mean[t][s] / count[t][s], 1.0 / 3.0, 0.02);
        }
}

} // namespace
