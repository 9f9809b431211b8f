// The parts under the subcommands: sizes, sequences.
#include "measure/sequences.h"
#include "tools/cli/number_range.h"
#include "tools/cli/sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace acdf::tools;
using acdf::measure::Sequence;
using acdf::measure::SequenceKind;

namespace {

TEST(Sizes, Parse) {
    EXPECT_EQ(parse_size("0"), 0u);
    EXPECT_EQ(parse_size("1000"), 1000u);
    EXPECT_EQ(parse_size("1000 bytes"), 1000u);
    EXPECT_EQ(parse_size("64KiB"), 65536u);
    EXPECT_EQ(parse_size("64kib"), 65536u);
    EXPECT_EQ(parse_size("64 KiB"), 65536u);
    EXPECT_EQ(parse_size("64k"), 64000u);
    EXPECT_EQ(parse_size("2MB"), 2000000u);
    EXPECT_EQ(parse_size("1.5MiB"), 1572864u);
    EXPECT_EQ(parse_size("3GiB"), 3221225472u);
    EXPECT_EQ(parse_size("0.0001KiB"), 0u);
    for (const char* text :
         {"", "KiB", "-1", "-0", "64 Kib/s", "1e3", "nan", "inf", "64KiB ", " 64", "99999999999GiB"})
        EXPECT_FALSE(parse_size(text)) << text;
}

TEST(Sizes, Print) {
    EXPECT_EQ(to_readable_size(0), "0 bytes");
    EXPECT_EQ(to_readable_size(1), "1 byte");
    EXPECT_EQ(to_readable_size(1000), "1000 bytes");
    EXPECT_EQ(to_readable_size(65536), "64 KiB");
    EXPECT_EQ(to_readable_size(1023 * 1024), "0.999 MiB");
    EXPECT_EQ(to_readable_size(1572864), "1.5 MiB");
    EXPECT_EQ(to_readable_size(3221225472), "3 GiB");
}

TEST(Sequences, StratifiedHasOnePointInEachBox) {
    for (const std::uint64_t n : {1u, 2u, 7u, 16u, 97u, 1000u}) {
        Sequence sequence(SequenceKind::stratified, n, 3);
        const auto rows = static_cast<std::uint64_t>(std::llround(std::sqrt(static_cast<double>(n))));
        double row_low = 0.0;
        for (std::uint64_t row = 0; row < rows; ++row) {
            const std::uint64_t count = n / rows + (row < n % rows ? 1 : 0);
            const double row_high = row_low + static_cast<double>(count) / static_cast<double>(n);
            for (std::uint64_t i = 0; i < count; ++i) {
                const auto u = sequence.next();
                const double box = u[0] * static_cast<double>(count);
                EXPECT_TRUE(box >= static_cast<double>(i) && box < static_cast<double>(i + 1)) << n;
                EXPECT_TRUE(u[1] >= row_low - 1e-15 && u[1] < row_high + 1e-15) << n;
            }
            row_low = row_high;
        }
    }
}

// Each of the elementary boxes 2^-i x 2^-(k-i) holds exactly one of the first 2^k points, for every i: what
// defines a (0, 2)-sequence.
TEST(Sequences, SobolIsAZeroTwoSequence) {
    constexpr int k = 8;
    for (const bool shifted : {false, true})
        for (int i = 0; i <= k; ++i) {
            Sequence sequence(SequenceKind::sobol, 1 << k,
                              shifted ? std::optional<std::uint64_t>(5) : std::nullopt);
            std::set<std::pair<int, int>> boxes;
            for (int n = 0; n < 1 << k; ++n) {
                const auto u = sequence.next();
                boxes.emplace(static_cast<int>(std::ldexp(u[0], i)), static_cast<int>(std::ldexp(u[1], k - i)));
            }
            EXPECT_EQ(boxes.size(), std::size_t{1} << k) << i;
        }
}

TEST(Sequences, SobolBeginsAsPublished) {
    const double expected[][2] = {{0, 0}, {0.5, 0.5}, {0.25, 0.75}, {0.75, 0.25}, {0.125, 0.625}, {0.625, 0.125}};
    for (std::uint32_t i = 0; i < 6; ++i) {
        const auto point = acdf::measure::sobol_point(i);
        EXPECT_EQ(point[0] * 0x1p-32, expected[i][0]) << i;
        EXPECT_EQ(point[1] * 0x1p-32, expected[i][1]) << i;
    }
}

TEST(NumberRange, TakesFiniteNumbersAlone) {
    const CLI::Validator fraction = acdf::tools::number_range(0.0, 1.0), positive = acdf::tools::positive_number();
    for (const char* good : {"0.5", "1", "1e-300"}) {
        EXPECT_EQ(fraction(std::string(good)), "") << good;
        EXPECT_EQ(positive(std::string(good)), "") << good;
    }
    for (const char* bad : {"nan", "-nan", "NaN(1)", "inf", "-inf", "infinity", "1e999", "-1", "x", ""}) {
        EXPECT_NE(fraction(std::string(bad)), "") << bad;
        EXPECT_NE(positive(std::string(bad)), "") << bad;
    }
    EXPECT_NE(fraction(std::string("1.5")), "");
    EXPECT_NE(positive(std::string("0")), "");
    EXPECT_LT(positive(std::string("0")).size(), 60u);
}

} // namespace
