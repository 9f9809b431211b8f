// TableView: drawing, evaluating and inverting on axes of any number, range and order.
#include "tests/inputs/table_files.h"
#include "tests/lib/compress/chi_square.h"

#include <acdf/acdf.h>

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace {

using namespace acdf;
using namespace acdf::test;
using acdf_test::uniform;

compress::AxisDescription axis(const std::string& name, std::uint32_t resolution, double low, double high,
                               AcdfAxisRole role = ACDF_AXIS_SAMPLED) {
    return {name, role, ACDF_MEASURE_LINEAR, resolution, low, high};
}

std::vector<std::uint8_t> table_file(const compress::Cascade& cascade, std::vector<compress::AxisDescription> axes,
                                     std::vector<float> shares = {1.0f}) {
    compress::Description description;
    description.kind = ACDF_KIND_TABLE;
    description.parameterization = ACDF_PARAM_TABLE;
    for (const int i : {0, 1, 2}) description.channel_weights[i] = i == 0 ? 1.0 : 0.0;
    description.axes = std::move(axes);
    description.shares = std::move(shares);
    return compress::store(compress::encode_tree(cascade), description);
}

/// A random tree over `resolution`, some segments tilted or dark.
class RandomTree {
public:
    RandomTree(std::uint64_t seed, std::vector<std::uint32_t> resolution, std::uint32_t first_axis, bool tilted)
        : random_(seed), resolution_(std::move(resolution)), first_axis_(first_axis), tilted_(tilted) {}

    void add_bin(compress::Cascade& cascade) {
        cascade.roots.push_back(static_cast<std::uint32_t>(cascade.curves.size()));
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges;
        for (const std::uint32_t n : resolution_) ranges.emplace_back(0, n);
        add(cascade, ranges, 0);
    }

private:
    using Ranges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    std::int32_t add(compress::Cascade& cascade, const Ranges& ranges, int depth) {
        const auto index = static_cast<std::int32_t>(cascade.curves.size());
        cascade.curves.emplace_back();
        compress::Curve curve;
        const std::size_t axis = random_() % ranges.size();
        const auto [low, high] = ranges[axis];
        curve.axis = first_axis_ + static_cast<std::uint32_t>(axis);
        for (std::uint32_t at = low + 1; at < high; ++at)
            if (random_() % (1 + (high - low) / 3) == 0) curve.knots.push_back(at);
        double sum = 0.0;
        for (std::size_t i = 0; i < curve.segments(); ++i) {
            curve.probability.push_back(i > 0 && random_() % 5 == 0 ? 0.0 : 0.1 + uniform(random_));
            sum += curve.probability.back();
        }
        curve.children.assign(curve.segments(), -1);
        const bool tilted = tilted_ && random_() % 2;
        if (tilted) curve.tilts.assign(curve.segments(), 0.0);
        for (std::size_t i = 0; i < curve.segments(); ++i) {
            curve.probability[i] /= sum;
            Ranges inside = ranges;
            inside[axis] = {i == 0 ? low : curve.knots[i - 1], i + 1 == curve.segments() ? high : curve.knots[i]};
            if (curve.probability[i] > 0.0 && depth < 4 && !tilted && random_() % 3)
                curve.children[i] = add(cascade, inside, depth + 1);
            else if (tilted) curve.tilts[i] = 1.8 * uniform(random_) - 0.9;
        }
        cascade.curves[static_cast<std::size_t>(index)] = std::move(curve);
        return index;
    }

    std::mt19937_64 random_;
    std::vector<std::uint32_t> resolution_;
    std::uint32_t first_axis_;
    bool tilted_;
};

TEST(TableView, OneAxisByHand) {
    // [10, 20): 1/4 over two steps, 3/4 over eight.
    compress::Cascade cascade;
    cascade.curves.push_back({0, {2}, {0.25, 0.75}, {}, {}});
    cascade.roots = {0};
    const LoadedTable loaded(table_file(cascade, {axis("x", 10, 10.0, 20.0)}));
    const TableView view = loaded.file.table();
    EXPECT_EQ(view.sampled_count(), 1u);
    EXPECT_EQ(view.indexed_count(), 0u);
    EXPECT_EQ(view.share(nullptr), 1.0);
    double x = 0.0, u = 0.125;
    EXPECT_NEAR(view.sample(nullptr, &u, &x), 0.125, 1e-5);
    EXPECT_NEAR(x, 11.0, 1e-3);
    for (const double at : {10.0, 11.999}) EXPECT_NEAR(view.pdf(nullptr, &at), 0.125, 1e-3) << at;
    for (const double at : {12.0, 15.0, 20.0}) EXPECT_NEAR(view.pdf(nullptr, &at), 0.09375, 1e-3) << at;
    for (const double at : {9.999999, 20.000001, double{-INFINITY}, double{INFINITY}, double{NAN}, 1e300, -1e300})
        EXPECT_EQ(view.pdf(nullptr, &at), 0.0) << at;
}

TEST(TableView, TheCInterfaceGivesTheSame) {
    compress::Cascade cascade;
    RandomTree(1, {9, 7}, 0, true).add_bin(cascade);
    const std::vector<std::uint8_t> bytes = table_file(cascade, {axis("x", 9, 0, 3), axis("y", 7, 2, 1)});
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

struct Space {
    const char* name;
    std::vector<compress::AxisDescription> axes;
};

std::vector<Space> spaces() {
    std::vector<compress::AxisDescription> eight;
    for (int i = 0; i < 8; ++i) eight.push_back(axis("a" + std::to_string(i), 5, 0.0, 1.0 + i));
    return {{"one", {axis("x", 37, 0.0, 37.0)}},
            {"reversed", {axis("x", 12, 3.0, -5.0), axis("y", 9, -0.1, -0.7)}},
            {"far", {axis("x", 16, 1e6, 1e6 + 1e-4), axis("y", 7, -1.0, -1.0 + 0x1p-36)}},
            {"large", {axis("x", 2147483647, 0.0, 1e30), axis("y", 1000000, -1e-20, 1e-20)}},
            {"three", {axis("x", 20, -1.0, 1.0), axis("y", 30, 0.0, 7.3), axis("z", 11, 2.0, 2.5)}},
            {"eight", eight}};
}

double next_double(std::mt19937_64& random) {
    const double edges[] = {0.0, 1.0, 1.0 - 0x1p-53, 0x1p-60, 0.5};
    return random() % 4 == 0 ? edges[random() % 5] : uniform(random);
}

TEST(TableView, PdfIsExactlyThatOfTheSampleAndInvertLeadsBack) {
    for (const Space& space : spaces()) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            SCOPED_TRACE(std::string(space.name) + " " + std::to_string(seed));
            std::vector<std::uint32_t> resolution;
            for (const auto& a : space.axes) resolution.push_back(std::min(a.resolution, 1000u));
            compress::Cascade cascade;
            RandomTree(seed, resolution, 0, seed % 2).add_bin(cascade);
            const LoadedTable loaded(table_file(cascade, space.axes));
            const TableView view = loaded.file.table();
            std::mt19937_64 random(seed);
            for (int n = 0; n < 2000; ++n) {
                double u[8] = {}, x[8] = {}, back[8] = {}, again[8] = {};
                for (std::size_t i = 0; i < space.axes.size(); ++i) u[i] = next_double(random);
                const double pdf = view.sample(nullptr, u, x);
                ASSERT_TRUE(pdf > 0.0 && std::isfinite(pdf));
                ASSERT_EQ(view.pdf(nullptr, x), pdf);
                ASSERT_TRUE(view.invert(nullptr, x, back));
                ASSERT_NEAR(view.sample(nullptr, back, again), pdf, 0.02 * pdf) << "another cell";
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
    compress::Cascade cascade;
    RandomTree tree(3, {6, 7}, 2, true);
    for (int bin = 0; bin < 6; ++bin) tree.add_bin(cascade);
    std::vector<float> shares(6, 0.2f);
    shares[4] = 0.0f; // index 1, 1: nothing there
    const LoadedTable loaded(
        table_file(cascade,
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

// Bins are row-major over the indexed axes: each one's density sits in the step of its own number.
// A coordinate decides, not its position, which rounding brings back to the end.
TEST(TableView, CoordinatesNextToTheEndsAreOutside) {
    const compress::Cascade cascade = {{{0, {}, {1.0}, {}, {}}}, {0}};
    for (const auto& [low, high] : {std::pair{-1.0, 1.0}, {1.0, -1.0}, {-3.0, 0.1}, {1e9, 1e9 + 1.0}}) {
        const auto bytes = table_file(cascade, {axis("x", 3, low, high)});
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

TEST(TableView, BinsAreRowMajor) {
    compress::Cascade cascade;
    for (std::uint32_t bin = 0; bin < 12; ++bin) {
        compress::Curve curve;
        curve.axis = 2;
        for (std::uint32_t i = 1; i < 12; ++i) curve.knots.push_back(i);
        curve.probability.assign(12, 0.0);
        curve.probability[bin] = 1.0;
        cascade.roots.push_back(bin);
        cascade.curves.push_back(curve);
    }
    const LoadedTable loaded(table_file(
        cascade,
        {axis("i", 3, 0, 3, ACDF_AXIS_INDEXED), axis("j", 4, 0, 4, ACDF_AXIS_INDEXED), axis("x", 12, 0, 12)},
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

/// Integral of the density over each grid box, by the midpoint or, with tilts, exactly: it is linear on each axis.
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

TEST(TableView, DensityIntegratesToOneAndSamplesFollowIt) {
    constexpr int kTests = 12, kSamples = 60000;
    for (std::uint64_t seed = 0; seed < kTests; ++seed) {
        SCOPED_TRACE(seed);
        const std::vector<std::uint32_t> shape = seed % 3 == 0   ? std::vector<std::uint32_t>{41}
                                                 : seed % 3 == 1 ? std::vector<std::uint32_t>{9, 7}
                                                                 : std::vector<std::uint32_t>{5, 6, 4};
        std::vector<compress::AxisDescription> axes;
        for (std::size_t k = 0; k < shape.size(); ++k)
            axes.push_back(axis("x" + std::to_string(k), shape[k], 1.0 - double(k), -2.0 * double(k)));
        compress::Cascade cascade;
        RandomTree(seed, shape, 0, seed % 2).add_bin(cascade);
        const LoadedTable loaded(table_file(cascade, axes));
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
