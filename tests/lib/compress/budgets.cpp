// What a byte buys on real probes: the figures that docs/method.md quotes, as bounds. Whole files, stored
// uncompressed, metadata of the usual length included; variances by exact summation over the stored pdf.
#include "tests/inputs/paths.h"

#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"
#include "compress/halvings/fit.h"
#include "compress/store/store.h"
#include "input/probe/probe.h"

#include <acdf/curves/curves.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace acdf;

struct Probe {
    const char* file;
    input::Projection projection;
};
constexpr Probe probes[] = {
    {"city.exr", input::Projection::latlong},          {"sunset.exr", input::Projection::latlong},
    {"studio.exr", input::Projection::latlong},        {"courtyard.exr", input::Projection::latlong},
    {"noon_grass_1k.hdr", input::Projection::latlong}, {"venice_sunset_1k.hdr", input::Projection::latlong}};

/// A file and its accuracy.
struct Made {
    std::vector<std::uint8_t> bytes;
    build::Accuracy accuracy;
};

class Budgets : public testing::Test {
protected:
    static void SetUpTestSuite() {
        const std::string folder = std::string(acdf_test::kTestData) + "/probes/";
        for (const Probe& probe : probes) {
            if (!std::filesystem::exists(folder + probe.file)) return targets_.clear();
            input::ProbeOptions options;
            options.projection = probe.projection;
            const input::Probe map = input::read_probe(folder + probe.file, options);
            ASSERT_EQ(map.width, 1024) << probe.file;
            targets_.push_back(compress::environment_target(map.rgb.data(), 1024, 512, {}));
        }
    }
    static void TearDownTestSuite() {
        targets_.clear();
        made_.clear();
    }
    void SetUp() override {
        if (targets_.empty()) GTEST_SKIP() << "no probes in " << acdf_test::kTestData;
    }

    static const Made& made(std::size_t i, std::uint64_t budget);
    static double mean_variance(std::uint64_t budget);

    static std::vector<compress::Target> targets_;
    static std::map<std::pair<std::size_t, std::uint64_t>, Made> made_;
};
std::vector<compress::Target> Budgets::targets_;
std::map<std::pair<std::size_t, std::uint64_t>, Made> Budgets::made_;

compress::Description usual_description(const compress::Target& target) {
    compress::Description description =
        compress::environment_description(target.columns, target.rows, target.parameterization);
    description.total = target.total;
    description.metadata = {{"about.as.long.as.usual", std::string(500, ' ')}};
    return description;
}

std::vector<std::uint8_t> usual_file(const compress::Target& target, const compress::HalvingsOptions& options) {
    return compress::store(compress::fit_halvings(target, options), usual_description(target));
}

build::Accuracy measured(const std::vector<std::uint8_t>& bytes, const compress::Target& target) {
    File file;
    const Status status = File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    return build::measure_environment(file, target);
}

std::vector<std::uint8_t> within(const compress::Target& target, std::uint64_t budget) {
    compress::HalvingsOptions options;
    options.goal.kind = compress::Goal::Kind::budget;
    options.chunk_bytes = compress::halvings_room(usual_description(target), budget);
    return usual_file(target, options);
}

/// The file of a probe within a budget; each is made once.
const Made& Budgets::made(std::size_t i, std::uint64_t budget) {
    Made& made = made_[{i, budget}];
    if (!made.bytes.empty()) return made;
    made.bytes = within(targets_[i], budget);
    made.accuracy = measured(made.bytes, targets_[i]);
    return made;
}

/// Geometric mean of the relative variance over the probes.
double Budgets::mean_variance(std::uint64_t budget) {
    double sum = 0.0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const auto& [bytes, accuracy] = made(i, budget);
        EXPECT_LE(bytes.size(), budget);
        EXPECT_GE(double(bytes.size()), 0.97 * double(budget)) << probes[i].file;
        EXPECT_EQ(accuracy.support_violations, 0u);
        std::printf("%-18s %6llu bytes: relative variance %.4g\n", probes[i].file,
                    static_cast<unsigned long long>(bytes.size()), accuracy.relative_variance);
        sum += std::log(accuracy.relative_variance);
    }
    return std::exp(sum / double(targets_.size()));
}

TEST_F(Budgets, SixteenKiB) { EXPECT_LE(mean_variance(16 << 10), 0.0048); }

TEST_F(Budgets, SixtyFourKiB) { EXPECT_LE(mean_variance(64 << 10), 0.0011); }

TEST_F(Budgets, TwoHundredAndFiftySixKiB) { EXPECT_LE(mean_variance(256 << 10), 0.00012); }

/// A file of the paper's fit: its size and relative variance, the better of both orders.
struct Point {
    double bytes = 0.0, variance = 1e30;
};
Point paper_fit(const compress::Target& target, std::uint32_t knots) {
    Point best;
    compress::FitOptions options;
    options.fit = ACDF_FIT_CDF;
    options.column_segments = options.row_segments = knots;
    for (compress::Order order : {compress::Order::phi, compress::Order::z}) {
        options.order = order;
        const std::vector<std::uint8_t> bytes =
            compress::store(compress::fit(target, options).tree, usual_description(target));
        const double variance = measured(bytes, target).relative_variance;
        if (variance < best.variance) best = {double(bytes.size()), variance};
    }
    return best;
}

TEST_F(Budgets, TheFitOfThePaperNeedsFourTimesTheBytes) {
    double sum = 0.0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        const double ours = made(i, 64 << 10).accuracy.relative_variance;
        Point before, after = paper_fit(targets_[i], 64);
        for (std::uint32_t knots = 90; after.variance > ours && knots <= 512; knots = knots * 7 / 5) {
            before = after;
            after = paper_fit(targets_[i], knots);
        }
        ASSERT_LE(after.variance, ours) << probes[i].file;
        // Between the two, variance is about a power of the size.
        const double share = std::log(before.variance / ours) / std::log(before.variance / after.variance);
        const double ratio = before.bytes / 65536.0 * std::pow(after.bytes / before.bytes, share);
        std::printf("%-18s --fit cdf needs %.2f times the bytes of --budget 64KiB\n", probes[i].file, ratio);
        sum += std::log(ratio);
    }
    const double ratio = std::exp(sum / double(targets_.size()));
    std::printf("geometric mean: %.2f\n", ratio);
    EXPECT_GE(ratio, 4.0);
}

TEST_F(Budgets, ATargetVarianceIsReachedAndNotMissedByMuch) {
    for (const double goal : {0.1, 0.01}) {
        for (const compress::Target& target : targets_) {
            compress::HalvingsOptions options;
            options.goal.kind = compress::Goal::Kind::variance;
            options.goal.variance = goal;
            const double variance = measured(usual_file(target, options), target).relative_variance;
            EXPECT_LE(variance, goal * (1.0 + 1e-9));
            EXPECT_GE(variance, 0.97 * goal);
        }
    }
}

TEST_F(Budgets, WeightsStayBelowTheBound) {
    for (const double bound : {2.0, 4.0}) {
        for (const compress::Target& target : targets_) {
            compress::HalvingsOptions options;
            options.max_weight = bound;
            options.goal.kind = compress::Goal::Kind::variance;
            options.goal.variance = 0.05;
            const build::Accuracy accuracy = measured(usual_file(target, options), target);
            EXPECT_LE(accuracy.max_weight, bound * (1.0 + 1e-6));
            EXPECT_LE(accuracy.relative_variance, 0.05);
        }
    }
}

} // namespace
