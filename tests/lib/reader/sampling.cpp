// Sampling and evaluation: against the slow decoder, against itself, and at the edges.
#include "tests/lib/reader/sampling.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace acdf_test;
using acdf_reference::Cell;
using acdf_reference::Environment;

extern "C" void acdf_c_sample(const AcdfEnvironment* env, double u0, double u1, AcdfDirectionSample* out);

namespace {

// The frame, with directions that distinguish all axes and signs: SPEC.md §6.1.
TEST(EnvironmentFrame, quadrantsAndHemispheres) {
    EnvironmentSpec spec;
    spec.columns = 4;
    spec.rows = 2;
    CurveSpec phi = even_curve(0, {1, 2, 3});
    phi.cumulative = {6553, 6553 * 3, 6553 * 6};
    phi.link_bytes = 1;
    phi.children = {1, 1, 1, 1};
    CurveSpec theta = even_curve(1, {1});
    theta.cumulative = {52428};
    spec.tree = {{phi, theta}, {}};
    const auto env = loaded(spec);
    const double p_phi[4] = {6553, 6553 * 2, 6553 * 3, 65535 - 6553 * 6};
    for (int quadrant = 0; quadrant < 4; ++quadrant)
        for (int south = 0; south < 2; ++south) {
            const double azimuth = M_PI - M_PI / 2 * quadrant - 0.3, z = south ? -0.4 : 0.6;
            const double sine = std::sqrt(1 - z * z);
            const float d[3] = {static_cast<float>(sine * std::cos(azimuth)),
                                static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(z)};
            const double p = p_phi[quadrant] / 65535 * (south ? 65535 - 52428 : 52428) / 65535;
            EXPECT_NEAR(env->view.pdf(d), p / (M_PI / 2), 1e-7) << quadrant << ' ' << south;
        }
    // u0 = 0 is phi = +pi: direction -x, just on its +y side; u1 = 0 is +z.
    const auto first = env->view.sample(0.0, 0.5);
    EXPECT_LT(first.direction[0], -0.5f);
    EXPECT_GT(first.direction[1], 0.0f);
    EXPECT_GT(env->view.sample(0.5, 0.0).direction[2], 0.999f);
    EXPECT_LT(env->view.sample(0.5, 1.0).direction[2], -0.999f);
    EXPECT_DOUBLE_EQ(env->view.total(), 1.0);
}

TEST(EnvironmentView, agreesWithTheSlowDecoder) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        EnvironmentSpec spec = random_environment(seed, options_of(seed));
        spec.zlib = seed % 7 == 0;
        const auto env = loaded(spec);
        const Environment reference(env->bytes);
        const double rounded_in_floats = spec.octahedral ? 4e-7 : 2e-7; // by tables
        std::mt19937_64 rng(seed);
        for (int n = 0; n < acdf_test::repeated(300); ++n) {
            const double u0 = uniform(rng), u1 = uniform(rng);
            const auto a = env->view.sample(u0, u1);
            const auto b = reference.sample(u0, u1);
            for (int i = 0; i < 3; ++i)
                ASSERT_NEAR(a.direction[i], b.direction[i], rounded_in_floats) << seed << ' ' << n;
            ASSERT_NEAR(a.pdf / b.pdf, 1.0, 1e-6) << seed << ' ' << n;
        }
        for (int n = 0; n < acdf_test::repeated(300); ++n) { // directions anywhere, dark ones too
            const double z = 2 * uniform(rng) - 1, phi = 2 * M_PI * uniform(rng), sine = std::sqrt(1 - z * z);
            const float f[3] = {rounded(sine * std::cos(phi)), rounded(sine * std::sin(phi)), rounded(z)};
            const double d[3] = {f[0], f[1], f[2]};
            const double expected = reference.pdf(d);
            ASSERT_NEAR(env->view.pdf(f), expected, 1e-5 * expected) << seed << ' ' << n;
        }
    }
}

TEST(EnvironmentView, compiledAsCIsTheSame) {
    const auto env = loaded(RandomTree(3, options_of(3)).make());
    std::mt19937_64 rng(3);
    for (int n = 0; n < 1000; ++n) {
        const double u0 = uniform(rng), u1 = uniform(rng);
        const auto a = env->view.sample(u0, u1);
        AcdfDirectionSample b;
        acdf_c_sample(&env->view.data(), u0, u1, &b);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
}

// pdf(sample(u).direction) == sample(u).pdf to the bit, even after the direction is normalised again.
void expect_equal_pdf(const acdf::EnvironmentView& view, int count, std::uint32_t seed) {
    std::mt19937_64 rng(seed);
    for (int n = 0; n < count; ++n) {
        const auto s = view.sample(uniform(rng), uniform(rng));
        ASSERT_EQ(view.pdf(s.direction), s.pdf) << "seed " << seed << ", sample " << n;
        const float length = std::sqrt(s.direction[0] * s.direction[0] + s.direction[1] * s.direction[1] +
                                       s.direction[2] * s.direction[2]);
        const float again[3] = {s.direction[0] / length, s.direction[1] / length, s.direction[2] / length};
        ASSERT_EQ(view.pdf(again), s.pdf) << "seed " << seed << ", sample " << n << ", normalised";
    }
}

TEST(EnvironmentView, pdfOfASampleIsExact) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        RandomOptions options = options_of(seed);
        options.tilts = false;
        expect_equal_pdf(loaded(random_environment(seed, options))->view, 1000, seed);
    }
}

TEST(EnvironmentView, pdfOfASampleIsExactInNarrowCells) {
    const std::uint32_t sizes[][2] = {{16384, 8192}, {65536, 65536}, {1, 65536}, {65536, 1}};
    for (std::uint32_t seed = 0; seed < 80; ++seed) {
        RandomOptions options;
        options.octahedral = seed >= 40;
        options.columns = sizes[seed % 4][0];
        options.rows = sizes[seed % 4][1];
        options.tilts = false;
        options.narrow_cells = true;
        options.segments = 24;
        options.depth = 4;
        expect_equal_pdf(loaded(random_environment(seed, options))->view, 5000, seed);
    }
}

// Cells of one row and one column, at both poles, the equator and the seam, and on the square at its sides, its
// middle and its corners, each with half the probability.
void expect_equal_pdf_at_edges(std::uint32_t columns, std::uint32_t rows, bool octahedral) {
    for (std::uint32_t row : {0u, 1u, 2u, rows / 4, rows / 2 - 1, rows / 2, rows - 2, rows - 1})
        for (std::uint32_t column : {0u, 1u, columns / 4, columns / 2 - 1, columns / 2, columns - 1}) {
            const auto around = [](std::uint32_t at, std::uint32_t end) {
                std::vector<std::uint32_t> knots;
                if (at > 0) knots.push_back(at);
                if (at + 1 < end) knots.push_back(at + 1);
                return knots;
            };
            EnvironmentSpec spec;
            spec.columns = columns;
            spec.rows = rows;
            CurveSpec theta = even_curve(1, around(row, rows));
            theta.link_bytes = 1;
            theta.children.assign(theta.segments(), 1);
            spec.tree = {{theta, even_curve(0, around(column, columns))}, {}};
            spec.octahedral = octahedral;
            expect_equal_pdf(loaded(spec)->view, 2000, row * 7 + column);
        }
}
TEST(EnvironmentView, pdfOfASampleIsExactAtThePolesAndTheSeam) { expect_equal_pdf_at_edges(16384, 8192, false); }
TEST(EnvironmentView, pdfOfASampleIsExactAtTheFoldsOfTheSquare) {
    expect_equal_pdf_at_edges(16384, 16384, true);
    expect_equal_pdf_at_edges(65536, 65536, true);
}

TEST(EnvironmentView, invertGivesTheRandomNumbersBack) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        RandomOptions options = options_of(seed);
        options.depth = 3;
        const auto env = loaded(random_environment(seed, options));
        std::mt19937_64 rng(seed);
        for (int n = 0; n < 300; ++n) {
            const auto s = env->view.sample(uniform(rng), uniform(rng));
            double u[2];
            ASSERT_TRUE(env->view.invert(s.direction, u));
            for (double v : u) ASSERT_TRUE(v >= 0.0 && v <= 1.0) << v;
            const auto again = env->view.sample(u[0], u[1]);
            for (int i = 0; i < 3; ++i) ASSERT_NEAR(again.direction[i], s.direction[i], 1e-6) << seed << ' ' << n;
        }
    }
    const auto env = loaded(EnvironmentSpec());
    const float dark[3] = {0, 0, 0};
    double u[2];
    EXPECT_FALSE(env->view.invert(dark, u));
}

bool good(const acdf::DirectionSample& s) {
    const double length = std::hypot(std::hypot(s.direction[0], s.direction[1]), s.direction[2]);
    return std::fabs(length - 1.0) < 1e-6 && std::isfinite(s.pdf) && s.pdf > 0.0f;
}

TEST(EnvironmentView, anyRandomNumberGivesASample) {
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> edges = {0.0,    -0.0, 1.0,  1.0 - 0x1p-24, 1.0 - 0x1p-53, 0x1p-24,   0x1p-53,     5e-324,
                                 1e-310, 0.5,  -1.0, 2.0,           infinity,      -infinity, std::nan("")};
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        EnvironmentSpec spec = random_environment(seed, options_of(seed));
        std::vector<double> us = edges;
        for (const CurveSpec& curve : spec.tree.curves)
            for (std::uint32_t c : curve.cumulative) { // exactly on a knot, and beside it
                const double u = static_cast<double>(c) / curve.maximum();
                us.insert(us.end(), {u, std::nextafter(u, 0.0), std::nextafter(u, 1.0)});
                if (us.size() > 60) break;
            }
        const auto env = loaded(spec);
        for (double u0 : us)
            for (double u1 : us) {
                const auto s = env->view.sample(u0, u1);
                ASSERT_TRUE(good(s)) << seed << ": " << u0 << ' ' << u1;
                ASSERT_GT(env->view.pdf(s.direction), 0.0f) << seed << ": " << u0 << ' ' << u1;
            }
    }
}

TEST(EnvironmentView, directionsAtTheEdges) {
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    const float none[][3] = {{0, 0, 0},     {nan, 0, 1},    {0, nan, 1},     {1, 0, nan},     {inf, 0, 0},
                             {0.9f, 0, 0},  {0, 1.1f, 0},   {2, 0, 0},       {0, 0, -0.99f},  {inf, inf, -inf},
                             {1e30f, 0, 0}, {1e-30f, 0, 0}, {0.8f, 0.8f, 0}, {nan, nan, nan}, {0, 0, 3e38f}};
    const float some[][3] = {{0, 0, 1},
                             {0, 0, -1},
                             {-0.0f, -0.0f, 1},
                             {1, 0, 0},
                             {-1, 0, 0},
                             {0, 1, 0},
                             {-1, -0.0f, 0},
                             {0, -1, 0},
                             {1, 1e-38f, -1e-38f},
                             {1e-20f, -1e-20f, 1},
                             {1.0004f, 0, 0},
                             {0, 0, 0.9996f},
                             {-1, 1e-8f, 0},
                             {-1, -1e-8f, 0}};
    EnvironmentSpec lit;
    const auto uniform = loaded(lit);
    for (const auto& d : none) EXPECT_EQ(uniform->view.pdf(d), 0.0f) << d[0] << ' ' << d[1] << ' ' << d[2];
    for (const auto& d : some)
        EXPECT_FLOAT_EQ(uniform->view.pdf(d), static_cast<float>(0.25 / M_PI))
            << d[0] << ' ' << d[1] << ' ' << d[2];
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        RandomOptions options = options_of(seed);
        options.dark = false;
        const auto env = loaded(random_environment(seed, options));
        for (const auto& d : none) EXPECT_EQ(env->view.pdf(d), 0.0f);
        for (const auto& d : some) EXPECT_GT(env->view.pdf(d), 0.0f) << d[0] << ' ' << d[1] << ' ' << d[2];
        if (options.octahedral) continue;
        // The seam phi = -pi belongs to column 0, as +pi does.
        const float plus[3] = {-1, 0.0f, 0}, minus[3] = {-1, -0.0f, 0}, rounded[3] = {-1, -1e-30f, 0};
        EXPECT_EQ(env->view.pdf(plus), env->view.pdf(minus));
        EXPECT_EQ(env->view.pdf(plus), env->view.pdf(rounded));
    }
}

// Strata of the random numbers stay strata: within a cell each coordinate follows its random number.
TEST(EnvironmentView, isMonotoneWithinASegment) {
    for (std::uint32_t k = 0; k < 60; ++k) {
        RandomOptions options = options_of(k % 2 == 0 ? k : latlong_count + k);
        options.depth = 1; // one curve: the other axis is whole
        const auto env = loaded(RandomTree(k, options).make());
        const Environment reference(env->bytes);
        double last[2] = {0.0, 0.0};
        for (int n = 0; n <= 2000; ++n) {
            const double u = n / 2000.0;
            // 0.45: on the square the folds are lines of the other axis
            const auto a = env->view.sample(u, 0.45), b = env->view.sample(0.45, u);
            double of_a[2], of_b[2];
            reference.position_of({a.direction[0], a.direction[1], a.direction[2]}, of_a);
            reference.position_of({b.direction[0], b.direction[1], b.direction[2]}, of_b);
            ASSERT_GE(of_a[0], last[0] - 1e-6 * options.columns);
            ASSERT_GE(of_b[1], last[1] - 1e-6 * options.rows);
            last[0] = of_a[0];
            last[1] = of_b[1];
        }
    }
}

// The mean of the pdf over each cell, times its solid angle, sums to one. A product of linear functions is
// integrated exactly by two Gauss points an axis.
TEST(EnvironmentView, integratesToOne) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        const auto env = loaded(random_environment(seed, options_of(seed)));
        const Environment reference(env->bytes);
        double sum = 0.0, probability = 0.0;
        reference.each_cell([&](const Cell& cell) {
            const double gauss[2] = {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)};
            for (double t0 : gauss)
                for (double t1 : gauss) {
                    double at[3];
                    reference.direction_in(cell, t0, t1, at);
                    const float d[3] = {static_cast<float>(at[0]), static_cast<float>(at[1]),
                                        static_cast<float>(at[2])};
                    sum += 0.25 * env->view.pdf(d) * reference.solid_angle(cell);
                }
            probability += cell.p;
        });
        EXPECT_NEAR(probability, 1.0, 1e-12) << seed;
        EXPECT_NEAR(sum, 1.0, 1e-5) << seed;
    }
}

} // namespace
