// From an array to a table file: how good the fit is, and that measurements are of the stored pdf.
#include "tests/inputs/table_files.h"
#include "tests/lib/compress/chi_square.h"

#include "compress/halvings/code_bits.h"

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

/// The least relative variance of `cells` cells over a 1D table that halvings make: of the sum of C = sqrt(length *
/// sum of f^2), which E[(f/p)^2] is the square of, by dynamic programming over all trees.
class BestHalvings {
public:
    explicit BestHalvings(const std::vector<float>& f) : square_(f.size() + 1, 0.0), size_(f.size()) {
        for (std::size_t i = 0; i < f.size(); ++i) {
            square_[i + 1] = square_[i] + double{f[i]} * f[i];
            mean_ += double{f[i]};
        }
    }

    double variance(std::size_t cells) const {
        const std::vector<double> best = costs(0, size_, cells);
        const double least = *std::min_element(best.begin(), best.end());
        return least * least / (mean_ * mean_) - 1.0;
    }

private:
    /// Of 1, 2, ... cells.
    std::vector<double> costs(std::size_t low, std::size_t high, std::size_t most) const {
        std::vector<double> out = {std::sqrt(double(high - low) * (square_[high] - square_[low]))};
        if (high - low < 2 || most < 2) return out;
        const std::size_t middle = (low + high) / 2;
        const std::vector<double> lower = costs(low, middle, most - 1), upper = costs(middle, high, most - 1);
        for (std::size_t cells = 2; cells <= std::min(most, lower.size() + upper.size()); ++cells) {
            out.push_back(std::numeric_limits<double>::infinity());
            for (std::size_t a = 1; a < cells && a <= lower.size(); ++a)
                if (cells - a <= upper.size())
                    out.back() = std::min(out.back(), lower[a - 1] + upper[cells - a - 1]);
        }
        return out;
    }

    std::vector<double> square_;
    std::size_t size_;
    double mean_ = 0.0;
};

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

TEST(TableFit, OneAxisIsNearTheBestHalvings) {
    const std::vector<input::NpyArray> arrays = {
        noisy_array({64}, 1, 0.0),
        noisy_array({90}, 2, 0.3),
        array_of({80}, [](const ShapeVector& i) { return 1.0 + std::sin(0.11 * i[0]); }),
        array_of({100}, [](const ShapeVector& i) { return i[0] == 31 || i[0] == 77 ? 50.0 : 1.0 + 0.02 * i[0]; }),
        array_of({64}, [](const ShapeVector& i) { return std::exp(-0.15 * i[0]); }),
        array_of({96},
                 [](const ShapeVector& i) { return std::abs(int(i[0]) - 48) < 7 ? 20.0 : 1.0; })}; // in the middle
    for (std::size_t k = 0; k < arrays.size(); ++k)
        for (const std::uint32_t cells : {4u, 8u, 16u, 24u, 40u}) {
            SCOPED_TRACE("array " + std::to_string(k) + ", " + std::to_string(cells) + " cells");
            const build::Table table = table_of(arrays[k], with_cells(cells));
            EXPECT_LE(table.accuracy.cells, cells);
            const double rounding = compress::predicted_loss(cells, compress::kUsualCodeBits);
            EXPECT_LE(table.accuracy.relative_variance,
                      1.3 * BestHalvings(arrays[k].values).variance(table.accuracy.cells) + 2.0 * rounding);
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
    options.goal.kind = compress::Goal::Kind::budget;
    options.goal.budget = 8000;
    const build::Table small = table_of(array, options);
    EXPECT_LE(small.bytes.size(), 8000u);
    EXPECT_GE(small.bytes.size(), 7700u);
    options.goal.kind = compress::Goal::Kind::variance;
    options.goal.variance = 0.05;
    const build::Table accurate = table_of(array, options);
    EXPECT_LE(accurate.accuracy.relative_variance, 0.05);
    EXPECT_GE(accurate.accuracy.relative_variance, 0.045);
    options.goal.variance = 1e-12;
    EXPECT_THROW(table_of(array, options), std::runtime_error);
    build::TableOptions light = with_cells(1500);
    light.max_weight = 3.0;
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
