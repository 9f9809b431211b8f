// Visibility: what is sampled where, from files written by hand, and the frozen one.
#include "tests/lib/reader/golden_numbers.h"
#include "tests/lib/visibility/visible_loaded.h"

#include <acdf/curves/curves.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace acdf_test;

constexpr float kNormals[][3] = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0.1f, -0.9f, 0.2f}};
/// In each cell, near borders, and at the bounds.
constexpr float kPositions[][3] = {{0, 0, 1},       {2, -1, 1},      {2, 1.5f, 1},
                                   {1.1f, 0.2f, 1}, {0.9f, 0.6f, 2}, {3, 2, 4}};

/// Eight columns and rows: the pdf is constant or linear across each square.
template <class Visit>
void for_each_direction(const Visit& visit) {
    constexpr int steps = 128;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < 2 * steps; ++k) {
            const double z0 = std::cos(pi * i / steps), z1 = std::cos(pi * (i + 1) / steps), z = 0.5 * (z0 + z1);
            const double phi = pi - 2.0 * pi * (k + 0.5) / (2 * steps), r = std::sqrt(1.0 - z * z);
            const float d[3] = {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
            visit(d, (z0 - z1) * pi / steps);
        }
}

TEST(Visibility, PdfsIntegrateToOne) {
    float share = 0.0f;
    for (NormalsSpec spec : {visible_normals(), regional_normals(), regional_normals()}) {
        spec.cosine_share = share;
        share = 0.25f;
        const LoadedVisible loaded(spec);
        for (const auto& n : kNormals)
            for (const auto& x : kPositions) {
                const AcdfVisiblePoint point = loaded.view().at(x, n);
                EXPECT_TRUE(point.in_cell);
                double sum = 0.0;
                for_each_direction(
                    [&](const float* d, double angle) { sum += double{loaded.view().pdf(point, d)} * angle; });
                EXPECT_NEAR(sum, 1.0, 2e-3);
            }
    }
}

TEST(Visibility, SamplesHaveThePdfThatIsFoundForThem) {
    for (const NormalsSpec& spec : {visible_normals(), regional_normals()}) {
        const LoadedVisible loaded(spec);
        std::mt19937_64 random(5);
        for (const auto& n : kNormals)
            for (const auto& x : kPositions) {
                const AcdfVisiblePoint point = loaded.view().at(x, n);
                for (int i = 0; i < 300; ++i) {
                    const double u0 = double(random() >> 11) * 0x1p-53, u1 = double(random() >> 11) * 0x1p-53;
                    const acdf::DirectionSample s = loaded.view().sample(point, u0, u1);
                    EXPECT_GT(s.pdf, 0.0f);
                    EXPECT_EQ(loaded.view().pdf(point, s.direction), s.pdf);
                }
            }
    }
}

/// The frequency of directions in octants against the integral of the pdf there.
TEST(Visibility, DirectionsFallWhereThePdfSays) {
    for (const NormalsSpec& spec : {visible_normals(), regional_normals()}) {
        const LoadedVisible loaded(spec);
        const AcdfVisiblePoint point = loaded.view().at(kPositions[3], kNormals[1]);
        const auto octant = [](const float* d) { return (d[0] > 0) + 2 * (d[1] > 0) + 4 * (d[2] > 0); };
        double expected[8] = {}, found[8] = {};
        for_each_direction([&](const float* d, double angle) {
            expected[octant(d)] += double{loaded.view().pdf(point, d)} * angle;
        });
        constexpr int side = 256;
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k)
                found[octant(loaded.view().sample(point, (i + 0.5) / side, (k + 0.5) / side).direction)] +=
                    1.0 / (side * side);
        for (int i = 0; i < 8; ++i) EXPECT_NEAR(found[i], expected[i], 0.01) << i;
    }
}

TEST(Visibility, NothingThatANormalSeesIsLost) {
    for (const NormalsSpec& spec : {visible_normals(), regional_normals()}) {
        const LoadedVisible loaded(spec);
        for (const auto& n : kNormals)
            for (const auto& x : kPositions) {
                const AcdfVisiblePoint here = loaded.view().at(x, n), anywhere = loaded.view().at(n);
                for_each_direction([&](const float* d, double) {
                    EXPECT_EQ(loaded.view().pdf(here, d) > 0.0f, loaded.view().pdf(anywhere, d) > 0.0f);
                });
            }
    }
}

TEST(Visibility, OutsideTheNormalAloneCounts) {
    const LoadedVisible loaded(visible_normals());
    const float nan = std::nanf("");
    const float outside[][3] = {{-1.5f, 0, 1}, {0, 2.5f, 1}, {0, 0, -0.1f}, {nan, 0, 1}, {0, 0, INFINITY}};
    for (const auto& x : outside)
        for (double u : {0.1, 0.5, 0.9}) {
            const AcdfVisiblePoint point = loaded.view().at(x, kNormals[1]);
            EXPECT_FALSE(point.in_cell);
            const acdf::DirectionSample a = loaded.view().sample(point, u, u),
                                        b = loaded.view().local().sample(kNormals[1], u, u);
            EXPECT_EQ(a.pdf, b.pdf);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(a.direction[k], b.direction[k]);
        }
    const LoadedVisible plain(small_normals());
    EXPECT_FALSE(plain.view().has_cells());
    EXPECT_FALSE(plain.view().at(kPositions[0], kNormals[0]).in_cell);
}

TEST(Visibility, PositionsAreTransformed) {
    NormalsSpec spec = visible_normals(), turned = visible_normals();
    const float to_cells[12] = {0, 0, 2, 1, 2, 0, 0, 0, 0, 2, 0, -1}; // twice (z, x, y), moved
    std::copy_n(to_cells, 12, turned.visibility->transform);
    const LoadedVisible loaded(spec), other(turned);
    for (const auto& x : kPositions) {
        const float there[3] = {x[1] / 2, (x[2] + 1) / 2, (x[0] - 1) / 2};
        const AcdfVisiblePoint a = loaded.view().at(x, kNormals[1]), b = other.view().at(there, kNormals[1]);
        EXPECT_TRUE(a.in_cell);
        EXPECT_TRUE(b.in_cell);
        EXPECT_EQ(a.cell, b.cell);
    }
}

/// A border belongs to the upper side.
TEST(Visibility, ABorderHasTwoSides) {
    const LoadedVisible loaded(visible_normals());
    const float up[3] = {0, 0, 1}, right[3] = {std::nextafter(1.0f, 0.0f), -1.0f, 1.0f},
                at[3] = {1.0f, -1.0f, 1.0f};
    EXPECT_EQ(loaded.view().at(right, up).cell, 0u);
    EXPECT_EQ(loaded.view().at(at, up).cell, 1u);
}

class GoldenVisibility : public ::testing::TestWithParam<const char*> {};

TEST_P(GoldenVisibility, SampleTheSameSamples) {
    const std::string path = std::string(ACDF_TEST_DIR "/golden/v1.0/") + GetParam();
    acdf::File file;
    acdf::LoadOptions walked; // what is sampled by runtime tables differs as floats round
    walked.tables = false;
    const acdf::Status status = acdf::File::open((path + ".acdf").c_str(), file, acdf::with_curves(walked));
    ASSERT_TRUE(status.ok()) << status.message;
    acdf::VisibleLocalView view;
    ASSERT_TRUE(acdf::VisibleLocalView::of(file, view).ok());
    const auto lines = golden_numbers<12>(path + ".txt");
    ASSERT_EQ(lines.size(), 6u * 6u * 16u);
    for (const std::array<double, 12>& v : lines) {
        const float x[3] = {float(v[0]), float(v[1]), float(v[2])}, n[3] = {float(v[3]), float(v[4]), float(v[5])};
        const AcdfVisiblePoint point = view.at(x, n);
        const acdf::DirectionSample s = view.sample(point, v[6], v[7]);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(double{s.direction[k]}, v[8 + k]);
        EXPECT_EQ(double{s.pdf}, v[11]);
    }
}

INSTANTIATE_TEST_SUITE_P(V1_0, GoldenVisibility, ::testing::Values("visibility", "visibility_regions", "portals"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
