// From an array to a table file: how good the fit is, and that measurements are of the stored pdf.
#include "tests/inputs/table_files.h"
#include "tests/lib/compress/chi_square.h"

#include "compress/fit/fit.h"
#include "compress/fit/tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

namespace {

using namespace acdf;
using namespace acdf::test;

build::TableOptions with_cells(std::uint32_t cells, std::uint32_t indexed = 0) {
    build::TableOptions options;
    options.cells = cells;
    options.indexed = indexed;
    return options;
}

/// The least relative variance of `cells` cells over a 1D table, by dynamic programming over all partitions: of the
/// sum of C = sqrt(length * sum of f^2), which E[(f/p)^2] is the square of.
double optimal_variance(const std::vector<float>& f, std::size_t cells) {
    const std::size_t n = f.size();
    std::vector<double> square(n + 1, 0.0);
    double mean = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        square[i + 1] = square[i] + double{f[i]} * f[i];
        mean += double{f[i]};
    }
    const auto cost = [&](std::size_t a, std::size_t b) {
        return std::sqrt(static_cast<double>(b - a) * (square[b] - square[a]));
    };
    std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
    best[0] = 0.0;
    for (std::size_t k = 0; k < cells; ++k) {
        std::vector<double> next(n + 1, std::numeric_limits<double>::infinity());
        for (std::size_t b = 1; b <= n; ++b)
            for (std::size_t a = 0; a < b; ++a) next[b] = std::min(next[b], best[a] + cost(a, b));
        best = std::move(next);
    }
    return best[n] * best[n] / (mean * mean) - 1.0;
}

/// How many cells a 1D cascade has, and its variance before its probabilities are rounded.
struct Curve1D {
    std::size_t cells = 0;
    double variance = 0.0;
};

Curve1D curve_of(const compress::Cascade& cascade, const input::NpyArray& array) {
    ShapeVector knots{0, array.shape[0]};
    for (const compress::Curve& curve : cascade.curves)
        knots.insert(knots.end(), curve.knots.begin(), curve.knots.end());
    std::sort(knots.begin(), knots.end());
    double cost = 0.0, mean = 0.0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        double square = 0.0;
        for (std::uint32_t j = knots[i]; j < knots[i + 1]; ++j) {
            square += double{array.values[j]} * array.values[j];
            mean += double{array.values[j]};
        }
        cost += std::sqrt((knots[i + 1] - knots[i]) * square);
    }
    return {knots.size() - 1, cost * cost / (mean * mean) - 1.0};
}

/// Relative variance of f/p over all boxes, with the pdf asked from the file at their centres.
double brute_variance(const TableView& view, const std::uint32_t* index, const float* f, const ShapeVector& shape) {
    const std::size_t n = count_of(shape);
    double volume = 1.0, integral = 0.0, square = 0.0;
    for (std::size_t k = 0; k < shape.size(); ++k) {
        const AcdfAxis& a = view.sampled_axis(static_cast<std::uint32_t>(k));
        volume *= std::abs(a.high - a.low) / shape[k];
    }
    ShapeVector at(shape.size(), 0);
    for (std::size_t i = 0; i < n; ++i) {
        double x[8] = {};
        for (std::size_t k = 0; k < shape.size(); ++k) {
            const AcdfAxis& a = view.sampled_axis(static_cast<std::uint32_t>(k));
            x[k] = a.low + (a.high - a.low) * (at[k] + 0.5) / shape[k];
        }
        const double p = view.pdf(index, x);
        if (f[i] > 0.0f) {
            EXPECT_GT(p, 0.0) << "a support violation at " << i;
            square += volume * double{f[i]} * f[i] / p;
        }
        integral += volume * double{f[i]};
        for (std::size_t k = shape.size(); k-- > 0 && ++at[k] == shape[k];) at[k] = 0;
    }
    return square / (integral * integral) - 1.0;
}

TEST(TableFit, OneAxisIsNearTheOptimalPartition) {
    const std::vector<input::NpyArray> arrays = {
        noisy_array({64}, 1, 0.0), noisy_array({90}, 2, 0.3),
        array_of({80}, [](const ShapeVector& i) { return 1.0 + std::sin(0.11 * i[0]); }),
        array_of({100}, [](const ShapeVector& i) { return i[0] == 31 || i[0] == 77 ? 50.0 : 1.0 + 0.02 * i[0]; }),
        array_of({64}, [](const ShapeVector& i) { return std::exp(-0.15 * i[0]); })};
    for (std::size_t k = 0; k < arrays.size(); ++k)
        for (const std::uint32_t cells : {4u, 8u, 16u, 24u, 40u}) {
            SCOPED_TRACE("array " + std::to_string(k) + ", " + std::to_string(cells) + " cells");
            compress::FitOptions fit;
            fit.goal.cells = cells;
            const std::vector<compress::Grid> grids = build::table_grids(arrays[k], 0);
            const compress::Fitted fitted = compress::fit_trees(grids, fit);
            const Curve1D found = curve_of(fitted.cascade, arrays[k]);
            EXPECT_LE(found.cells, cells);
            EXPECT_LE(found.variance, 1.1 * optimal_variance(arrays[k].values, found.cells));
            if (k != 3 || cells > 4) { // two spikes: nothing gains before both sides of one are cut
                EXPECT_GE(found.cells, cells - cells / 8);
            }
            // Rounding the probabilities is worth its bytes, but never more than the size itself.
            const build::Table table = table_of(arrays[k], with_cells(cells));
            EXPECT_LE(table.accuracy.relative_variance, 1.5 * found.variance);
            EXPECT_EQ(table.accuracy.cells, found.cells);
        }
}

TEST(TableFit, MeasuresWhatBruteForceFinds) {
    for (const ShapeVector& shape : {ShapeVector{50}, ShapeVector{17, 23}, ShapeVector{9, 8, 11},
                                     ShapeVector{5, 6, 4, 7}, ShapeVector{3, 4, 3, 4, 3, 4}}) {
        SCOPED_TRACE(shape.size());
        const input::NpyArray array = noisy_array(shape, 7 + shape.size());
        build::TableOptions options = with_cells(60);
        for (std::size_t k = 0; k < shape.size(); ++k) options.ranges.emplace_back(1.0, -0.5 * double(k));
        const build::Table table = table_of(array, options);
        const LoadedTable loaded(table.bytes);
        const double brute = brute_variance(loaded.file.table(), nullptr, array.values.data(), shape);
        EXPECT_NEAR(table.accuracy.relative_variance, brute, 1e-9 * (1.0 + brute));
        EXPECT_EQ(table.accuracy.support_violations, 0u);
        EXPECT_LE(table.accuracy.cells, 60u);
        EXPECT_LT(brute, brute_variance(LoadedTable(table_of(array, with_cells(10)).bytes).file.table(), nullptr,
                                        array.values.data(), shape));
        EXPECT_GE(table.accuracy.max_weight, 1.0);
    }
}

TEST(TableFit, TwoAxesAreFittedAsAnEnvironmentIs) {
    const input::NpyArray array = noisy_array({40, 60}, 11);
    compress::Target target;
    target.rows = 40;
    target.columns = 60;
    target.values = array.values;
    target.row_measure.assign(40, 1.0 / 40);
    target.column_measure.assign(60, 1.0 / 60);
    target.row_axis = 0;
    target.column_axis = 1;
    target.total = compress::integral(target);
    for (const std::uint32_t cells : {1u, 30u, 400u}) {
        compress::FitOptions fit;
        fit.goal.cells = cells;
        const compress::EncodedTree expected = compress::fit(target, fit).tree;
        const LoadedTable loaded(table_of(array, with_cells(cells)).bytes);
        ASSERT_EQ(loaded.file.tree_units() * 2u, expected.bytes.size());
        EXPECT_TRUE(std::equal(expected.bytes.begin(), expected.bytes.end(), loaded.file.tree()));
    }
}

TEST(TableFit, ThreeAxesIntegrateToOneAndSamplesFollowTheTable) {
    const ShapeVector shape{7, 6, 5};
    const input::NpyArray array = noisy_array(shape, 4);
    build::TableOptions options = with_cells(1000000); // as many as there are numbers
    options.ranges = {{0, 2}, {-1, 1}, {5, 4}};
    const LoadedTable loaded(table_of(array, options).bytes);
    const TableView view = loaded.file.table();
    double total = 0.0;
    for (const float f : array.values) total += double{f};
    EXPECT_NEAR(view.total() / (total * 2.0 * 2.0 * 1.0 / 210), 1.0, 1e-12);
    std::vector<double> expected; // of the file, which is what samples follow exactly
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 210; ++i) {
        const double x[3] = {2.0 * (i / 30 + 0.5) / 7, -1.0 + 2.0 * (i / 5 % 6 + 0.5) / 6, 5.0 - (i % 5 + 0.5) / 5};
        expected.push_back(view.pdf(nullptr, x) * 4.0 / 210);
        sum += expected.back();
        EXPECT_EQ(expected.back() > 0.0, array.values[i] > 0.0f) << i;
        if (array.values[i] > 0.0f) {
            EXPECT_NEAR(expected.back() / (double{array.values[i]} / total), 1.0, 0.1) << i;
        }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    std::vector<std::uint32_t> observed(210, 0);
    std::mt19937_64 random(9);
    for (int n = 0; n < 100000; ++n) {
        double u[3], x[3];
        for (double& v : u) v = acdf_test::uniform(random);
        view.sample(nullptr, u, x);
        const auto i = static_cast<std::size_t>(x[0] / 2 * 7), j = static_cast<std::size_t>((x[1] + 1) / 2 * 6),
                   k = static_cast<std::size_t>((5 - x[2]) * 5);
        ++observed[(i * 6 + j) * 5 + k];
    }
    const acdf_test::ChiSquare test = acdf_test::chi_square(observed, expected);
    EXPECT_FALSE(test.impossible);
    EXPECT_GT(test.p_value, 0.001);
}

TEST(TableFit, IndexedBins) {
    // Bin (1, 2) is dark. The others hold i + 10 j times a bump that moves with them.
    const ShapeVector shape{2, 3, 16, 12};
    const input::NpyArray array = array_of(shape, [](const ShapeVector& at) {
        if (at[0] == 1 && at[1] == 2) return 0.0;
        const double x = at[2] - 4.0 * at[0], y = at[3] - 3.0 * at[1];
        return (1.0 + at[0] + 10.0 * at[1]) * std::exp(-0.05 * (x * x + y * y));
    });
    build::TableOptions options = with_cells(40, 2);
    options.names = {"i", "j", "x", "y"};
    options.ranges = {{0, 1}, {0, 1}, {-1, 1}, {0, 3}};
    const build::Table table = table_of(array, options);
    const LoadedTable loaded(table.bytes);
    const TableView view = loaded.file.table();
    EXPECT_EQ(loaded.file.description().bin_count, 6u);
    EXPECT_EQ(table.accuracy.lit_bins, 5u);
    EXPECT_LE(table.accuracy.cells, 240u);
    double total = 0.0, shares = 0.0, mean = 0.0, worst = 0.0;
    for (const float f : array.values) total += double{f};
    for (std::uint32_t i = 0; i < 2; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) {
            const std::uint32_t index[2] = {i, j};
            const float* const f = array.values.data() + (i * 3 + j) * 192;
            double sum = 0.0;
            for (int k = 0; k < 192; ++k) sum += double{f[k]};
            EXPECT_NEAR(view.share(index), sum / total, 1e-6);
            shares += view.share(index);
            const double u[2] = {0.3, 0.6};
            double x[2];
            EXPECT_EQ(view.sample(index, u, x) > 0.0, sum > 0.0);
            if (!(sum > 0.0)) continue;
            const double variance = brute_variance(view, index, f, {16, 12});
            mean += variance / 5;
            worst = std::max(worst, variance);
        }
    EXPECT_NEAR(shares, 1.0, 1e-6);
    EXPECT_NEAR(view.total() / (total * 6.0 / 192), 1.0, 1e-12);
    EXPECT_NEAR(table.accuracy.relative_variance, mean, 1e-9);
    EXPECT_NEAR(table.accuracy.worst, worst, 1e-9);
    EXPECT_LE(table.accuracy.median, worst);
    EXPECT_GT(table.accuracy.median, 0.0);
}

TEST(TableFit, BinsOfOneCell) {
    const build::Table table = table_of(
        array_of({5, 7}, [](const ShapeVector& at) { return at[0] == 2 ? 0.0 : 1.0 + at[0]; }), with_cells(8, 1));
    const LoadedTable loaded(table.bytes);
    for (std::uint32_t i = 0; i < 5; ++i) {
        const double x = 3.5;
        EXPECT_NEAR(loaded.file.table().pdf(&i, &x), i == 2 ? 0.0 : 1.0 / 7.0, 1e-12);
    }
}

// Shares that no float can hold stay positive: nothing with energy is lost.
TEST(TableFit, FaintBinsCanBeSampled) {
    const input::NpyArray array = array_of({2, 4}, [](const ShapeVector& at) {
        return at[0] == 0 ? 3e38 : at[1] == 2 ? 1e-42 : 0.0;
    });
    const build::Table table = table_of(array, with_cells(8, 1));
    const LoadedTable loaded(table.bytes);
    const std::uint32_t index = 1;
    const double u = 0.5;
    double x = 0.0;
    EXPECT_EQ(loaded.file.table().sample(&index, &u, &x), 1.0);
    EXPECT_EQ(std::floor(x), 2.0);
    EXPECT_EQ(table.accuracy.support_violations, 0u);
}

TEST(TableFit, GoalsAreMet) {
    const input::NpyArray array = noisy_array({20, 20, 20}, 5);
    build::TableOptions options;
    options.fit.goal.kind = compress::Goal::Kind::budget;
    options.fit.goal.budget = 8000;
    const build::Table small = table_of(array, options);
    EXPECT_LE(small.bytes.size(), 8000u);
    EXPECT_GE(small.bytes.size(), 7700u);
    options.fit.goal.kind = compress::Goal::Kind::variance;
    options.fit.goal.variance = 0.05;
    const build::Table accurate = table_of(array, options);
    EXPECT_LE(accurate.accuracy.relative_variance, 0.05);
    EXPECT_GE(accurate.accuracy.relative_variance, 0.045);
    options.fit.goal.variance = 1e-12;
    EXPECT_THROW(table_of(array, options), std::runtime_error);
    build::TableOptions light = with_cells(1500);
    light.fit.max_weight = 3.0;
    EXPECT_LE(table_of(array, light).accuracy.max_weight, 3.0);
    EXPECT_GT(table_of(array, with_cells(1500)).accuracy.max_weight, 3.0);
}

TEST(TableFit, TheSameBytesForAnyNumberOfThreads) {
    const input::NpyArray array = noisy_array({4, 3, 24, 30}, 8);
    std::vector<std::uint8_t> first;
    for (const std::size_t threads : {1u, 2u, 3u, 8u}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const std::vector<std::uint8_t> bytes = table_of(array, with_cells(64, 1)).bytes;
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first) << threads;
    }
}

TEST(TableFit, ScaledDoublesKeepTheirTotal) {
    input::NpyArray array = noisy_array({30}, 2);
    const double total = LoadedTable(table_of(array, with_cells(10)).bytes).file.table().total();
    array.scale = 0x1p300;
    const LoadedTable scaled(table_of(array, with_cells(10)).bytes);
    EXPECT_NEAR(scaled.file.table().total() / (total * 0x1p300), 1.0, 1e-12);
}

void expect_refused(const input::NpyArray& array, const build::TableOptions& options, const char* why) {
    try {
        table_of(array, options);
        ADD_FAILURE() << "accepted, though " << why;
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
}

TEST(TableFit, OptionsThatDoNotFit) {
    const input::NpyArray array = noisy_array({4, 5}, 1);
    expect_refused(array, with_cells(5, 2), "one at least is sampled");
    build::TableOptions options;
    options.names = {"a"};
    expect_refused(array, options, "1 names");
    options.names = {"a", "a"};
    expect_refused(array, options, "two axes are called 'a'");
    options.names = {"a", ""};
    expect_refused(array, options, "1 to 15 bytes");
    options.names = {"a", "sixteen bytes ab"};
    expect_refused(array, options, "1 to 15 bytes");
    options.names = {};
    for (const auto& [low, high] : {std::pair{1.0, 1.0}, {0.0, double{INFINITY}}, {double{NAN}, 1.0}}) {
        options.ranges = {{0, 1}, {low, high}};
        expect_refused(array, options, "empty or not finite");
    }
    for (const auto& [low, high] : {std::pair{1e13, 1e13 + 1.0}, {0.0, 1e40}, {0.0, 1e-40}, {-1e308, 1e308}}) {
        options.ranges = {{0, 1}, {low, high}};
        expect_refused(array, options, "choose other units");
    }
    expect_refused(array_of({4, 5}, [](const ShapeVector&) { return 0.0; }), {}, "nothing to sample");
    input::NpyArray huge = noisy_array({4, 5}, 1);
    huge.scale = 0x1p1020;
    std::fill(huge.values.begin(), huge.values.end(), 1e5f);
    expect_refused(huge, {}, "not a number that a double holds");
}

} // namespace
