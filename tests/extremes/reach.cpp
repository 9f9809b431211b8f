// Random numbers are floats in most renderers: 2^24 steps an axis. Which cells can they reach, and how far from
// its pdf is what they sample? Every number of the grid counts: nothing is sampled.
#include "tests/extremes/targets.h"
#include "tests/inputs/environment_file.h"
#include "tests/inputs/sanitized.h"

#include "build/accuracy/cells.h"
#include "compress/fit/fit.h"
#include "compress/store/store.h"
#include "compress/sum.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace acdf_test;
using acdf::compress::Sum;
using acdf::compress::Target;

constexpr std::uint32_t kBits = 24, kSteps = 1u << kBits;

/// Integers in [low, high).
struct Steps {
    std::uint32_t low, high;
    std::uint32_t count() const { return high > low ? high - low : 0; }
};

/// The numbers k / scale, k an integer from 0 to kSteps - 1, in [low, low + width).
Steps steps_in(double low, double width, double scale) {
    const auto first = [&](double x) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(x * scale), 0.0, double{kSteps}));
    };
    return {first(low), first(low + width)};
}

/// Blocks of 2^n numbers that begin at a multiple of 2^n: what [low, high) is made of.
struct Block {
    std::uint32_t low, bits;
};
std::vector<Block> blocks(Steps steps) {
    std::vector<Block> out;
    for (std::uint32_t at = steps.low; at < steps.high;) {
        std::uint32_t bits = 0;
        while (bits < kBits && at % (2u << bits) == 0 && at + (2u << bits) <= steps.high) ++bits;
        out.push_back({at, bits});
        at += 1u << bits;
    }
    return out;
}

/// How many k in `plain` have their reverse in `reversed`.
std::uint64_t count_reversed(Steps plain, Steps reversed) {
    if (reversed.count() == kSteps) return plain.count();
    std::uint64_t count = 0;
    for (const Block& p : blocks(plain))
        for (const Block& r : blocks(reversed)) {
            // p fixes the upper bits of k, r its lower ones.
            const std::uint32_t upper = kBits - p.bits, lower = kBits - r.bits;
            const std::uint32_t fixed = acdf_reverse24(r.low); // its lower `lower` bits are what r fixes
            if (upper + lower <= kBits) {
                count += std::uint64_t{1} << (kBits - upper - lower);
                continue;
            }
            const std::uint32_t both = ((1u << lower) - 1) & ~((1u << (kBits - upper)) - 1); // bits that both fix
            count += (p.low & both) == (fixed & both);
        }
    return count;
}

/// Pairs of floats (k0, k1) / 2^24 that lead into a cell: as they are, and widened.
struct Pairs {
    std::uint64_t plain = 0, widened = 0;
};

/// For one step k of an axis, the reverses of the other number that lead into [low, low + width).
Steps reverses(std::uint32_t k, const AcdfStratum& s) {
    return steps_in(s.low * kSteps - k, s.width * kSteps, double{kSteps});
}

Pairs pairs_into(const AcdfStratum strata[2]) {
    Pairs pairs;
    Steps touched[2], inside[2]; // steps of which any part, or all, lies in the stratum
    for (int a = 0; a < 2; ++a) {
        const double low = strata[a].low * kSteps, high = (strata[a].low + strata[a].width) * kSteps;
        touched[a] = {static_cast<std::uint32_t>(std::floor(low)),
                      static_cast<std::uint32_t>(std::min(std::ceil(high), double{kSteps}))};
        inside[a] = {static_cast<std::uint32_t>(std::ceil(low)), static_cast<std::uint32_t>(std::floor(high))};
        if (inside[a].high < inside[a].low) inside[a].high = inside[a].low;
    }
    pairs.plain = std::uint64_t{steps_in(strata[0].low, strata[0].width, kSteps).count()} *
                  steps_in(strata[1].low, strata[1].width, kSteps).count();
    pairs.widened = std::uint64_t{inside[0].count()} * inside[1].count();
    const auto at_border = [&](int a, std::uint32_t k) { return k < inside[a].low || k >= inside[a].high; };
    for (int a = 0; a < 2; ++a) // one number at a border, the other inside
        for (std::uint32_t k = touched[a].low; k < touched[a].high; ++k) {
            if (inside[a].count() > 0 && k == inside[a].low) k = inside[a].high;
            if (k >= touched[a].high) break;
            pairs.widened += count_reversed(inside[1 - a], reverses(k, strata[a]));
        }
    for (std::uint32_t k0 = touched[0].low; k0 < touched[0].high; ++k0) { // both at a border
        if (inside[0].count() > 0 && k0 == inside[0].low) k0 = inside[0].high;
        if (k0 >= touched[0].high) break;
        for (std::uint32_t k1 = touched[1].low; k1 < touched[1].high; ++k1) {
            if (inside[1].count() > 0 && k1 == inside[1].low) k1 = inside[1].high;
            if (k1 >= touched[1].high) break;
            if (!at_border(0, k0) || !at_border(1, k1)) continue;
            const Steps r0 = reverses(k0, strata[0]), r1 = reverses(k1, strata[1]);
            const std::uint32_t h0 = acdf_reverse24(k1), h1 = acdf_reverse24(k0);
            pairs.widened += h0 >= r0.low && h0 < r0.high && h1 >= r1.low && h1 < r1.high;
        }
    }
    return pairs;
}

// ---- the counting itself -------------------------------------------------------------------------------

TEST(Widening, ReversesBits) {
    EXPECT_EQ(acdf_reverse24(0), 0u);
    EXPECT_EQ(acdf_reverse24(1), 1u << 23);
    EXPECT_EQ(acdf_reverse24(0xFFFFFF), 0xFFFFFFu);
    EXPECT_EQ(acdf_reverse24(0x000013), 0xC80000u);
    std::mt19937_64 random(1);
    for (int i = 0; i < 1000; ++i) {
        const auto k = static_cast<std::uint32_t>(random() % kSteps);
        EXPECT_EQ(acdf_reverse24(acdf_reverse24(k)), k);
    }
}

TEST(Widening, StaysInItsStepAndUsesTheOtherNumber) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 10000; ++i) {
        const auto k0 = static_cast<std::uint32_t>(random() % kSteps),
                   k1 = static_cast<std::uint32_t>(random() % kSteps);
        double u[2];
        acdf_widen(static_cast<float>(k0) * 0x1p-24f, static_cast<float>(k1) * 0x1p-24f, u);
        EXPECT_EQ(std::floor(u[0] * kSteps), k0);
        EXPECT_EQ(std::floor(u[1] * kSteps), k1);
        EXPECT_EQ((u[0] * kSteps - k0) * kSteps, acdf_reverse24(k1));
        EXPECT_EQ((u[1] * kSteps - k1) * kSteps, acdf_reverse24(k0));
    }
    double u[2];
    acdf_widen(1.0f, NAN, u);
    EXPECT_LT(u[0], 1.0);
    EXPECT_GE(u[0], 1.0 - 0x1p-24);
    EXPECT_EQ(std::floor(u[1] * kSteps), 0.0);
    acdf_widen(0x1p-30f, 0.5f, u); // finer than a step: kept
    EXPECT_EQ(u[0], 0x1p-30);
}

TEST(Widening, CountsAreThoseOfTryingAll) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20; ++i) {
        const auto some = [&] { return static_cast<std::uint32_t>(random() % (kSteps + 1)); };
        Steps plain{some(), some()}, reversed{some(), some()};
        if (plain.low > plain.high) std::swap(plain.low, plain.high);
        if (reversed.low > reversed.high) std::swap(reversed.low, reversed.high);
        if (i % 2) reversed.high = std::min(reversed.high, reversed.low + 300);
        if (plain.count() > 200000) plain.high = plain.low + 200000;
        std::uint64_t tried = 0;
        for (std::uint32_t k = plain.low; k < plain.high; ++k) {
            const std::uint32_t r = acdf_reverse24(k);
            tried += r >= reversed.low && r < reversed.high;
        }
        EXPECT_EQ(count_reversed(plain, reversed), tried);
    }
}

// ---- environments --------------------------------------------------------------------------------------

/// A sun of half a degree, a million times as bright as the sky around it.
Target sun_in_sky(std::uint32_t columns, std::uint32_t rows) {
    Target target;
    target.columns = columns;
    target.rows = rows;
    target.column_axis = ACDF_AXIS_PHI;
    target.row_axis = ACDF_AXIS_THETA;
    target.column_measure.assign(columns, 2.0 * kPi / columns);
    for (std::uint32_t r = 0; r < rows; ++r)
        target.row_measure.push_back(acdf_row_z(r, rows) - acdf_row_z(r + 1, rows));
    target.values.resize(std::size_t{columns} * rows);
    const double radius = 0.0045, theta = 1.1, phi = 0.7;
    std::vector<float> wave(columns);
    for (std::uint32_t c = 0; c < columns; ++c)
        wave[c] = static_cast<float>(1.0 + 0.5 * std::cos(centre_phi(c, columns) - 1.0));
    for (std::uint32_t r = 0; r < rows; ++r) {
        const double t = kPi * (r + 0.5) / rows;
        const auto sky = static_cast<float>(1.0 + 0.6 * std::cos(t));
        for (std::uint32_t c = 0; c < columns; ++c) {
            const double across = (centre_phi(c, columns) - phi) * std::sin(theta), down = t - theta;
            const double size = std::max(radius, 0.51 * kPi / rows);
            const bool sun = across * across + down * down < size * size;
            target.values[std::size_t{r} * columns + c] = sky * wave[c] * (sun ? 1e6f : 1.0f);
        }
    }
    target.total = acdf::compress::integral(target);
    return target;
}

struct Reach {
    std::uint64_t cells = 0, unreachable_plain = 0, unreachable_widened = 0;
    std::uint64_t plain = 0, widened = 0;        ///< pairs that lead into any cell
    double bias_plain = 0.0, bias_widened = 0.0; ///< of the estimate of the integral, relative
    double dark_plain = 0.0, dark_widened = 0.0; ///< share of the energy in cells out of reach
};

Reach reach(const Target& target, const acdf::compress::FitOptions& options) {
    const auto bytes = environment_file(target, options);
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
    EXPECT_TRUE(status.ok()) << status.message;
    const AcdfEnvironment env = file.environment().data();
    Reach out;
    Sum bias_plain, bias_widened;
    acdf::build::for_each_cell(file.environment(), [&](const acdf::build::Cell& cell) {
        Sum energy;
        for (std::uint32_t r = cell.range[1].low; r < cell.range[1].high; ++r) {
            Sum row;
            for (std::uint32_t c = cell.range[0].low; c < cell.range[0].high; ++c)
                row.add(double{target.row(r)[c]});
            energy.add(row.value() * target.row_measure[r] * target.column_measure[0]);
        }
        if (!(energy.value() > 0.0)) return;
        const std::uint32_t square[2] = {cell.range[0].low, cell.range[1].low};
        AcdfRange range[2];
        AcdfStratum strata[2];
        const double p = acdf_environment_find_square(&env, square, range, strata);
        EXPECT_NEAR(strata[0].width * strata[1].width / p, 1.0, 1e-9);
        const Pairs pairs = pairs_into(strata);
        const double share = energy.value() / target.total;
        bias_plain.add(share * (static_cast<double>(pairs.plain) * 0x1p-48 / p - 1.0));
        bias_widened.add(share * (static_cast<double>(pairs.widened) * 0x1p-48 / p - 1.0));
        ++out.cells;
        out.plain += pairs.plain;
        out.widened += pairs.widened;
        out.unreachable_plain += pairs.plain == 0;
        out.unreachable_widened += pairs.widened == 0;
        if (pairs.plain == 0) out.dark_plain += share;
        if (pairs.widened == 0) out.dark_widened += share;
    });
    out.bias_plain = std::abs(bias_plain.value());
    out.bias_widened = std::abs(bias_widened.value());
    return out;
}

void report(const char* what, std::uint32_t columns, const Reach& r) {
    std::printf(
        "%s, %u columns: %llu cells; floats as they are: %llu out of reach with %.2g of the energy, bias %.2g; "
        "widened: %llu, %.2g, bias %.2g\n",
        what, columns, static_cast<unsigned long long>(r.cells),
        static_cast<unsigned long long>(r.unreachable_plain), r.dark_plain, r.bias_plain,
        static_cast<unsigned long long>(r.unreachable_widened), r.dark_widened, r.bias_widened);
}

class Reachability : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(Reachability, FloatsReachAllLightWithoutBias) {
    const std::uint32_t columns = GetParam();
    if (kSanitized && columns > 1024) GTEST_SKIP() << "too large a map for sanitizers";
    const Target target = sun_in_sky(columns, columns / 2);
    acdf::compress::FitOptions variance, paper;
    paper.fit = ACDF_FIT_CDF;
    const std::pair<const char*, acdf::compress::FitOptions> fits[] = {{"variance", variance}, {"cdf", paper}};
    for (const auto& [name, options] : fits) {
        const Reach r = reach(target, options);
        report(name, columns, r);
        EXPECT_EQ(r.plain, std::uint64_t{1} << 48) << name << ": its CDFs end at exactly 1";
        // The strata of cells are known to about 2^-52: less than a pair each, but not exactly.
        EXPECT_NEAR(static_cast<double>(r.widened) * 0x1p-48, 1.0, 1e-12) << name;
        EXPECT_EQ(r.unreachable_plain, 0u) << name;
        EXPECT_EQ(r.unreachable_widened, 0u) << name;
        EXPECT_LT(r.bias_widened, 1e-9) << name;
        EXPECT_LT(r.bias_plain, 1e-5) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Suns, Reachability, ::testing::Values(1024u, 4096u, 16384u));

// ---- deep trees ----------------------------------------------------------------------------------------

/// A chain of curves with two segments, of which the first has probability `share` and goes on.
std::vector<std::uint8_t> chain(std::uint32_t depth, double share, bool one_axis) {
    acdf::compress::Cascade cascade;
    std::uint32_t high[2] = {1u << 14, 1u << 13};
    for (std::uint32_t i = 0; i < depth; ++i) {
        acdf::compress::Curve curve;
        curve.axis = one_axis ? 0 : i % 2;
        high[curve.axis] /= 2;
        curve.knots = {high[curve.axis]};
        curve.probability = {share, 1.0 - share};
        if (i + 1 < depth) curve.children = {static_cast<std::int32_t>(i + 1), -1};
        cascade.curves.push_back(curve);
    }
    cascade.roots = {0};
    return acdf::compress::store(acdf::compress::encode_tree(cascade),
                                 acdf::compress::environment_description(1u << 14, 1u << 13));
}

TEST(DeepTrees, AtDepth12EveryCellIsReachedAsOftenAsItShould) {
    const double shares[] = {0.5, 0.125, 1.0 / 11};
    for (const bool one_axis : {false, true})
        for (const double share : shares) {
            const auto bytes = chain(12, share, one_axis);
            acdf::File file;
            const acdf::Status status =
                acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves());
            ASSERT_TRUE(status.ok()) << status.message;
            const AcdfEnvironment env = file.environment().data();
            std::uint64_t all = 0, cells = 0;
            acdf::build::for_each_cell(file.environment(), [&](const acdf::build::Cell& cell) {
                const std::uint32_t square[2] = {cell.range[0].low, cell.range[1].low};
                AcdfRange range[2];
                AcdfStratum strata[2];
                const double p = acdf_environment_find_square(&env, square, range, strata);
                const std::uint64_t pairs = pairs_into(strata).widened;
                EXPECT_NEAR(static_cast<double>(pairs) * 0x1p-48, p, 1e-3 * p + 0x1p-44);
                EXPECT_GT(pairs, 0u);
                all += pairs;
                ++cells;
                // And the numbers that invert returns do lead back, with all bits of a double.
                float direction[3];
                direction_of(kPi - 2.0 * kPi * (cell.range[0].low + 0.4) / env.columns,
                             std::cos(kPi * (cell.range[1].low + 0.4) / env.rows), direction);
                double u[2];
                ASSERT_TRUE(file.environment().invert(direction, u));
                const auto again = file.environment().sample(u[0], u[1]);
                for (int i = 0; i < 3; ++i) EXPECT_NEAR(again.direction[i], direction[i], 2e-6);
                EXPECT_EQ(again.pdf, file.environment().pdf(direction));
            });
            EXPECT_EQ(cells, 13u);
            EXPECT_EQ(all, std::uint64_t{1} << 48); // each pair leads somewhere, once
        }
}

} // namespace
