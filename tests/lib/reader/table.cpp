// TableView: sampling, evaluating and inverting on axes of any number, range and order.
#include "tests/lib/compress/chi_square.h"
#include "tests/lib/reader/table_random.h"

#include <acdf/acdf.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace {

using namespace acdf;
using namespace acdf::test;

TEST(TableView, OneAxisByHand) {
    // [10, 20): 1/4 over two steps, 3/4 over eight.
    TableTrees trees;
    trees.halvings.code_bits = 12;
    trees.halvings.axis_bits = 0;
    trees.halvings.axes = {0, 0, -1, -1, -1}; // [0, 5), of that [0, 2) and [2, 5); [5, 10)
    const compress::HalvingCodes codes(12);
    for (const double share : {0.53125, 0.25 / 0.53125})
        trees.halvings.codes.push_back(
            static_cast<std::uint16_t>(codes.best(ACDF_STEPS, share, 1.0 - share, 1.0, 1.0)));
    trees.roots = {0};
    const LoadedTable loaded(table_file(trees, {axis("x", 10, 10.0, 20.0)}));
    const TableView view = loaded.file.table();
    EXPECT_EQ(view.sampled_count(), 1u);
    EXPECT_EQ(view.indexed_count(), 0u);
    EXPECT_EQ(view.share(nullptr), 1.0);
    double x = 0.0, u = 0.125;
    const std::uint32_t lower = codes.lower(ACDF_STEPS, trees.halvings.codes[0]);
    const double of_first = codes.lower(lower, trees.halvings.codes[1]) * 0x1p-31;
    EXPECT_NEAR(of_first, 0.25, 1e-4); // as near as codes are
    EXPECT_EQ(view.sample(nullptr, &u, &x), 0.5 * of_first);
    EXPECT_NEAR(x, 11.0, 1e-3);
    for (const double at : {10.0, 11.999}) EXPECT_NEAR(view.pdf(nullptr, &at), 0.125, 1e-3) << at;
    for (const double at : {12.0, 15.0, 20.0}) EXPECT_NEAR(view.pdf(nullptr, &at), 0.09375, 1e-3) << at;
    for (const double at : {9.999999, 20.000001, double{-INFINITY}, double{INFINITY}, double{NAN}, 1e300, -1e300})
        EXPECT_EQ(view.pdf(nullptr, &at), 0.0) << at;
}

TEST(TableView, TheCInterfaceGivesTheSame) {
    RandomTableTrees random(1, {9, 7});
    random.add_bin();
    const std::vector<std::uint8_t> bytes = table_file(random.trees, {axis("x", 9, 0, 3), axis("y", 7, 2, 1)});
    const std::unique_ptr<AcdfFile, decltype(&acdf_close)> handle(
        acdf_from_memory(bytes.data(), bytes.size(), nullptr), acdf_close);
    ASSERT_TRUE(handle);
    AcdfTable table;
    AcdfEnvironment none;
    ASSERT_EQ(acdf_table(handle.get(), &table), 1);
    EXPECT_EQ(acdf_environment(handle.get(), &none), 0);
    const LoadedTable loaded(bytes);
    const double u[2] = {0.25, 0.75};
    double x[2], y[2];
    EXPECT_EQ(acdf_table_sample(&table, nullptr, u, x), loaded.file.table().sample(nullptr, u, y));
    EXPECT_EQ(x[0], y[0]);
    EXPECT_EQ(x[1], y[1]);
    const std::vector<std::uint8_t> sky = small_environment();
    const std::unique_ptr<AcdfFile, decltype(&acdf_close)> other(acdf_from_memory(sky.data(), sky.size(), nullptr),
                                                                 acdf_close);
    EXPECT_EQ(acdf_table(other.get(), &table), 0);
}

TEST(TableView, PdfIsExactlyThatOfTheSampleAndInvertLeadsBack) {
    for (const Space& space : spaces()) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            SCOPED_TRACE(std::string(space.name) + " " + std::to_string(seed));
            const LoadedTable loaded(random_table(space, seed));
            const TableView view = loaded.file.table();
            std::mt19937_64 random(seed);
            for (int n = 0; n < 2000; ++n) {
                double u[8] = {}, x[8] = {}, back[8] = {}, again[8] = {};
                for (std::size_t i = 0; i < space.axes.size(); ++i) u[i] = next_double(random);
                const double pdf = view.sample(nullptr, u, x);
                ASSERT_TRUE(pdf > 0.0 && std::isfinite(pdf));
                ASSERT_EQ(view.pdf(nullptr, x), pdf);
                ASSERT_TRUE(view.invert(nullptr, x, back));
                ASSERT_EQ(view.sample(nullptr, back, again), pdf) << "another cell";
                for (std::size_t i = 0; i < space.axes.size(); ++i) {
                    const double low = std::min(space.axes[i].low, space.axes[i].high);
                    const double high = std::max(space.axes[i].low, space.axes[i].high);
                    ASSERT_TRUE(x[i] >= low && x[i] <= high) << x[i];
                    ASSERT_NEAR(back[i], u[i], 1e-2); // the border of a cell of one far step, over its range
                }
            }
        }
    }
}

TEST(TableView, OutOfRangeAndBadNumbersAreSafe) {
    RandomTableTrees random(3, {6, 7});
    for (int bin = 0; bin < 6; ++bin) bin == 4 ? random.add_none() : random.add_bin();
    std::vector<float> shares(6, 0.2f);
    shares[4] = 0.0f; // index 1, 1: nothing there
    const LoadedTable loaded(
        table_file(random.trees,
                   {axis("i", 2, 0, 2, ACDF_AXIS_INDEXED), axis("j", 3, 0, 3, ACDF_AXIS_INDEXED),
                    axis("x", 6, 0, 1), axis("y", 7, 0, 1)},
                   shares));
    const TableView view = loaded.file.table();
    EXPECT_EQ(view.indexed_count(), 2u);
    const double bad[] = {NAN, -1.0, 2.0, INFINITY, -INFINITY, 1e308, 0.5};
    for (const double a : bad)
        for (const double b : bad) {
            const std::uint32_t index[2] = {0, 2};
            const double u[2] = {a, b};
            double x[2];
            EXPECT_GT(view.sample(index, u, x), 0.0);
            EXPECT_GT(view.pdf(index, x), 0.0);
            const double pdf = view.pdf(index, u);
            EXPECT_TRUE(a == 0.5 && b == 0.5 ? pdf >= 0.0 : pdf == 0.0) << a << " " << b;
        }
    const std::uint32_t nowhere[][2] = {{1, 1}, {2, 0}, {0, 3}, {0xFFFFFFFF, 0}, {0, 0xFFFFFFFF}};
    for (const auto& index : nowhere) {
        const double u[2] = {0.5, 0.5};
        double x[2] = {-7.0, -7.0};
        EXPECT_EQ(view.sample(index, u, x), 0.0);
        EXPECT_EQ(x[0], -7.0);
        EXPECT_EQ(view.pdf(index, u), 0.0);
        EXPECT_FALSE(view.invert(index, u, x));
        EXPECT_EQ(view.share(index), 0.0);
    }
}

// A coordinate decides, not its position, which rounding brings back to the end.
TEST(TableView, CoordinatesNextToTheEndsAreOutside) {
    const TableTrees whole = compress::whole_cells({1.0f});
    for (const auto& [low, high] : {std::pair{-1.0, 1.0}, {1.0, -1.0}, {-3.0, 0.1}, {1e9, 1e9 + 1.0}}) {
        const auto bytes = table_file(whole, {axis("x", 3, low, high)});
        File file;
        ASSERT_TRUE(File::from_memory(bytes.data(), bytes.size(), file).ok());
        const TableView view = file.table();
        for (const double end : {low, high}) {
            const double away = end == std::max(low, high) ? 1e300 : -1e300, outside = std::nextafter(end, away);
            EXPECT_GT(view.pdf(nullptr, &end), 0.0) << end;
            EXPECT_EQ(view.pdf(nullptr, &outside), 0.0) << outside - end;
        }
    }
}

// Bins are row-major over the indexed axes: each one's pdf sits in the step of its own number.
TEST(TableView, BinsAreRowMajor) {
    TableTrees trees;
    trees.halvings.axis_bits = 0;
    for (std::uint32_t bin = 0; bin < 12; ++bin) {
        trees.roots.push_back(static_cast<std::uint32_t>(trees.halvings.codes.size()));
        AcdfSpan left = {{0, 12}};
        std::size_t behind = 0;
        for (; left.end[1] - left.end[0] > 1;) { // all on the side of the step, the other one dark
            const std::uint32_t middle = acdf_span_middle(&left), upper = bin >= middle;
            trees.halvings.axes.push_back(0);
            trees.halvings.codes.push_back(upper ? 0 : 255);
            if (upper) trees.halvings.axes.push_back(-1);
            else ++behind;
            left.end[1 - upper] = middle;
        }
        trees.halvings.axes.insert(trees.halvings.axes.end(), 1 + behind, -1);
    }
    const LoadedTable loaded(table_file(
        trees, {axis("i", 3, 0, 3, ACDF_AXIS_INDEXED), axis("j", 4, 0, 4, ACDF_AXIS_INDEXED), axis("x", 12, 0, 12)},
        std::vector<float>(12, 1.0f / 12)));
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t j = 0; j < 4; ++j) {
            const std::uint32_t index[2] = {i, j};
            const double u = 0.4;
            double x = 0.0;
            EXPECT_EQ(loaded.file.table().sample(index, &u, &x), 1.0);
            EXPECT_EQ(static_cast<std::uint32_t>(x), 4 * i + j);
        }
}

/// Integral of the pdf over each grid box.
std::vector<double> box_probabilities(const TableView& view, const std::vector<std::uint32_t>& shape) {
    std::vector<double> out;
    ShapeVector index(shape.size(), 0);
    for (std::size_t i = 0; i < count_of(shape); ++i) {
        double x[8] = {}, volume = 1.0;
        for (std::size_t k = 0; k < shape.size(); ++k) {
            const AcdfAxis& a = view.sampled_axis(static_cast<std::uint32_t>(k));
            x[k] = a.low + (a.high - a.low) * (index[k] + 0.5) / shape[k];
            volume *= std::abs(a.high - a.low) / shape[k];
        }
        out.push_back(view.pdf(nullptr, x) * volume);
        for (std::size_t k = shape.size(); k-- > 0 && ++index[k] == shape[k];) index[k] = 0;
    }
    return out;
}

TEST(TableView, PdfIntegratesToOneAndSamplesFollowIt) {
    constexpr int kTests = 12, kSamples = 60000;
    for (std::uint64_t seed = 0; seed < kTests; ++seed) {
        SCOPED_TRACE(seed);
        const std::vector<std::uint32_t> shape = seed % 3 == 0   ? std::vector<std::uint32_t>{41}
                                                 : seed % 3 == 1 ? std::vector<std::uint32_t>{9, 7}
                                                                 : std::vector<std::uint32_t>{5, 6, 4};
        std::vector<compress::AxisDescription> axes;
        for (std::size_t k = 0; k < shape.size(); ++k)
            axes.push_back(axis("x" + std::to_string(k), shape[k], 1.0 - double(k), -2.0 * double(k)));
        RandomTableTrees random_trees(seed, shape);
        random_trees.add_bin();
        const LoadedTable loaded(table_file(random_trees.trees, axes));
        const TableView view = loaded.file.table();
        const std::vector<double> expected = box_probabilities(view, shape);
        double sum = 0.0;
        for (const double p : expected) sum += p;
        ASSERT_NEAR(sum, 1.0, 1e-9);

        std::mt19937_64 random(100 + seed);
        std::vector<std::uint32_t> observed(expected.size(), 0);
        for (int n = 0; n < kSamples; ++n) {
            double u[8] = {}, x[8] = {};
            for (std::size_t k = 0; k < shape.size(); ++k) u[k] = uniform(random);
            view.sample(nullptr, u, x);
            std::size_t box = 0;
            for (std::size_t k = 0; k < shape.size(); ++k)
                box = box * shape[k] +
                      static_cast<std::size_t>((x[k] - axes[k].low) / (axes[k].high - axes[k].low) * shape[k]);
            ++observed[box];
        }
        const acdf_test::ChiSquare test = acdf_test::chi_square(observed, expected);
        EXPECT_FALSE(test.impossible);
        EXPECT_GT(test.p_value, acdf_test::sidak(0.01, kTests));
    }
}

} // namespace
