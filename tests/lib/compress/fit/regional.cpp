// fit(): what all fits share, and the paper's cascade in particular.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/cascade_cells.h"

#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"
#include "compress/store/store.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <stdexcept>

namespace {

using namespace acdf::compress;

constexpr AcdfFit kFits[] = {ACDF_FIT_UNIFORM, ACDF_FIT_CDF, ACDF_FIT_PDF};

FitOptions options_of(AcdfFit fit, Order order) {
    FitOptions options;
    options.fit = fit;
    options.order = order;
    options.column_segments = 9;
    options.row_segments = 5;
    return options;
}

void expect_same(const Cascade& a, const Cascade& b) {
    ASSERT_EQ(a.curves.size(), b.curves.size());
    EXPECT_EQ(a.roots, b.roots);
    for (std::size_t i = 0; i < a.curves.size(); ++i) {
        EXPECT_EQ(a.curves[i].axis, b.curves[i].axis);
        EXPECT_EQ(a.curves[i].knots, b.curves[i].knots);
        EXPECT_EQ(a.curves[i].probability, b.curves[i].probability);
        EXPECT_EQ(a.curves[i].children, b.curves[i].children);
        EXPECT_EQ(a.curves[i].tilts, b.curves[i].tilts);
    }
}

TEST(Fit, OrderPhiIsOrderZOfTheTransposedTarget) {
    const Target t = acdf_test::noise_target(31, 23, 1, 1.0, 0.1);
    for (const AcdfFit kind : kFits) {
        SCOPED_TRACE(kind);
        FitOptions phi = options_of(kind, Order::phi), z = options_of(kind, Order::z);
        phi.gradient_knots = z.gradient_knots = 3;
        std::swap(z.column_segments, z.row_segments); // budgets belong to the axes, not to the order
        const Cascade a = fit(t, phi).cascade, b = fit(transposed(t), z).cascade;
        expect_same(a, b);
        EXPECT_EQ(a.curves[0].axis, ACDF_AXIS_PHI + 0u);
        EXPECT_EQ(fit(t, z).cascade.curves[0].axis, ACDF_AXIS_THETA + 0u);
    }
}

TEST(Transposed, TwiceIsTheSame) {
    const Target t = acdf_test::noise_target(131, 67, 1); // larger than a block, no multiple of one
    const Target back = transposed(transposed(t));
    EXPECT_EQ(back.values, t.values);
    EXPECT_EQ(back.column_measure, t.column_measure);
    EXPECT_EQ(back.row_measure, t.row_measure);
    EXPECT_EQ(transposed(t).row(130)[66], t.row(66)[130]);
    EXPECT_EQ(transposed(t).row(5)[64], t.row(64)[5]);
    EXPECT_NEAR(integral(transposed(t)) / integral(t), 1.0, 1e-14);
}

TEST(Target, MeasuresAreSolidAngles) {
    const Target t = acdf_test::sphere_target(36, 18, [](double, double) { return 0.5; });
    EXPECT_NEAR(integral(t), 0.5 * 4.0 * acdf_test::kPi, 1e-13);
    for (std::uint32_t r = 0; r < 18; ++r)
        EXPECT_NEAR(t.row_measure[r], std::cos(acdf_test::kPi * r / 18) - std::cos(acdf_test::kPi * (r + 1) / 18),
                    1e-15);
}

TEST(Target, WeighsChannelsAndDropsNegatives) {
    const float rgb[] = {1.0f, 2.0f, -4.0f, -1.0f, -1.0f, 8.0f};
    TargetOptions options;
    options.weights = {0.25, 0.5, 1.0};
    const Target t = environment_target(rgb, 2, 1, options);
    EXPECT_EQ(t.values, (std::vector<float>{1.25f, 8.0f}));
    EXPECT_EQ(environment_target(rgb, 2, 1, TargetOptions{}).values[1], static_cast<float>(8.0 * 0.0722));
}

TEST(Target, RefusesWhatIsNotFinite) {
    for (const float bad : {NAN, INFINITY}) {
        const float rgb[] = {1.0f, bad, 1.0f};
        EXPECT_THROW(environment_target(rgb, 1, 1, TargetOptions{}), std::invalid_argument);
    }
}

TEST(Fit, RefusesATargetWithoutEnergy) {
    const Target t = acdf_test::sphere_target(8, 4, [](double, double) { return 0.0; });
    for (const AcdfFit kind : kFits) EXPECT_THROW(fit(t, options_of(kind, Order::z)), std::invalid_argument);
}

TEST(Fit, KeepsItsBudgets) {
    for (const auto& [name, t] : acdf_test::synthetic_targets())
        for (const AcdfFit kind : kFits)
            for (const Order order : {Order::phi, Order::z}) {
                SCOPED_TRACE(name + " " + std::to_string(kind));
                const Cascade cascade = fit(t, options_of(kind, order)).cascade;
                EXPECT_LE(acdf_test::cells_of(cascade, t).size(), 45u);
                for (const Curve& curve : cascade.curves)
                    EXPECT_LE(curve.segments(), curve.axis == ACDF_AXIS_PHI ? 9u : 5u);
            }
}

TEST(Fit, GradientKnotsComeOnTopOfTheBudget) {
    const Target t = acdf_test::noise_target(40, 60, 8);
    for (const AcdfFit kind : {ACDF_FIT_CDF, ACDF_FIT_PDF}) {
        FitOptions options = options_of(kind, Order::z);
        const auto before = fit(t, options).cascade.curves[0].knots;
        options.gradient_knots = 7;
        const auto after = fit(t, options).cascade.curves[0].knots;
        EXPECT_GT(after.size(), before.size());
        EXPECT_LE(after.size(), before.size() + 7);
        EXPECT_TRUE(std::includes(after.begin(), after.end(), before.begin(), before.end()));
    }
}

TEST(Fit, ConstantTargetIsOneCell) { // the furnace
    const Target t = acdf_test::sphere_target(50, 25, [](double, double) { return 0.25; });
    for (const AcdfFit kind : {ACDF_FIT_CDF, ACDF_FIT_PDF})
        for (const Order order : {Order::phi, Order::z}) {
            SCOPED_TRACE(kind);
            FitOptions options = options_of(kind, order);
            options.epsilon = 1e-9; // rounding is no reason for a knot
            const Cascade cascade = fit(t, options).cascade;
            EXPECT_EQ(acdf_test::cells_of(cascade, t).size(), 1u);
            const auto bytes = store(encode_tree(cascade), environment_description(50, 25));
            acdf::File file;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
            const auto accuracy = acdf::build::measure_environment(file, t);
            EXPECT_NEAR(accuracy.relative_variance, 0.0, 1e-14);
            EXPECT_NEAR(accuracy.rms_pdf_error, 0.0, 1e-14);
            EXPECT_EQ(accuracy.cells, 1u);
        }
}

TEST(Fit, CellsWithoutEnergyHaveNoProbability) {
    for (const auto& [name, t] : acdf_test::synthetic_targets())
        for (const AcdfFit kind : kFits)
            for (const Order order : {Order::phi, Order::z}) {
                SCOPED_TRACE(name + " " + std::to_string(kind));
                for (const auto& cell : acdf_test::cells_of(fit(t, options_of(kind, order)).cascade, t))
                    EXPECT_EQ(acdf_test::cell_sums(cell, t).f > 0.0L, cell.probability > 0.0);
            }
}

TEST(Fit, SameBytesWithAnyNumberOfThreads) {
    const Target t = acdf_test::noise_target(300, 170, 6, 2.0, 0.1);
    for (const AcdfFit kind : kFits)
        for (const Order order : {Order::phi, Order::z}) {
            SCOPED_TRACE(kind);
            FitOptions options = options_of(kind, order);
            options.column_segments = options.row_segments = 20;
            options.goal.cells = 400;
            options.gradient_knots = 10;
            std::vector<std::uint8_t> first;
            for (const std::size_t threads : {1u, 2u, 7u}) {
                const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
                const auto bytes = store(fit(t, options).tree, environment_description(300, 170));
                if (first.empty()) first = bytes;
                EXPECT_EQ(bytes, first) << threads << " threads";
            }
        }
}

/// Probability of each column, from a cascade whose marginal is one region.
std::vector<double> column_shares(const Target& t, Conditional weighting) {
    FitOptions options = options_of(ACDF_FIT_CDF, Order::z);
    options.row_segments = 1;
    options.column_segments = t.columns;
    options.conditional = weighting;
    std::vector<double> shares;
    for (const auto& cell : acdf_test::cells_of(fit(t, options).cascade, t)) {
        EXPECT_EQ(cell.high[0] - cell.low[0], 1u);
        shares.push_back(cell.probability);
    }
    return shares;
}

TEST(Conditional, AveragesRowsByEnergyOrByExtent) {
    // The northernmost row is bright on the left, the next dim, twice as bright on the right as on the left, and
    // larger; the third is dark and has no conditional.
    const float f[4][2] = {{90.0f, 10.0f}, {1.0f, 2.0f}, {0.0f, 0.0f}, {0.0f, 0.0f}};
    const Target t = acdf_test::texel_target(2, 4, [&](std::uint32_t c, std::uint32_t r) { return f[r][c]; });
    const double cap = 1.0 - std::sqrt(0.5), belt = std::sqrt(0.5); // extents in z
    const auto energy = column_shares(t, Conditional::energy);
    EXPECT_NEAR(energy[0], (90.0 * cap + 1.0 * belt) / (100.0 * cap + 3.0 * belt), 1e-12);
    const auto mean = column_shares(t, Conditional::mean); // eq. 4
    EXPECT_NEAR(mean[0], (0.9 * cap + belt / 3.0) / (cap + belt), 1e-12);
}

} // namespace
