// Tables that are made to be combined with another table, against slow references.
#include "tests/inputs/table_files.h"
#include "tests/lib/compress/chi_square.h"

#include "build/table_partner.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace {

using namespace acdf;
using namespace acdf::test;

constexpr std::uint32_t kBins = 3, kX = 24, kY = 20, kPoints = kX * kY;

build::TableOptions beside(const input::NpyArray& other, AcdfHeuristic heuristic, double light) {
    build::TableOptions options;
    options.indexed = 1;
    options.cells = 200;
    options.mis = {ACDF_PARTNER_TABLE, heuristic, light, 1.0};
    options.other = &other;
    return options;
}

/// What a file samples of a bin, what its partner does, and f: pdfs at the middles of boxes, of one each.
struct BesideOther {
    std::vector<double> f, p, b;

    BesideOther(const File& file, const input::NpyArray& array, const input::NpyArray& other, std::uint32_t bin) {
        double sum_f = 0.0, sum_b = 0.0;
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            f.push_back(double{array.values[bin * kPoints + i]});
            b.push_back(double{other.values[bin * kPoints + i]});
            sum_f += f.back();
            sum_b += b.back();
            const double x[2] = {i / kY + 0.5, i % kY + 0.5};
            p.push_back(file.table().pdf(&bin, x));
        }
        for (double& value : f) value /= sum_f;
        for (double& value : b) value = sum_b > 0.0 ? value / sum_b : 0.0;
    }

    /// N times the variance of N samples.
    double variance(double share, AcdfHeuristic heuristic) const {
        double mean[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
        for (std::size_t i = 0; i < f.size(); ++i) {
            const double q[2] = {p[i], b[i]}, a[2] = {share * p[i], (1.0 - share) * b[i]};
            for (int k = 0; k < 2; ++k) {
                if (!(q[k] > 0.0)) continue;
                const double x = f[i] * (heuristic == ACDF_HEURISTIC_POWER ? a[k] / (a[0] * a[0] + a[1] * a[1])
                                                                           : 1.0 / (a[0] + a[1]));
                mean[k] += q[k] * x;
                square[k] += q[k] * x * x;
            }
        }
        return share * (square[0] - mean[0] * mean[0]) + (1.0 - share) * (square[1] - mean[1] * mean[1]);
    }
    double second_moment(double share) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < f.size(); ++i)
            if (f[i] > 0.0) sum += f[i] * f[i] / (share * p[i] + (1.0 - share) * b[i]);
        return sum;
    }
    /// With the pdf that is best in each box by the balance heuristic.
    double least_variance(double share) const {
        const double ratio = share / (1.0 - share);
        double low = 1e-6, high = 1.0 / ratio;
        const auto sum = [&](double nu) {
            double out = 0.0;
            for (std::size_t i = 0; i < f.size(); ++i) out += std::max(0.0, f[i] - nu * b[i]);
            return out;
        };
        for (int step = 0; step < 100; ++step) {
            const double nu = std::sqrt(low * high);
            (sum(nu) > nu * ratio ? low : high) = nu;
        }
        BesideOther best = *this;
        for (std::size_t i = 0; i < f.size(); ++i) best.p[i] = std::max(0.0, f[i] - high * b[i]) / sum(high);
        return best.variance(share, ACDF_HEURISTIC_BALANCE);
    }
};

/// An MIS partner that knows the bump, and not the noise; in the last bin it has nothing.
input::NpyArray smooth() {
    return array_of({kBins, kX, kY}, [](const ShapeVector& i) {
        const double x = (i[1] + 0.5) / kX - 0.4, y = (i[2] + 0.5) / kY - 0.5;
        return i[0] + 1 == kBins ? 0.0 : std::exp(-8.0 * (x * x + y * y));
    });
}

TEST(TablePartner, IsMeasuredAsASlowReferenceDoesAndNearTheBestThereIs) {
    const input::NpyArray array = noisy_array({kBins, kX, kY}, 5, 0.1), other = smooth();
    for (const AcdfHeuristic heuristic : {ACDF_HEURISTIC_BALANCE, ACDF_HEURISTIC_POWER})
        for (const double light : {1.0, 3.0}) {
            build::TableOptions options = beside(other, heuristic, light);
            options.cells = kPoints;
            const build::Table made = table_of(array, options);
            const LoadedTable loaded(made.bytes);
            const double share = light / (light + 1.0);
            EXPECT_TRUE(loaded.file.table().requires_mis());
            EXPECT_EQ(made.accuracy.support_violations, 0u);
            double sum = 0.0;
            for (std::uint32_t bin = 0; bin < kBins; ++bin) {
                const BesideOther at(loaded.file, array, other, bin);
                const double variance = at.variance(share, heuristic);
                sum += variance / kBins;
                if (heuristic == ACDF_HEURISTIC_BALANCE) {
                    EXPECT_LT(variance, 1.05 * at.least_variance(share) + 2e-3) << bin;
                }
            }
            EXPECT_NEAR(made.accuracy.relative_variance, sum, 1e-6 * sum + 1e-9);
        }
}

TEST(TablePartner, HasLessNoiseThanAFileThatIsMadeToBeUsedAlone) {
    const input::NpyArray array = noisy_array({kBins, kX, kY}, 5, 0.1), other = smooth();
    const LoadedTable with(table_of(array, beside(other, ACDF_HEURISTIC_BALANCE, 1.0)).bytes);
    build::TableOptions options = beside(other, ACDF_HEURISTIC_BALANCE, 1.0);
    options.mis = {};
    const LoadedTable alone(table_of(array, options).bytes);
    for (std::uint32_t bin = 0; bin + 1 < kBins; ++bin) {
        const BesideOther ours(with.file, array, other, bin), theirs(alone.file, array, other, bin);
        EXPECT_LT(ours.variance(0.5, ACDF_HEURISTIC_BALANCE), 0.9 * theirs.variance(0.5, ACDF_HEURISTIC_BALANCE));
        EXPECT_GT(std::count(ours.p.begin(), ours.p.end(), 0.0), 0);
        // The share that is recommended has the least moment of all steps of 1/32.
        std::size_t best = 1;
        for (std::size_t k = 2; k < 32; ++k)
            if (ours.second_moment(double(k) / 32.0) < ours.second_moment(double(best) / 32.0)) best = k;
        EXPECT_EQ(with.file.table().recommended_light_share(&bin), static_cast<float>(best) / 32.0f);
    }
}

TEST(TablePartner, SamplesFollowThePdf) {
    const input::NpyArray array = noisy_array({kBins, kX, kY}, 5, 0.1), other = smooth();
    const LoadedTable loaded(table_of(array, beside(other, ACDF_HEURISTIC_BALANCE, 1.0)).bytes);
    std::mt19937_64 random(11);
    for (std::uint32_t bin = 0; bin < kBins; ++bin) {
        const BesideOther at(loaded.file, array, other, bin);
        double sum = 0.0;
        for (const double p : at.p) sum += p;
        EXPECT_NEAR(sum, 1.0, 1e-9);
        std::vector<std::uint32_t> observed(kPoints, 0);
        for (int k = 0; k < 20000; ++k) {
            const double u[2] = {acdf_test::uniform(random), acdf_test::uniform(random)};
            double x[2];
            const double p = loaded.file.table().sample(&bin, u, x);
            ASSERT_EQ(p, loaded.file.table().pdf(&bin, x));
            ++observed[static_cast<std::uint32_t>(x[0]) * kY + static_cast<std::uint32_t>(x[1])];
        }
        const acdf_test::ChiSquare test = acdf_test::chi_square(observed, at.p);
        EXPECT_FALSE(test.impossible);
        EXPECT_GT(test.p_value, 0.01 / kBins);
    }
}

TEST(TablePartner, CommandMakesAndMeasuresIt) {
    const Folder folder;
    const input::NpyArray array = noisy_array({kBins, kX, kY}, 5, 0.1), other = smooth();
    write_text(folder / "a.npy", npy_file(array.values, array.shape));
    write_text(folder / "b.npy", npy_file(other.values, other.shape));
    write_text(folder / "c.npy", npy_file(std::vector<float>(kPoints, 1.0f), {kX, kY}));
    const std::string a = folder / "a.npy", b = folder / "b.npy", c = folder / "c.npy", file = folder / "a.acdf";
    const Result made = run_acdf(
        {"table", a, "-o", file, "--indexed", "1", "--cells", "200", "--mis", b, "--shares", "2:1", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto report = nlohmann::json::parse(made.out);
    EXPECT_EQ(report["combined"], true);
    EXPECT_EQ(run_acdf({"validate", "--strict", file}).code, 0);
    const auto info = nlohmann::json::parse(run_acdf({"info", "--json", file}).out);
    EXPECT_EQ(info["partner"]["kind"], "table");
    EXPECT_EQ(info["options"], "--indexed 1 --cells 200 --mis table --shares 2:1");
    const auto measured =
        nlohmann::json::parse(run_acdf({"measure", file, "--against", a, "--mis", b, "--json"}).out);
    for (const char* key : {"relative_variance", "relative_variance_worst", "max_weight", "cells", "combined"})
        EXPECT_EQ(measured[key], report[key]) << key;

    const auto fails = [](const std::vector<std::string>& command, int code) {
        const Result result = run_acdf(command);
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    };
    fails({"measure", file, "--against", a}, 1);
    fails({"table", a, "-o", folder / "x.acdf", "--mis", c}, 1);
    fails({"table", a, "-o", folder / "x.acdf", "--shares", "1:1"}, 2);
    fails({"table", a, "-o", folder / "x.acdf", "--mis", b, "--max-weight", "3"}, 2);
}

} // namespace
