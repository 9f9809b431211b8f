// Portals: samples through them, from files written by hand.
#include "tests/lib/visibility/visible_loaded.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace acdf_test;

constexpr float kNormalsInside[][3] = {{1, 0, 0}, {0.6f, 0.3f, 0.4f}, {0.1f, -0.9f, 0.2f}, {0, 0, 1}, {-1, 0, 0}};
/// In each cell, between two and three of them, next to a portal, and in the plane of one.
constexpr float kInside[][3] = {{0, 0, 1},       {2, -1, 1}, {2, 1.5f, 1}, {1.1f, 0.2f, 1},
                                {0.9f, 0.6f, 2}, {3, 2, 4},  {3, 1, 1.5f}, {2.9f, -0.5f, 1.5f}};

/// Rounding may carry what is sampled at the border of a square to the next one: the pdf is that of the
/// direction.
TEST(Portals, SamplesHaveThePdfThatIsFoundForThem) {
    float share = 0.0f;
    for (int kind = 0; kind < 2; ++kind, share = 0.25f) {
        NormalsSpec spec = windowed_normals();
        spec.cosine_share = share;
        const LoadedVisible loaded(spec);
        ASSERT_TRUE(loaded.view().has_portals());
        std::mt19937_64 random(7);
        int seen = 0;
        for (const auto& n : kNormalsInside)
            for (const auto& x : kInside) {
                const AcdfVisiblePoint point = loaded.view().at(x, n);
                seen += point.portals;
                for (int i = 0; i < 300; ++i) {
                    const double u0 = double(random() >> 11) * 0x1p-53, u1 = double(random() >> 11) * 0x1p-53;
                    const acdf::DirectionSample s = loaded.view().sample(point, u0, u1);
                    EXPECT_GT(s.pdf, 0.0f);
                    if (point.portals > 0) {
                        EXPECT_EQ(loaded.view().pdf(point, s.direction), s.pdf);
                    }
                }
            }
        EXPECT_GT(seen, 40);
    }
}

/// Directions that a row never samples are sampled through no portal alone, and what a row samples stays so.
TEST(Portals, NothingThatANormalSeesIsLost) {
    const LoadedVisible loaded(windowed_normals());
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 100000; ++i) {
        double v[3], length = 0.0;
        for (double& x : v) {
            x = normal(random);
            length += x * x;
        }
        float d[3];
        for (int k = 0; k < 3; ++k) d[k] = float(v[k] / std::sqrt(length));
        const auto& n = kNormalsInside[random() % 5];
        const auto& x = kInside[random() % 8];
        if (loaded.view().pdf(loaded.view().at(n), d) > 0.0f) {
            EXPECT_GT(loaded.view().pdf(loaded.view().at(x, n), d), 0.0f);
        }
    }
}

struct Histogram {
    static constexpr int rows = 32, columns = 64;
    std::vector<double> of = std::vector<double>(rows * columns, 0.0);

    static std::size_t bin(const float* d) {
        const double z = std::min(std::max(double{d[2]}, -1.0), 1.0), phi = std::atan2(double{d[1]}, double{d[0]});
        const int row = std::min(int((1.0 - z) / 2.0 * rows), rows - 1);
        const int column = std::min(int((phi + pi) / (2.0 * pi) * columns), columns - 1);
        return std::size_t(row * columns + column);
    }
};

/// The pdf in bins of equal solid angle, by midpoints of 16 x 16 parts of each.
Histogram expected_of(const acdf::VisibleLocalView& view, const AcdfVisiblePoint& point) {
    constexpr int parts = 16;
    Histogram out;
    for (int i = 0; i < Histogram::rows * parts; ++i)
        for (int k = 0; k < Histogram::columns * parts; ++k) {
            const double z = 1.0 - 2.0 * (i + 0.5) / (Histogram::rows * parts), r = std::sqrt(1.0 - z * z),
                         phi = -pi + 2.0 * pi * (k + 0.5) / (Histogram::columns * parts);
            const float d[3] = {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
            out.of[Histogram::bin(d)] += double{view.pdf(point, d)} * 4.0 * pi /
                                         (double(Histogram::rows * parts) * Histogram::columns * parts);
        }
    return out;
}

/// Chi square over bins of enough samples; the pdf integrates to 1.
TEST(Portals, DirectionsFallWhereThePdfSays) {
    const LoadedVisible loaded(windowed_normals());
    std::mt19937_64 random(9);
    const struct { int position, normal; } cases[] = {{0, 0}, {1, 1}, {3, 3}, {6, 0}};
    for (const auto& c : cases) {
        const AcdfVisiblePoint point = loaded.view().at(kInside[c.position], kNormalsInside[c.normal]);
        ASSERT_GT(point.portals, 0) << c.position;
        const Histogram expected = expected_of(loaded.view(), point);
        double whole = 0.0;
        for (const double p : expected.of) whole += p;
        EXPECT_NEAR(whole, 1.0, 8e-3) << c.position; // portals cut squares
        constexpr int samples = 40000;
        Histogram found;
        for (int i = 0; i < samples; ++i) {
            const double u0 = double(random() >> 11) * 0x1p-53, u1 = double(random() >> 11) * 0x1p-53;
            found.of[Histogram::bin(loaded.view().sample(point, u0, u1).direction)] += 1.0;
        }
        double square = 0.0, rest_found = 0.0, rest = 0.0;
        int bins = 0;
        for (std::size_t b = 0; b < found.of.size(); ++b) {
            const double e = samples * expected.of[b];
            if (e < 10.0) {
                rest += e;
                rest_found += found.of[b];
                continue;
            }
            square += (found.of[b] - e) * (found.of[b] - e) / e;
            ++bins;
        }
        if (rest > 5.0) square += (rest_found - rest) * (rest_found - rest) / rest;
        // Bins that a portal cuts are summed less exactly: half as much again is allowed beside five deviations.
        EXPECT_LT(square, 1.5 * bins + 5.0 * std::sqrt(2.0 * bins)) << c.position;
    }
}

/// Strata of random numbers stay together: next to each other, u sample directions of the same piece or of the
/// next.
TEST(Portals, NumbersAreClampedAndAtTheEndsSafe) {
    const LoadedVisible loaded(windowed_normals());
    const AcdfVisiblePoint point = loaded.view().at(kInside[0], kNormalsInside[0]);
    for (double u0 : {0.0, 1.0, -1.0, 2.0, std::nan(""), 0.16, 0.16015625})
        for (double u1 : {0.0, 1.0, -1.0, 2.0, std::nan("")}) {
            const acdf::DirectionSample s = loaded.view().sample(point, u0, u1);
            EXPECT_GT(s.pdf, 0.0f);
            EXPECT_TRUE(std::isfinite(s.pdf));
            EXPECT_EQ(loaded.view().pdf(point, s.direction), s.pdf);
        }
    const float bad[][3] = {{0, 0, 0}, {NAN, 0, 1}, {0.5f, 0, 0}};
    for (const auto& d : bad) EXPECT_EQ(loaded.view().pdf(point, d), 0.0f);
}

/// Cells without light stand between those with light, and at the ends: nothing is sampled there, whatever the
/// numbers.
TEST(Portals, NothingIsSampledInCellsWithoutLight) {
    NormalsSpec spec = windowed_normals();
    for (PortalMapSpec& map : spec.portals->maps) map.light = {0, 0, 0, 0, 0, 5, 7, 0, 0, 0, 9, 0, 0, 0, 0, 0};
    const LoadedVisible loaded(spec);
    int seen = 0;
    for (const auto& n : kNormalsInside)
        for (const auto& x : kInside) {
            const AcdfVisiblePoint point = loaded.view().at(x, n);
            if (point.portals == 0) continue;
            ++seen;
            const double row = point.seen.of_row;
            for (double u0 : {row, row + 0x1p-53, 0.5 + 0.5 * row, 0.75 + 0.25 * row, 1.0 - 0x1p-24, 1.0})
                for (double u1 : {0.0, 0x1p-30, 0.25, 0.5, 0.75, 1.0 - 0x1p-53, 1.0}) {
                    const acdf::DirectionSample s = loaded.view().sample(point, u0, u1);
                    const double of_row = row * acdf_visible_rows_pdf(&loaded.view().data(), &point, s.direction);
                    EXPECT_GT(s.pdf, 1.001 * of_row) << u0 << ' ' << u1;
                }
        }
    EXPECT_GT(seen, 10);
}

/// What a portal shows of a dark cell is nothing, whatever rounding makes of large sums around it.
TEST(Portals, RoundingIsNoLight) {
    NormalsSpec spec = windowed_normals();
    spec.portals->portals = {{{4, 0.3f, 1.3f}, {1, 2}, 0}};
    spec.portals->maps.resize(1);
    spec.portals->maps[0].unit = 1e30f;
    spec.portals->maps[0].light = {0, 0, 1000000007, 0, 0, 0, 0, 0, 3000000001, 0, 0, 0, 0, 0, 0, 0};
    spec.portals->rows = std::vector<Bytes>(4, Bytes(5, 250));
    const LoadedVisible loaded(spec);
    for (int i = 0; i < 100; ++i) {
        const float x[] = {0, -0.002f * static_cast<float>(i), 1};
        EXPECT_EQ(loaded.view().at(x, kNormalsInside[0]).portals, 0) << i;
    }
    spec.portals->maps[0].light[10] = 1;
    const float x[] = {0, 0, 1};
    EXPECT_EQ(LoadedVisible(spec).view().at(x, kNormalsInside[0]).portals, 1);
}

/// A position that samples by its row alone, one behind a wall, one outside, and a normal alone see no portals.
TEST(Portals, PositionsWithoutAPortalSampleTheirRow) {
    const LoadedVisible loaded(windowed_normals()), rows(visible_normals());
    const struct {
        float x[3], n[3];
    } cases[] = {{{2, 1.5f, 1}, {0, 0, 1}}, {{0, 0, 1}, {-1, -1, 0}}, {{9, 0, 1}, {1, 0, 0}}};
    for (const auto& c : cases) {
        const AcdfVisiblePoint point = loaded.view().at(c.x, c.n), row = rows.view().at(c.x, c.n);
        EXPECT_EQ(point.portals, 0);
        const acdf::DirectionSample a = loaded.view().sample(point, 0.3, 0.7),
                                    b = rows.view().sample(row, 0.3, 0.7);
        EXPECT_EQ(a.pdf, b.pdf);
        for (int k = 0; k < 3; ++k) EXPECT_EQ(a.direction[k], b.direction[k]);
    }
}

} // namespace
